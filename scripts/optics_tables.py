#!/usr/bin/env python3
"""Write the tables of refractive indices that the crate `airlight` embeds (standard library only).

    python3 scripts/optics_tables.py water segelstein81_index.txt data/optics/water_index.txt

(output path relative to crates/airlight/)

Sources
  water  D. J. Segelstein, The Complex Refractive Index of Water, M.S. thesis, University of Missouri-Kansas City, 1981:
         columns wavelength (micrometres), n, k, as shipped with miepython 3.3.0 (`miepython/data/`).
"""

import sys

from embedded_table import write


def water(source, path):
    rows = []
    with open(source, encoding="utf-8") as lines:
        for line in lines:
            fields = line.split()
            if len(fields) == 3 and fields[0][0].isdigit():
                nm = 1e3 * float(fields[0])
                if 200.0 <= nm <= 4000.0:
                    rows.append((f"{nm:.6g}", fields[1], f"{float(fields[2]):.4g}"))
    write(
        path,
        [
            "Complex refractive index n + i k of liquid water at 298 K.",
            "Columns: wavelength nm, n, k.",
            "Source: D. J. Segelstein, The Complex Refractive Index of Water, M.S. thesis, University of Missouri-Kansas",
            "City, 1981.",
            "Made by scripts/optics_tables.py water",
        ],
        rows,
    )


if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] != "water":
        sys.exit(__doc__)
    water(sys.argv[2], sys.argv[3])

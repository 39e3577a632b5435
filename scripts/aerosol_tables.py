#!/usr/bin/env python3
"""Write the tables of aerosol materials that the crate `airlight` embeds (standard library only).

    python3 scripts/aerosol_tables.py FOLDER

FOLDER holds the refractive indices of the database OPAC as text files, as distributed with MOPSMAP 1.0 (folder `data/`;
`refr_mineral` is in `misc/paper_examples/`): columns wavelength (micrometres), n, k. The tables are written to
crates/airlight/data/atmosphere/.

Sources
  OPAC     M. Hess, P. Koepke & I. Schult, Optical Properties of Aerosols and Clouds: The Software Package OPAC, Bull. Amer.
           Meteor. Soc. 79, 831-844, 1998.
  MOPSMAP  J. Gasteiger & M. Wiegner, MOPSMAP v1.0, Geosci. Model Dev. 11, 2739-2762, 2018.

The hygroscopic growth follows from the indices: OPAC mixes the solute with water by volume, so that

    m(wet) = m(water) + (m(dry) - m(water)) (r_dry / r_wet)^3

with the same ratio at all wavelengths. It is computed from k at the wavelength where the digits of k resolve it best.
"""

import os
import sys

MATERIALS = ["insoluble", "water_soluble", "soot", "seasalt", "mineral", "sulfate", "water"]
HUMIDITIES = [50, 70, 80, 90, 95, 98, 99]
# Column: file of the dry index, stem of the wet ones, wavelength (micrometres) to compare at.
GROWING = [("water_soluble", "waso", 1.0), ("seasalt", "seasalt", 1.0), ("sulfate", "suso", 0.25)]
SOURCE = [
    "Source: M. Hess, P. Koepke & I. Schult, Optical Properties of Aerosols and Clouds: The Software Package OPAC, Bull.",
    "Amer. Meteor. Soc. 79, 831-844, 1998; indices as shipped with MOPSMAP 1.0 (J. Gasteiger & M. Wiegner, Geosci. Model",
    "Dev. 11, 2739-2762, 2018).",
    "Made by scripts/aerosol_tables.py",
]
OUT = os.path.join(os.path.dirname(__file__), "../crates/airlight/data/medium")


def index(folder, name):
    rows = {}
    with open(os.path.join(folder, "refr_" + name), encoding="ascii") as lines:
        for line in lines:
            um, n, k = line.split()
            rows[float(um)] = (float(n), float(k))
    return rows


def write(name, header, rows):
    with open(os.path.join(OUT, name), "w", encoding="ascii", newline="\n") as out:
        for line in header + SOURCE:
            out.write(f"# {line}\n")
        for row in rows:
            out.write(" ".join(row) + "\n")


def main(folder):
    indices = [index(folder, name) for name in MATERIALS]
    rows = []
    for um in sorted(indices[0]):
        if um <= 1.25:
            pairs = [f"{n:.3f} {k:.4g}" for n, k in (material[um] for material in indices)]
            rows.append([f"{1e3 * um:.0f}", *pairs])
    header = [
        "Complex refractive indices n + i k of the materials of aerosols, dry; the last is water.",
        "Columns: wavelength nm, then n and k of insoluble, water-soluble, soot, sea salt, mineral, sulfate (75 % H2SO4), water.",
    ]
    write("aerosol_indices.txt", header, rows)
    water = index(folder, "water")
    rows = [["0", *("1" for _ in GROWING)]]
    for humidity in HUMIDITIES:
        row = [f"{humidity / 100:.2f}"]
        for dry, wet, um in GROWING:
            k_dry, k_water = index(folder, dry)[um][1], water[um][1]
            k_wet = index(folder, f"{wet}{humidity}")[um][1]
            row.append(f"{((k_wet - k_water) / (k_dry - k_water)) ** (-1 / 3):.4g}")
        rows.append(row)
    header = [
        "Growth of particles in moist air: radius over dry radius.",
        "Columns: relative humidity, water-soluble, sea salt, sulfate.",
        "Found from the refractive indices of the wet materials, see the script.",
    ]
    write("aerosol_growth.txt", header, rows)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])

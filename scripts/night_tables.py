#!/usr/bin/env python3
"""Write the tables of the night sky that the crate `airlight` embeds.

    python3 scripts/night_tables.py stars    bsc5-short.json    data/night/bright_stars.txt
    python3 scripts/night_tables.py airglow  airglow_130sfu.dat data/night/airglow.txt

(output paths relative to crates/airlight/)

Sources
  stars    Hoffleit & Warren 1991, The Bright Star Catalogue, 5th revised edition (preliminary version), CDS catalogue V/50, as JSON:
           a list of objects with "RA" ("00h 05m 09.9s"), "Dec" ("+45d 13' 45""), both J2000, "V" (magnitude) and "K" (colour
           temperature, K). Stars without position or magnitude, and stars fainter than 6.5, are left out.
  airglow  ESO SkyCalc, the Cerro Paranal Advanced Sky Model (Noll et al. 2012, Astron. Astrophys. 543, A92): columns wavelength nm
           and radiance of the airglow at the zenith, photons s^-1 m^-2 um^-1 arcsec^-2, for a solar radio flux of 130 sfu.
           Averaged over 10 nm.
"""

import json
import re
import sys

from embedded_table import write

FAINTEST = 6.5
"""Magnitude of the faintest stars in the table."""
TEMPERATURE_K = 6000
"""Colour temperature of stars of which the catalogue has none."""


def angle(text):
    numbers = [float(number) for number in re.findall(r"[0-9.]+", text)]
    value = numbers[0] + numbers[1] / 60 + numbers[2] / 3600
    return -value if text.strip().startswith(("-", "\u2212")) else value


def stars(source, path):
    with open(source, encoding="utf-8") as file:
        catalogue = json.load(file)
    rows = []
    for star in catalogue:
        if not all(key in star for key in ("RA", "Dec", "V")) or float(star["V"]) > FAINTEST:
            continue
        right_ascension, declination = 15 * angle(star["RA"]), angle(star["Dec"])
        temperature = star.get("K", TEMPERATURE_K)
        rows.append((f"{right_ascension:.3f}", f"{declination:.3f}", f"{float(star['V']):g}", f"{float(temperature):g}"))
    rows.sort(key=lambda row: float(row[2]))
    write(
        path,
        [
            f"Stars up to magnitude {FAINTEST}, brightest first.",
            "Columns: right ascension and declination (J2000) deg, V magnitude, colour temperature K.",
            "Source: Hoffleit & Warren 1991, The Bright Star Catalogue, 5th revised edition, CDS V/50.",
            "Made by scripts/night_tables.py stars",
        ],
        rows,
    )


def airglow(source, path):
    planck_j_s, light_m_s, square_arcsec_per_sr = 6.62607015e-34, 299792458.0, 4.25451703e10
    bins = {}
    with open(source, encoding="ascii") as lines:
        for line in lines:
            if line.startswith("#"):
                continue
            nm, photons = (float(field) for field in line.split())
            watts = photons * 1e-3 * square_arcsec_per_sr * planck_j_s * light_m_s / (nm * 1e-9)
            bins.setdefault(int(nm // 10), []).append(watts)
    rows = [(f"{10 * i + 5}", f"{sum(b) / len(b):.4g}") for i, b in sorted(bins.items()) if 30 <= i < 90]
    write(
        path,
        [
            "Radiance of the airglow at the zenith for a solar radio flux of 130 sfu.",
            "Columns: middle of a band of 10 nm, mean radiance W m^-2 sr^-1 nm^-1.",
            "Source: ESO SkyCalc, the Cerro Paranal Advanced Sky Model (Noll et al. 2012, A&A 543, A92).",
            "Made by scripts/night_tables.py airglow",
        ],
        rows,
    )


if __name__ == "__main__":
    tables = {"stars": stars, "airglow": airglow}
    if len(sys.argv) != 4 or sys.argv[1] not in tables:
        sys.exit(__doc__)
    tables[sys.argv[1]](sys.argv[2], sys.argv[3])

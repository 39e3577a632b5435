#!/usr/bin/env python3
"""Write the tables of atmospheres that the crate `airlight` embeds (standard library only).

    python3 scripts/medium_tables.py csm csm_atmosphere_parameters.csv data/atmosphere/csm_atmosphere.txt
    python3 scripts/medium_tables.py mars-dust                         data/atmosphere/mars_dust_phase.txt
    python3 scripts/medium_tables.py venus-air venus_seiff1985.txt     data/atmosphere/venus_air.txt
    python3 scripts/medium_tables.py venus-absorber haus_uv_xsec_low.dat data/atmosphere/venus_absorber.txt
    python3 scripts/medium_tables.py venus-absorber-profile venus_haus_uv.cld data/atmosphere/venus_absorber_profile.txt
    python3 scripts/medium_tables.py titan-haze Tomasko2008_PhaseFunction.txt data/atmosphere/titan_haze_phase.txt
    python3 scripts/medium_tables.py titan-air Waite2013Model.txt      data/atmosphere/titan_air.txt

(output paths relative to crates/airlight/)

Sources
  csm        the comparison of clear-sky models of E. Bruneton, "A Qualitative and Quantitative Evaluation of 8 Clear
             Sky Models", IEEE TVCG 23(12), 2017: comma-separated columns wavelength nm, solar irradiance, Rayleigh
             scattering, aerosol extinction, aerosol scattering, ground albedo.
  mars-dust  computed here; see `mars_dust`.
  venus-*, titan-*  tables of publications that the header of each output names, as files in the folders input/Venus,
             input/Venus/clouds and input/Titan of github.com/Nicholaswogan/SolarSystemExploration.
"""

import math
import sys

from embedded_table import write


def csm(source, path):
    with open(source, encoding="ascii") as lines:
        rows = [line.strip().split(",") for line in lines if line[0].isdigit()]
    write(
        path,
        [
            "The atmosphere of a comparison of clear-sky models at its 40 wavelengths.",
            "Columns: wavelength nm, solar irradiance at the top of the atmosphere W m^-2 nm^-1, scattering of air at sea",
            "level m^-1, extinction of aerosol at sea level m^-1, scattering of aerosol at sea level m^-1, albedo of grass.",
            "Source: E. Bruneton, A Qualitative and Quantitative Evaluation of 8 Clear Sky Models, IEEE Transactions on",
            "Visualization and Computer Graphics 23(12), 2641-2655, 2017, doi:10.1109/TVCG.2016.2622272.",
            "Made by scripts/medium_tables.py csm",
        ],
        rows,
    )


# Martian dust by wavelength: extinction efficiency, single-scattering albedo, asymmetry parameter for an effective
# radius of 1.5 um and an effective variance of 0.3 (Wolff et al., J. Geophys. Res. 114, E00D04, 2009, as tabulated for
# the Mars general circulation model of the LMD: interpolated linearly at these wavelengths; the
# efficiencies to about 5 %). The asymmetry is constant below 440 nm.
DUST = {
    388.0: (2.50, 0.730, 0.766),
    440.0: (2.55, 0.777, 0.766),
    550.0: (2.50, 0.888, 0.693),
    650.0: (2.59, 0.967, 0.684),
    700.0: (2.87, 0.977, 0.711),
    800.0: (3.18, 0.980, 0.705),
}
EFFECTIVE_RADIUS_UM = 1.5
EFFECTIVE_VARIANCE = 0.3


def bessel_j1(x):
    """J1 by Bessel's integral, for which the trapezoidal rule converges geometrically."""
    count = 24 + int(1.5 * x)
    total = 0.0
    for i in range(count):
        t = math.pi * (i + 0.5) / count
        total += math.cos(t - x * math.sin(t))
    return total / count


def diffraction(angle, wavelength_um):
    """Fraunhofer diffraction of the gamma distribution n(r) ~ r^((1-3v)/v) exp(-r/(a v)), relative to 0 degrees.

    Hansen & Travis, Space Sci. Rev. 16, 527, 1974, eqs. 2.56 and 2.25; obliquity ((1 + cos)/2)^2.
    """
    a, v = EFFECTIVE_RADIUS_UM, EFFECTIVE_VARIANCE
    total = at_zero = 0.0
    steps = 240
    for i in range(steps):
        r = 12.0 * (i + 0.5) / steps
        x = 2.0 * math.pi * r / wavelength_um
        weight = r ** ((1.0 - 3.0 * v) / v) * math.exp(-r / (a * v)) * r**4
        z = x * math.sin(angle)
        airy = 1.0 if z < 1e-6 else (2.0 * bessel_j1(z) / z) ** 2
        total += weight * airy
        at_zero += weight
    return total / at_zero * (0.5 * (1.0 + math.cos(angle))) ** 2


def henyey_greenstein(g, mu):
    return (1.0 - g * g) / (4.0 * math.pi * (1.0 + g * g - 2.0 * g * mu) ** 1.5)


def mars_dust(path):
    """Semi-empirical dust after Pollack & Cuzzi (J. Atmos. Sci. 37, 868, 1980): the light diffracted round particles of
    any shape (a share 1 / (Q_ext albedo) of what is scattered), plus a smooth part for the light that goes through or
    is reflected: Henyey-Greenstein lobes of g = 0.8 and 0.05, mixed so that the whole has the asymmetry above. With
    these two lobes the whole stays near the sky radiance fit of Chen-Chen et al. (2019) at 650 nm (printed)."""
    angles = [0.25 * i for i in range(4 * 20)] + [0.5 * i for i in range(40, 80)]
    angles += [2.0 * i for i in range(20, 91)]
    fine = [math.pi * (i + 0.5) / 4000 for i in range(4000)]
    columns = []
    notes = []
    for nm, (efficiency, albedo, asymmetry) in DUST.items():
        coarse = [diffraction(math.radians(t), nm * 1e-3) for t in angles]

        def lobe(angle):
            degrees = math.degrees(angle)
            i = max(j for j in range(len(angles) - 1) if angles[j] <= degrees)
            t = (degrees - angles[i]) / (angles[i + 1] - angles[i])
            return coarse[i] * (1.0 - t) + coarse[i + 1] * t

        ring = [2.0 * math.pi * math.sin(a) * lobe(a) * math.pi / 4000 for a in fine]
        norm = sum(ring)
        g_diffracted = sum(w * math.cos(a) for w, a in zip(ring, fine)) / norm
        share = 1.0 / (efficiency * albedo)
        g_rest = (asymmetry - share * g_diffracted) / (1.0 - share)
        forward = (g_rest - 0.05) / (0.8 - 0.05)
        columns.append(
            [
                share * d / norm
                + (1.0 - share)
                * (
                    forward * henyey_greenstein(0.8, math.cos(math.radians(t)))
                    + (1.0 - forward) * henyey_greenstein(0.05, math.cos(math.radians(t)))
                )
                for t, d in zip(angles, coarse)
            ]
        )
        notes.append(f"{nm:g} nm: share diffracted {share:.4f}, its g {g_diffracted:.4f}, g of the rest {g_rest:.4f}")
    for i, t in enumerate(angles):
        if t in (0, 2, 5, 10, 20, 30, 45, 60, 90, 120, 150):
            mu = math.cos(math.radians(t))
            fit = 0.743 * henyey_greenstein(0.889, mu) + 0.257 * henyey_greenstein(0.094, mu)
            print(f"{t:g} degrees, 650 nm: {columns[3][i] / fit:.2f} times the fit of Chen-Chen et al.")
    rows = [[f"{t:g}"] + [f"{column[i]:.6g}" for column in columns] for i, t in enumerate(angles)]
    write(
        path,
        [
            "Phase function of Martian dust, sr^-1: effective radius 1.5 um, effective variance 0.3.",
            "Columns: angle in degrees, then " + ", ".join(f"{nm:g}" for nm in DUST) + " nm.",
            "Method: diffraction plus Henyey-Greenstein lobes of g 0.8 and 0.05, after J. B. Pollack and J. N. Cuzzi,",
            "Scattering by nonspherical particles of size comparable to a wavelength, J. Atmos. Sci. 37, 868-881, 1980.",
            "Dust: M. J. Wolff et al., Wavelength dependence of dust aerosol single scattering albedo as observed by CRISM,",
            "J. Geophys. Res. 114, E00D04, 2009, doi:10.1029/2009JE003350.",
            *notes,
            "Made by scripts/medium_tables.py mars-dust",
        ],
        rows,
    )


def numbers(source):
    """Return the rows of a file whose fields are all numbers."""
    rows = []
    with open(source, encoding="utf-8") as lines:
        for line in lines:
            try:
                rows.append([float(field) for field in line.split(";")[0].split()])
            except ValueError:
                continue
    return [row for row in rows if len(row) > 1]


BOLTZMANN_J_PER_K = 1.380649e-23


def venus_air(source, path):
    write(
        path,
        [
            "The air of Venus at 45 degrees latitude.",
            "Columns: altitude km, molecules per m^3 (pressure over Boltzmann's constant and temperature).",
            "Source: A. Seiff et al., Models of the structure of the atmosphere of Venus from the surface to 100 kilometers",
            "altitude, Adv. Space Res. 5(11), 3-58, 1985, doi:10.1016/0273-1177(85)90197-8.",
            "Made by scripts/medium_tables.py venus-air",
        ],
        [[f"{z:g}", f"{1e5 * bar / (BOLTZMANN_J_PER_K * kelvin):.4e}"] for z, kelvin, bar in numbers(source)],
    )


def venus_absorber(source, path):
    rows = sorted({row[0]: row[1] for row in numbers(source)}.items())
    write(
        path,
        [
            "Cross-section of the unknown absorber in the clouds of Venus, for the profile in venus_absorber_profile.txt.",
            "Columns: wavelength nm, cross-section m^2.",
            "Source: R. Haus, D. Kappel and G. Arnold, Radiative heating and cooling in the middle and lower atmosphere of Venus",
            "and responses to atmospheric and spectroscopic parameter variations, Planet. Space Sci. 117, 262-294, 2015,",
            'doi:10.1016/j.pss.2015.06.024 (their "low" model).',
            "Made by scripts/medium_tables.py venus-absorber",
        ],
        [[f"{1e3 * um:g}", f"{1e-4 * cm2:.4e}"] for um, cm2 in rows],
    )


def venus_absorber_profile(source, path):
    rows = [
        (km, low * pascal / (BOLTZMANN_J_PER_K * kelvin)) for pascal, kelvin, km, low, _ in numbers(source) if km > 47.0
    ]
    inside = [i for i, (_, density) in enumerate(rows) if density > 0.0]
    write(
        path,
        [
            "The unknown absorber in the clouds of Venus.",
            "Columns: altitude km, particles per m^3 (mixing ratio times molecules).",
            "Source: as for venus_absorber.txt.",
            "Made by scripts/medium_tables.py venus-absorber-profile",
        ],
        [[f"{km:.3f}", f"{density:.4e}"] for km, density in sorted(rows[inside[0] - 1 : inside[-1] + 2])],
    )


def titan_haze(source, path):
    # Two tables, of which only the first row of wavelengths up to 935 nm is used; below 80 km they differ from 713 nm on.
    rows = [row for row in numbers(source) if len(row) == 19]
    half = len(rows) // 2
    high, low = rows[:half], rows[half:]
    assert [row[0] for row in high] == [row[0] for row in low]
    write(
        path,
        [
            "Phase functions of the haze of Titan, relative to isotropic scattering.",
            "Columns: angle in degrees; above 80 km at 355, 430, 490.9, 599.9, 713.1, 822.4 and 934.8 nm; the same below 80 km.",
            "Source: M. G. Tomasko et al., A model of Titan's aerosols based on measurements made inside the atmosphere, Planet.",
            "Space Sci. 56, 669-707, 2008, doi:10.1016/j.pss.2007.11.019, table 1.",
            "Made by scripts/medium_tables.py titan-haze",
        ],
        [[f"{a[0]:g}"] + [f"{value:g}" for value in a[1:8] + b[1:8]] for a, b in zip(high, low)],
    )


def titan_air(source, path):
    nitrogen_kg, methane_kg = 28.014 * 1.66053907e-27, 16.043 * 1.66053907e-27
    levels = [*range(0, 20, 2), *range(20, 60, 5), *range(60, 401, 20)]
    rows = {row[0]: row for row in numbers(source)}
    write(
        path,
        [
            "The air of Titan.",
            "Columns: altitude km, molecules per m^3 (density over the mean mass of nitrogen and methane), fraction of methane.",
            "Source: the recommended profile of J. H. Waite et al., Model for Titan atmosphere, 2013, from Huygens' descent.",
            "Made by scripts/medium_tables.py titan-air",
        ],
        [
            [f"{z}", f"{rows[z][3] / (methane * methane_kg + (1.0 - methane) * nitrogen_kg):.4e}", f"{methane:g}"]
            for z in levels
            for methane in [rows[z][9]]
        ],
    )


if __name__ == "__main__":
    kind, *arguments = sys.argv[1:]
    tables = {
        "csm": csm,
        "mars-dust": mars_dust,
        "venus-air": venus_air,
        "venus-absorber": venus_absorber,
        "venus-absorber-profile": venus_absorber_profile,
        "titan-haze": titan_haze,
        "titan-air": titan_air,
    }
    tables[kind](*arguments)

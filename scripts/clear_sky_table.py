#!/usr/bin/env python3
"""Print the tables of the book's chapter on Python: clear-sky irradiance beside pvlib's spectrl2 and Ineichen.

    scripts/python                      (which builds the package and installs pvlib)
    target/python/bin/python scripts/clear_sky_table.py

The air is the same: aerosol optical depth 0.12 at 550 nm with an Angstrom exponent of 1.3, 300 DU of ozone, sea level. pvlib's
models also absorb by 14 mm of water vapour, which the solver does not have. Ineichen, which has no spectrum, is multiplied by the
share of the band in spectrl2.
"""

import numpy as np
import pandas
import pvlib
from airlight import irradiance
from pvlib.spectrum import spectrl2

PLACE = (48.86, 2.29)
TIMES = ["2026-06-21T12:00", "2026-06-21T16:00", "2026-06-21T18:00", "2026-12-21T12:00"]
AEROSOL_550, EXPONENT, WATER_CM = 0.12, 1.3, 1.4
#: Our parts of the light, and their names in pvlib.
PARTS = {"direct_normal": "dni", "diffuse_horizontal": "dhi"}
BANDS = [(low, low + 100) for low in range(300, 900, 100)]
WHOLE = (300, 900)


def aerosol(nm: float) -> float:
    """Optical depth of the aerosol."""
    return AEROSOL_550 * (nm / 550.0) ** -EXPONENT


def integral(nm: np.ndarray, values: np.ndarray, band: tuple[float, float]) -> float:
    """Irradiance in a band, W/m^2."""
    at = np.linspace(*band, 6001)
    return np.trapezoid(np.interp(at, nm, values), at)


def table(head: str, rows: list[list[str]]) -> None:
    """Print a Markdown table."""
    print(f"| {head} |\n|{'---|' * (head.count('|') + 1)}")
    for row in rows:
        print(f"| {' | '.join(row)} |")


def main() -> None:
    times = pandas.DatetimeIndex(TIMES, tz="UTC")
    ours = irradiance.clear_sky_spectra(times, *PLACE, atmosphere="average")
    nm = ours.wavelength.values
    zenith = pvlib.location.Location(*PLACE, altitude=0).get_solarposition(times).apparent_zenith
    airmass = pvlib.atmosphere.get_relative_airmass(zenith)
    absolute = pvlib.atmosphere.get_absolute_airmass(airmass)
    broad = pvlib.atmosphere.bird_hulstrom80_aod_bb(aerosol(380), aerosol(500))
    turbidity = pvlib.atmosphere.kasten96_lt(absolute, WATER_CM, broad)
    extra = pvlib.irradiance.get_extra_radiation(times)
    ineichen = pvlib.clearsky.ineichen(zenith, absolute, turbidity, altitude=0, dni_extra=extra)
    bands, shares, spectra = [], [], []
    for k, time in enumerate(times):
        theirs = spectrl2(
            apparent_zenith=zenith.iloc[k], aoi=zenith.iloc[k], surface_tilt=0, ground_albedo=0.1, surface_pressure=101325,
            relative_airmass=airmass.iloc[k], precipitable_water=WATER_CM, ozone=0.3, aerosol_turbidity_500nm=aerosol(500),
            dayofyear=time.day_of_year,
        )
        at = np.ravel(theirs["wavelength"])
        sun = f"{90 - zenith.iloc[k]:.1f}°"
        bands.append([sun])
        shares.append([sun])
        for part, name in PARTS.items():
            values, mine = np.ravel(theirs[name]), ours[part].values[k]
            within, whole = integral(at, values, WHOLE), np.trapezoid(values, at)
            bands[-1] += [f"{integral(nm, mine, WHOLE):.0f}", f"{within:.0f}", f"{ineichen[name].iloc[k] * within / whole:.0f}"]
            shares[-1] += [f"{100 * within / whole:.0f} %", f"{ineichen[name].iloc[k]:.0f}"]
            ratios = [integral(nm, mine, band) / integral(at, values, band) - 1 for band in BANDS]
            spectra.append([sun, part.split("_")[0], *(f"{100 * ratio:+.0f} %" for ratio in ratios)])
    models = "Airlight | spectrl2 | Ineichen"
    table(f"sun | direct normal: {models} | diffuse: {models}", bands)
    print()
    names = " | ".join(f"{low} to {high} nm" for low, high in BANDS)
    table(f"sun | light | {names}", spectra)
    print()
    table("sun | direct: 300 to 900 nm of the whole | whole, Ineichen | diffuse: 300 to 900 nm of the whole | whole, Ineichen", shares)


if __name__ == "__main__":
    main()

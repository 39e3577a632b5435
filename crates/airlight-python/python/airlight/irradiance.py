"""Irradiance of a clear sky over a time index, direct and diffuse, by wavelength and in a band; needs pandas or xarray."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from airlight import _native
from airlight._sun import sun_position

if TYPE_CHECKING:
    import pandas
    import xarray

#: Wavelengths of band irradiances, nm: the whole range of the solver in steps over which the sun's spectrum is averaged.
BAND_NM = np.arange(300.0, 901.0, 10.0)

# Mean distance of the sun is 1 AU.
_PARTS = ("direct_normal", "direct_horizontal", "diffuse_horizontal", "global_horizontal")


def _solve(
    times: Any,
    latitude_deg: float,
    longitude_deg: float,
    altitude_m: float,
    atmosphere: _native.Atmosphere | str,
    wavelengths_nm: ArrayLike,
    threads: int | None,
) -> tuple[NDArray[np.float64], NDArray[np.float64], dict[str, NDArray[np.float64]]]:
    """Wavelengths, elevations of the sun, and irradiances of shape (times, wavelengths)."""
    sun = sun_position(times, latitude_deg, longitude_deg, altitude_m)
    sky = _native.Sky(atmosphere, wavelengths=wavelengths_nm, altitude_m=altitude_m, threads=threads)
    shape = (len(sun.elevation_deg), len(sky.wavelengths_nm))
    parts = {name: np.zeros(shape) for name in _PARTS}
    for index, elevation_deg in enumerate(sun.elevation_deg):
        view = sky.view(
            altitude_m,
            sun_elevation_deg=float(elevation_deg),
            distance_ratio=float(sun.distance_au[index]),
            threads=threads,
        )
        direct = view.sun_irradiance()
        parts["direct_normal"][index] = direct
        parts["direct_horizontal"][index] = direct * max(np.sin(np.radians(elevation_deg)), 0.0)
        parts["diffuse_horizontal"][index] = view.downwelling_irradiance(threads=threads)
    parts["global_horizontal"] = parts["direct_horizontal"] + parts["diffuse_horizontal"]
    return sky.wavelengths_nm, sun.elevation_deg, parts


def clear_sky(
    times: Any,
    latitude_deg: float,
    longitude_deg: float,
    altitude_m: float = 0.0,
    *,
    atmosphere: _native.Atmosphere | str = "average",
    threads: int | None = None,
) -> pandas.DataFrame:
    """Irradiance of a clear sky from 300 to 900 nm, the range of the solver.

    Under suns 16 to 65 degrees high, that is 60 to 66 % of the direct and 88 to 90 % of the diffuse light of the whole spectrum by
    pvlib's spectrl2; the rest is infrared.

    Parameters
    ----------
    times : pandas.DatetimeIndex, str, datetime.datetime, numpy.datetime64, or a sequence of them
        Times, as for ``airlight.sun_position``.
    latitude_deg, longitude_deg : float
        Degrees north and east.
    altitude_m : float
        Altitude of the eye above sea level, m.
    atmosphere : Atmosphere or str
        The air.
    threads : int or None
        Number of threads.

    Returns
    -------
    pandas.DataFrame
        A row for each time: ``direct_normal``, ``direct_horizontal``, ``diffuse_horizontal`` and ``global_horizontal``, W m^-2,
        and the apparent ``sun_elevation_deg``.
    """
    import pandas

    band = _solve(times, latitude_deg, longitude_deg, altitude_m, atmosphere, BAND_NM, threads)
    nm, elevation_deg, parts = band
    columns = {name: np.trapezoid(values, nm, axis=1) for name, values in parts.items()}
    index = times if isinstance(times, pandas.DatetimeIndex) else None
    return pandas.DataFrame({**columns, "sun_elevation_deg": elevation_deg}, index=index)


def clear_sky_spectra(
    times: Any,
    latitude_deg: float,
    longitude_deg: float,
    altitude_m: float = 0.0,
    *,
    wavelengths_nm: ArrayLike = BAND_NM,
    atmosphere: _native.Atmosphere | str = "average",
    threads: int | None = None,
) -> xarray.Dataset:
    """Spectral irradiance of a clear sky.

    Parameters
    ----------
    times : pandas.DatetimeIndex, str, datetime.datetime, numpy.datetime64, or a sequence of them
        Times, as for ``airlight.sun_position``.
    latitude_deg, longitude_deg : float
        Degrees north and east.
    altitude_m : float
        Altitude of the eye above sea level, m.
    wavelengths_nm : array_like, shape (w,)
        Wavelengths from 300 to 900 nm.
    atmosphere : Atmosphere or str
        The air.
    threads : int or None
        Number of threads.

    Returns
    -------
    xarray.Dataset
        ``direct_normal``, ``direct_horizontal``, ``diffuse_horizontal`` and ``global_horizontal`` by ``time`` (UTC) and
        ``wavelength``, W m^-2 nm^-1.
    """
    import xarray

    from airlight._sun import unix_times

    nm, elevation_deg, parts = _solve(times, latitude_deg, longitude_deg, altitude_m, atmosphere, wavelengths_nm, threads)
    seconds = unix_times(times)
    utc = (seconds * 1e9).round().astype("int64").astype("datetime64[ns]")
    units = {"units": "W m-2 nm-1"}
    return xarray.Dataset(
        {name: (("time", "wavelength"), values, units) for name, values in parts.items()},
        coords={
            "time": utc,
            "wavelength": ("wavelength", nm, {"units": "nm"}),
            "sun_elevation": ("time", elevation_deg, {"units": "degree"}),
        },
    )

"""Position of the sun at times of any kind."""

from __future__ import annotations

import datetime
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from airlight import _native


class SunPosition(NamedTuple):
    """Position of the sun at each time.

    Attributes
    ----------
    azimuth_deg : numpy.ndarray, shape (n,)
        Azimuth, degrees clockwise from north.
    elevation_deg : numpy.ndarray, shape (n,)
        Elevation above the horizon, degrees: apparent if computed with refraction.
    geometric_elevation_deg : numpy.ndarray, shape (n,)
        Elevation without refraction, degrees.
    distance_au : numpy.ndarray, shape (n,)
        Distance from the Earth, AU.
    """

    azimuth_deg: NDArray[np.float64]
    elevation_deg: NDArray[np.float64]
    geometric_elevation_deg: NDArray[np.float64]
    distance_au: NDArray[np.float64]

    @property
    def direction(self) -> NDArray[np.float64]:
        """Unit vectors towards the sun, shape (n, 3): x east, y up, z south."""
        return _native.direction(self.azimuth_deg, self.elevation_deg)


def unix_times(times: Any) -> NDArray[np.float64]:
    """Seconds since 1970-01-01T00:00:00Z.

    Parameters
    ----------
    times : str, datetime.datetime, numpy.datetime64, pandas.DatetimeIndex, or a sequence of them
        Texts and datetimes state their offset from UTC; ``datetime64`` is UTC.

    Returns
    -------
    numpy.ndarray, shape (n,)

    Raises
    ------
    ValueError
        For a time without an offset from UTC.
    """
    if isinstance(times, str | datetime.datetime | np.datetime64):
        times = [times]
    zone = getattr(times, "tz", np)
    if zone is None:
        raise ValueError("expected times with a zone, got an index without; try .tz_localize('UTC')")
    if zone is not np:
        times = times.tz_convert("UTC").tz_localize(None)
    values = getattr(times, "values", times)
    if isinstance(values, np.ndarray) and np.issubdtype(values.dtype, np.datetime64):
        if np.isnat(values).any():
            raise ValueError("expected times, got NaT")
        return values.astype("datetime64[ns]").ravel().astype(np.int64) / 1e9
    return np.array([_unix_time(time) for time in _sequence(times)], dtype=np.float64)


def _sequence(times: Any) -> Iterable[Any]:
    if not isinstance(times, Iterable):
        raise TypeError(f"expected times as text, datetime or datetime64, got {type(times).__name__}")
    return times


def _unix_time(time: Any) -> float:
    if isinstance(time, str):
        return _native.unix_time(time)
    if isinstance(time, np.datetime64):
        return float(unix_times(np.array([time]))[0])
    if isinstance(time, datetime.datetime):
        if time.tzinfo is None:
            raise ValueError(f"expected a time with a zone, got {time}; try datetime(..., tzinfo=timezone.utc)")
        return time.timestamp()
    raise TypeError(f"expected times as text, datetime or datetime64, got {type(time).__name__}")


def sun_position(
    times: Any,
    latitude_deg: float,
    longitude_deg: float,
    altitude_m: float = 0.0,
    *,
    refraction: bool = True,
    pressure_pa: float = 101_325.0,
    temperature_c: float = 15.0,
) -> SunPosition:
    """Position of the sun at times and a place on the Earth, accurate to 0.0003 degrees.

    Parameters
    ----------
    times : str, datetime.datetime, numpy.datetime64, pandas.DatetimeIndex, or a sequence of them
        Texts and datetimes state their offset from UTC (``2026-06-21T21:15:00+02:00``, ``2026-06-21 21:15 Europe/Paris``, ``now``);
        ``datetime64`` is UTC.
    latitude_deg, longitude_deg : float
        Degrees north and east.
    altitude_m : float
        Altitude above sea level, m.
    refraction : bool
        Whether the air refracts sunlight, by half a degree at the horizon.
    pressure_pa, temperature_c : float
        Air that refracts.

    Returns
    -------
    SunPosition

    Examples
    --------
    >>> sun = airlight.sun_position("2026-06-21T12:00:00Z", 48.86, 2.29)
    >>> float(sun.elevation_deg[0].round(1))
    64.5
    """
    pressure = pressure_pa if refraction else None
    parts = _native.sun_position(unix_times(times), latitude_deg, longitude_deg, altitude_m, pressure, temperature_c)
    return SunPosition(*parts)


def view_at(
    time: Any,
    latitude_deg: float,
    longitude_deg: float,
    altitude_m: float = 2.0,
    *,
    atmosphere: _native.Atmosphere | str = "average",
    wavelengths: ArrayLike | str = "standard",
    threads: int | None = None,
) -> _native.View:
    """The sky of a clear day at a place and an hour.

    Parameters
    ----------
    time : str, datetime.datetime, numpy.datetime64
        One time, as for ``sun_position``.
    latitude_deg, longitude_deg : float
        Degrees north and east.
    altitude_m : float
        Altitude of the eye above sea level, m.
    atmosphere : Atmosphere or str
        The air.
    wavelengths : str or array_like, shape (w,)
        A grid or wavelengths, as for ``Sky``.
    threads : int or None
        Number of threads.

    Returns
    -------
    View

    Raises
    ------
    ValueError
        For several times, and for one without an offset from UTC.

    Examples
    --------
    >>> airlight.view_at("2026-06-21T12:00:00Z", 48.86, 2.29, wavelengths="rgb")
    View("average", sun 64.54 degrees high at azimuth 183.92)
    """
    sun = sun_position(time, latitude_deg, longitude_deg, altitude_m)
    if len(sun.elevation_deg) != 1:
        raise ValueError(f"time: expected one time, got {len(sun.elevation_deg)}")
    elevation_deg = float(sun.elevation_deg[0])
    sky = _native.Sky(atmosphere, wavelengths=wavelengths, sun_elevation_deg=elevation_deg, altitude_m=altitude_m, threads=threads)
    return sky.view(
        altitude_m,
        sun_elevation_deg=elevation_deg,
        sun_azimuth_deg=float(sun.azimuth_deg[0]),
        distance_ratio=float(sun.distance_au[0]),
        threads=threads,
    )

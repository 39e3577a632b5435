"""Tables of xarray and pandas, which are optional."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np

from airlight import _native

if TYPE_CHECKING:
    import pandas
    import xarray


def view_to_xarray(view: _native.View, azimuth_deg: Any, elevation_deg: Any, threads: int | None) -> xarray.DataArray:
    """Radiance of a view on a grid of directions."""
    import xarray

    azimuth = np.arange(0.0, 360.0, 10.0) if azimuth_deg is None else np.asarray(azimuth_deg, float)
    elevation = np.arange(0.0, 90.1, 5.0) if elevation_deg is None else np.asarray(elevation_deg, float)
    grid = np.meshgrid(azimuth, elevation, indexing="ij")
    directions = _native.direction(grid[0].ravel(), grid[1].ravel())
    radiance = view.radiance(directions, threads=threads)
    return xarray.DataArray(
        radiance.reshape(azimuth.size, elevation.size, -1),
        dims=("azimuth", "elevation", "wavelength"),
        coords={
            "azimuth": ("azimuth", azimuth, {"units": "degree", "long_name": "azimuth clockwise from north"}),
            "elevation": ("elevation", elevation, {"units": "degree", "long_name": "elevation above the horizon"}),
            "wavelength": ("wavelength", view.wavelengths_nm, {"units": "nm"}),
        },
        name="radiance",
        attrs={"units": "W m-2 sr-1 nm-1", "long_name": "radiance of sky and ground without the sun's disc"},
    )


def frame_of_csv(csv: str) -> pandas.DataFrame:
    """Table of a probe."""
    import pandas

    return pandas.read_csv(io.StringIO(csv))

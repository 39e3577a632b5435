"""Skies as the light of Mitsuba 3; needs the package mitsuba."""

from __future__ import annotations

from typing import Any

import numpy as np

from airlight import _native


def environment(
    view: _native.View, height: int = 512, *, sun_disc: bool = True, scale: float = 1.0, threads: int | None = None
) -> dict[str, Any]:
    """Environment map of a sky as an emitter for ``mitsuba.load_dict``, where north is -z, east x and up y.

    Parameters
    ----------
    view : airlight.View
        The sky.
    height : int
        Number of rows of the map.
    sun_disc : bool
        Whether the map has the sun's disc. Its light is right at any resolution: a pixel has the mean over its solid angle.
    scale : float
        Factor on the light, which is in cd/m^2; 1e-4 suits the exposure of most viewers.
    threads : int or None
        Number of threads.

    Returns
    -------
    dict
        ``{"type": "envmap", "bitmap": mitsuba.Bitmap, "scale": float}``. A variant of Mitsuba must be set.
    """
    import mitsuba

    picture = view.panorama(height, "srgb", sun_disc=sun_disc, orientation="mitsuba", threads=threads)
    # Colours outside sRGB have negative components, which Mitsuba refuses.
    return {"type": "envmap", "bitmap": mitsuba.Bitmap(np.maximum(picture, 0.0)), "scale": scale}

"""Skies as the light of Blender: from scripts that Blender runs without this package, or inside its Python.

The scene's axes are x east, y north and z up. Light is in cd/m^2 and lx times a scale. The sun's disc is a light of its own, which
casts sharp shadows at little noise; the environment map is the sky without it.
"""

from __future__ import annotations

import os
import pathlib
import tempfile
from typing import Any

import numpy as np

from airlight import _native

_SCRIPT = '''\
"""The light of a sky as Blender's world and sun light; axes: x east, y north, z up.

    blender --python {script}
"""

import os

{source}


set_sky(os.path.join(os.path.dirname(os.path.abspath(__file__)), {map!r}), {scale!r}, {sun!r})
'''


def _sun(view: _native.View, scale: float) -> dict[str, Any] | None:
    """The sun light; None for a sun below the horizon."""
    # Colours outside sRGB have negative components, which Blender does not take.
    irradiance = [max(float(lux) * scale, 0.0) for lux in view.sun_illuminance("srgb")]
    if max(irradiance) == 0.0:
        return None
    east, up, south = view.sun
    diameter = float(np.radians(view.sun_diameter_deg))
    return {"direction": (east, -south, up), "irradiance": irradiance, "diameter": diameter}


def _write_map(path: str | os.PathLike[str], view: _native.View, height: int, threads: int | None) -> None:
    picture = view.panorama(height, "srgb", sun_disc=False, orientation="blender", threads=threads)
    _native.write_picture(path, np.maximum(picture, 0.0))


def write_script(
    path: str | os.PathLike[str],
    view: _native.View,
    height: int = 1024,
    *,
    scale: float = 2e-4,
    threads: int | None = None,
) -> None:
    """Write a script for ``blender --python`` that sets world and sun light, and its environment map beside it.

    Parameters
    ----------
    path : str or os.PathLike
        The script; the map has the same name with the ending .exr. Both can be moved together.
    view : airlight.View
        The sky, such as ``airlight.view_at`` returns for a place and an hour.
    height : int
        Number of rows of the map.
    scale : float
        Factor on the light, which is in cd/m^2 and lx; with 2e-4 a daylight scene suits an exposure of 0.
    threads : int or None
        Number of threads.

    Examples
    --------
    >>> view = airlight.view_at("2026-06-21 20:30 Europe/Paris", 48.8584, 2.2945)  # doctest: +SKIP
    >>> airlight.blender.write_script("paris.py", view)  # doctest: +SKIP
    """
    script = pathlib.Path(path)
    environment = script.with_suffix(".exr")
    source = pathlib.Path(__file__).with_name("_blender_scene.py").read_text(encoding="utf-8")
    # The script has a docstring of its own.
    source = source.split('"""', 2)[2].strip()
    _write_map(environment, view, height, threads)
    words = {"script": script.name, "source": source, "map": environment.name, "scale": scale, "sun": _sun(view, scale)}
    script.write_text(_SCRIPT.format(**words), encoding="utf-8")


def set_world(view: _native.View, height: int = 1024, *, scale: float = 2e-4, threads: int | None = None) -> None:
    """Set world and sun light of the open scene; for Blender's own Python, into which this package is installed.

    Parameters
    ----------
    view : airlight.View
        The sky.
    height : int
        Number of rows of the environment map, which is packed into the scene's file.
    scale : float
        Factor on the light, as for ``write_script``.
    threads : int or None
        Number of threads.
    """
    from airlight._blender_scene import set_sky

    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "airlight.exr")
        _write_map(path, view, height, threads)
        set_sky(path, scale, _sun(view, scale)).pack()

"""What air does to light: skies, haze and fog, spectral and in physical units.

Classes and functions have the names of the Rust library. Arrays are NumPy arrays; docstrings state their shapes and units.
World axes are x east, y up, z south; azimuth is in degrees clockwise from north, elevation in degrees above the horizon.
Long computations release the global lock of the interpreter, stop on Ctrl-C, and return the same bits for any number of
threads.
"""

from airlight._native import (
    AccuracyReport,
    Atmosphere,
    Fog,
    Particles,
    Picture,
    RadianceView,
    Scene,
    Sky,
    View,
    __version__,
    accuracy,
    direction,
    fog_batch,
    mie_phase,
    mie_sphere,
    models,
    read_depth,
    read_picture,
    write_picture,
)
from airlight._sun import SunPosition, sun_position, view_at

__all__ = [
    "AccuracyReport",
    "Atmosphere",
    "Fog",
    "Particles",
    "Picture",
    "RadianceView",
    "Scene",
    "Sky",
    "SunPosition",
    "View",
    "__version__",
    "accuracy",
    "direction",
    "fog_batch",
    "mie_phase",
    "mie_sphere",
    "models",
    "read_depth",
    "read_picture",
    "sun_position",
    "view_at",
    "write_picture",
]

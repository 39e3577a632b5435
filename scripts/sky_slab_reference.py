#!/usr/bin/env python3
"""Write the reference table of light in optically thick air for the tests of the crate `airlight`.

    pip install numpy PythonicDISORT
    python3 scripts/sky_slab_reference.py > crates/airlight-validation/data/sky_slabs_disort.csv

Takes a minute. Slabs of a Henyey-Greenstein medium under a sun of unit irradiance, seen from the ground and from above.
"""

from importlib.metadata import version

import numpy as np

from fog_disort import Slab, henyey_greenstein

STREAMS = 48
# Zenith angle of the sun, single-scattering albedo, albedo of the ground, asymmetry, optical depth.
SLABS = [
    (30.0, omega, albedo, g, tau)
    for omega, albedo in ((0.999999, 0.0), (0.999999, 0.8), (0.9, 0.0))
    for g in (0.0, 0.7)
    for tau in (5.0, 20.0, 100.0)
]
SLABS += [
    (80.0, 0.999999, 0.0, 0.7, 5.0),
    (80.0, 0.999999, 0.8, 0.7, 20.0),
    (30.0, 0.999999, 0.0, 0.7, 1000.0),
]
# Part of the depth above the observer, zenith angle and azimuth relative to the sun.
VIEWS = [
    (1, 0.0, 0.0),
    (1, 60.0, 0.0),
    (1, 80.0, 180.0),
    (0, 180.0, 0.0),
    (0, 120.0, 0.0),
    (0, 100.0, 90.0),
]

print("# Light scattered in plane-parallel slabs, all orders of scattering, seen from the ground (above = 1) and from the top")
print("# (above = 0). Zenith angle of a sun of unit irradiance, single-scattering albedo omega, Henyey-Greenstein phase function of")
print("# asymmetry g, vertical optical depth tau; the other columns as in fog_slabs_disort.csv.")
print(f"# PythonicDISORT {version('PythonicDISORT')}, {STREAMS} streams; written by scripts/sky_slab_reference.py.")
print("sun_zenith,omega,g,tau,albedo,above,zenith,azimuth,scattered")
for sun_zenith, omega, albedo, g, tau in SLABS:
    phase = lambda cosine: henyey_greenstein(g, cosine)
    slab = Slab(omega, tau, np.radians(sun_zenith), albedo, g ** np.arange(STREAMS + 1), phase)
    views = [(above, np.radians(zenith), np.radians(azimuth)) for above, zenith, azimuth in VIEWS]
    for (above, zenith, azimuth), light in zip(VIEWS, slab.to_the_edge(views)):
        row = [sun_zenith, omega, g, tau, albedo, above, zenith, azimuth, light]
        print(",".join(f"{value:.6g}" for value in row))

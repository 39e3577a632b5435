#!/usr/bin/env python3
"""Write the reference table of light scattered into nearly horizontal view rays in fog for the tests of the crate `airlight`.

    pip install numpy PythonicDISORT
    python3 scripts/fog_level_reference.py > crates/airlight/tests/data/fog_level_disort.csv

Takes five minutes on two processors. As `fog_reference.py`, for view rays of given optical length near the horizon, along
which the radiance inside the fog is evaluated point by point.
"""

from importlib.metadata import version

import numpy as np

from fog_disort import Slab, gauss, henyey_greenstein
from fog_reference import STREAMS

OMEGA, ALBEDO = 0.999999, 0.2
# Zenith angle, azimuth relative to the sun and optical length of each view ray, from the ground.
VIEWS = [
    (zenith, azimuth, length)
    for zenith in (75.0, 84.0, 88.0, 89.5)
    for azimuth in (0.0, 40.0, 90.0, 180.0)
    for length in (0.3, 1.0, 3.0, 1e9)
]


def lines(g, tau, sun_zenith):
    """Yield the radiance scattered into each view ray."""
    moments = g ** np.arange(STREAMS + 1)
    slab = Slab(OMEGA, tau, np.radians(sun_zenith), ALBEDO, moments, lambda cosine: henyey_greenstein(g, cosine))
    for zenith, azimuth, length in VIEWS:
        mu = np.cos(np.radians(zenith))
        end = min(length, tau / mu)
        path, weight = gauss(np.concatenate([[0.0], np.geomspace(end * 1e-3, end, 14)]))
        seen = path < 40.0
        path, weight = path[seen], weight[seen]
        # The solver requires increasing depths.
        depth = np.clip(tau - mu * path, 0.0, tau)[::-1]
        source = slab.source(depth, slab.field(depth), mu, np.radians(azimuth))[::-1]
        yield zenith, azimuth, length, np.sum(weight * source * np.exp(-path))


def main():
    print(
        "# Light scattered into nearly level lines in a slab of fog (Henyey-Greenstein), all orders of scattering, seen from\n"
        f"# the ground. PythonicDISORT {version('PythonicDISORT')}, {STREAMS} streams; written by scripts/fog_level_reference.py.\n"
        f"# Sun of unit irradiance; single-scattering albedo {OMEGA}, ground albedo {ALBEDO}; angles in degrees; zenith and\n"
        "# azimuth of the line (0: towards the sun), its optical length (1e9: to the top of the fog), 1/sr.\n"
        "g,tau,sun_zenith,zenith,azimuth,length,scattered"
    )
    count = 0
    for g in (0.7, 0.85):
        for tau in (0.02, 0.1, 0.5, 2.0):
            for sun_zenith in (30.0, 65.0, 80.0):
                for zenith, azimuth, length, scattered in lines(g, tau, sun_zenith):
                    count += 1
                    if count % 7 == 0:
                        print(f"{g:g},{tau:g},{sun_zenith:g},{zenith:g},{azimuth:g},{length:g},{scattered:.6g}")


if __name__ == "__main__":
    main()

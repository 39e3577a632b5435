#!/usr/bin/env python3
"""Writes the table of light scattered into nearly level lines in fog that the tests of the crate `airlight` read.

    pip install numpy PythonicDISORT
    python3 scripts/fog_level_reference.py > crates/airlight/tests/data/fog_level_disort.csv

Five minutes on two processors. As `fog_reference.py`, but for lines of a given optical length near the horizon, along
which the field inside the fog is evaluated point by point.
"""

from importlib.metadata import version

import numpy as np
from PythonicDISORT import pydisort

from fog_reference import STREAMS, henyey_greenstein

OMEGA, ALBEDO = 0.999999, 0.2
# View zenith angles, azimuths relative to the sun, optical lengths of the line; from the ground.
VIEWS = [
    (zenith, azimuth, length)
    for zenith in (75.0, 84.0, 88.0, 89.5)
    for azimuth in (0.0, 40.0, 90.0, 180.0)
    for length in (0.3, 1.0, 3.0, 1e9)
]


def lines(g, tau, sun_zenith):
    """The radiance scattered into each view's line."""
    sun_cosine = np.cos(np.radians(sun_zenith))
    peak = g**STREAMS
    moments = g ** np.arange(STREAMS)
    angles, _, _, _, field = pydisort(
        np.array([tau]), np.array([OMEGA]), STREAMS, moments[None, :], sun_cosine, 1.0, 0.0,
        f_arr=np.array([peak]), BDRF_Fourier_modes=[ALBEDO], NFourier=STREAMS,
    )
    azimuth = np.linspace(0.0, np.pi, STREAMS + 1)
    azimuth_weight = np.full(STREAMS + 1, np.pi / STREAMS)
    azimuth_weight[[0, -1]] /= 2.0
    nodes, weights = np.polynomial.legendre.leggauss(STREAMS // 2)
    nodes, weights = (nodes + 1.0) / 2.0, weights / 2.0
    angle_weight = weights[np.argmin(np.abs(np.abs(angles)[:, None] - nodes), axis=1)]
    thinning = 1.0 - OMEGA * peak
    truncated = OMEGA * (moments - peak) * (2.0 * np.arange(STREAMS) + 1.0) / (4.0 * np.pi)
    cosine = -angles  # of the direction in which light travels, positive downwards
    sine = np.sqrt(1.0 - cosine**2)
    for zenith, view_azimuth, length in VIEWS:
        mu = np.cos(np.radians(zenith))
        mu_sine, phi = np.sqrt(1.0 - mu * mu), np.radians(view_azimuth)
        end = min(length, tau / mu)
        edges = np.concatenate([[0.0], np.geomspace(end * 1e-3, end, 14)])
        x, w = np.polynomial.legendre.leggauss(8)
        half = np.diff(edges)[:, None] / 2.0
        path = ((edges[:-1, None] + edges[1:, None]) / 2.0 + half * x).ravel()
        weight = (half * w).ravel()
        seen = path < 40.0
        path, weight = path[seen], weight[seen]
        depth = np.clip(tau - mu * path, 0.0, tau)
        order = np.argsort(depth)
        radiance = np.empty((len(angles), len(depth), len(azimuth)))
        radiance[:, order, :] = field(depth[order], azimuth)
        phase = 0.0
        for side in (1.0, -1.0):
            between = cosine[:, None] * mu + sine[:, None] * mu_sine * np.cos(phi - side * azimuth)
            phase = phase + np.polynomial.legendre.legval(np.clip(between, -1.0, 1.0), truncated)
        source = np.einsum("mp,mtp,m,p->t", phase, radiance, angle_weight, azimuth_weight)
        scattering = mu * sun_cosine + mu_sine * np.sqrt(1.0 - sun_cosine**2) * np.cos(phi)
        once = OMEGA * henyey_greenstein(g, np.clip(scattering, -1.0, 1.0))
        source = source + once * np.exp(-thinning * depth / sun_cosine)
        yield zenith, view_azimuth, length, np.sum(weight * source * np.exp(-path))


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

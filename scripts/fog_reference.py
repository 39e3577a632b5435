#!/usr/bin/env python3
"""Writes the table of light scattered in plane-parallel fog that the tests of the crate `airlight` read.

    pip install numpy PythonicDISORT
    python3 scripts/fog_reference.py > crates/airlight/tests/data/fog_slabs_disort.csv

A slab of fog of vertical optical depth tau, single-scattering albedo omega and the Henyey-Greenstein phase function of
asymmetry g lies over a Lambertian ground. It is lit from above either by the sun (unit irradiance perpendicular to its
beam) or by an isotropic sky of unit radiance. The discrete-ordinate solver PythonicDISORT (delta-M scaling, 48 streams
and azimuth modes) gives the scattered radiance at its own angles and at any depth. The radiance in the wanted direction is
then the integral, along the line of sight, of the source that this field makes through the truncated phase function, plus
the sun's light scattered once by the full phase function (Nakajima and Tanaka's TMS): this needs no interpolation between
angles. With `--check` the script writes instead by how much the rows change when 64 streams are used.

In three slabs and an exponential fog the method agrees with PythonicDISORT's own intensities to 4e-6 and 3e-5, and with a
Monte Carlo (Mitsuba 3.9.1, volpath) within 1.3 of its standard errors of 0.1 to 0.3 %. The white furnace (omega = 1 - 1e-7,
ground albedo 1, sky of radiance 1) holds to 2e-6.
"""

import sys
from importlib.metadata import version

import numpy as np
from PythonicDISORT import pydisort

STREAMS = 48
OMEGA = (0.999999, 0.99, 0.9)
G = (0.0, 0.7, 0.85)
TAU = (0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0)
LIGHT = (0.0, 30.0, 60.0, 80.0, "sky")
ALBEDO = (0.0, 0.3)
# One slab in so many of the full grid is kept, and of each about so many views.
STRIDE = 6
ROWS_PER_SLAB = 5
# The observer's place as the part of tau above it, view zenith angle and azimuth relative to the sun (0 = towards it).
VIEWS = (
    [(1.0, 0.0, 0.0)]
    + [(1.0, zenith, azimuth) for zenith in (30.0, 60.0, 80.0, 85.0) for azimuth in (0.0, 30.0, 90.0, 180.0)]
    + [(0.0, 180.0, 0.0)]
    + [(0.0, zenith, azimuth) for zenith in (120.0, 100.0) for azimuth in (0.0, 90.0, 180.0)]
    + [(0.5, zenith, azimuth) for zenith in (80.0, 100.0) for azimuth in (0.0, 90.0, 180.0)]
)


def depth_nodes(tau):
    """Gauss-Legendre nodes and weights in depth, dense at the boundaries and on both sides of the middle."""
    wanted = [0.0, tau / 2.0, tau]
    offsets = (0.03, 0.1, 0.25, 0.5, 1.0, 2.0, 3.5, 5.0, 7.5, 10.0, 15.0, 20.0, 30.0)
    for start, sign in ((0.0, 1.0), (tau, -1.0), (tau / 2.0, 1.0), (tau / 2.0, -1.0)):
        for offset in offsets:
            edge = start + sign * offset
            if 0.0 < edge < tau and min(abs(edge - other) for other in wanted) > 1e-3 * min(tau, 10.0):
                wanted.append(edge)
    edges = np.array(sorted(wanted))
    x, w = np.polynomial.legendre.leggauss(8)
    half = np.diff(edges)[:, None] / 2.0
    middle = (edges[:-1, None] + edges[1:, None]) / 2.0
    return (middle + half * x).ravel(), (half * w).ravel()


def henyey_greenstein(g, cosine):
    return (1.0 - g * g) / (4.0 * np.pi) / (1.0 + g * g - 2.0 * g * cosine) ** 1.5


def slab(omega, g, tau, light, albedo, views, streams):
    """Returns, for each view, the radiance scattered into the line of sight up to the edge of the fog, and the ground's irradiance."""
    sky = light == "sky"
    sun_cosine = 0.5 if sky else np.cos(np.radians(light))
    sun = 0.0 if sky else 1.0
    peak = g**streams
    moments = np.array([g**order if order else 1.0 for order in range(streams)])
    axial = sky or g == 0.0 or sun_cosine == 1.0
    angles, _, down, axial_field, *field = pydisort(
        np.array([tau]),
        np.array([omega]),
        streams,
        moments[None, :],
        sun_cosine,
        sun,
        0.0,
        b_neg=0.0 if sun else 1.0,
        f_arr=np.array([peak]),
        BDRF_Fourier_modes=[albedo] if albedo > 0.0 else [],
        NFourier=1 if axial else streams,
    )
    diffuse, direct = down(tau)
    irradiance = float(np.squeeze(diffuse) + np.squeeze(direct))

    depth, depth_weight = depth_nodes(tau)
    azimuth = np.linspace(0.0, np.pi, streams + 1)
    azimuth_weight = np.full(streams + 1, np.pi / streams)
    azimuth_weight[[0, -1]] /= 2.0
    if axial:
        radiance = np.repeat(axial_field(depth)[:, :, None], streams + 1, axis=2)
    else:
        radiance = field[0](depth, azimuth)
    half_nodes, half_weights = np.polynomial.legendre.leggauss(streams // 2)
    half_nodes, half_weights = (half_nodes + 1.0) / 2.0, half_weights / 2.0
    angle_weight = half_weights[np.argmin(np.abs(np.abs(angles)[:, None] - half_nodes), axis=1)]

    thinning = 1.0 - omega * peak
    truncated = omega * (moments - peak) * (2.0 * np.arange(streams) + 1.0) / (4.0 * np.pi)
    cosine = -angles  # of the direction in which light travels, positive downwards
    sine = np.sqrt(1.0 - cosine**2)
    out = []
    for above, zenith, view_azimuth in views:
        mu = np.cos(np.radians(zenith))
        mu_sine = np.sqrt(1.0 - mu * mu)
        phi = np.radians(view_azimuth)
        phase = 0.0
        for side in (1.0, -1.0):
            between = cosine[:, None] * mu + sine[:, None] * mu_sine * np.cos(phi - side * azimuth)
            phase = phase + np.polynomial.legendre.legval(np.clip(between, -1.0, 1.0), truncated)
        source = np.einsum("mp,mtp,m,p->t", phase, radiance, angle_weight, azimuth_weight)
        scattering = np.clip(mu * sun_cosine + mu_sine * np.sqrt(1.0 - sun_cosine**2) * np.cos(phi), -1.0, 1.0)
        once = sun * omega * henyey_greenstein(g, scattering)
        source = source + once * np.exp(-thinning * depth / sun_cosine)
        path = (above * tau - depth) / mu
        ahead = path > 0.0
        weight = np.where(ahead, depth_weight / abs(mu), 0.0)
        scattered = np.sum(weight * source * np.exp(-thinning * np.where(ahead, path, 0.0)))
        # What the scaling let through of the light from beyond the fog, although it was scattered in it.
        full = (above * tau if mu > 0.0 else (above - 1.0) * tau) / mu
        beyond = (1.0 if sky else 0.0) if mu > 0.0 else albedo * irradiance / np.pi
        scattered += (np.exp(-thinning * full) - np.exp(-full)) * beyond
        out.append((scattered, irradiance))
    return out


def chosen():
    """A fixed, well mixed choice of slabs from the grid, and for each a few views that walk through all of them."""
    grid = [
        (omega, g, tau, light, albedo) for omega in OMEGA for g in G for tau in TAU for light in LIGHT for albedo in ALBEDO
    ]
    mixed = sorted(range(len(grid)), key=lambda index: index * 389 % len(grid))
    for turn, index in enumerate(sorted(mixed[: len(grid) // STRIDE])):
        first = turn * 7
        views = sorted({(first + 7 * step) % len(VIEWS) for step in range(ROWS_PER_SLAB)})
        light = grid[index][3]
        if light != "sky":
            # One view straight at the sun.
            near = VIEWS.index((1.0, light, 0.0))
            views = sorted(set(views) | {near})
        if light == "sky":
            views = [view for view in views if VIEWS[view][2] == 0.0] or [0, 13]
        elif light == 0.0:
            # All azimuths are the same.
            views = [view for view in views if VIEWS[view][2] in (0.0, 90.0)]
        yield grid[index], [VIEWS[view] for view in views]


def main():
    check = "--check" in sys.argv[1:]
    if check:
        worst = []
        for parameters, views in chosen():
            some = slab(*parameters, views, STREAMS)
            more = slab(*parameters, views, 64)
            worst += [abs(a[0] / b[0] - 1.0) for a, b in zip(some, more)]
        print(f"rows {len(worst)}, median {np.median(worst):.1e}, worst {max(worst):.1e}")
        return
    print(
        "# Light scattered in a plane-parallel slab of fog (Henyey-Greenstein phase function), all orders of scattering.\n"
        f"# PythonicDISORT {version('PythonicDISORT')}, {STREAMS} streams, delta-M, source integrated along the line of sight;"
        " written by scripts/fog_reference.py.\n"
        "# 48 against 64 streams: median 2e-8, worst 1.5e-4 (g = 0.85, towards the sun).\n"
        "# omega: single-scattering albedo; g: asymmetry; tau: vertical optical depth of the slab.\n"
        "# light: sun zenith angle in degrees (unit irradiance perpendicular to the beam), or `sky` (isotropic, radiance 1 from above, no sun).\n"
        "# albedo: of the Lambertian ground under the slab. above: the part of tau above the observer (1 at the ground, 0 on top).\n"
        "# zenith, azimuth: of the line of sight, degrees; 0 = straight up; relative azimuth 0 = towards the sun.\n"
        "# scattered: radiance scattered into the line of sight between the observer and the edge of the fog, sr^-1 per unit\n"
        "#   irradiance of the sun (or unitless, under the sky), without the light of the ground or the sky seen through the fog.\n"
        "# irradiance: on the ground, direct light included; the ground's radiance is albedo * irradiance / pi.\n"
        "omega,g,tau,light,albedo,above,zenith,azimuth,scattered,irradiance"
    )
    for parameters, views in chosen():
        omega, g, tau, light, albedo = parameters
        name = light if light == "sky" else f"{light:g}"
        for (above, zenith, azimuth), (scattered, irradiance) in zip(views, slab(*parameters, views, STREAMS)):
            print(f"{omega:g},{g:g},{tau:g},{name},{albedo:g},{above:g},{zenith:g},{azimuth:g},{scattered:.6g},{irradiance:.6g}")


if __name__ == "__main__":
    main()

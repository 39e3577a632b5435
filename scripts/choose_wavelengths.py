#!/usr/bin/env python3
"""Optimise the wavelengths of the grids `standard` and `fast` of the crate `airlight`.

    python3 scripts/choose_wavelengths.py standard [SEED ...]
    python3 scripts/choose_wavelengths.py fast [SEED ...]

Coordinate descent on whole nanometres from a jittered uniform start for each seed; without a seed, from the
current wavelengths. Prints the cost, the wavelengths, the largest and the root mean square CIEDE2000 up to air mass 19.5,
and the most negative colour weight relative to the sun's X, Y and Z. Needs numpy, scipy and colour-science 0.4.7; reads
the tables in crates/airlight/data.
"""

import pathlib
import sys

import colour
import numpy as np
from scipy.interpolate import CubicSpline

DATA = pathlib.Path(__file__).parent.parent / "crates/airlight/data"
NM = np.arange(360.0, 831.0)
D65 = np.array([95.047, 100.0, 108.883])

GRIDS = {
    # current wavelengths, range of the uniform start, fixed ends, smallest and largest distance between neighbours
    "standard": (
        [360, 398, 424, 446, 466, 485, 510, 539, 562, 595, 612, 637, 671, 716, 765, 830],
        (398, 700), ([360], [765, 830]), (16, 75),
    ),
    "fast": ([413, 448, 483, 523, 563, 596, 632, 682], (400, 680), ([], []), (28, 90)),
}


def table(name):
    return np.loadtxt(DATA / name)


sun = table("spectrum/solar_astm_g173.txt")
ozone_table = table("optics/ozone_233k.txt")
KERNEL = (
    683.002
    * np.interp(NM, sun[:, 0], sun[:, 1])[:, None]
    * table("spectrum/cie_1931_2deg.txt")[:, 1:]
)


def spectra():
    """Target responses, with the air mass of each and whether it belongs to the clear sky of the colour test."""
    air = 0.0973 * (550.0 / NM) ** 4.08
    cross_section = np.interp(NM, ozone_table[:, 0], ozone_table[:, 1])
    for mass in (1.0, 1.15, 2.0, 5.6, 10.0, 19.5, 38.0):
        for dobson in (0, 300, 450):
            ozone = cross_section * dobson * 2.6867e20
            for at_550, angstrom in ((0.03, 1.3), (0.1, 1.3), (0.4, 1.3), (0.2, 0.2)):
                haze = at_550 * (NM / 550.0) ** -angstrom
                clear = dobson == 300 and at_550 == 0.1 and mass in (1.15, 5.6, 19.5)
                direct = np.exp(-mass * (air + ozone + haze))
                yield direct, mass, clear
                yield air * direct, mass, clear
                yield haze * direct, mass, False
                # Twilight: much of the ozone path is above most of the air.
                yield air * np.exp(-mass * (0.3 * (air + haze) + ozone)), mass, False
                yield air * -np.expm1(-mass * (air + haze)) * np.exp(-mass * ozone), mass, False


ROWS = list(spectra())
RESPONSES = np.array([row[0] for row in ROWS])
USUAL = np.array([row[1] <= 19.5 for row in ROWS])
CLEAR = np.array([row[2] for row in ROWS])
WANT = RESPONSES @ KERNEL
SCALE = 100.0 / WANT[:, 1:2]


def lab(xyz):
    t = xyz / D65
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.stack(
        [116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], -1
    )


def measure(nodes):
    nodes = np.asarray(nodes)
    cardinal = CubicSpline(nodes, np.eye(len(nodes)), bc_type="natural")
    weights = cardinal(np.clip(NM, nodes[0], nodes[-1])).T @ KERNEL
    got = RESPONSES[:, nodes - 360] @ weights
    difference = colour.difference.delta_E_CIE2000(lab(WANT * SCALE), lab(got * SCALE))
    return difference, weights / weights.sum(axis=0)


def cost(nodes):
    difference, shares = measure(nodes)
    usual = difference[USUAL]
    return (
        np.sqrt((usual**2).mean())
        + 0.3 * usual.max()
        + 0.5 * difference[CLEAR].max()
        + 0.02 * difference.max()
        - 3.0 * np.minimum(shares, 0.0).sum()
    )


def allowed(nodes, spacing):
    steps = np.diff(nodes)
    return nodes[0] >= 360 and nodes[-1] <= 830 and steps.min() >= spacing[0] and steps.max() <= spacing[1]


def descend(nodes, held, spacing):
    free = range(len(held[0]), len(nodes) - len(held[1]))
    best = cost(nodes)
    for step in (16, 8, 4, 2, 1):
        improved = True
        while improved:
            improved = False
            for k in free:
                for move in (-step, step):
                    trial = list(nodes)
                    trial[k] += move
                    if allowed(trial, spacing) and (c := cost(trial)) < best:
                        best, nodes, improved = c, trial, True
    return best, nodes


def main():
    if len(sys.argv) < 2 or sys.argv[1] not in GRIDS:
        sys.exit(__doc__)
    in_use, span, held, spacing = GRIDS[sys.argv[1]]
    starts = [in_use]
    if len(sys.argv) > 2:
        inner = len(in_use) - len(held[0]) - len(held[1])
        even = np.linspace(*span, inner)
        starts = [
            held[0]
            + [int(round(x)) for x in even + np.random.default_rng(int(seed)).normal(0, 3, inner)]
            + held[1]
            for seed in sys.argv[2:]
        ]
    for start in starts:
        best, nodes = descend(start, held, spacing)
        difference, shares = measure(nodes)
        usual = difference[USUAL]
        print(
            f"{best:.4f} {nodes} max {usual.max():.3f} rms {np.sqrt((usual**2).mean()):.3f}"
            f" least share {shares.min():.4f}"
        )


if __name__ == "__main__":
    main()

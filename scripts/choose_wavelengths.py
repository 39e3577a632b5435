#!/usr/bin/env python3
"""Optimise the wavelengths of the grids `standard` and `fast` of the crate `airlight`.

    python3 scripts/choose_wavelengths.py standard [SEED ...]
    python3 scripts/choose_wavelengths.py fast [SEED ...]
    python3 scripts/choose_wavelengths.py fast --write

Coordinate descent on whole nanometres from a jittered uniform start for each seed; without a seed, from the
current wavelengths. Prints the cost, the wavelengths, the largest and the root mean square CIEDE2000 up to air mass 19.5,
and the most negative colour weight relative to the sun's X, Y and Z. `--write` writes the interpolant of the current
wavelengths of `fast` (see `interpolant_of_air`) to crates/airlight/data/spectrum/fast_interpolant.txt.

Needs numpy, scipy and colour-science 0.4.7; reads the tables in crates/airlight/data.
"""

import pathlib
import sys

import colour
import numpy as np
from scipy.interpolate import CubicSpline

DATA = pathlib.Path(__file__).parent.parent / "crates/airlight/data"
NM = np.arange(360.0, 831.0)
# Wavelengths beyond which the eye is less than a three-hundredth as sensitive as at its best.
SEEN_NM = (390.0, 710.0)
D65 = np.array([95.047, 100.0, 108.883])

GRIDS = {
    # current wavelengths, range of the uniform start, fixed ends, smallest and largest distance between neighbours
    "standard": (
        [360, 398, 424, 446, 466, 485, 510, 539, 562, 595, 612, 637, 671, 716, 765, 830],
        (398, 700), ([360], [765, 830]), (16, 75),
    ),
    "fast": ([423, 457, 499, 526, 559, 596, 635, 683], (410, 690), ([], []), (14, 90)),
}


def table(name):
    return np.loadtxt(DATA / name)


sun = table("spectrum/solar_astm_g173.txt")
ozone_table = table("optics/ozone_233k.txt")
# Cross-section of a Dobson unit.
OZONE = np.interp(NM, ozone_table[:, 0], ozone_table[:, 1]) * 2.6867e20
KERNEL = (
    683.002
    * np.interp(NM, sun[:, 0], sun[:, 1])[:, None]
    * table("spectrum/cie_1931_2deg.txt")[:, 1:]
)


def in_units_of_sunlight(responses):
    """Responses scaled to the luminance of the sun's own light."""
    return responses / (responses @ KERNEL[:, 1:2]) * KERNEL[:, 1].sum()


def spectra():
    """Target responses, with the air mass of each and whether it belongs to the clear sky of the colour test."""
    air = 0.0973 * (550.0 / NM) ** 4.08
    for mass in (1.0, 1.15, 2.0, 5.6, 10.0, 19.5, 38.0):
        for dobson in (0, 300, 450):
            ozone = OZONE * dobson
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


def rayleigh():
    """Optical depth of the air (Bodhaine et al. 1999 with 36 Pa of carbon dioxide, relative to 0.0971 at 550 nm)."""
    square = (NM / 1000.0) ** -2
    refractivity = 8060.51 + 2480990.0 / (132.274 - square) + 17455.7 / (39.32957 - square)
    king = (
        78.084 * (1.034 + 3.17e-4 * square)
        + 20.946 * (1.096 + 1.385e-3 * square + 1.448e-4 * square**2)
        + 0.934
        + 0.036 * 1.15
    )
    depth = refractivity**2 * square**2 * king
    return 0.0971 * depth / np.interp(550.0, NM, depth)


def likely_spectra():
    """Responses between which `interpolant_of_air` interpolates: of the sun, of skies by day and in deep twilight, whose
    light has a longer path in ozone than in the air below it, and the same times powers of the wavelength."""
    air = rayleigh()
    rows = []
    for mass in (1.0, 2.0, 5.0, 10.0, 20.0, 38.0):
        for dobson in (0, 150, 300, 450):
            ozone = OZONE * dobson
            for at_550, angstrom in ((0.03, 1.3), (0.15, 1.3), (0.4, 1.0), (0.3, 0.2)):
                haze = at_550 * (NM / 550.0) ** -angstrom
                direct = np.exp(-mass * (air + ozone + haze))
                lights = [direct, air * direct, haze * direct]
                lights.append(air * -np.expm1(-mass * (air + haze)) * np.exp(-mass * ozone))
                for longer in (1.0, 2.0):
                    lights.append(air * np.exp(-mass * (0.3 * (air + haze) + longer * ozone)))
                    lights.append(air**2 * np.exp(-mass * (0.5 * (air + haze) + longer * ozone)))
                rows += [light * (NM / 550.0) ** power for light in lights for power in (-1.5, 0, 1.5)]
    return in_units_of_sunlight(np.array(rows))


def covariance():
    """Mean product of a response at two wavelengths: of likely spectra, of any smooth function, a hundredth as strong, and
    of a constant, which is thereby reproduced."""
    likely = likely_spectra()
    smooth = np.exp(-((NM[:, None] - NM) ** 2) / (2.0 * 60.0**2))
    return likely.T @ likely / len(likely) + 0.01 * smooth + 1e3


def interpolant_of_air(nodes):
    """Cardinal functions at NM: the linear prediction of a response from its values at the nodes that has the least mean
    square error for responses of `covariance` (kriging)."""
    at = np.asarray(nodes) - 360
    functions = np.linalg.solve(COVARIANCE[np.ix_(at, at)], COVARIANCE[at])
    # Constant where the eye hardly sees, as the factors of an extrapolation are large.
    seen = np.clip(NM, *SEEN_NM).astype(int) - 360
    return (functions / functions.sum(axis=0))[:, seen]


def natural_spline(nodes):
    cardinal = CubicSpline(nodes, np.eye(len(nodes)), bc_type="natural")
    return cardinal(np.clip(NM, nodes[0], nodes[-1])).T


COVARIANCE = covariance()
INTERPOLANTS = {"standard": natural_spline, "fast": interpolant_of_air}
ROWS = list(spectra())
RESPONSES = np.array([row[0] for row in ROWS])
USUAL = np.array([row[1] <= 19.5 for row in ROWS])
CLEAR = np.array([row[2] for row in ROWS])
AIR = np.concatenate([in_units_of_sunlight(RESPONSES[USUAL]), likely_spectra()])


def coloured_surfaces():
    """Responses of the 24 surfaces of a colour chart in white light, in that of two suns and of a sky."""
    chart = colour.SDS_COLOURCHECKERS["ISO 17321-1"].values()
    surfaces = np.array([np.interp(NM, surface.wavelengths, surface.values) for surface in chart])
    clear = rayleigh() + 0.1 * (NM / 550.0) ** -1.3 + 300 * OZONE
    lights = in_units_of_sunlight(np.array([NM**0, np.exp(-1.15 * clear), np.exp(-10 * clear), rayleigh()]))
    return np.concatenate([surfaces * light for light in lights])


def lab(xyz):
    t = xyz / D65
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.stack(
        [116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], -1
    )


def differences(responses, nodes, weights, white=None):
    """CIEDE2000 of responses by the nodes; of light by itself, or of surfaces under a white of a luminance."""
    want = responses @ KERNEL
    scale = 100.0 / (want[:, 1:2] if white is None else white)
    got = responses[:, np.asarray(nodes) - 360] @ weights
    return colour.difference.delta_E_CIE2000(lab(want * scale), lab(got * scale))


SURFACES = coloured_surfaces()


def measure(name, nodes):
    weights = INTERPOLANTS[name](nodes) @ KERNEL
    return differences(RESPONSES, nodes, weights), weights / weights.sum(axis=0), weights


def rms(values):
    return np.sqrt((values**2).mean())


def cost(name, nodes):
    difference, shares, weights = measure(name, nodes)
    if name == "fast":
        skies = differences(AIR, nodes, weights)
        surfaces = differences(SURFACES, nodes, weights, KERNEL[:, 1].sum())
        return (
            rms(skies)
            + 0.3 * skies.max()
            + 0.3 * (surfaces.mean() + 0.3 * surfaces.max())
            - 20.0 * np.minimum(shares + 0.005, 0.0).sum()
        )
    usual = difference[USUAL]
    return (
        rms(usual)
        + 0.3 * usual.max()
        + 0.5 * difference[CLEAR].max()
        + 0.02 * difference.max()
        - 3.0 * np.minimum(shares, 0.0).sum()
    )


def allowed(nodes, spacing):
    steps = np.diff(nodes)
    return nodes[0] >= 360 and nodes[-1] <= 830 and steps.min() >= spacing[0] and steps.max() <= spacing[1]


def descend(name, nodes, held, spacing):
    free = range(len(held[0]), len(nodes) - len(held[1]))
    best = cost(name, nodes)
    for step in (16, 8, 4, 2, 1):
        improved = True
        while improved:
            improved = False
            for k in free:
                for move in (-step, step):
                    trial = list(nodes)
                    trial[k] += move
                    if allowed(trial, spacing) and (c := cost(name, trial)) < best:
                        best, nodes, improved = c, trial, True
    return best, nodes


def write_interpolant(nodes):
    lines = [
        "# Interpolation of the response of sunlit air (radiance over solar irradiance) between the wavelengths of the grid `fast`.",
        "# Columns: wavelength nm, factors of the responses at " + ", ".join(map(str, nodes)) + " nm.",
        "# Source: least mean square error for spectra of the sun and of skies by day and in twilight (kriging).",
        "# Made by scripts/choose_wavelengths.py fast --write",
    ]
    for nm, factors in zip(NM, interpolant_of_air(nodes).T):
        lines.append(f"{nm:.0f} " + " ".join(f"{factor:.6f}" for factor in factors))
    (DATA / "spectrum/fast_interpolant.txt").write_text("\n".join(lines) + "\n")


def main():
    if len(sys.argv) < 2 or sys.argv[1] not in GRIDS:
        sys.exit(__doc__)
    name = sys.argv[1]
    in_use, span, held, spacing = GRIDS[name]
    if sys.argv[2:] == ["--write"] and name == "fast":
        return write_interpolant(in_use)
    starts = [in_use]
    if len(sys.argv) > 2:
        inner = len(in_use) - len(held[0]) - len(held[1])
        even = np.linspace(*span, inner)
        starts = [
            held[0]
            + [int(round(x)) for x in even + np.random.default_rng(int(seed)).normal(0, 5, inner)]
            + held[1]
            for seed in sys.argv[2:]
        ]
    for start in starts:
        best, nodes = descend(name, start, held, spacing)
        difference, shares, weights = measure(name, nodes)
        usual = difference[USUAL]
        surfaces = differences(SURFACES, nodes, weights, KERNEL[:, 1].sum())
        print(
            f"{best:.4f} {nodes} max {usual.max():.3f} rms {rms(usual):.3f}"
            f" least share {shares.min():.4f} coloured surfaces {surfaces.mean():.2f}, {surfaces.max():.2f}"
        )


if __name__ == "__main__":
    main()

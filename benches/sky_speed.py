#!/usr/bin/env python3
"""Time skies and spheres of the Python package beside programs that do the same, in one run; `benches/README.md` says how to install
them.

Prints Markdown tables. Times are CPU times of all threads, medians of several turns, in which each program runs once, so that all meet
the same machine; a program that took seconds is not run again. Each time is printed on standard error when it is known.
"""

import csv
import pathlib
import statistics
import sys
import time
from collections.abc import Callable

import airlight
import miepython
import mitsuba
import numpy as np
import pvlib
import sasktran2 as sk

TURNS = 5
#: Processor time after which a program is not run again, s.
ENOUGH_S = 5.0
COUNT = 10_000
TRUTH = pathlib.Path(__file__).parents[1] / "crates/airlight-validation/data/mc_sphere_rayleigh.csv"
#: Wavelengths of the reference atmosphere, nm, and its scattering at sea level, 1/m.
RAYLEIGH = {680.0: 5.8e-6, 550.0: 13.5e-6, 440.0: 33.1e-6}
SUN_ZENITH_DEG = 60.0


def directions() -> tuple[np.ndarray, np.ndarray]:
    """Azimuths and elevations of directions that are even on the upper hemisphere, degrees; the sun is at azimuth 0."""
    index = np.arange(COUNT) + 0.5
    return (index * 180 * (3 - 5**0.5)) % 360, np.degrees(np.arcsin(index / COUNT))


def truth() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Azimuths, elevations and radiances (3 wavelengths) of the Monte Carlo reference."""
    rows = {}
    for row in csv.DictReader(TRUTH.open()):
        if row["config"] == "a0.0" and float(row["sun_zenith_deg"]) == SUN_ZENITH_DEG:
            at = float(row["rel_azimuth_deg"]), 90 - float(row["view_zenith_deg"])
            rows.setdefault(at, []).append(float(row["L"]))
    azimuth, elevation = np.array(list(rows)).T
    return azimuth, elevation, np.array(list(rows.values()))


def airlight_sky(azimuth: np.ndarray, elevation: np.ndarray) -> np.ndarray:
    """The solver: prepared for the sun, and each direction integrated in full."""
    sun = 90 - SUN_ZENITH_DEG
    sky = airlight.Sky(
        "reference-rayleigh",
        wavelengths=sorted(RAYLEIGH),
        sun_elevation_deg=sun,
        altitude_m=0.0,
        polarisation_correction=False,
    )
    view = sky.view(0.0, sun_elevation_deg=sun, sun_azimuth_deg=0.0)
    return view.radiance(airlight.direction(azimuth, elevation))[:, ::-1]


def sasktran(source: sk.MultipleScatterSource, step_m: float) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    """SASKTRAN2 with a source of multiple scattering on a uniform grid of altitudes."""

    def radiance(azimuth: np.ndarray, elevation: np.ndarray) -> np.ndarray:
        config = sk.Config()
        config.multiple_scatter_source = source
        config.num_streams = 16
        config.num_threads = 2
        cos_sun = np.cos(np.radians(SUN_ZENITH_DEG))
        altitudes = np.arange(0.0, 60_000.1, step_m)
        geometry = sk.Geometry1D(cos_sun, 0.0, 6_360_000.0, altitudes)
        rays = sk.ViewingGeometry()
        for turn, height in zip(np.radians(azimuth), np.radians(elevation), strict=True):
            rays.add_ray(sk.SolarAnglesObserverLocation(cos_sun, turn, np.sin(height), 0.0))
        air = sk.Atmosphere(
            geometry,
            config,
            wavelengths_nm=np.array(list(RAYLEIGH)),
            calculate_derivatives=False,
        )
        air.storage.total_extinction[:] = np.exp(-altitudes / 8000.0)[:, None] * np.array(list(RAYLEIGH.values()))
        air.storage.ssa[:] = 1.0
        air.leg_coeff.a1[0] = 1.0
        air.leg_coeff.a1[2] = 0.5
        found = sk.Engine(config, geometry, rays).calculate_radiance(air)
        return found["radiance"].isel(stokes=0).values.T

    return radiance


def mitsuba_sky() -> np.ndarray:
    """The emitter `sunsky` without its sun, in a picture of 10 000 pixels."""
    side = int(COUNT**0.5)
    scene = mitsuba.load_dict({
        "type": "scene",
        "integrator": {"type": "direct"},
        "sky": {"type": "sunsky", "sun_direction": [0.0, 0.75**0.5, 0.5], "sun_scale": 0.0},
        "sensor": {
            "type": "perspective",
            "fov": 90,
            "to_world": mitsuba.ScalarTransform4f().look_at(origin=[0, 0, 0], target=[0, 0, 1], up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": side, "height": side, "rfilter": {"type": "box"}},
            "sampler": {"type": "independent", "sample_count": 1},
        },
    })  # fmt: skip
    return np.array(mitsuba.render(scene))


def hosek_wilkie() -> np.ndarray:
    """The model of Mitsuba's emitter, by this package."""
    scene = airlight.Scene.from_toml("sun.elevation_deg = 30\nsolver.name = 'hosek-wilkie'")
    return scene.view("srgb").radiance(airlight.direction(*directions()))


def tilted_planes() -> tuple[np.ndarray, np.ndarray]:
    """Azimuths and slopes of planes, degrees."""
    azimuth, elevation = directions()
    return azimuth, 90 - elevation


def airlight_planes() -> np.ndarray:
    """Spectral irradiance of the planes at 16 wavelengths by the sky and the ground."""
    view = airlight.Sky("average", sun_elevation_deg=30).view(sun_elevation_deg=30, sun_azimuth_deg=0.0)
    azimuth, slope = tilted_planes()
    return view.irradiance(airlight.direction(azimuth, 90 - slope))


def pvlib_planes() -> np.ndarray:
    """Broadband irradiance of the planes, by Ineichen's clear sky and the transposition of Perez."""
    azimuth, slope = tilted_planes()
    airmass = pvlib.atmosphere.get_relative_airmass(60.0)
    clear = pvlib.clearsky.ineichen(60.0, airmass, 3.0)
    total = pvlib.irradiance.get_total_irradiance(
        slope,
        azimuth,
        60.0,
        0.0,
        clear["dni"],
        clear["ghi"],
        clear["dhi"],
        dni_extra=1367.0,
        airmass=airmass,
        albedo=0.1,
        model="perez",
    )
    return total["poa_diffuse"]


COSINES = np.cos(np.linspace(0, np.pi, COUNT))
INDEX = 1.333


def airlight_mie(size: float) -> np.ndarray:
    """Efficiencies and phase function of a sphere."""
    airlight.mie_sphere(size, INDEX + 0j)
    return airlight.mie_phase(size, INDEX + 0j, np.degrees(np.arccos(COSINES)))


def miepython_mie(size: float) -> np.ndarray:
    """The same by miepython."""
    miepython.efficiencies_mx(INDEX, size)
    return miepython.i_unpolarized(INDEX, size, COSINES, norm="one")


def cpu_seconds(call: Callable[[], object]) -> float:
    """Processor time of a call."""
    begun = time.process_time()
    call()
    return time.process_time() - begun


def shown(seconds: float) -> str:
    """A time with its unit."""
    return f"{seconds:.3g} s" if seconds >= 1 else f"{1000 * seconds:.3g} ms"


def table(
    head: str,
    calls: dict[str, Callable[[], object]],
    remarks: dict[str, str] | None = None,
) -> None:
    """Print the medians of the times of calls, and their ratios to that of the first."""
    times: dict[str, list[float]] = {name: [] for name in calls}
    for _ in range(TURNS):
        for name, call in calls.items():
            if sum(times[name]) > ENOUGH_S:
                continue
            times[name].append(cpu_seconds(call))
            print(f"{head}: {name}: {times[name][-1]:.3g} s", file=sys.stderr, flush=True)
    medians = {name: statistics.median(found) for name, found in times.items()}
    first = next(iter(medians.values()))
    more = [] if remarks is None else ["difference from Monte Carlo: median, 95th percentile"]
    cells = [head, "CPU time", "relative", *more]
    print(f"\n| {' | '.join(cells)} |\n|{'---|' * len(cells)}")
    for name, median in medians.items():
        cells = [name, shown(median), f"{median / first:.3g}"]
        if remarks is not None:
            cells.append(remarks.get(name, ""))
        print(f"| {' | '.join(cells)} |", flush=True)


def main() -> None:
    """Print all tables."""
    mitsuba.set_variant("scalar_rgb")
    sources = sk.MultipleScatterSource
    skies = {
        "Airlight": airlight_sky,
        "SASKTRAN2, discrete ordinates, 16 streams, grid of 500 m": sasktran(sources.DiscreteOrdinates, 500.0),
        "SASKTRAN2, successive orders, grid of 500 m": sasktran(sources.SuccessiveOrders, 500.0),
    }
    azimuth, elevation, expected = truth()
    errors = {}
    for name, sky in skies.items():
        difference = np.abs(sky(azimuth, elevation) / expected - 1)
        errors[name] = f"{100 * np.median(difference):.2f} %, {100 * np.quantile(difference, 0.95):.2f} %"
    at = directions()
    calls = {name: (lambda sky=sky: sky(*at)) for name, sky in skies.items()}
    table("sky of molecules: solved, radiance in 10 000 directions", calls, errors)
    fits = {
        "Airlight, `solver.name = 'hosek-wilkie'`": hosek_wilkie,
        "Mitsuba, `sunsky`, scalar variant": mitsuba_sky,
    }
    table("fitted sky of Hosek and Wilkie: 10 000 directions in RGB", fits)
    table("irradiance of 10 000 tilted planes by a clear sky", {
        "Airlight: solved, spectral (16 wavelengths)": airlight_planes,
        "pvlib: Ineichen and Perez, broadband": pvlib_planes,
    })  # fmt: skip
    for size in (10.0, 1000.0):
        ours, theirs = airlight_mie(size), miepython_mie(size)
        assert np.allclose(ours, theirs, rtol=1e-3), "both compute the same phase function"
        kind = "compiled by numba" if miepython.USE_JIT else "NumPy"
        table(f"sphere of size parameter {size:g}: efficiencies, phase function at 10 000 angles", {
            "Airlight": lambda size=size: airlight_mie(size),
            f"miepython ({kind})": lambda size=size: miepython_mie(size),
        })  # fmt: skip


if __name__ == "__main__":
    main()

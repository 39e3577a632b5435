#!/usr/bin/env python3
"""Time the Python package beside programs that do the same, in one run; `benches/README.md` says how to install them.

Prints a Markdown table of the medians of several runs, which take turns so that all meet the same machine.
"""

import statistics
import time
from collections.abc import Callable

import airlight
import albumentations
import numpy as np

RUNS = 9
SIZE = (1024, 1024)


def pictures() -> tuple[np.ndarray, np.ndarray]:
    """A picture of a megapixel with depth."""
    random = np.random.default_rng(1)
    picture = random.integers(0, 256, (*SIZE, 3), dtype=np.uint8)
    depth = random.uniform(2.0, 400.0, SIZE).astype(np.float32)
    return picture, depth


def numpy_fog(picture: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """Uniform fog by NumPy: tables for the sRGB curve, single precision, the pinhole camera's ray lengths."""
    height, width = depth.shape
    focal = 0.5 * width / np.tan(np.radians(30.0))
    x = (np.arange(width, dtype=np.float32) - 0.5 * width + 0.5) / np.float32(focal)
    y = (np.arange(height, dtype=np.float32) - 0.5 * height + 0.5) / np.float32(focal)
    lengths = depth * np.sqrt(1 + x[None, :] ** 2 + y[:, None] ** 2)
    through = np.exp(lengths * np.float32(np.log(0.05) / 120.0))[..., None]
    light = DECODE[picture] * through + np.float32(0.5) * (1 - through)
    return ENCODE[(light * np.float32(65535) + np.float32(0.5)).astype(np.uint16)]


def _decode(signal: np.ndarray) -> np.ndarray:
    return np.where(signal <= 0.04045, signal / 12.92, ((signal + 0.055) / 1.055) ** 2.4)


DECODE = _decode(np.arange(256) / 255).astype(np.float32)
_LEVELS = np.arange(65536) / 65535
_SIGNALS = np.where(_LEVELS <= 0.0031308, 12.92 * _LEVELS, 1.055 * _LEVELS ** (1 / 2.4) - 0.055)
ENCODE = (255 * _SIGNALS + 0.5).astype(np.uint8)


def seconds(call: Callable[[], object]) -> float:
    """Time of a call."""
    begun = time.perf_counter()
    call()
    return time.perf_counter() - begun


def main() -> None:
    picture, depth = pictures()
    fog = airlight.Fog(120, ambient=(0.5, 0.5, 0.5), fov_deg=60)
    random_fog = albumentations.RandomFog(p=1.0)
    ours, theirs = fog(picture, depth), numpy_fog(picture, depth)
    assert np.abs(ours.astype(int) - theirs).max() <= 1, "both draw the same fog"
    calls = {
        "`airlight.Fog`, 1 thread": lambda: fog(picture, depth, threads=1),
        "`airlight.Fog`, all threads": lambda: fog(picture, depth),
        "NumPy": lambda: numpy_fog(picture, depth),
        "albumentations `RandomFog` (circles of white, without depth)": lambda: random_fog(image=picture),
    }
    times: dict[str, list[float]] = {name: [] for name in calls}
    for _ in range(RUNS):
        for name, call in calls.items():
            times[name].append(seconds(call))
    print("| uniform fog over a megapixel, uint8 in and out | time |")
    print("|---|---|")
    for name, found in times.items():
        print(f"| {name} | {1000 * statistics.median(found):.0f} ms |")


if __name__ == "__main__":
    main()

"""Fixtures: the program, a picture with depth, a view."""

import os
import pathlib
import subprocess

import numpy as np
import pytest

import airlight

ROOT = pathlib.Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def program():
    """Run the program airlight of this checkout."""
    path = pathlib.Path(os.environ.get("AIRLIGHT_PROGRAM", ROOT / "target/debug/airlight"))
    if not path.exists():
        pytest.fail(f"no program at {path}: build it, or set AIRLIGHT_PROGRAM")

    def run(*arguments):
        done = subprocess.run([path, *map(str, arguments)], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


@pytest.fixture(scope="session")
def photograph():
    """A picture of all colours, uint8."""
    return np.random.default_rng(7).integers(0, 256, (48, 64, 3), dtype=np.uint8)


@pytest.fixture(scope="session")
def depth():
    """Depth of the picture, m: from 2 m to 400 m, with sky at the top."""
    rows = np.geomspace(400.0, 2.0, 48, dtype=np.float32)
    depth = np.repeat(rows[:, None], 64, axis=1)
    depth[:4] = np.inf
    return depth


@pytest.fixture(scope="session")
def view():
    """A clear sky under a sun 30 degrees high in the south."""
    return airlight.Sky("clear", sun_elevation_deg=30).view(sun_elevation_deg=30)

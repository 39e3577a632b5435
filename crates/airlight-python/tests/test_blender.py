"""Hand-over to Blender, in Cycles of the package bpy, which has a virtual environment of its own as it needs an older NumPy."""

import os
import pathlib
import subprocess

import numpy as np
import pytest

import airlight
from airlight import blender

SCALE = 1e-4
SUN = {"sun_elevation_deg": 30.0, "sun_azimuth_deg": 120.0}
RENDER = pathlib.Path(__file__).with_name("render_in_blender.py")


@pytest.fixture(scope="module")
def view():
    return airlight.Sky("clear", sun_elevation_deg=30).view(**SUN)


def rendered(script, folder):
    """Pictures of the sky that a script sets in Blender, by name."""
    python = os.environ.get("AIRLIGHT_BLENDER_PYTHON")
    if python is None:
        pytest.skip("needs AIRLIGHT_BLENDER_PYTHON, a Python with the package bpy")
    done = subprocess.run([python, RENDER, script, folder], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return {path.stem: airlight.read_picture(path) for path in folder.glob("*.exr")}


@pytest.fixture(scope="module")
def pictures(view, tmp_path_factory):
    folder = tmp_path_factory.mktemp("blender")
    # Names that Blender and Python could take for something else.
    script = folder / "it's a {sky}.py"
    blender.write_script(script, view, 256, scale=SCALE)
    out = folder / "out"
    out.mkdir()
    return rendered(script, out)


def test_scripts_state_the_sun_and_need_no_package(view, tmp_path):
    blender.write_script(tmp_path / "sky.py", view, 16)
    text = (tmp_path / "sky.py").read_text()
    compile(text, "sky.py", "exec")
    assert "import airlight" not in text
    assert "from airlight" not in text
    east, up, south = view.sun
    assert f"({east!r}, {-south!r}, {up!r})" in text
    environment = airlight.read_picture(tmp_path / "sky.exr")
    assert environment.shape == (16, 32, 3)
    # The centre is east: the sun at azimuth 120 degrees is to its right.
    assert environment.sum(axis=(0, 2)).argmax() == pytest.approx(16 + 32 * 30 / 360, abs=1.5)


def test_a_sun_below_the_horizon_is_no_sun_light(tmp_path):
    night = airlight.Sky("clear", wavelengths="rgb", sun_elevation_deg=-5).view(sun_elevation_deg=-5)
    blender.write_script(tmp_path / "dusk.py", night, 16)
    assert (tmp_path / "dusk.py").read_text().rstrip().endswith("None)")


@pytest.mark.slow
def test_directions_are_those_of_the_sky(view, pictures):
    skies = {name: picture for name, picture in pictures.items() if name.startswith("sky-")}
    assert len(skies) == 4
    for name, picture in skies.items():
        direction = airlight.direction(*[[float(word)] for word in name.split("-")[1:]])
        np.testing.assert_allclose(picture.mean(axis=(0, 1)) / SCALE, view.rgb(direction)[0], rtol=0.002, err_msg=name)


@pytest.mark.slow
def test_a_white_plane_reflects_the_irradiance(pictures):
    toml = "sun = { elevation_deg = 30, azimuth_deg = 120 }\nair.atmosphere = 'clear'"
    scene = airlight.Scene.from_toml(toml).view("srgb")
    expected = scene.irradiance([[0, 1, 0]])[0] + scene.sun_irradiance() * np.sin(np.radians(30))
    np.testing.assert_allclose(np.pi * pictures["plane"].mean(axis=(0, 1)) / SCALE, expected, rtol=0.002)


@pytest.mark.slow
def test_shadows_fall_away_from_the_sun(pictures):
    light = pictures["pole"].sum(axis=2)
    side = light.shape[0]
    metre = side / 8
    rows, columns = np.nonzero(light < 0.5 * np.median(light))
    east, north = (columns + 0.5 - side / 2) / metre, (side / 2 - rows - 0.5) / metre
    outside = np.hypot(east, north) > 0.15
    azimuth = np.degrees(np.arctan2(east[outside].mean(), north[outside].mean()))
    assert azimuth % 360 == pytest.approx(120 + 180, abs=1)
    # A pole of 1 m, and half of its width of 0.1 m.
    assert np.hypot(east, north).max() == pytest.approx(1 / np.tan(np.radians(30)) + 0.05, abs=0.1)


@pytest.mark.slow
def test_the_package_sets_the_same_light_inside_blender(pictures, tmp_path):
    script = tmp_path / "inside.py"
    script.write_text(
        "import airlight, airlight.blender\n"
        f"view = airlight.Sky('clear', sun_elevation_deg=30).view(**{SUN})\n"
        # The second call replaces what the first has set.
        "airlight.blender.set_world(view, 16, scale=1.0)\n"
        f"airlight.blender.set_world(view, 256, scale={SCALE})\n"
    )
    inside = rendered(script, tmp_path)
    for name, picture in pictures.items():
        np.testing.assert_array_equal(inside[name], picture, err_msg=name)

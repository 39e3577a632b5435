"""Fog over arrays: the bytes of the program, closed forms, and use in workers."""

import math
import multiprocessing
import pickle

import numpy as np
import pytest

import airlight


def test_foggy_photograph_is_that_of_the_program(program, tmp_path, photograph, depth):
    cv2 = pytest.importorskip("cv2")
    cv2.imwrite(str(tmp_path / "rgb.png"), photograph[..., ::-1])
    np.save(tmp_path / "depth.npy", depth)
    program("fog", tmp_path / "rgb.png", "--depth", tmp_path / "depth.npy", "--visibility-m", 150, "-o", tmp_path / "a.png")
    expected = cv2.imread(str(tmp_path / "a.png"))[..., ::-1]
    foggy = airlight.Fog(150)(photograph, depth)
    assert foggy.dtype == np.uint8
    np.testing.assert_array_equal(foggy, expected)
    toml = airlight.Fog.from_toml("fog.visibility_m = 150")
    np.testing.assert_array_equal(toml(photograph, depth), expected)


def test_linear_light_in_lit_patchy_height_fog_is_that_of_the_program(program, tmp_path, photograph, depth):
    scene = airlight.Scene.from_toml("sun.elevation_deg = 20\ncamera = { size = [64, 48], projection = 'perspective' }")
    light = scene.render().rgb
    scene = airlight.Scene.from_toml(scene.to_toml() + "\n[output]\nprecision = 'float'")
    scene.write(tmp_path / "rgb.exr")
    np.save(tmp_path / "depth.npy", depth)
    options = ["--sun-elevation", 25, "--fog-profile", "height", "--scale-height-m", 30, "--patch-strength", 0.4]
    program(
        "fog",
        tmp_path / "rgb.exr",
        "--depth",
        tmp_path / "depth.npy",
        "--visibility-m",
        150,
        *options,
        "-o",
        tmp_path / "a.exr",
    )
    fog = airlight.Fog(150, sun_elevation_deg=25, profile="height", scale_height_m=30, patch_strength=0.4)
    np.testing.assert_array_equal(fog(light, depth), airlight.read_picture(tmp_path / "a.exr"))


def test_fog_with_lights_in_a_solved_sky_is_that_of_the_program(program, tmp_path, photograph, depth):
    cv2 = pytest.importorskip("cv2")
    cv2.imwrite(str(tmp_path / "rgb.png"), photograph[..., ::-1])
    np.save(tmp_path / "depth.npy", depth)
    toml = f"""
        sun = {{ elevation_deg = 12, azimuth_deg = 20 }}
        fog = {{ visibility_m = 200, profile = "height", scale_height_m = 40 }}
        lights = [{{ kind = "spot", position_m = [2, 6, -20], intensity = [40, 30, 20] }}]
        overlay = {{ sky_light = true, colour = "{tmp_path}/rgb.png", depth = "{tmp_path}/depth.npy" }}
        output.file = "{tmp_path}/a.png"
    """
    (tmp_path / "scene.toml").write_text(toml)
    program("fog", "--scene", tmp_path / "scene.toml")
    fog = airlight.Fog.from_toml(toml)
    expected = cv2.imread(str(tmp_path / "a.png"))[..., ::-1]
    np.testing.assert_array_equal(fog(photograph, depth), expected)
    again = pickle.loads(pickle.dumps(fog))
    np.testing.assert_array_equal(again(photograph, depth), expected)


def test_transmittance_at_the_visibility_is_5_percent(photograph):
    depth = np.full((48, 64), 100.0)
    transmittance, path_radiance, depth_m = airlight.Fog(100, depth_kind="ray").layers(photograph, depth)
    np.testing.assert_allclose(transmittance, 0.05, rtol=1e-5)
    assert (path_radiance > 0).all()
    assert depth_m.max() <= 100
    picture = photograph.astype(np.float32) / 255
    fog = airlight.Fog(100, depth_kind="ray", ambient=(0.5, 0.6, 0.7))
    transmittance, path_radiance, _ = fog.layers(picture, depth)
    np.testing.assert_allclose(fog(picture, depth), transmittance * picture + path_radiance, rtol=1e-5)


def test_wide_integers_keep_their_type_and_agree_with_bytes(photograph, depth):
    fog = airlight.Fog(150, ambient=(0.5, 0.5, 0.5))
    wide = fog(photograph.astype(np.uint16) * 257, depth)
    assert wide.dtype == np.uint16
    assert np.abs(wide / 257 - fog(photograph, depth)).max() < 1.1


def test_views_of_arrays_are_read_in_their_order(photograph, depth):
    fog = airlight.Fog(150, ambient=(0.5, 0.5, 0.5))
    straight = fog(photograph[:, ::-1].copy(), depth)
    np.testing.assert_array_equal(fog(photograph[:, ::-1], depth), straight)


def test_fog_survives_pickling(photograph, depth):
    fog = airlight.Fog(80, profile="height", scale_height_m=20, holes="far", ambient_scale=0.7)
    again = pickle.loads(pickle.dumps(fog))
    assert again.visibility_m == 80
    np.testing.assert_array_equal(again(photograph, depth), fog(photograph, depth))


def _foggy(job):
    fog, picture, depth = job
    return fog(picture, depth)


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_forked_and_spawned_workers_compute_the_same(method, photograph, depth):
    fog = airlight.Fog(80)
    here = fog(photograph, depth)
    with multiprocessing.get_context(method).Pool(2) as pool:
        for there in pool.map_async(_foggy, [(fog, photograph, depth)] * 4).get(timeout=60):
            np.testing.assert_array_equal(there, here)


@pytest.mark.parametrize(
    ("picture", "depth", "sentence"),
    [
        (np.zeros((4, 4, 3)), np.ones((4, 4)), "uint8, uint16 or float32"),
        (np.zeros((4, 4), np.uint8), np.ones((4, 4)), "uint8, uint16 or float32"),
        (np.zeros((4, 4, 4), np.uint8), np.ones((4, 4)), r"\(height, width, 3\)"),
        (np.zeros((0, 4, 3), np.uint8), np.ones((0, 4)), "1 to 65536"),
        (np.zeros((4, 4, 3), np.uint8), np.ones((4, 4, 1)), r"\(height, width\)"),
        (np.zeros((4, 4, 3), np.uint8), np.ones((4, 3)), "aspect ratio"),
        (np.zeros((4, 4, 3), np.uint8), -np.ones((4, 4)), "negative depth in 16"),
        (np.zeros((4, 4, 3), np.uint8), np.zeros((4, 4)), "16 holes"),
    ],
)
def test_arrays_that_are_no_picture_with_depth_are_refused(picture, depth, sentence):
    with pytest.raises(ValueError, match=sentence):
        airlight.Fog(50)(picture, depth)


@pytest.mark.parametrize(
    "settings",
    [
        {"visibility_m": -1},
        {"visibility_m": math.nan},
        {"visibility_m": 50, "profile": "thick"},
        {"visibility_m": 50, "sun_strength": 2},
        {"visibility_m": 50, "fov_deg": 60, "focal_px": 500},
        {"visibility_m": 50, "depth_kind": "far"},
    ],
)
def test_settings_that_contradict_are_refused_at_once(settings):
    with pytest.raises(ValueError, match="expected"):
        airlight.Fog(**settings)

"""Sky, View and Scene: the same numbers as the program, and the laws of light."""

import math

import numpy as np
import pytest

import airlight

UP = [[0.0, 1.0, 0.0]]


def test_radiance_has_a_row_for_each_direction_and_a_column_for_each_wavelength(view):
    directions = airlight.direction([0.0, 90.0, 180.0], [10.0, 45.0, 90.0])
    radiance = view.radiance(directions)
    assert radiance.shape == (3, 16)
    assert radiance.dtype == np.float32
    assert (radiance > 0).all()
    assert view.wavelengths_nm.shape == (16,)


def test_results_have_the_same_bits_for_any_number_of_threads():
    directions = airlight.direction(np.arange(0.0, 360.0, 7.0), np.linspace(-5.0, 90.0, 52))
    results = []
    for threads in (1, 2, 5):
        sky = airlight.Sky("hazy", wavelengths="rgb", sun_elevation_deg=5, threads=threads)
        view = sky.view(sun_elevation_deg=5)
        results.append((view.radiance(directions, threads=threads), view.panorama(32, threads=threads)))
    for radiance, panorama in results[1:]:
        np.testing.assert_array_equal(radiance, results[0][0])
        np.testing.assert_array_equal(panorama, results[0][1])


def test_panorama_is_the_picture_of_the_program(program, tmp_path):
    view = airlight.Sky("clear", wavelengths="fast", sun_elevation_deg=30).view(sun_elevation_deg=30)
    file = tmp_path / "sky.exr"
    program("sky", "--atmosphere", "clear", "--sun-elevation", 30, "--size", "128x64", "--precision", "float", "-o", file)
    np.testing.assert_array_equal(view.panorama(64), airlight.read_picture(file))


def test_scene_is_the_picture_of_the_program(program, tmp_path):
    toml = """
        sun.elevation_deg = 4
        sun.azimuth_deg = 210
        air.aod_550 = 0.2
        fog = { visibility_m = 2000, top_m = 40 }
        camera = { projection = "perspective", size = [96, 64], azimuth_deg = 200, elevation_deg = 10, fov_deg = 70 }
        output.precision = "float"
    """
    (tmp_path / "scene.toml").write_text(toml)
    program("sky", "--scene", tmp_path / "scene.toml", "-o", tmp_path / "a.exr")
    scene = airlight.Scene.load(tmp_path / "scene.toml")
    picture = scene.render()
    np.testing.assert_array_equal(picture.rgb, airlight.read_picture(tmp_path / "a.exr"))
    assert scene.write(tmp_path / "b.exr") == [tmp_path / "b.exr"]
    np.testing.assert_array_equal(picture.rgb, airlight.read_picture(tmp_path / "b.exr"))
    assert airlight.Scene.from_toml(scene.to_toml()).to_toml() == scene.to_toml()


def test_displayed_picture_is_the_png_of_the_program(program, tmp_path):
    cv2 = pytest.importorskip("cv2")
    program("sky", "--sun-elevation", 20, "--size", "64x32", "-o", tmp_path / "sky.png")
    picture = airlight.Scene.from_toml("sun.elevation_deg = 20\ncamera.size = [64, 32]").render()
    png = cv2.cvtColor(cv2.imread(str(tmp_path / "sky.png")), cv2.COLOR_BGR2RGB)
    np.testing.assert_array_equal(picture.displayed(), png)
    shown = cv2.imdecode(np.frombuffer(picture._repr_png_(), np.uint8), cv2.IMREAD_COLOR)
    np.testing.assert_array_equal(cv2.cvtColor(shown, cv2.COLOR_BGR2RGB), png)


def test_luminance_is_the_luminance_of_the_colour(view):
    directions = airlight.direction([0.0, 120.0, 250.0], [5.0, 40.0, 80.0])
    luminance = view.rgb(directions) @ np.array([0.2126, 0.7152, 0.0722])
    np.testing.assert_allclose(view.luminance(directions), luminance, rtol=2e-4)


def test_irradiance_is_the_integral_of_radiance_over_the_sky(view):
    nodes, weights = np.polynomial.legendre.leggauss(48)
    sines, azimuths = (nodes + 1) / 2, np.arange(72) * 5.0
    grid = np.meshgrid(azimuths, np.degrees(np.arcsin(sines)), indexing="ij")
    radiance = view.radiance(airlight.direction(grid[0].ravel(), grid[1].ravel())).reshape(72, 48, 16)
    integral = (radiance * (weights / 2 * sines)[None, :, None]).sum(axis=(0, 1)) * 2 * math.pi / 72
    np.testing.assert_allclose(view.irradiance(UP)[0], integral, rtol=0.01)


def test_sunlight_is_attenuated_by_the_optical_depth_of_the_air():
    air = airlight.Atmosphere("clear")
    sky = airlight.Sky(air, sun_elevation_deg=90)
    view = sky.view(sun_elevation_deg=90)
    expected = np.exp(-air.vertical_optical_depth(sky.wavelengths_nm))
    np.testing.assert_allclose(view.transmittance(UP)[0], expected, rtol=2e-3)
    np.testing.assert_allclose(view.sun_irradiance() / sky.solar_irradiance, expected, rtol=3e-3)


def test_published_models_and_monte_carlo_are_scenes():
    assert {"orders", "monte-carlo", "preetham", "hosek-wilkie"} <= set(airlight.models())
    scene = "sun.elevation_deg = 40\nair.atmosphere = 'clear'\nsolver = { wavelengths = '450,550,650' %s }"
    solved = airlight.Scene.from_toml(scene % "").view()
    traced = airlight.Scene.from_toml(scene % ", name = 'monte-carlo', paths = 4096").view()
    directions = airlight.direction([0.0, 90.0], [60.0, 30.0])
    mean, error = traced.estimate(directions)
    assert mean.shape == error.shape == (2, 3)
    assert ((error > 0) & (error < 0.03 * mean)).all()
    np.testing.assert_array_less(np.abs(mean - solved.radiance(directions)), 4 * error + 0.005 * mean)
    with pytest.raises(ValueError, match="monte-carlo"):
        solved.estimate(directions)
    preetham = airlight.Scene.from_toml("sun.elevation_deg = 40\nsolver.name = 'preetham'").view("srgb")
    red, _, blue = preetham.radiance(UP)[0]
    assert blue > red


def test_path_optics_compose_to_the_whole_ray():
    view = airlight.Scene.from_toml("sun.elevation_deg = 30").view()
    direction = airlight.direction([30.0], [20.0])
    transmittance, path_radiance = view.path(direction, math.inf)
    np.testing.assert_allclose(path_radiance, view.radiance(direction), rtol=0.02)
    near, _ = view.path(direction, 1000.0)
    assert (near > transmittance).all()


def test_probe_is_the_table_of_the_program(program, tmp_path):
    pandas = pytest.importorskip("pandas")
    (tmp_path / "rays.csv").write_text("azimuth_deg,elevation_deg\n10,20\n200,60\n")
    printed = program("probe", "--sun-elevation", 30, "--views", tmp_path / "rays.csv", "--format", "csv")
    (tmp_path / "probe.csv").write_text(printed)
    table = airlight.Scene.from_toml("sun.elevation_deg = 30").probe([10, 200], [20, 60])
    pandas.testing.assert_frame_equal(table, pandas.read_csv(tmp_path / "probe.csv"))


def test_xarray_has_dimensions_and_units(view):
    pytest.importorskip("xarray")
    radiance = view.to_xarray(azimuth_deg=[0, 90], elevation_deg=[10, 20, 30])
    assert dict(radiance.sizes) == {"azimuth": 2, "elevation": 3, "wavelength": 16}
    assert radiance.attrs["units"] == "W m-2 sr-1 nm-1"
    one = radiance.sel(azimuth=90, elevation=20)
    np.testing.assert_array_equal(one, view.radiance(airlight.direction([90.0], [20.0]))[0])


def test_notebooks_show_a_sky_and_a_scene(view):
    png = b"\x89PNG\r\n"
    assert view._repr_png_().startswith(png)
    assert airlight.Scene.from_toml("sun.elevation_deg = 5")._repr_png_().startswith(png)


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: airlight.Atmosphere("claer"), 'try "clear"'),
        (lambda: airlight.Atmosphere.from_toml("aerosol.aod = 3"), "line 1"),
        (lambda: airlight.Sky(wavelengths=[400, 300]), "wavelength"),
        (lambda: airlight.Sky(wavelengths="coarse"), "expected a wavelength grid"),
        (lambda: airlight.Sky(threads=0), "threads: expected 1 to 4096"),
        (lambda: airlight.Scene.from_toml("sun.elevation_deg = 95"), "sun.elevation_deg"),
        (lambda: airlight.Scene.from_toml("camera.height = 3"), "unknown key"),
        (lambda: airlight.direction([1.0], [1.0, 2.0]), "as many azimuths as elevations"),
    ],
)
def test_errors_are_the_sentences_of_the_library(call, sentence):
    with pytest.raises(ValueError, match=sentence):
        call()


def test_directions_of_another_shape_are_refused(view):
    for wrong in ([0, 1, 0], [[0, 1]], [[0, 0, 0]], [[math.nan, 1, 0]]):
        with pytest.raises(ValueError, match="expected"):
            view.radiance(wrong)


def test_missing_files_are_os_errors(tmp_path):
    for read in (airlight.Scene.load, airlight.read_picture, airlight.read_depth):
        with pytest.raises(OSError, match="cannot read"):
            read(tmp_path / "none.exr")

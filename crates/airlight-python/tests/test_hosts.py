"""Hand-over to renderers and farms, with the real packages."""

import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import airlight
from airlight import openjd


@pytest.fixture
def pictures(tmp_path, photograph, depth):
    """A folder of pictures with depth, and the scene that adds fog to them."""
    cv2 = pytest.importorskip("cv2")
    (tmp_path / "rgb").mkdir()
    (tmp_path / "depth").mkdir()
    for number in range(10):
        cv2.imwrite(str(tmp_path / f"rgb/{number:02}.png"), np.roll(photograph, number, axis=1))
        np.save(tmp_path / f"depth/{number:02}.npy", depth)

    def scene(output, fog="fog.visibility_m = 100"):
        return f"""
            {fog}
            overlay = {{ colour = "{tmp_path}/rgb", depth = "{tmp_path}/depth" }}
            output.file = "{output}/"
        """

    return scene


def files(folder):
    return {path.name: path.read_bytes() for path in pathlib.Path(folder).glob("*.png")}


def test_shards_make_the_pictures_of_the_whole(pictures, tmp_path):
    settings = {"vary": ["visibility=50..500"], "seed": 3}
    assert airlight.fog_batch(pictures(tmp_path / "whole", ""), **settings) == (10, 0, [])
    for shard in ("1/3", "2/3", "3/3"):
        airlight.fog_batch(pictures(tmp_path / "parts", ""), shard=shard, **settings)
    assert files(tmp_path / "parts") == files(tmp_path / "whole")
    assert len(files(tmp_path / "parts")) == 10
    assert airlight.fog_batch(pictures(tmp_path / "whole", ""), **settings) == (0, 10, [])
    with pytest.raises(ValueError, match="4/3"):
        airlight.fog_batch(pictures(tmp_path / "parts", ""), shard="4/3", **settings)


def test_a_corrupt_picture_fails_alone(pictures, tmp_path):
    (tmp_path / "rgb/04.png").write_bytes(b"no picture")
    made, existing, failures = airlight.fog_batch(pictures(tmp_path / "out"))
    assert (made, existing, len(failures)) == (9, 0, 1)
    assert "04.png" in failures[0]


def test_jobs_that_cannot_be_split_are_refused():
    for command, tasks in ((["airlight"], 3), (["airlight", "probe"], 3), (["airlight", "fog", "--shard", "1/2"], 3)):
        with pytest.raises(ValueError, match="expected"):
            openjd.job("job", command, tasks)
    with pytest.raises(ValueError, match="tasks"):
        openjd.job("job", ["airlight", "fog"], 0)


def test_jobs_of_pictures_have_their_folders_as_parameters(pictures, tmp_path):
    job = openjd.fog_job(pictures(tmp_path / "out"), each=["droplets=fine,radiation"])
    assert [parameter["name"] for parameter in job["parameterDefinitions"]] == ["PicturesDir", "DepthDir", "OutputDir", "Program"]
    step = job["steps"][0]
    assert step["parameterSpace"]["taskParameterDefinitions"][0]["range"] == "1-10"
    words = "fog --scene {{Task.File.Scene}} {{Param.PicturesDir}}/ --depth {{Param.DepthDir}}/ --output {{Param.OutputDir}}/ "
    words += "--each=droplets=fine,radiation --shard {{Task.Param.Shard}}/10"
    assert step["script"]["actions"]["onRun"]["args"] == words.split()
    assert str(tmp_path) not in step["script"]["embeddedFiles"][0]["data"]
    with pytest.raises(ValueError, match="1 to 10"):
        openjd.fog_job(pictures(tmp_path / "out"), 11)


def run_job(path, *options):
    """Run a job by the command line of Open Job Description."""
    runner = pathlib.Path(sys.executable).with_name("openjd")
    if not runner.exists():
        pytest.skip("needs openjd-cli")
    program = pathlib.Path(os.environ.get("AIRLIGHT_PROGRAM", "airlight")).resolve().parent
    environment = {**os.environ, "PATH": f"{program}:{os.environ['PATH']}"}
    for action in (["check", path], ["run", path, *options]):
        done = subprocess.run([runner, *action], capture_output=True, text=True, check=False, env=environment)
        assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.slow
def test_openjd_runs_a_job_in_parts(program, pictures, tmp_path):
    airlight.fog_batch(pictures(tmp_path / "whole", ""), vary=["visibility=50..500"], seed=3)
    name = os.environ.get("AIRLIGHT_PROGRAM", "airlight")
    command = [name, "fog", tmp_path / "rgb", "--depth", tmp_path / "depth"]
    command += ["--vary", "visibility=50..500", "--seed", 3, "-o", f"{tmp_path}/farm/"]
    openjd.write(tmp_path / "job.json", openjd.job("fog", command, 4))
    run_job(tmp_path / "job.json")
    assert files(tmp_path / "farm") == files(tmp_path / "whole")


@pytest.mark.slow
def test_openjd_adds_fog_in_parts(program, pictures, tmp_path):
    settings = {"vary": ["visibility=50..500"], "seed": 3}
    airlight.fog_batch(pictures(tmp_path / "whole", ""), **settings)
    # Of the program, whose folders are options, and of Python, whose folders are parameters of the job.
    words = ["fog", tmp_path / "rgb", "--depth", tmp_path / "depth/*.npy", "-o", f"{tmp_path}/program/"]
    program(*words, "--vary", "visibility=50..500", "--seed", 3, "--openjd", tmp_path / "program.json", "--tasks", 4)
    openjd.write(tmp_path / "python.json", openjd.fog_job(pictures(tmp_path / "python", ""), 3, **settings))
    for name in ("program", "python"):
        folders = {"PicturesDir": "rgb", "DepthDir": "depth", "OutputDir": name}
        options = [f"-p{parameter}={tmp_path / folder}" for parameter, folder in folders.items()]
        run_job(tmp_path / f"{name}.json", *options)
        assert files(tmp_path / name) == files(tmp_path / "whole")


@pytest.mark.slow
def test_openjd_draws_a_sequence_of_the_program(program, tmp_path):
    sky = ["sky", "--at", "50,10", "--when", "2026-06-21T18:00:00Z", "--every", "1h", "--until", "+3h", "--size", "32x16"]
    for name in ("farm", "whole"):
        (tmp_path / name).mkdir()
    program(*sky, "-o", tmp_path / "farm/day.png", "--openjd", tmp_path / "job.json", "--tasks", 2)
    run_job(tmp_path / "job.json", "-p", f"OutputDir={tmp_path}/farm")
    program(*sky, "-o", tmp_path / "whole/day.png")
    drawn, expected = (sorted((tmp_path / folder).glob("*.png")) for folder in ("farm", "whole"))
    assert [path.name for path in drawn] == [f"day.000{number}.png" for number in (1, 2, 3, 4)]
    for one, other in zip(drawn, expected, strict=True):
        np.testing.assert_array_equal(airlight.read_picture(one), airlight.read_picture(other))


@pytest.mark.slow
def test_openjd_draws_a_panorama_in_bands_and_joins_it(program, tmp_path):
    program("sky", "--sun-elevation", 20, "--size", "256x128", "--sun-disc", "separate", "-o", tmp_path / "sky.exr")
    scene = airlight.Scene.from_toml(
        f"sun.elevation_deg = 20\ncamera.size = [256, 128]\noutput = {{ file = '{tmp_path}/sky.exr', sun_disc = 'separate' }}"
    )
    openjd.write(tmp_path / "job.json", openjd.sky_job(scene, 3))
    (tmp_path / "farm").mkdir()
    run_job(tmp_path / "job.json", "-p", f"OutputDir={tmp_path}/farm")
    for name in ("sky.exr", "sky.sun.exr"):
        np.testing.assert_array_equal(
            airlight.read_picture(tmp_path / "farm" / name), airlight.read_picture(tmp_path / name), err_msg=name
        )


@pytest.mark.slow
class TestMitsuba:
    """The sky as the light of a scene in Mitsuba 3."""

    @pytest.fixture
    def mitsuba(self):
        mitsuba = pytest.importorskip("mitsuba")
        mitsuba.set_variant("scalar_rgb")
        return mitsuba

    def radiance(self, mitsuba, sky, origin, target, up, objects=None):
        """Mean of a narrow picture."""
        scene = mitsuba.load_dict(
            {
                "type": "scene",
                "integrator": {"type": "path"},
                "sky": sky,
                "sensor": {
                    "type": "perspective",
                    "fov": 0.5,
                    "to_world": mitsuba.ScalarTransform4f().look_at(origin=origin, target=target, up=up),
                    "film": {"type": "hdrfilm", "width": 4, "height": 4, "rfilter": {"type": "box"}},
                    "sampler": {"type": "independent", "sample_count": 4096},
                },
                **(objects or {}),
            }
        )
        return np.array(mitsuba.render(scene))[:, :, :3].mean(axis=(0, 1))

    @pytest.mark.parametrize(("azimuth", "elevation"), [(0.0, 20.0), (90.0, 40.0), (200.0, 15.0), (300.0, 60.0)])
    def test_directions_are_those_of_the_sky(self, mitsuba, azimuth, elevation):
        from airlight.mitsuba import environment

        view = airlight.Sky("clear", sun_elevation_deg=30).view(sun_elevation_deg=30, sun_azimuth_deg=120)
        direction = airlight.direction([azimuth], [elevation])
        seen = self.radiance(mitsuba, environment(view, 256), [0, 0, 0], direction[0].tolist(), [0, 1, 0])
        np.testing.assert_allclose(seen, view.rgb(direction)[0], rtol=0.02)

    def test_a_white_plane_reflects_the_irradiance(self, mitsuba):
        from airlight.mitsuba import environment

        view = airlight.Sky("clear", sun_elevation_deg=30).view(sun_elevation_deg=30)
        white = {"type": "diffuse", "reflectance": {"type": "rgb", "value": 1.0}}
        turn = mitsuba.ScalarTransform4f().rotate([1, 0, 0], -90)
        plane = {"plane": {"type": "rectangle", "to_world": turn, "bsdf": white}}
        seen = self.radiance(mitsuba, environment(view, 256), [0, 1, 0], [0, 0, 0], [0, 0, -1], plane)
        scene = airlight.Scene.from_toml("sun.elevation_deg = 30\nair.atmosphere = 'clear'").view("srgb")
        expected = scene.irradiance([[0, 1, 0]])[0] + scene.sun_irradiance() * np.sin(np.radians(30))
        np.testing.assert_allclose(np.pi * seen, expected, rtol=0.03)


@pytest.fixture(scope="module")
def ray():
    """A local cluster of two processes."""
    ray = pytest.importorskip("ray")
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    yield ray
    ray.shutdown()


def workers():
    """Processes of the tasks of a data set, which Ray names after them."""
    found = []
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            name = (folder / "cmdline").read_text()
        except OSError:
            continue
        if name.startswith("ray::_make"):
            found.append(int(folder.name))
    return found


@pytest.fixture
def small_disk(tmp_path):
    """A file system of its own with space for a few pictures, and a function that enlarges it."""
    folder = tmp_path / "disk"
    folder.mkdir()

    def mount(*options):
        return subprocess.run(["mount", *options, folder], capture_output=True, check=False).returncode == 0

    if not mount("-t", "tmpfs", "-o", "size=48k", "tmpfs"):
        pytest.skip("needs the right to mount a file system")
    yield folder, lambda: mount("-o", "remount,size=8m")
    subprocess.run(["umount", folder], check=True)


@pytest.mark.slow
class TestRay:
    """Data sets on a local cluster of processes."""

    def test_pictures_do_not_depend_on_the_number_of_tasks(self, ray, pictures, tmp_path):
        from airlight.ray import fog_dataset

        settings = {"vary": ["visibility=50..500"], "seed": 3}
        airlight.fog_batch(pictures(tmp_path / "whole", ""), **settings)
        for shards in (1, 4):
            report = fog_dataset(pictures(tmp_path / f"ray{shards}", ""), shards=shards, **settings)
            assert (report.made, report.existing, report.failures, report.lost) == (10, 0, [], {})
            assert files(tmp_path / f"ray{shards}") == files(tmp_path / "whole")

    def test_an_interrupted_data_set_is_resumed_and_a_corrupt_picture_named(self, ray, pictures, tmp_path):
        from airlight.ray import fog_dataset

        picture = tmp_path / "rgb/03.png"
        whole = picture.read_bytes()
        picture.write_bytes(whole[:100])
        report = fog_dataset(pictures(tmp_path / "out"), shards=3)
        assert (report.made, len(report.failures)) == (9, 1)
        assert "03.png" in report.failures[0]
        picture.write_bytes(whole)
        report = fog_dataset(pictures(tmp_path / "out"), shards=3)
        assert (report.made, report.existing, report.failures) == (1, 9, [])

    def test_a_killed_worker_is_replaced(self, ray, pictures, tmp_path, photograph, depth):
        import cv2

        from airlight.ray import fog_dataset

        for number in range(10):
            large = np.tile(np.roll(photograph, number, axis=0), (24, 24, 1))
            cv2.imwrite(str(tmp_path / f"rgb/{number:02}.png"), large)
            np.save(tmp_path / f"depth/{number:02}.npy", np.tile(depth, (24, 24)))
        airlight.fog_batch(pictures(tmp_path / "whole"))
        killed = []

        def kill():
            deadline = time.monotonic() + 60
            while time.monotonic() < deadline and not files(tmp_path / "out"):
                time.sleep(0.01)
            # One that this test started, and that works on its pictures.
            for worker in workers()[:1]:
                os.kill(worker, signal.SIGKILL)
                killed.append(worker)

        killer = threading.Thread(target=kill)
        killer.start()
        report = fog_dataset(pictures(tmp_path / "out"), shards=2)
        killer.join()
        assert len(killed) == 1
        assert report.lost == {}
        assert report.made + report.existing == 10
        assert files(tmp_path / "out") == files(tmp_path / "whole")

    def test_a_shard_that_cannot_write_is_lost_and_resumed(self, ray, pictures, tmp_path):
        from airlight.ray import fog_dataset

        # A folder in the place of its manifest.
        obstacle = tmp_path / "out/manifest-2-of-3.jsonl"
        obstacle.mkdir(parents=True)
        report = fog_dataset(pictures(tmp_path / "out"), shards=3)
        assert list(report.lost) == ["2/3"]
        assert report.made == 7
        obstacle.rmdir()
        report = fog_dataset(pictures(tmp_path / "out"), shards=3)
        assert (report.made, report.existing, report.lost) == (3, 7, {})

    def test_a_full_disk_loses_shards_that_are_resumed(self, ray, pictures, tmp_path, small_disk):
        from airlight.ray import fog_dataset

        airlight.fog_batch(pictures(tmp_path / "whole"))
        folder, enlarge = small_disk
        report = fog_dataset(pictures(folder / "out"), shards=5)
        assert report.lost
        for reason in report.lost.values():
            assert "No space left on device" in reason
        whole, written = files(tmp_path / "whole"), files(folder / "out")
        assert 0 < len(written) < 10
        assert all(whole[name] == content for name, content in written.items())
        enlarge()
        again = fog_dataset(pictures(folder / "out"), shards=5)
        assert (again.made, again.existing, again.failures, again.lost) == (10 - len(written), len(written), [], {})
        assert files(folder / "out") == whole

    def test_bad_settings_are_refused(self, ray, pictures, tmp_path):
        from airlight.ray import fog_dataset

        with pytest.raises(ValueError, match="expected"):
            fog_dataset(pictures(tmp_path / "out"), vary=["thickness=1..2"])

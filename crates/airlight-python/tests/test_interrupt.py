"""Long computations stop on Ctrl-C and let other threads run."""

import os
import signal
import threading
import time

import numpy as np
import pytest

import airlight

TWILIGHT = "sun.elevation_deg = 10\nsolver = { name = 'monte-carlo', paths = 100000 }\ncamera.size = [256, 128]"


def fine_sky():
    airlight.Sky("hazy", wavelengths="fine", effort="fine")


def monte_carlo_picture():
    airlight.Scene.from_toml(TWILIGHT).render()


def monte_carlo_rays():
    view = airlight.Scene.from_toml(TWILIGHT).view()
    view.estimate(airlight.direction(np.arange(300.0), np.full(300, 30.0)))


def many_rays():
    view = airlight.Sky("clear", wavelengths="rgb", sun_elevation_deg=30).view(sun_elevation_deg=30)
    for _ in range(20):
        view.radiance(np.tile([[0.3, 0.5, 0.1]], (2_000_000, 1)))


def many_suns():
    airlight.sun_position(np.datetime64("2026-01-01") + np.arange(5_000_000).astype("timedelta64[s]"), 48.86, 2.29)


def many_angles_of_a_sphere():
    airlight.mie_phase(20_000.0, 1.333 + 0j, np.linspace(0.0, 180.0, 200_000))


def fog_tables():
    scene = airlight.Scene.from_toml("sun.elevation_deg = 10\nsolver.wavelengths = 'fine'\nfog.visibility_m = 300")
    for _ in range(50):
        scene.view()


def probed_fog():
    scene = airlight.Scene.from_toml("sun.elevation_deg = 10\nfog = { visibility_m = 300, patches.strength = 0.5 }")
    for _ in range(50):
        scene.probe_csv([0.0, 90.0], [10.0, 20.0])


def drops_of_other_wavelengths():
    fog = "fog = { visibility_m = 300, droplets = 'rain' }"
    airlight.Scene.from_toml(f"sun.elevation_deg = 10\nsolver.wavelengths = 'fine'\n{fog}").view()


def one_ray_of_many_paths():
    scene = "sun.elevation_deg = 10\nsolver = { name = 'monte-carlo', paths = 10000000, wavelengths = 'rgb' }"
    airlight.Scene.from_toml(scene).view().estimate([[0, 1, 0]])


def scattering_by_large_drops():
    for _ in range(50):
        airlight.Particles(50.0, 0.15).scattering_matrix(550.0, np.linspace(0.0, 180.0, 20_000))


def accuracy_of_tables():
    for _ in range(50):
        airlight.accuracy(["tables"])


def pictures_of_files(tmp_path):
    paths = [tmp_path / f"a.{ending}" for ending in ("exr", "hdr", "png", "jpg")]
    picture = np.random.default_rng(1).uniform(0, 1, (1000, 2000, 3)).astype(np.float32)
    for path in paths:
        airlight.write_picture(path, picture)

    def read():
        for _ in range(50):
            for path in paths:
                airlight.read_picture(path)

    return read


@pytest.fixture
def ctrl_c_raises():
    """The handler of a shell's own programs: one started in the background ignores Ctrl-C."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def cost_after_ctrl_c(work):
    """Processor time from Ctrl-C, a second after the begin, to the exception, s for each processor."""
    sent = []

    def send():
        time.sleep(1.0)
        sent.append(time.process_time())
        os.kill(os.getpid(), signal.SIGINT)

    sender = threading.Thread(target=send)
    sender.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            work()
        return (time.process_time() - sent[0]) / os.cpu_count()
    finally:
        sender.join()


# Processor time, since other programs may hold the processors.
@pytest.mark.usefixtures("ctrl_c_raises")
@pytest.mark.parametrize(
    "work",
    [
        accuracy_of_tables,
        drops_of_other_wavelengths,
        fine_sky,
        fog_tables,
        many_angles_of_a_sphere,
        many_rays,
        many_suns,
        monte_carlo_picture,
        monte_carlo_rays,
        one_ray_of_many_paths,
        probed_fog,
        scattering_by_large_drops,
    ],
)
def test_ctrl_c_stops_within_a_fifth_of_a_second(work):
    assert cost_after_ctrl_c(work) < 0.2


@pytest.mark.usefixtures("ctrl_c_raises")
def test_ctrl_c_stops_the_readers_of_pictures(tmp_path):
    assert cost_after_ctrl_c(pictures_of_files(tmp_path)) < 0.2


def test_other_threads_run_during_a_computation():
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.005)

    ticker = threading.Thread(target=tick)
    ticker.start()
    begun = time.monotonic()
    airlight.Sky("average", threads=1)
    took = time.monotonic() - begun
    done.set()
    ticker.join()
    during = [t for t in ticks if begun < t < begun + took]
    assert len(during) > took / 0.1, f"{len(during)} ticks in {took} s"

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
@pytest.mark.parametrize("work", [fine_sky, monte_carlo_picture, monte_carlo_rays, many_rays, many_suns, many_angles_of_a_sphere])
def test_ctrl_c_stops_within_a_fifth_of_a_second(work):
    assert cost_after_ctrl_c(work) < 0.2


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

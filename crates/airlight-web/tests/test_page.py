"""The page shows what the desktop shows, follows its controls, and keeps its state in the address."""

import io
import os
import subprocess
import time

import numpy
import pytest
from PIL import Image

SIZE = {"width": 900, "height": 600}
# The panel of controls, with text, is to the right.
PICTURE = (slice(20, 560), slice(10, 560))
SUNSET = "1&sun.elevation_deg=2.0&sun.azimuth_deg=285.0&camera.azimuth_deg=262.0&camera.elevation_deg=9.0&camera.fov_deg=75.0"
NOON = SUNSET.replace("elevation_deg=2.0", "elevation_deg=50.0", 1)
SECONDS = 60
# Keeps the memory of the page's module in reach.
WATCH = """
const instantiate = WebAssembly.instantiateStreaming;
WebAssembly.instantiateStreaming = async (...all) => {
    const made = await instantiate(...all);
    globalThis.memoryOfPage = made.instance.exports.memory;
    return made;
};
"""


def pixels(data):
    return numpy.asarray(Image.open(io.BytesIO(data)).convert("RGB")).astype(float)


def desktop(fragment, folder):
    """The window of the desktop with this state."""
    file = folder / "desktop.png"
    size = f"{SIZE['width']}x{SIZE['height']}"
    subprocess.run([os.environ["AIRLIGHT_DESKTOP"], fragment, size, file], check=True)
    return pixels(file.read_bytes())


def settled(page):
    """A screenshot once the picture has light and no longer changes."""
    end = time.monotonic() + SECONDS
    last = None
    while time.monotonic() < end:
        page.wait_for_timeout(300)
        shot = pixels(page.screenshot())
        if last is not None and (shot == last).all() and shot[PICTURE].std() > 3 and page.locator("#note").count() == 0:
            return shot
        last = shot
    pytest.fail(f"no still picture after {SECONDS} s")


@pytest.fixture
def opened(browser, address):
    """Opens the page with a fragment; it must not complain, nor ask for anything else."""
    pages = []
    complaints = []

    def open_page(fragment):
        page = browser.new_page(viewport=SIZE)
        pages.append(page)
        page.add_init_script(WATCH)
        page.on("console", lambda message: complaints.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("request", lambda request: None if request.url.startswith((address, "data:")) else complaints.append(request.url))
        page.goto(f"{address}#{fragment}")
        return page

    yield open_page
    for page in pages:
        page.close()
    assert complaints == []


def fragment_of(page):
    return page.evaluate("location.hash.slice(1)")


def differences(shot, wanted):
    """Differences of signals, 0 to 255, of means over 5 by 5 pixels, which hold no dither."""
    def smooth(of):
        of = of[PICTURE]
        rows, columns = (n - n % 5 for n in of.shape[:2])
        return of[:rows, :columns].reshape(rows // 5, 5, columns // 5, 5, 3).mean(axis=(1, 3))

    return numpy.abs(smooth(shot) - smooth(wanted))


@pytest.mark.parametrize("fragment", [SUNSET, NOON])
def test_page_shows_what_the_desktop_shows(opened, tmp_path, fragment, browser):
    shot = settled(opened(fragment))
    keep = os.environ.get("AIRLIGHT_SHOTS")
    if keep:
        Image.fromarray(shot.astype("uint8")).save(f"{keep}/{browser.graphics}-{'noon' if fragment == NOON else 'sunset'}.png")
    apart = differences(shot, desktop(fragment, tmp_path))
    # A level of 255 is at most 1.2 % of the light.
    assert numpy.quantile(apart, 0.99) <= 1
    assert apart.mean() < 0.3
    # No single bright dot, and the same disc of the sun.
    assert apart.max() <= 4


def test_keys_move_the_sun_and_the_address_keeps_it(opened, tmp_path):
    page = opened(NOON)
    before = settled(page)
    page.mouse.click(200, 300)
    # Held, as frames are slower than keys.
    page.keyboard.down("Control")
    for _ in range(4):
        page.keyboard.press("ArrowDown")
        page.wait_for_timeout(200)
    page.wait_for_timeout(500)
    page.keyboard.up("Control")
    settled(page)
    fragment = fragment_of(page)
    assert fragment.startswith("1&") and "sun.elevation_deg=50.0" not in fragment
    # Without the readings that the click has opened.
    page.reload()
    after = settled(page)
    assert fragment_of(page) == fragment
    assert differences(before, after).mean() > 0.3
    assert numpy.quantile(differences(after, desktop(fragment, tmp_path)), 0.99) <= 1


def test_all_controls_are_reached_by_keyboard(opened):
    page = opened(SUNSET)
    settled(page)
    page.mouse.click(200, 300)
    shots = []
    # Tab goes from control to control, first those of the reading that the click opens: each shows that it has the keyboard.
    for _ in range(12):
        page.keyboard.press("Tab")
        page.wait_for_timeout(150)
        shots.append(pixels(page.screenshot()))
    changes = [numpy.abs(a - b).max() for a, b in zip(shots, shots[1:])]
    assert sum(change > 30 for change in changes) >= 10, changes


def test_memory_is_stable_over_many_moves(opened):
    page = opened(NOON)
    settled(page)
    page.mouse.click(200, 300)
    memory = lambda: page.evaluate("memoryOfPage.buffer.byteLength")
    sizes = []
    page.keyboard.down("Control")
    for _ in range(5):
        for move in range(100):
            page.keyboard.press("ArrowDown" if (move // 10) % 2 else "ArrowUp")
        page.wait_for_timeout(500)
        sizes.append(memory())
    assert sizes[-1] <= sizes[1], sizes


def test_wrong_address_is_explained(browser, address):
    page = browser.new_page(viewport=SIZE)
    page.goto(f"{address}#1&sun.elevation=3")
    page.get_by_text("elevation_deg").wait_for(timeout=1000 * SECONDS)
    page.close()

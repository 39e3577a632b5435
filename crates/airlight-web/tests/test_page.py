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
# The field with the name of a file, in the panel.
FILE_NAME = (735, 95)
SECONDS = 60
# Size of the answer with the light of a scene.
ANSWER_BYTES = 2.5e6
# Keeps the memory of the page's module in reach, and the times of frames, of requests to workers and of large answers, ms.
WATCH = """
const instantiate = WebAssembly.instantiateStreaming;
WebAssembly.instantiateStreaming = async (...all) => {
    const made = await instantiate(...all);
    globalThis.memoryOfPage = made.instance.exports.memory;
    return made;
};
globalThis.frames = [];
const request = requestAnimationFrame.bind(globalThis);
globalThis.requestAnimationFrame = (draw) => request((time) => {
    draw(time);
    frames.push(performance.now());
});
globalThis.solved = [];
globalThis.Worker = class extends Worker {
    postMessage(...all) {
        this.asked = performance.now();
        super.postMessage(...all);
    }
    set onmessage(take) {
        super.onmessage = (event) => {
            if (event.data.byteLength > 1e6) solved.push([this.asked, performance.now()]);
            take(event);
        };
    }
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


def wait_until(page, condition):
    """Waits for an expression; the page's security policy forbids that of Playwright."""
    end = time.monotonic() + SECONDS
    while not page.evaluate(condition):
        assert time.monotonic() < end, f"not {condition} after {SECONDS} s: {fragment_of(page)}"
        page.wait_for_timeout(100)


def wait_for_frames(page, count):
    for _ in range(count):
        page.evaluate("() => new Promise(requestAnimationFrame)")


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
    sizes = []
    page.keyboard.down("Control")
    # The first 200 moves fill the history of undo.
    for move in range(700):
        page.keyboard.press("ArrowDown" if (move // 10) % 2 else "ArrowUp")
        # Each is drawn, and is a state of its own.
        wait_for_frames(page, 1)
        if move % 50 == 49:
            sizes.append(page.evaluate("memoryOfPage.buffer.byteLength"))
    print("memory of the page, MB:", [round(size / 1e6, 2) for size in sizes])
    # The memory never shrinks, and grows by one more answer of the worker where another allocation has split the place of the last one;
    # 500 moves that each keep 5 kB would be found.
    assert sizes[-1] <= sizes[3] + ANSWER_BYTES, sizes


def test_first_picture_comes_soon_after_the_window(opened):
    page = opened(SUNSET)
    settled(page)
    frames, solved = page.evaluate("[frames, solved]")
    answered = solved[0][1]
    # An empty window of egui is there with the second frame.
    window, picture = frames[1], next(time for time in frames if time > answered)
    print(f"window {window:.0f} ms after the load, picture after {picture:.0f} ms, {picture / window:.1f} times that")
    assert picture < 8 * window


def test_page_goes_on_while_the_worker_solves(opened):
    page = opened(NOON)
    settled(page)
    page.mouse.click(200, 300)
    before = page.evaluate("solved.length")
    page.keyboard.down("Control")
    page.keyboard.press("ArrowDown")
    # All suns, now that the sun has moved.
    wait_until(page, f"solved.length > {before}")
    frames, (asked, answered) = page.evaluate("[frames, solved.at(-1)]")
    during = [asked, *(time for time in frames if asked < time < answered), answered]
    longest = max(numpy.diff(during))
    print(f"solved in {answered - asked:.0f} ms, {len(during) - 2} frames meanwhile, the longest {longest:.0f} ms")
    assert longest < 0.5 * (answered - asked)


def dropped(page, name, contents):
    """Drops a file on the page."""
    script = """([name, numbers]) => {
        const files = new DataTransfer();
        files.items.add(new File([new Uint8Array(numbers)], name));
        return files;
    }"""
    transfer = page.evaluate_handle(script, [name, list(contents)])
    page.dispatch_event("#canvas", "drop", {"dataTransfer": transfer})


def saved(page, name, tmp_path):
    """The file that the page saves under a name."""
    page.mouse.click(*FILE_NAME)
    wait_for_frames(page, 3)
    page.keyboard.press("Control+a")
    wait_for_frames(page, 3)
    page.keyboard.type(name)
    wait_for_frames(page, 3)
    with page.expect_download(timeout=1000 * SECONDS) as download:
        page.keyboard.press("Control+s")
    assert download.value.suggested_filename == name
    file = tmp_path / name
    download.value.save_as(file)
    return file


def test_scenes_are_dropped_and_saved(opened, tmp_path):
    page = opened(NOON)
    settled(page)
    scene = saved(page, "noon.toml", tmp_path).read_text()
    assert "elevation_deg = 50.0" in scene
    before = page.evaluate("solved.length")
    dropped(page, "low.toml", scene.replace("elevation_deg = 50.0", "elevation_deg = 2.5").encode())
    wait_until(page, "location.hash.includes('sun.elevation_deg=2.5')")
    wait_until(page, f"solved.length > {before}")
    shot = settled(page)
    assert numpy.quantile(differences(shot, desktop(fragment_of(page), tmp_path)), 0.99) <= 1
    dropped(page, "wrong.toml", b"[sun]\nelevation = 3")
    page.wait_for_timeout(1000)
    # The sentence stands in the picture; the scene stays.
    assert "sun.elevation_deg=2.5" in fragment_of(page)
    assert numpy.abs(settled(page) - shot)[520:, :560].max() > 100


def test_pictures_are_saved(opened, tmp_path):
    page = opened(SUNSET)
    shot = settled(page)
    png = pixels(saved(page, "sunset.png", tmp_path).read_bytes())
    height, width = png.shape[:2]
    assert height == SIZE["height"] and 500 < width < 600
    # What is shown, but for notes over it.
    assert differences(shot[:, :width], png).max() <= 1
    # The header of Radiance, and its size.
    hdr = saved(page, "sunset.hdr", tmp_path).read_bytes()
    assert hdr.startswith(b"#?RADIANCE\n") and f"-Y {height} +X {width}\n".encode() in hdr


def test_heights_are_dropped_as_terrain(opened, tmp_path):
    page = opened(NOON)
    before = settled(page)
    ridge = numpy.zeros((64, 64), "<f4")
    ridge[30:34] = 900.0
    dropped(page, "ridge.pfm", b"Pf\n64 64\n-1.0\n" + ridge.tobytes())
    wait_until(page, "location.hash.includes('ridge.pfm')")
    assert numpy.abs(settled(page) - before)[PICTURE].mean() > 3
    # The address keeps the name alone.
    page.reload()
    page.locator("#note").wait_for(state="detached", timeout=1000 * SECONDS)
    assert "ridge.pfm" in fragment_of(page)


def test_figures_follow_their_sliders(browser, address):
    page = browser.new_page(viewport=SIZE)
    complaints = []
    page.on("console", lambda message: complaints.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.goto(f"{address}figures.html")
    for name, curves, sliders in [("phase-function", 2, 2), ("height-fog", 3, 3)]:
        figure = page.locator(f"[data-figure={name}]")
        figure.locator("svg").wait_for(timeout=1000 * SECONDS)
        paths = lambda: [figure.locator("path").nth(k).get_attribute("d") for k in range(curves)]
        assert figure.get_by_role("slider").count() == sliders
        before = paths()
        figure.get_by_role("slider").first.focus()
        for _ in range(5):
            page.keyboard.press("ArrowLeft")
        assert paths()[0] != before[0]
        assert all(len(path.split("L")) == 201 and "NaN" not in path for path in paths())
    keep = os.environ.get("AIRLIGHT_SHOTS")
    if keep:
        page.screenshot(path=f"{keep}/{browser.graphics}-figures.png", full_page=True)
    page.close()
    assert complaints == []


def test_wrong_address_is_explained(browser, address):
    page = browser.new_page(viewport=SIZE)
    page.goto(f"{address}#1&sun.elevation=3")
    page.get_by_text("elevation_deg").wait_for(timeout=1000 * SECONDS)
    page.close()

"""A server of the page, and headless Chromium that shows it."""

import functools
import http.server
import os
import pathlib
import shutil
import threading

import pytest
from playwright.sync_api import sync_playwright

PAGE = pathlib.Path(os.environ["AIRLIGHT_PAGE"])
NAMES = ("chromium", "chromium-browser", "google-chrome")
# Without the options of ANGLE the canvas of WebGPU stays blank without a screen.
OPTIONS = [
    "--no-sandbox",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-quic",
    "--ignore-gpu-blocklist",
    "--use-gl=angle",
    "--use-angle=gl-egl",
]


class Handler(http.server.SimpleHTTPRequestHandler):
    """Files of the page, an empty page for tests of its modules, and no line for each."""

    def do_GET(self):
        if self.path != "/blank.html":
            return super().do_GET()
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.end_headers()
        self.wfile.write(b"<!doctype html><title>blank</title>")

    def log_message(self, *arguments):
        pass


@pytest.fixture(scope="session")
def address():
    handler = functools.partial(Handler, directory=PAGE)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_address[1]}/"
    server.shutdown()


@pytest.fixture(scope="session")
def playwright():
    with sync_playwright() as started:
        yield started


def start(playwright, *options):
    path = next((path for path in map(shutil.which, NAMES) if path), None)
    assert path, "no Chromium: on Debian, apt-get install chromium"
    return playwright.chromium.launch(executable_path=path, args=[*OPTIONS, *options])


@pytest.fixture(scope="session", params=["webgpu", "webgl"])
def browser(request, playwright):
    """A browser with WebGPU, and one with WebGL 2 alone."""
    options = {"webgpu": ["--enable-unsafe-webgpu"], "webgl": ["--disable-features=WebGPU"]}
    started = start(playwright, *options[request.param])
    started.graphics = request.param
    yield started
    started.close()

#!/usr/bin/env python3
"""Render panoramas of `airlight sky --orientation HOST` in their hosts, and check where the sun appears.

    pip install numpy bpy==4.5.15 mitsuba==3.9.1
    npm install three@0.187
    python3 scripts/check_orientation.py --airlight target/release/airlight blender mitsuba three three-cube

Each host renders the picture as its environment, by a camera that looks past the sun: off to the side and lower, so that a
turned, mirrored or upside-down picture is found. The script prints, for each sun, the angle between the place where the sun appears and
the azimuth and elevation that `airlight` was given, and fails above half a degree (the disc is 0.53 degrees across). three.js
runs in a headless Chromium (`--chromium`) and is read from `--modules` (`node_modules` by default).
"""

import argparse
import functools
import http.server
import pathlib
import subprocess
import sys
import tempfile
import threading

import numpy as np

# Azimuth and elevation of the suns, degrees: one in each quadrant, and beside the seam of the panorama of each host.
SUNS = ((40.0, 20.0), (93.0, 8.0), (135.0, 45.0), (182.0, 15.0), (250.0, 10.0), (268.0, 60.0), (330.0, 60.0))
# The camera looks this far to the left of the sun and below it.
ASIDE_DEG = (12.0, 9.0)
FOV_DEG = 60.0
SIZE = 256
LIMIT_DEG = 0.5


def direction(azimuth_deg, elevation_deg, axes):
    """Unit vector in axes given as the vectors east, north and up."""
    east, north, up = (np.array(axis, dtype=float) for axis in axes)
    azimuth, elevation = np.radians((azimuth_deg, elevation_deg))
    return np.cos(elevation) * (np.sin(azimuth) * east + np.cos(azimuth) * north) + np.sin(elevation) * up


def camera(forward, up):
    """Vectors to the right, up and forward of a level camera."""
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    return right, np.cross(right, forward), forward


def brightest(image, right, up, forward):
    """Direction in which the brightest part of a picture (rows from the top) lies."""
    light = image.mean(axis=2)
    rows, columns = np.nonzero(light > light.max() / 2)
    tangent = np.tan(np.radians(FOV_DEG / 2))
    across = (columns + 0.5) / SIZE * 2 - 1
    down = (rows + 0.5) / SIZE * 2 - 1
    rays = forward + tangent * (across[:, None] * right - down[:, None] * up)
    mean = (rays / np.linalg.norm(rays, axis=1)[:, None]).mean(axis=0)
    return mean / np.linalg.norm(mean)


def blender(picture, right, up, forward, _options):
    """Cycles, world with an Environment Texture as it is by default."""
    import bpy
    from mathutils import Matrix

    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    texture = nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(str(picture))
    links.new(texture.outputs["Color"], nodes["Background"].inputs["Color"])
    scene.world = world
    lens = bpy.data.cameras.new("camera")
    lens.angle = np.radians(FOV_DEG)
    eye = bpy.data.objects.new("camera", lens)
    eye.matrix_world = Matrix(np.column_stack((right, up, -forward)).tolist()).to_4x4()
    scene.collection.objects.link(eye)
    scene.camera = eye
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 16
    scene.cycles.use_denoising = False
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = str(picture.with_suffix(".render.exr"))
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    # Blender keeps rows from the bottom.
    return np.array(image.pixels[:]).reshape(SIZE, SIZE, -1)[::-1, :, :3]


def mitsuba(picture, right, up, forward, _options):
    """`envmap` without a transform."""
    import mitsuba as mi

    mi.set_variant("scalar_rgb")
    scene = mi.load_dict({
        "type": "scene",
        "integrator": {"type": "path"},
        "sky": {"type": "envmap", "filename": str(picture)},
        "sensor": {
            "type": "perspective",
            "fov": FOV_DEG,
            "to_world": mi.ScalarTransform4f().look_at(
                origin=[0, 0, 0], target=forward.tolist(), up=up.tolist()
            ),
            "film": {"type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"}},
            "sampler": {"type": "independent", "sample_count": 16},
        },
    })
    return np.array(mi.render(scene))[:, :, :3]


PAGE = """<!doctype html><script type="importmap">{"imports": {"three": "/modules/three/build/three.module.js"}}</script>
<script type="module">
import * as THREE from 'three';
import { EXRLoader } from '/modules/three/examples/jsm/loaders/EXRLoader.js';
const load = SHAPE === 'cube'
  ? new THREE.CubeTextureLoader().setPath('/').loadAsync(['px', 'nx', 'py', 'ny', 'pz', 'nz'].map(f => `NAME.${f}.png`))
  : new EXRLoader().setDataType(THREE.FloatType).loadAsync('/NAME.exr');
try {
  const texture = await load;
  if (SHAPE !== 'cube') texture.mapping = THREE.EquirectangularReflectionMapping;
  const scene = new THREE.Scene();
  scene.background = texture;
  const camera = new THREE.PerspectiveCamera(FOV, 1, 0.1, 10);
  camera.up.set(UP);
  camera.lookAt(FORWARD);
  const renderer = new THREE.WebGLRenderer();
  const target = new THREE.WebGLRenderTarget(SIZE, SIZE, { type: THREE.FloatType });
  renderer.setRenderTarget(target);
  renderer.render(scene, camera);
  const pixels = new Float32Array(SIZE * SIZE * 4);
  renderer.readRenderTargetPixels(target, 0, 0, SIZE, SIZE, pixels);
  await fetch('/result', { method: 'POST', body: pixels.buffer });
} catch (error) {
  await fetch('/failure', { method: 'POST', body: String(error) });
}
</script>"""


class Page(http.server.SimpleHTTPRequestHandler):
    """Serves the page, the picture and the modules, and takes the pixels."""

    page, modules = "", pathlib.Path()
    arrived = threading.Event()

    def translate_path(self, path):
        if path.startswith("/modules/"):
            return str(Page.modules / path.removeprefix("/modules/"))
        return super().translate_path(path)

    def do_GET(self):
        if self.path != "/":
            return super().do_GET()
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.end_headers()
        self.wfile.write(Page.page.encode())

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        Page.answer = (self.path, body)
        self.send_response(204)
        self.end_headers()
        Page.arrived.set()

    def log_message(self, *_):
        pass


def three(picture, right, up, forward, options, shape="panorama"):
    """`scene.background` with `EquirectangularReflectionMapping`, or of a `CubeTextureLoader`."""
    values = {
        "SHAPE": repr(shape), "NAME": picture.stem, "FOV": str(FOV_DEG), "SIZE": str(SIZE),
        "UP": ", ".join(map(str, up)), "FORWARD": ", ".join(map(str, forward)),
    }
    Page.page = PAGE
    for name, value in values.items():
        Page.page = Page.page.replace(name, value)
    Page.modules = options.modules.resolve()
    Page.arrived.clear()
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Page, directory=picture.parent))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with tempfile.TemporaryDirectory() as profile:
        browser = subprocess.Popen(
            [options.chromium, "--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
             "--no-first-run", f"--user-data-dir={profile}", "--remote-debugging-port=0",
             f"http://127.0.0.1:{server.server_port}/"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )
        answered = Page.arrived.wait(120)
        browser.terminate()
        browser.wait()
        server.shutdown()
    if not answered:
        sys.exit("three.js: no picture within two minutes")
    path, body = Page.answer
    if path != "/result":
        sys.exit(f"three.js: {body.decode()}")
    return np.frombuffer(body, dtype=np.float32).reshape(SIZE, SIZE, 4)[::-1, :, :3]


# Name: orientation, file name, more options of `airlight sky`, the host's axes that are east, north and up, and its renderer.
EXR = ("--size", "2048x1024")
# A picture of which only the sun is white.
CUBE = ("--projection", "cube", "--size", "1024x1024", "--exposure", "24")
HOSTS = {
    "blender": ("blender", "sky.exr", EXR, ((1, 0, 0), (0, 1, 0), (0, 0, 1)), blender),
    "mitsuba": ("mitsuba", "sky.exr", EXR, ((1, 0, 0), (0, 0, -1), (0, 1, 0)), mitsuba),
    "three": ("three", "sky.exr", EXR, ((1, 0, 0), (0, 0, -1), (0, 1, 0)), three),
    "three-cube": ("three", "sky.png", CUBE, ((1, 0, 0), (0, 0, -1), (0, 1, 0)), functools.partial(three, shape="cube")),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hosts", nargs="*", metavar="HOST", help=f"{', '.join(HOSTS)} [default: all]")
    parser.add_argument("--airlight", default="airlight")
    parser.add_argument("--modules", type=pathlib.Path, default=pathlib.Path("node_modules"))
    parser.add_argument("--chromium", default="chromium")
    options = parser.parse_args()
    unknown = set(options.hosts) - set(HOSTS)
    if unknown:
        parser.error(f"expected hosts of {', '.join(HOSTS)}, got {', '.join(sorted(unknown))}")
    is_wrong = False
    for host in options.hosts or HOSTS:
        orientation, file, more, axes, render = HOSTS[host]
        for azimuth, elevation in SUNS:
            with tempfile.TemporaryDirectory() as folder:
                picture = pathlib.Path(folder) / file
                subprocess.run(
                    [options.airlight, "sky", "--sun-elevation", str(elevation), "--sun-azimuth", str(azimuth),
                     "--orientation", orientation, *more, "-o", str(picture)],
                    check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                )
                forward = direction(azimuth - ASIDE_DEG[0], elevation - ASIDE_DEG[1], axes)
                view = camera(forward, np.array(axes[2], dtype=float))
                seen = brightest(render(picture, *view, options), *view)
            error = np.degrees(np.arccos(np.clip(seen @ direction(azimuth, elevation, axes), -1, 1)))
            print(f"{host}: sun at azimuth {azimuth:g}, elevation {elevation:g}: {error:.2f} degrees off", flush=True)
            is_wrong |= not error < LIMIT_DEG
    sys.exit("the sun is not where it was set" if is_wrong else 0)


if __name__ == "__main__":
    main()

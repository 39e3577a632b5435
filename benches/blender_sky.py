"""Time to a panorama of a sky in memory, by Airlight and by Blender's multiple-scattering sky in turns.

    pip install "bpy>=5.0,<5.1"
    pip install ./crates/airlight-python
    python benches/blender_sky.py

Blender (Cycles, one sample a pixel) computes its sky at four wavelengths with fitted multiple scattering whenever the sun has
moved, and renders it; Airlight solves for all orders of scattering, tabulates the view and draws it, at sixteen wavelengths
(the grid "standard") and at the eight of pictures ("fast"). All hold 2048 x 1024 pixels without the sun's disc in the end, without a file. Prints
medians in seconds, and the ratios of those of Airlight to that of Blender.
"""

import math
import statistics
import time
from collections.abc import Callable
from functools import partial

import airlight
import bpy
import numpy as np

HEIGHT = 1024
ELEVATIONS_DEG = [60.0, 10.0, 2.0, -4.0, -10.0]
REPETITIONS = 7


def blender_scene() -> bpy.types.ShaderNodeTexSky:
    """An empty scene whose camera sees the whole sphere of the sky."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    world = bpy.data.worlds.new("sky")
    scene.world = world
    world.use_nodes = True
    nodes = world.node_tree.nodes
    sky = nodes.new("ShaderNodeTexSky")
    sky.sky_type = "MULTIPLE_SCATTERING"
    sky.sun_disc = False
    world.node_tree.links.new(sky.outputs["Color"], nodes["Background"].inputs["Color"])
    camera = bpy.data.cameras.new("camera")
    camera.type = "PANO"
    camera.panorama_type = "EQUIRECTANGULAR"
    scene.camera = bpy.data.objects.new("camera", camera)
    scene.camera.rotation_euler = (math.pi / 2, 0.0, 0.0)
    scene.collection.objects.link(scene.camera)
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = 2 * HEIGHT, HEIGHT
    scene.cycles.samples = 1
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.use_denoising = False
    return sky


def blender(sky: bpy.types.ShaderNodeTexSky, elevation_deg: float) -> None:
    """Render the sky with the sun at an elevation."""
    sky.sun_elevation = math.radians(elevation_deg)
    bpy.ops.render.render()


def ours(wavelengths: str, elevation_deg: float) -> np.ndarray:
    """Solve for the sky with the sun at an elevation and draw it."""
    sky = airlight.Sky("average", sun_elevation_deg=elevation_deg, wavelengths=wavelengths)
    view = sky.view(sun_elevation_deg=elevation_deg, sun_azimuth_deg=180)
    return view.panorama(HEIGHT, sun_disc=False)


def seconds(work: Callable[[], object]) -> float:
    """Time that some work takes."""
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def main() -> None:
    """Print the table."""
    sky = blender_scene()
    print(f"Blender {bpy.app.version_string}, Airlight {airlight.__version__}")
    renderers = [partial(blender, sky), partial(ours, "standard"), partial(ours, "fast")]
    print("sun, degrees  Blender  standard  ratio   fast  ratio")
    for elevation_deg in ELEVATIONS_DEG:
        times = [[] for _ in renderers]
        for turn in range(REPETITIONS):
            # Another sun each time, so that nothing is kept.
            moved_deg = elevation_deg + 0.01 * turn
            for render, taken in zip(renderers, times, strict=True):
                taken.append(seconds(partial(render, moved_deg)))
        theirs, standard, fast = (statistics.median(taken) for taken in times)
        print(
            f"{elevation_deg:12}  {theirs:7.3f}  {standard:8.3f}  {standard / theirs:5.3f}  {fast:5.3f}  {fast / theirs:5.3f}"
        )


if __name__ == "__main__":
    main()

"""Run a script in Blender and render small pictures of its sky: `python render_in_blender.py SCRIPT FOLDER` with the package bpy.

Files in FOLDER: plane.exr, a white plane from above; pole.exr, with a pole of 1 m at the centre of 8 m;
sky-AZIMUTH-ELEVATION.exr, the sky in directions.
"""

import math
import pathlib
import runpy
import sys

import bpy
from mathutils import Vector

DIRECTIONS = [(0.0, 20.0), (90.0, 40.0), (200.0, 15.0), (300.0, 60.0)]


def main(script, folder):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    runpy.run_path(script)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.use_denoising = False
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.filter_width = 0.01
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    for azimuth, elevation in DIRECTIONS:
        a, e = math.radians(azimuth), math.radians(elevation)
        look = Vector((math.cos(e) * math.sin(a), math.cos(e) * math.cos(a), math.sin(e)))
        camera = add_camera("PERSP", Vector((0, 0, 0)), look)
        camera.angle = math.radians(0.5)
        render(folder / f"sky-{azimuth:g}-{elevation:g}.exr", 4, 256)
    bpy.ops.mesh.primitive_plane_add(size=2000)
    bpy.context.object.data.materials.append(white())
    camera = add_camera("ORTHO", Vector((0, 0, 50)), Vector((0, 0, -1)))
    camera.ortho_scale = 0.1
    render(folder / "plane.exr", 4, 4096)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, 0.5), scale=(0.1, 0.1, 1))
    camera.ortho_scale = 8
    render(folder / "pole.exr", 160, 64)


def white():
    material = bpy.data.materials.new("white")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    diffuse, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    diffuse.inputs["Color"].default_value = (1, 1, 1, 1)
    material.node_tree.links.new(diffuse.outputs["BSDF"], output.inputs["Surface"])
    return material


def add_camera(kind, place, look):
    camera = bpy.data.cameras.new("camera")
    camera.type = kind
    eye = bpy.data.objects.new("camera", camera)
    eye.location = place
    eye.rotation_euler = look.to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(eye)
    bpy.context.scene.camera = eye
    return camera


def render(path, side, samples):
    scene = bpy.context.scene
    scene.cycles.samples = samples
    scene.render.resolution_x = scene.render.resolution_y = side
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]))

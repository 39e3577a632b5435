"""World and sun light of Blender. This file is also a part of the scripts that `airlight.blender` writes: it needs only bpy."""

import bpy
import mathutils

NAME = "Airlight"


def set_sky(map_path: str, strength: float, sun: dict | None) -> bpy.types.Image:
    """Light the scene by an environment map and a sun light, and replace those of an earlier call.

    Parameters
    ----------
    map_path : str
        Equirectangular picture of the sky without the sun's disc, whose centre is Blender's +X, east; +Y is north.
    strength : float
        Factor on its values.
    sun : dict or None
        ``direction`` (towards the sun, in Blender's axes), ``irradiance`` (red, green and blue of a surface that faces it, in the
        unit of the scene) and ``diameter`` of the disc (rad); None: no sun.

    Returns
    -------
    bpy.types.Image
        The environment map.
    """
    image = bpy.data.images.load(map_path)
    scene = bpy.context.scene
    scene.world = _world(image, strength)
    old = bpy.data.objects.get(NAME)
    if old is not None:
        bpy.data.objects.remove(old)
    if sun is not None:
        scene.collection.objects.link(_sun_light(**sun))
    return image


def _world(image: bpy.types.Image, strength: float) -> bpy.types.World:
    world = bpy.data.worlds.get(NAME) or bpy.data.worlds.new(NAME)
    if world.node_tree is None:
        world.use_nodes = True
    nodes, link = world.node_tree.nodes, world.node_tree.links.new
    nodes.clear()
    texture = nodes.new("ShaderNodeTexEnvironment")
    background = nodes.new("ShaderNodeBackground")
    output = nodes.new("ShaderNodeOutputWorld")
    texture.image = image
    background.inputs["Strength"].default_value = strength
    link(texture.outputs["Color"], background.inputs["Color"])
    link(background.outputs["Background"], output.inputs["Surface"])
    return world


def _sun_light(direction: tuple, irradiance: list, diameter: float) -> bpy.types.Object:
    light = bpy.data.lights.new(NAME, "SUN")
    light.energy = max(irradiance)
    light.color = [component / light.energy for component in irradiance]
    light.angle = diameter
    source = bpy.data.objects.new(NAME, light)
    # A sun light shines along its -Z.
    source.rotation_euler = mathutils.Vector(direction).to_track_quat("Z", "Y").to_euler()
    return source

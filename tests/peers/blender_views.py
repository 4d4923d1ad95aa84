"""Renders the views in Blender, which runs this file: script of the light, folder for EXRs."""

import math
import runpy
import sys
from pathlib import Path

import bpy
from mathutils import Vector

FOLDER = Path(sys.argv[-1])
SETTINGS = dict(argument.split("=", 1) for argument in sys.argv if "=" in argument)
ALBEDO = float(SETTINGS["albedo"])


def number_of(name):
    """A pair of numbers by name, as ``plane=1.0,32``."""
    first, second = SETTINGS[name].split(",")
    return float(first), int(second)


def in_blender(x, y, z):
    """A point or direction of the map's axes."""
    return Vector((x, -z, y))


def empty_scene():
    """Remove all objects, and set up a renderer without any look of its own."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.use_denoising = False
    scene.cycles.sample_clamp_indirect = 0.0
    scene.cycles.blur_glossy = 0.0
    scene.cycles.pixel_filter_type = "BOX"
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    runpy.run_path(SETTINGS["light"], run_name="__main__")
    return scene


def material(*, is_mirror, albedo=ALBEDO):
    """A diffuse or a mirroring material."""
    made = bpy.data.materials.new("material")
    if made.node_tree is None:
        made.use_nodes = True
    nodes = made.node_tree.nodes
    nodes.clear()
    kind = "ShaderNodeBsdfGlossy" if is_mirror else "ShaderNodeBsdfDiffuse"
    shader, output = nodes.new(kind), nodes.new("ShaderNodeOutputMaterial")
    value = 1.0 if is_mirror else albedo
    shader.inputs["Color"].default_value = (value, value, value, 1.0)
    shader.inputs["Roughness"].default_value = 0.0
    made.node_tree.links.new(shader.outputs["BSDF"], output.inputs["Surface"])
    return made


def give(made):
    """Give the active object a material."""
    bpy.context.object.data.materials.append(made)


def add_plane(size=100.0, albedo=ALBEDO):
    """A level plane at the origin."""
    bpy.ops.mesh.primitive_plane_add(size=size)
    give(material(is_mirror=False, albedo=albedo))


def add_ball(center, radius, *, is_mirror, albedo=ALBEDO):
    """A sphere with smooth normals."""
    bpy.ops.mesh.primitive_uv_sphere_add(
        segments=256, ring_count=128, radius=radius, location=in_blender(*center)
    )
    bpy.ops.object.shade_smooth()
    give(material(is_mirror=is_mirror, albedo=albedo))


def add_pole(x, z, height, radius):
    """An upright cylinder on the plane."""
    bpy.ops.mesh.primitive_cylinder_add(
        radius=radius, depth=height, location=in_blender(x, 0.5 * height, z), vertices=48
    )
    give(material(is_mirror=False))


def camera(place, target, up="Y"):
    """A camera that looks from one point to another; `up` is the axis that stays upright."""
    data = bpy.data.cameras.new("camera")
    made = bpy.data.objects.new("camera", data)
    made.location = in_blender(*place)
    toward = in_blender(*target) - made.location
    made.rotation_euler = toward.to_track_quat("-Z", up).to_euler()
    bpy.context.scene.collection.objects.link(made)
    bpy.context.scene.camera = made
    return data


def look_from_above(half_width):
    """North at the top."""
    data = camera((0.0, 10.0, 0.0), (0.0, 0.0, 0.0))
    bpy.context.scene.camera.rotation_euler = (0.0, 0.0, 0.0)
    data.type, data.ortho_scale = "ORTHO", 2.0 * half_width


def look_north(half_width):
    """Level, from the south."""
    data = camera((0.0, 0.0, 10.0), (0.0, 0.0, 0.0))
    data.type, data.ortho_scale = "ORTHO", 2.0 * half_width


def render(scene, name, width, height, samples):
    """Render to an EXR of the name of the view."""
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.cycles.samples = samples
    scene.render.filepath = str(FOLDER / f"{name}.exr")
    bpy.ops.render.render(write_still=True)


def strength_by_usd():
    """Strength of the sun that Blender makes of a USD file, over that of the script."""
    of_script = strongest(bpy.data.lights)
    for light in list(bpy.data.lights):
        bpy.data.lights.remove(light)
    bpy.ops.wm.usd_import(filepath=SETTINGS["usd"])
    return strongest(bpy.data.lights) / of_script


def strongest(lights):
    """Largest channel of the strength of the only sun."""
    (sun,) = (light for light in lights if light.type == "SUN")
    return sun.energy * max(sun.color)


def main():
    """Render all views, and tell the version."""
    half, edge = number_of("plane")
    scene = empty_scene()
    add_plane()
    look_from_above(half)
    render(scene, "plane", edge, edge, 256)

    half, edge = number_of("ball")
    for name in ("sphere", "mirror"):
        scene = empty_scene()
        add_ball((0.0, 0.0, 0.0), 1.0, is_mirror=name == "mirror")
        look_north(half)
        render(scene, name, edge, edge, 256 if name == "sphere" else 16)

    half, edge = number_of("pole")
    height, radius = map(float, SETTINGS["pole_size"].split(","))
    scene = empty_scene()
    add_plane()
    add_pole(0.0, 0.0, height, radius)
    look_from_above(half)
    render(scene, "pole", edge, edge, 16)

    scene = empty_scene()
    add_plane()
    add_ball((-1.1, 1.0, 0.0), 1.0, is_mirror=False)
    add_ball((1.1, 1.0, 0.0), 1.0, is_mirror=True)
    add_pole(0.0, 1.6, 1.2, 0.06)
    data = camera((0.0, 2.2, 8.0), (0.0, 0.8, 0.0))
    data.angle = math.radians(40.0)
    scene.cycles.use_denoising = True
    width, height = map(int, SETTINGS["picture"].split(","))
    render(scene, "picture", width, height, 96)
    factor = strength_by_usd()
    (FOLDER / "version").write_text(
        f"{bpy.app.version_string}, which takes the sun of a USD file {factor:.2f} times as bright"
    )


main()

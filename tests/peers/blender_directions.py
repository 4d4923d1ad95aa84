"""What an Environment Texture of Blender shows toward directions in its axes.

Run by a Python that has ``bpy``: ``python blender_directions.py MAP DIRECTIONS.json RESULT.json``.
"""

import json
import sys
import tempfile
from pathlib import Path

import bpy
from mathutils import Vector


def shown(file, directions):
    """Return RGB toward unit vectors, by a narrow camera that looks there."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    world = bpy.data.worlds.new("Sky")
    scene.world = world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    texture = nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(str(file))
    links.new(texture.outputs["Color"], nodes["Background"].inputs["Color"])
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 1
    scene.cycles.use_denoising = False
    scene.render.resolution_x = scene.render.resolution_y = 4
    scene.render.filter_size = 0.01
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.color_mode = "RGB"
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.angle = 0.001
    scene.collection.objects.link(camera)
    scene.camera = camera
    colours = []
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "seen.exr")
        for direction in directions:
            camera.rotation_euler = Vector(direction).to_track_quat("-Z", "Y").to_euler()
            bpy.ops.render.render(write_still=True)
            seen = bpy.data.images.load(scene.render.filepath)
            colours.append(list(seen.pixels[:3]))
            bpy.data.images.remove(seen)
    return colours


if __name__ == "__main__":
    source, wanted, result = map(Path, sys.argv[1:4])
    found = shown(source, json.loads(wanted.read_text()))
    result.write_text(json.dumps({"version": bpy.app.version_string, "colours": found}))

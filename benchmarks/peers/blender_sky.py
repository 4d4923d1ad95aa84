"""Bakes Blender's sky texture into a map: ``blender_sky.py WIDTH ELEVATION_DEG FILE.exr``.

One Cycles sample a pixel through a panoramic camera in an empty world; the sky is the one with
multiple scattering, where Blender has it.
"""

import math
import sys

import bpy

width, elevation = int(sys.argv[1]), math.radians(float(sys.argv[2]))
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.cycles.samples = 1
scene.cycles.use_denoising = False
scene.cycles.use_adaptive_sampling = False
scene.render.resolution_x, scene.render.resolution_y = width, width // 2
scene.render.resolution_percentage = 100
world = bpy.data.worlds.new("World")
scene.world = world
world.use_nodes = True
nodes = world.node_tree.nodes
sky = nodes.new("ShaderNodeTexSky")
kinds = {item.identifier for item in sky.bl_rna.properties["sky_type"].enum_items}
sky.sky_type = "MULTIPLE_SCATTERING" if "MULTIPLE_SCATTERING" in kinds else "NISHITA"
sky.sun_elevation = elevation
background = next(node for node in nodes if node.type == "BACKGROUND")
world.node_tree.links.new(sky.outputs[0], background.inputs[0])
camera = bpy.data.cameras.new("Camera")
camera.type = "PANO"
if hasattr(camera, "panorama_type"):
    camera.panorama_type = "EQUIRECTANGULAR"
else:
    camera.cycles.panorama_type = "EQUIRECTANGULAR"
stand = bpy.data.objects.new("Camera", camera)
stand.rotation_euler = (math.pi / 2.0, 0.0, 0.0)
scene.collection.objects.link(stand)
scene.camera = stand
scene.view_settings.view_transform = "Raw"
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "16"
scene.render.image_settings.exr_codec = "ZIP"
scene.render.filepath = sys.argv[3]
bpy.ops.render.render(write_still=True)

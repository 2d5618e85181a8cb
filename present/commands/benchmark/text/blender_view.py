"""Renders a view of this benchmark with Blender's Cycles, as linear EXR of R, G and B:

    blender -b -P blender_view.py -- NAME VIEW MODEL SAMPLES OUTPUT.exr

MODEL is inverse_square or inverse_square_shadows. Materials become Lambertian ones of their base
colour without textures, so scores are of street and lantern_forest. Cycles chooses a light at
random for each sample: with few samples the score shows its noise.
"""
import csv
import json
import math
import pathlib
import sys

import bpy
import numpy
from mathutils import Matrix, Vector

if "bool" not in numpy.__dict__:
    numpy.bool = bool  # numpy 1.24 lacks it, the glTF importer of Blender 3.4 needs it

FOLDER = pathlib.Path(__file__).resolve().parent
FILTER = 0.01  # [pixel]: samples lie at the pixels' centres


def to_blender(v):
    """glTF's Y is up, Blender's Z."""
    return Vector((v[0], -v[2], v[1]))


def frame_of(right, up, back, position):
    axes = [to_blender(v) for v in (right, up, back, position)]
    return Matrix([[axis[i] for axis in axes] for i in range(3)] + [[0, 0, 0, 1]])


def load_surfaces(name):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(FOLDER / (name + ".glb")))
    for thing in list(bpy.data.objects):
        if thing.type != "MESH":
            bpy.data.objects.remove(thing)
    for material in bpy.data.materials:
        nodes = material.node_tree.nodes
        colour = list(nodes["Principled BSDF"].inputs["Base Color"].default_value)
        nodes.clear()
        diffuse, out = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
        diffuse.inputs["Color"].default_value = colour
        material.node_tree.links.new(diffuse.outputs[0], out.inputs[0])


def shape_cone(light, inner, outer):
    """glTF's cone, of a light that points along its -Z: Blender's own spots fade otherwise."""
    light.use_nodes = True
    nodes, link = light.node_tree.nodes, light.node_tree.links.new
    towards, axes = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeSeparateXYZ")
    share, square = nodes.new("ShaderNodeMapRange"), nodes.new("ShaderNodeMath")
    share.inputs["From Min"].default_value = -math.cos(outer)
    share.inputs["From Max"].default_value = -math.cos(inner)
    square.operation, square.inputs[1].default_value = "POWER", 2
    link(towards.outputs["Normal"], axes.inputs[0])
    link(axes.outputs["Z"], share.inputs["Value"])
    link(share.outputs[0], square.inputs[0])
    link(square.outputs[0], nodes["Emission"].inputs["Strength"])


def add_lights(name, shadows):
    for row in csv.DictReader(open(FOLDER / (name + "_lights.csv"))):
        spot = row["type"] == "spot"
        if not spot and row["type"] != "point":
            sys.exit(f"blender_view.py: {name}: lights of type '{row['type']}' are not supported")
        light = bpy.data.lights.new("light", "POINT")
        rgb = [float(row[c + "_cd"]) for c in ("red", "green", "blue")]
        light.color = [c / max(rgb) for c in rgb]
        light.energy = 4 * math.pi * max(rgb)  # Blender's watts; 1 W/sr here stands for 1 cd
        light.shadow_soft_size = 0
        light.cycles.cast_shadow = shadows
        vector = lambda key: [float(row[key + axis]) for axis in ("x", "y", "z")]
        position = [float(row[axis + "_m"]) for axis in "xyz"]
        back, right = (0, 0, 1), (1, 0, 0)
        if spot:
            shape_cone(light, float(row["inner_cone_rad"]), float(row["outer_cone_rad"]))
            back, right = [-c for c in vector("direction_")], vector("side_")
        up = Vector(back).cross(Vector(right))
        thing = bpy.data.objects.new("light", light)
        thing.matrix_world = frame_of(right, up, back, position)
        bpy.context.collection.objects.link(thing)


def add_camera(view):
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle = view["vertical_angle_rad"]
    camera.clip_start, camera.clip_end = 0.01, 10000
    thing = bpy.data.objects.new("camera", camera)
    thing.matrix_world = frame_of(view["right"], view["up"], view["back"], view["position_m"])
    bpy.context.collection.objects.link(thing)
    bpy.context.scene.camera = thing


def render(view, samples, output):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.world = bpy.data.worlds.new("black")
    scene.world.color = (0, 0, 0)
    cycles = scene.cycles
    cycles.samples, cycles.max_bounces = samples, 0
    cycles.pixel_filter_type, cycles.filter_width = "BOX", FILTER
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    cycles.sample_clamp_direct = 0
    scene.render.resolution_x, scene.render.resolution_y = view["width"], view["height"]
    scene.render.resolution_percentage = 100
    scene.view_settings.view_transform = "Raw"
    image = scene.render.image_settings
    image.file_format, image.color_depth, image.color_mode = "OPEN_EXR", "32", "RGB"
    scene.render.filepath = output
    bpy.ops.render.render(write_still=True)


def main():
    name, view, model, samples, output = sys.argv[sys.argv.index("--") + 1 :]
    if model not in ("inverse_square", "inverse_square_shadows"):
        sys.exit(f"blender_view.py: MODEL is '{model}', not inverse_square or inverse_square_shadows")
    scenes = json.loads((FOLDER / "views.json").read_text())["scenes"]
    row = next(s for s in scenes if s["name"] == name)["views"][int(view)]
    load_surfaces(name)
    add_lights(name, model == "inverse_square_shadows")
    add_camera(row)
    render(row, int(samples), output)


main()

# SPDX-License-Identifier: Apache-2.0
"""Renders a frame of a robot's motion with Cycles: under water, sunlit, framed by the camera.

    mercury run sample:ray --seconds 4 --record ray.h5
    mercury export ray.h5 -o ray.pc2
    blender --background --python render_motion.py -- ray.pc2 --frame 100 -o ray.png

ray.pc2 moves the vertices of ray.obj, which lies beside it. Save the scene with --save ray.blend and open it in
Blender to change it, or to render all frames.
"""

import argparse
import math
import os
import sys

import bpy
from mathutils import Vector


def arguments():
    parser = argparse.ArgumentParser(prog="render_motion.py")
    parser.add_argument("cache", help="the .pc2 file; its .obj file lies beside it")
    parser.add_argument("-o", "--output", default="//frame.png", help="the picture")
    parser.add_argument("--frame", type=int, default=0, help="of the recording")
    parser.add_argument("--size", default="1280x720", help="WIDTHxHEIGHT")
    parser.add_argument("--samples", type=int, default=64, help="per pixel")
    parser.add_argument("--azimuth", type=float, default=-62, help="of the eye, from +x toward +y [degrees]")
    parser.add_argument("--elevation", type=float, default=16, help="of the eye above the horizon [degrees]")
    parser.add_argument("--zoom", type=float, default=1, help="above 1 is closer")
    parser.add_argument("--save", help="keep the scene in this .blend file")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:])


# A soft, slightly wet skin; the second names are those of Blender 4.
WET = {"Roughness": 0.38, "Specular": 0.4, "Specular IOR Level": 0.4, "Clearcoat": 0.25, "Coat Weight": 0.25,
       "Clearcoat Roughness": 0.2, "Coat Roughness": 0.2}


def robot_of(cache):
    """The mesh with its point cache: z is up in both, and vertex i of the mesh is point i of the cache."""
    bpy.ops.wm.obj_import(filepath=os.path.splitext(cache)[0] + ".obj", forward_axis="Y", up_axis="Z")
    robot = bpy.context.selected_objects[0]
    modifier = robot.modifiers.new("Motion", "MESH_CACHE")
    modifier.cache_format = "PC2"
    modifier.filepath = os.path.abspath(cache)
    modifier.frame_start = 0
    for polygon in robot.data.polygons:
        polygon.use_smooth = True
    round_off = robot.modifiers.new("Round", "SUBSURF")  # as Mercury draws skins
    round_off.levels = round_off.render_levels = 2
    for slot in robot.material_slots:
        skin = slot.material.node_tree.nodes["Principled BSDF"].inputs
        for name, value in WET.items():
            if name in skin:
                skin[name].default_value = value
    return robot


def box_of(robot):
    """Middle and half size of the robot at the current frame."""
    shape = robot.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    points = [robot.matrix_world @ vertex.co for vertex in shape.vertices]
    low = Vector(min(p[i] for p in points) for i in range(3))
    high = Vector(max(p[i] for p in points) for i in range(3))
    return (low + high) / 2, (high - low) / 2, points


class Nodes:
    """Builds a node tree in few lines."""

    def __init__(self, tree):
        self.tree = tree
        tree.nodes.clear()

    def add(self, kind, **values):
        node = self.tree.nodes.new(kind)
        for name, value in values.items():
            if hasattr(value, "bl_idname"):  # an output of another node
                self.tree.links.new(value, node.inputs[name.replace("_", " ")])
            elif name.startswith("set_"):
                setattr(node, name[4:], value)
            else:
                node.inputs[name.replace("_", " ")].default_value = value
        return node

    def link(self, output, node, index):
        self.tree.links.new(output, node.inputs[index])


# The water in the picture, from its lower to its upper edge.
WATER = [(0, (0.001, 0.012, 0.03, 1)), (0.55, (0.004, 0.06, 0.115, 1)), (1, (0.025, 0.2, 0.29, 1))]


def add_ramp(nodes, factor, stops):
    ramp = nodes.add("ShaderNodeValToRGB")
    ramp.color_ramp.interpolation = "EASE"
    while len(ramp.color_ramp.elements) < len(stops):
        ramp.color_ramp.elements.new(0.5)
    for element, (position, color) in zip(ramp.color_ramp.elements, stops):
        element.position, element.color = position, color
    nodes.link(factor, ramp, 0)
    return ramp.outputs["Color"]


def add_water(scene):
    """The color of the water by the height in the picture, and light from all around."""
    world = scene.world = bpy.data.worlds.new("Water")
    world.use_nodes = True
    nodes = Nodes(world.node_tree)
    window = nodes.add("ShaderNodeTexCoord")
    split = nodes.add("ShaderNodeSeparateXYZ")
    nodes.link(window.outputs["Window"], split, 0)
    seen = nodes.add("ShaderNodeBackground", Strength=1.0)
    nodes.link(add_ramp(nodes, split.outputs["Y"], WATER), seen, 0)
    around = nodes.add("ShaderNodeBackground", Color=(0.08, 0.3, 0.42, 1), Strength=0.5)
    path = nodes.add("ShaderNodeLightPath")
    mix = nodes.add("ShaderNodeMixShader")
    nodes.link(path.outputs["Is Camera Ray"], mix, 0)
    nodes.link(around.outputs[0], mix, 1)
    nodes.link(seen.outputs[0], mix, 2)
    nodes.link(mix.outputs[0], nodes.add("ShaderNodeOutputWorld"), 0)


def add_sand(middle, depth, fade):
    """The sea floor, which the water hides with distance."""
    bpy.ops.mesh.primitive_plane_add(size=400, location=(middle.x, middle.y, middle.z - depth))
    material = bpy.data.materials.new("Sand")
    material.use_nodes = True
    nodes = Nodes(material.node_tree)
    place = nodes.add("ShaderNodeTexCoord").outputs["Object"]
    grain = nodes.add("ShaderNodeTexNoise", Vector=place, Scale=2.5, Detail=6.0)
    waves = nodes.add("ShaderNodeTexWave", Vector=place, Scale=1.4, Distortion=6.0, Detail=2.0)
    bump = nodes.add("ShaderNodeBump", Strength=0.3, Distance=0.04, Height=waves.outputs["Fac"])
    sand = nodes.add("ShaderNodeBsdfDiffuse", Normal=bump.outputs["Normal"])
    nodes.link(add_ramp(nodes, grain.outputs["Fac"], [(0.3, (0.04, 0.11, 0.12, 1)), (0.7, (0.09, 0.19, 0.19, 1))]), sand, 0)
    distance = nodes.add("ShaderNodeCameraData").outputs["View Distance"]
    share = nodes.add("ShaderNodeMath", set_operation="DIVIDE")
    nodes.link(distance, share, 0)
    share.inputs[1].default_value = fade
    window = nodes.add("ShaderNodeSeparateXYZ")
    nodes.link(nodes.add("ShaderNodeTexCoord").outputs["Window"], window, 0)
    water = nodes.add("ShaderNodeEmission", Strength=1.0)
    nodes.link(add_ramp(nodes, window.outputs["Y"], WATER), water, 0)
    hidden = add_ramp(nodes, share.outputs[0], [(0, (0.1, 0.1, 0.1, 1)), (0.8, (1, 1, 1, 1))])
    mix = nodes.add("ShaderNodeMixShader")
    nodes.link(hidden, mix, 0)
    nodes.link(sand.outputs[0], mix, 1)
    nodes.link(water.outputs[0], mix, 2)
    nodes.link(mix.outputs[0], nodes.add("ShaderNodeOutputMaterial"), 0)
    bpy.context.object.data.materials.append(material)


def add_sun(middle, size):
    """A sun through a rippled surface: a sheet above the robot lets through a net of bright lines."""
    bpy.ops.object.light_add(type="SUN", rotation=(math.radians(22), math.radians(-18), 0))
    sun = bpy.context.object.data
    sun.energy, sun.angle, sun.color = 11, math.radians(0.4), (1, 0.97, 0.88)
    bpy.ops.mesh.primitive_plane_add(size=60, location=(middle.x, middle.y, middle.z + 4 * size))
    sheet = bpy.context.object
    sheet.visible_camera = sheet.visible_diffuse = sheet.visible_glossy = False
    material = bpy.data.materials.new("Ripples")
    material.use_nodes = True
    nodes = Nodes(material.node_tree)
    place = nodes.add("ShaderNodeTexCoord").outputs["Object"]
    wobble = nodes.add("ShaderNodeTexNoise", Vector=place, Scale=1.5 / size)
    moved = nodes.add("ShaderNodeVectorMath", set_operation="MULTIPLY_ADD")
    nodes.link(wobble.outputs["Color"], moved, 0)
    moved.inputs[1].default_value = (0.35 * size,) * 3
    nodes.link(place, moved, 2)
    cells = nodes.add("ShaderNodeTexVoronoi", set_feature="DISTANCE_TO_EDGE", Vector=moved.outputs[0], Scale=3.2 / size)
    light = add_ramp(nodes, cells.outputs["Distance"],
                     [(0, (1, 1, 1, 1)), (0.04, (0.85, 0.85, 0.85, 1)), (0.16, (0.3, 0.3, 0.3, 1))])
    gate = nodes.add("ShaderNodeBsdfTransparent")
    nodes.link(light, gate, 0)
    nodes.link(gate.outputs[0], nodes.add("ShaderNodeOutputMaterial"), 0)
    sheet.data.materials.append(material)
    bpy.ops.object.light_add(type="AREA", location=middle + Vector((2.2 * size, 2.5 * size, 0.8 * size)))
    rim = bpy.context.object
    rim.rotation_euler = (middle - rim.location).to_track_quat("-Z", "Y").to_euler()
    rim.data.energy, rim.data.size, rim.data.color = 55 * size * size, 1.5 * size, (0.35, 0.8, 1)


def add_camera(scene, middle, points, options):
    """Looks at the robot from the side that the options say, so near that it fills most of the picture."""
    azimuth, elevation = math.radians(options.azimuth), math.radians(options.elevation)
    toward = Vector((math.cos(elevation) * math.cos(azimuth), math.cos(elevation) * math.sin(azimuth), math.sin(elevation)))
    bpy.ops.object.camera_add()
    camera = scene.camera = bpy.context.object
    camera.rotation_euler = toward.to_track_quat("Z", "Y").to_euler()
    camera.data.lens = 50
    turn = camera.rotation_euler.to_matrix().transposed()
    aspect = scene.render.resolution_x / scene.render.resolution_y
    half = 18 / 50  # of the picture's width at distance 1
    distance = max(max(abs(p.x) / half, abs(p.y) * aspect / half) + p.z for p in (turn @ (q - middle) for q in points))
    distance *= 1.12 / options.zoom
    camera.location = middle + distance * toward
    camera.data.dof.use_dof = True
    camera.data.dof.focus_distance = distance
    camera.data.dof.aperture_fstop = 2.8
    return distance


def main():
    options = arguments()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    width, height = map(int, options.size.split("x"))
    scene.render.resolution_x, scene.render.resolution_y = width, height
    robot = robot_of(options.cache)
    scene.frame_set(options.frame)
    middle, half, points = box_of(robot)
    add_water(scene)
    distance = add_camera(scene, middle, points, options)
    add_sand(middle, 1.2 * distance / 3 + half.z, 6 * distance)
    add_sun(middle, half.length)
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = options.samples
    scene.cycles.use_denoising = getattr(bpy.app.build_options, "openimagedenoise", False)  # not in Debian's build
    scene.cycles.transparent_max_bounces = 8
    scene.view_settings.view_transform = "Filmic"
    scene.view_settings.look = "Medium High Contrast"
    scene.render.image_settings.file_format = "JPEG" if options.output.endswith((".jpg", ".jpeg")) else "PNG"
    scene.render.filepath = os.path.abspath(options.output)
    if options.save:
        bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(options.save))
    bpy.ops.render.render(write_still=True)


main()

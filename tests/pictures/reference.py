"""The same picture in Cycles: hair, head, lamps, sky and camera as Nabiki has them."""

from math import pi, radians, sqrt, tau

import bpy
import numpy as np
from mathutils import Matrix

import cases

EUMELANIN = np.array([0.419, 0.697, 1.37])
PHEOMELANIN = np.array([0.187, 0.4, 1.05])
GRADES = 8
TILT_SPREAD = 0.14


def linear(srgb):
    srgb = np.asarray(srgb, float)
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def of_strand(strands, purpose):
    """The number in 0..1 that belongs to a strand and a purpose, as crates/nabiki_render/src/colour.rs makes it."""
    h = (strands.astype("u4") * np.uint32(0x9E3779B1)) ^ np.uint32(purpose * 0x85EBCA77 & 0xFFFFFFFF)
    h = (h ^ h >> np.uint32(16)) * np.uint32(0x7FEB352D)
    h = (h ^ h >> np.uint32(15)) * np.uint32(0x846CA68B)
    return ((h ^ h >> np.uint32(16)) >> np.uint32(8)) / 2.0**24


def direction(azimuth, elevation):
    a, e = radians(azimuth), radians(elevation)
    return np.array([np.cos(e) * np.cos(a), np.sin(e), np.cos(e) * np.sin(a)])


def imported(path, frame):
    """Points of the strands, where each begins, and the head's vertices and faces: centimetres, y up."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.usd_import(filepath=str(path))
    bpy.context.scene.frame_set(frame)
    graph = bpy.context.evaluated_depsgraph_get()

    def placed(object_, attribute):
        flat = np.empty(3 * len(attribute), "f4")
        attribute.foreach_get("vector", flat)
        world = np.array(object_.matrix_world)
        z_up = 100.0 * (flat.reshape(-1, 3) @ world[:3, :3].T + world[:3, 3])
        return np.stack([z_up[:, 0], z_up[:, 2], -z_up[:, 1]], 1).astype("f4")

    [hair] = [o.evaluated_get(graph) for o in bpy.data.objects if o.type == "CURVES"]
    points = placed(hair, hair.data.attributes["position"].data)
    counts = np.array([curve.points_length for curve in hair.data.curves])
    [head] = [o.evaluated_get(graph) for o in bpy.data.objects if o.type == "MESH"]
    vertices = placed(head, head.data.attributes["position"].data)
    faces = [list(polygon.vertices) for polygon in head.data.polygons]
    return points, counts, vertices, faces


def material(name, kind):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes = made.node_tree.nodes
    nodes.clear()
    shader, output = nodes.new(kind), nodes.new("ShaderNodeOutputMaterial")
    made.node_tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return made, shader


def hair_material():
    made, shader = material("hair", "ShaderNodeBsdfHairPrincipled")
    shader.model = "CHIANG"
    shader.parametrization = "ABSORPTION"
    tree = made.node_tree
    for attribute, output, socket in [("absorption", "Vector", "Absorption Coefficient"), ("tilt", "Fac", "Offset")]:
        node = tree.nodes.new("ShaderNodeAttribute")
        node.attribute_name = attribute
        tree.links.new(node.outputs[output], shader.inputs[socket])
    # Nabiki: R has the variance (2 beta)^2. Cycles: (0.726 r + 0.812 r^2)^2, with a term of r^20 that is nothing here.
    shader.inputs["Roughness"].default_value = (sqrt(0.726**2 + 4 * 0.812 * 2 * radians(cases.ROUGHNESS)) - 0.726) / (2 * 0.812)
    shader.inputs["Radial Roughness"].default_value = cases.AROUND
    shader.inputs["IOR"].default_value = cases.REFRACTION
    for socket in ["Coat", "Random Roughness"]:
        shader.inputs[socket].default_value = 0.0
    return made


def add_hair(points, counts, case):
    data = bpy.data.hair_curves.new("hair")
    data.add_curves(counts.tolist())
    data.set_types(type="CATMULL_ROM")
    data.attributes["position"].data.foreach_set("vector", points.ravel())
    ends = np.cumsum(counts)
    starts = ends - counts
    step = np.zeros(len(points))
    step[1:] = np.linalg.norm(points[1:] - points[:-1], axis=1)
    step[starts] = 0.0
    along = np.cumsum(step)
    along -= np.repeat(along[starts], counts)
    along /= np.repeat(along[ends - 1], counts)
    thin = np.clip((along - 1.0 + cases.TAPER) / cases.TAPER, 0.0, 1.0)
    radius = 0.5 * case.view.width * (1.0 - thin * (1.0 - case.view.tip))
    if "radius" not in data.attributes:
        data.attributes.new("radius", "FLOAT", "POINT")
    data.attributes["radius"].data.foreach_set("value", radius.astype("f4"))

    strands = np.arange(len(counts))
    eu, pheo = cases.MELANIN[case.colour]
    grade = np.minimum((of_strand(strands, 3) + of_strand(strands, 4)) * 0.5 * GRADES, GRADES - 1).astype(int)
    pigment = np.exp(1.6 * cases.VARIATION * (2.0 * grade / (GRADES - 1) - 1.0))
    absorption = pigment[:, None] * (eu * EUMELANIN + pheo * PHEOMELANIN)
    data.attributes.new("absorption", "FLOAT_VECTOR", "CURVE").data.foreach_set("vector", absorption.astype("f4").ravel())
    deviation = of_strand(strands, 1) + of_strand(strands, 2) - 1.0
    tilt = radians(cases.TILT) + TILT_SPREAD * cases.VARIATION * deviation
    data.attributes.new("tilt", "FLOAT", "CURVE").data.foreach_set("value", tilt.astype("f4"))
    data.materials.append(hair_material())
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("hair", data))


def add_head(vertices, faces):
    mesh = bpy.data.meshes.new("head")
    mesh.from_pydata(vertices.tolist(), [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    skin, shader = material("skin", "ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (*linear(cases.SKIN), 1.0)
    mesh.materials.append(skin)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("head", mesh))


def facing(z):
    """A turn whose z axis is `z` (unit) and whose y axis is as near to up as can be."""
    x = np.cross([0.0, 1.0, 0.0], z)
    x /= np.linalg.norm(x)
    turn = np.eye(4)
    turn[:3, :3] = np.stack([x, np.cross(z, x), z], 1)
    return turn


def add_lamps(case):
    for number, (azimuth, elevation, strength, colour, extent) in enumerate(case.lamps):
        sun = bpy.data.lights.new(f"lamp {number}", "SUN")
        # A white surface facing it shows its strength.
        sun.energy, sun.color, sun.angle = pi * strength, colour, radians(extent)
        lamp = bpy.data.objects.new(f"lamp {number}", sun)
        lamp.matrix_world = Matrix(facing(direction(case.view.azimuth + azimuth, elevation)))
        bpy.context.scene.collection.objects.link(lamp)


def add_sky(case):
    """Two even halves, above and below."""
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    tree = world.node_tree
    tree.nodes.clear()
    new = tree.nodes.new
    place, parts, above = new("ShaderNodeTexCoord"), new("ShaderNodeSeparateXYZ"), new("ShaderNodeMath")
    mix, background, output = new("ShaderNodeMix"), new("ShaderNodeBackground"), new("ShaderNodeOutputWorld")
    above.operation = "GREATER_THAN"
    above.inputs[1].default_value = 0.0
    mix.data_type = "RGBA"
    colours = [socket for socket in mix.inputs if socket.type == "RGBA"]
    colours[0].default_value, colours[1].default_value = (*cases.BELOW, 1.0), (*cases.ABOVE, 1.0)
    background.inputs["Strength"].default_value = case.sky
    tree.links.new(place.outputs["Generated"], parts.inputs[0])
    tree.links.new(parts.outputs["Y"], above.inputs[0])
    tree.links.new(above.outputs[0], mix.inputs[0])
    tree.links.new(next(socket for socket in mix.outputs if socket.type == "RGBA"), background.inputs["Color"])
    tree.links.new(background.outputs[0], output.inputs["Surface"])


def add_camera(view):
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.angle = "VERTICAL", radians(view.fov)
    camera = bpy.data.objects.new("camera", data)
    outward = direction(view.azimuth, view.elevation)
    place = facing(outward)
    place[:3, 3] = np.array(view.target) + view.distance * outward
    camera.matrix_world = Matrix(place)
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def render(case, hair, samples, path):
    """Draws a case into an OpenEXR file: linear, premultiplied."""
    points, counts, vertices, faces = hair
    bpy.ops.wm.read_factory_settings(use_empty=True)
    add_head(vertices, faces)
    add_hair(points, counts, case)
    add_lamps(case)
    add_sky(case)
    add_camera(case.view)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = cases.SIZE
    scene.render.film_transparent = True
    scene.cycles.samples = samples
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.use_denoising = False
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.sample_clamp_indirect = 0.0
    for kind in ["max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces"]:
        setattr(scene.cycles, kind, 64)
    scene.cycles_curves.shape = "RIBBONS"
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)

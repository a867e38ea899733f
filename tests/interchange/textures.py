"""Plays vertex-animation textures as a shader would, and compares every vertex with the point cache of the same run.

    textures.py blender FOLDER   ribbons.exr and ribbons.exr.glb, as Blender has them
    textures.py three FOLDER     what textures.mjs wrote of ribbons.exr and lines.exr, against the same

FOLDER/moving.pc2 has the simulated hair. Distances are in centimetres.
"""

import struct
import sys
from pathlib import Path

import numpy as np


def known(folder):
    """The points of every frame: centimetres, y up, facing +x."""
    data = (folder / "moving.pc2").read_bytes()
    _, _, points, _, _, frames = struct.unpack_from("<12siiffi", data)
    return np.frombuffer(data, "<f4", offset=32).reshape(frames, points, 3).astype("f8")


def compare(program, name, found, folder):
    """Vertices in glTF's axes and unit, for each frame."""
    wanted = known(folder)
    found = found.astype("f8")
    # Ribbons have two vertices at each point.
    found = 0.5 * (found[:, ::2] + found[:, 1::2]) if found.shape[1] == 2 * wanted.shape[1] else found
    x, y, z = np.moveaxis(100.0 * found, 2, 0)
    apart = np.linalg.norm(np.stack([z, y, -x], 2) - wanted, axis=2).max()
    print(f"measured: {name} in {program}: {len(wanted)} frames, {apart:.1e} cm from the simulated hair at most")
    # Floats of 32 bits, 1.5 m from the origin.
    assert apart < 1e-4, name


def blender(folder):
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(folder / "ribbons.exr.glb"))
    [hair] = [o for o in bpy.data.objects if o.type == "MESH"]
    mesh = hair.data
    image = bpy.data.images.load(str(folder / "ribbons.exr"))
    image.colorspace_settings.name = "Non-Color"
    image.alpha_mode = "CHANNEL_PACKED"
    width, height = image.size
    texels = np.empty(4 * width * height, "f4")
    image.pixels.foreach_get(texels)
    # From the bottom to the top, as Blender has v.
    texels = texels.reshape(height, width, 4)
    corners = np.empty(len(mesh.loops), "i4")
    mesh.loops.foreach_get("vertex_index", corners)
    uvs = np.empty(2 * len(corners), "f4")
    mesh.uv_layers[1].uv.foreach_get("vector", uvs)
    uv = np.full((len(mesh.vertices), 2), np.nan)
    uv[corners] = uvs.reshape(-1, 2)
    rest = np.empty(3 * len(mesh.vertices), "f4")
    mesh.vertices.foreach_get("co", rest)
    frames = len(known(folder))
    found = []
    for n in range(frames):
        row, column = np.floor((uv[:, 1] - n / frames) * height), np.floor(uv[:, 0] * width)
        found.append(texels[row.astype(int), column.astype(int)])
    found = np.array(found)
    x, y, z = rest.reshape(-1, 3).T
    assert np.array_equal(found[0, :, :3], np.stack([x, z, -y], 1)), "the mesh is the first frame"
    assert (found[..., 3].min(), found[..., 3].max()) == (0.0, 1.0), "from root to tip"
    compare("Blender", "ribbons.exr", found[..., :3], folder)


def three(folder):
    for name in ["ribbons.exr", "lines.exr"]:
        frames = len(known(folder))
        compare("three.js", name, np.fromfile(folder / f"{name}.f32", "f4").reshape(frames, -1, 3), folder)


if __name__ == "__main__":
    {"blender": blender, "three": three}[sys.argv[1]](Path(sys.argv[2]))

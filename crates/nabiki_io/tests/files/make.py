#!/usr/bin/env python3
"""Writes the sample files of this folder, with Python's standard library alone and none of the project's writers.

    python3 crates/nabiki_io/tests/files/make.py

All hair is one groom, all meshes are one solid, all motion is one nod; what they are stands in README.md. The .usdc and
.abc files are made out of groom.usda and motion.nabiki by the command, as README.md says.
"""

import base64
import json
import math
import pathlib
import struct

import xxhash

HERE = pathlib.Path(__file__).parent

# Metres, y up, face along +z; every number is exact in binary.
STRANDS = [[(x, 1.5 + 0.125 * p, 0.0625 * p * p) for p in range(4)] for x in (-0.25, 0.0, 0.5)]
POINTS = [point for strand in STRANDS for point in strand]

# An octahedron around (0, 1.5, 0), wound counter-clockwise seen from outside.
CORNERS = [(0.25, 1.5, 0), (-0.25, 1.5, 0), (0, 1.75, 0), (0, 1.25, 0), (0, 1.5, 0.25), (0, 1.5, -0.25)]
FACES = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
UVS = [(0.125 * i, 1 - 0.125 * i) for i in range(6)]

# 25 samples at 48 Hz: the hips go along +z, the head, half a metre above them, turns about y.
RATE = 48
SAMPLES = [(i / RATE, (0, 1, 0.0625 * i), 3.75 * i) for i in range(25)]
NECK = 0.5


def text(name, *lines):
    (HERE / name).write_text("\n".join(lines) + "\n")


def binary(name, *parts):
    (HERE / name).write_bytes(b"".join(parts))


def pack(kind, values):
    values = list(values)
    return struct.pack(f"<{len(values)}{kind}", *values)


def flat(rows):
    return [value for row in rows for value in row]


def turn(degrees):
    half = math.radians(degrees) / 2
    return (0, math.sin(half), 0, math.cos(half))


def hair():
    counts = [len(strand) for strand in STRANDS]
    header = b"HAIR" + pack("I", [len(STRANDS), len(POINTS), 3, 0]) + pack("f", [0.0001, 0.25, 1, 0.5, 0.25])
    segments = pack("H", [count - 1 for count in counts])
    binary("groom.hair", header, b"sample".ljust(88, b"\0"), segments, pack("f", flat(POINTS)))

    def held(p):
        return 0 if p % 4 in (0, 3) else 1

    offsets = [160, 160 + 16 * len(POINTS), 0, 0, 0]
    head = pack("f", [4.0]) + pack("I", [len(STRANDS), 4] + offsets) + bytes(128)
    places = pack("f", flat((*point, held(p)) for p, point in enumerate(POINTS)))
    binary("groom_4.tfx", head, places, pack("f", flat((0.25 * s, 0.5) for s in range(3))))

    offsets = [296, 296 + 12 * len(POINTS), 0, 0, 0, 0]
    head = pack("f", [3.0]) + pack("I", [len(STRANDS), 4, 5, 1]) + bytes(124) + pack("I", offsets) + bytes(128)
    binary("groom_3.tfx", head, pack("f", flat(POINTS)), pack("f", [0.0001, 0.0002, 0.0003]))

    lines = ["# the groom as polylines", *("v %g %g %g" % point for point in POINTS)]
    text("groom.obj", *lines, *("l %d %d %d %d" % tuple(4 * s + p + 1 for p in range(4)) for s in range(3)))

    points = ", ".join("(%g, %g, %g)" % point for point in POINTS)
    text(
        "groom.usda",
        "#usda 1.0",
        "(",
        '    defaultPrim = "groom"',
        "    metersPerUnit = 1",
        '    upAxis = "Y"',
        "    timeCodesPerSecond = %d" % RATE,
        ")",
        "",
        'def Xform "groom"',
        "{",
        '    def BasisCurves "hair"',
        "    {",
        '        uniform token type = "linear"',
        '        uniform token wrap = "nonperiodic"',
        "        int[] curveVertexCounts = [4, 4, 4]",
        "        point3f[] points = [%s]" % points,
        '        float[] widths = [0.0001] (interpolation = "constant")',
        "    }",
        "",
        '    def Mesh "skin"',
        "    {",
        "        int[] faceVertexCounts = [%s]" % ", ".join("3" for _ in FACES),
        "        int[] faceVertexIndices = [%s]" % ", ".join(str(v) for v in flat(FACES)),
        "        point3f[] points = [%s]" % ", ".join("(%g, %g, %g)" % corner for corner in CORNERS),
        "        texCoord2f[] primvars:st = [%s] (interpolation = \"faceVarying\")" % ", ".join("(%g, %g)" % uv for uv in UVS),
        "        int[] primvars:st:indices = [%s]" % ", ".join(str(v) for v in flat(FACES)),
        "    }",
        "}",
        "",
        'def Xform "Hips"',
        "{",
        "    double3 xformOp:translate.timeSamples = {",
        *("        %d: (%g, %g, %g)," % (i, *hips) for i, (_, hips, _) in enumerate(SAMPLES)),
        "    }",
        '    uniform token[] xformOpOrder = ["xformOp:translate"]',
        "",
        '    def Xform "Head"',
        "    {",
        "        double3 xformOp:translate = (0, %g, 0)" % NECK,
        "        double xformOp:rotateY.timeSamples = {",
        *("            %d: %r," % (i, angle) for i, (_, _, angle) in enumerate(SAMPLES)),
        "        }",
        '        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateY"]',
        "    }",
        "}",
    )


def meshes():
    lines = ["# the solid, with texture coordinates", *("v %g %g %g" % corner for corner in CORNERS)]
    lines += ["vt %g %g" % uv for uv in UVS]
    text("solid.obj", *lines, "g solid", *("f " + " ".join("%d/%d" % (v + 1, v + 1) for v in face) for face in FACES))

    def header(form):
        return "\n".join([
            "ply", f"format {form} 1.0", "comment the solid", "element vertex 6", "property float x",
            "property float y", "property float z", "property float s", "property float t", "element face 8",
            "property list uchar int vertex_indices", "end_header\n",
        ])

    rows = ["%g %g %g %g %g" % (*corner, *uv) for corner, uv in zip(CORNERS, UVS)]
    faces = ["3 %d %d %d" % face for face in FACES]
    (HERE / "solid_text.ply").write_text(header("ascii") + "\n".join(rows + faces) + "\n")
    for name, form, order in [("solid_little.ply", "little", "<"), ("solid_big.ply", "big", ">")]:
        body = b"".join(struct.pack(order + "5f", *corner, *uv) for corner, uv in zip(CORNERS, UVS))
        body += b"".join(struct.pack(order + "B3i", 3, *face) for face in FACES)
        binary(name, header(f"binary_{form}_endian").encode(), body)

    bone = "0 0 0 0 1 0 0 0"
    text(
        "solid.tfxmesh",
        "numOfBones 1", "# bone index, bone name", "0 root", "numOfVertices 6",
        *("%d %g %g %g 0 1 0 %s" % (v, *corner, bone) for v, corner in enumerate(CORNERS)),
        "numOfTriangles 8", *("%d %d %d %d" % (f, *face) for f, face in enumerate(FACES)),
    )

    # Seen in the mirror, and mirrored back by its node.
    mirrored = [(-x, y, z) for x, y, z in CORNERS]
    # glTF counts v from the top.
    down = [(u, 1 - v) for u, v in UVS]
    blob = pack("f", flat(mirrored)) + pack("f", flat(down)) + pack("H", flat((a, c, b) for a, b, c in FACES))
    times = [time for time, _, _ in SAMPLES]
    at = len(blob)
    blob += pack("f", times) + pack("f", flat(hips for _, hips, _ in SAMPLES))
    blob += pack("f", flat(turn(angle) for _, _, angle in SAMPLES))
    count = len(SAMPLES)
    views = [(0, 72), (72, 48), (120, 48), (at, 4 * count), (at + 4 * count, 12 * count), (at + 16 * count, 16 * count)]
    lows = [min(column) for column in zip(*mirrored)]
    highs = [max(column) for column in zip(*mirrored)]

    def accessor(view, kind, count, shape, **more):
        return {"bufferView": view, "componentType": kind, "count": count, "type": shape, **more}

    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [
            {"name": "solid", "mesh": 0, "scale": [-1, 1, 1]},
            {"name": "Hips", "children": [2]},
            {"name": "Head", "translation": [0, NECK, 0]},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2}]}],
        "animations": [{
            "name": "nod",
            "samplers": [{"input": 3, "output": 4}, {"input": 3, "output": 5}],
            "channels": [
                {"sampler": 0, "target": {"node": 1, "path": "translation"}},
                {"sampler": 1, "target": {"node": 2, "path": "rotation"}},
            ],
        }],
        "accessors": [
            accessor(0, 5126, 6, "VEC3", min=lows, max=highs),
            accessor(1, 5126, 6, "VEC2"),
            accessor(2, 5123, 24, "SCALAR"),
            accessor(3, 5126, count, "SCALAR", min=[times[0]], max=[times[-1]]),
            accessor(4, 5126, count, "VEC3"),
            accessor(5, 5126, count, "VEC4"),
        ],
        "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": length} for at, length in views],
        "buffers": [{"byteLength": len(blob)}],
    }
    words = json.dumps(document).encode()
    words += b" " * (-len(words) % 4)
    blob += bytes(-len(blob) % 4)
    chunks = struct.pack("<II", len(words), 0x4E4F534A) + words + struct.pack("<II", len(blob), 0x004E4942) + blob
    binary("solid.glb", b"glTF", struct.pack("<II", 2, 12 + len(chunks)), chunks)
    data = "data:application/octet-stream;base64," + base64.b64encode(blob).decode()
    document["buffers"] = [{"byteLength": len(blob), "uri": data}]
    (HERE / "solid.gltf").write_text(json.dumps(document, indent=1) + "\n")


def fbx():
    """ASCII of version 7.4. The solid is seen in the mirror, and mirrored back by its node."""
    second = 46186158000

    def array(name, values):
        values = list(values)
        return "%s: *%d { a: %s }" % (name, len(values), ",".join("%.17g" % value for value in values))

    def model(number, name, kind, *properties):
        rows = ['P: "%s", "%s", "", "A",%g,%g,%g' % (key, key, *value) for key, value in properties]
        return ['Model: %d, "Model::%s", "%s" {' % (number, name, kind), "Version: 232", "Properties70: {", *rows, "}", "}"]

    def curve(number, values):
        # A line from key to key.
        keys = [
            array("KeyTime", (round(time * second) for time, _, _ in SAMPLES)), array("KeyValueFloat", values),
            "KeyAttrFlags: *1 { a: 4 }", "KeyAttrDataFloat: *4 { a: 0,0,0,0 }",
            "KeyAttrRefCount: *1 { a: %d }" % len(SAMPLES),
        ]
        return ['AnimationCurve: %d, "AnimCurve::", "" {' % number, "Default: 0", "KeyVer: 4008", *keys, "}"]

    def curves(number, name, value):
        rows = ['P: "d|%s", "Number", "", "A",%g' % pair for pair in zip("XYZ", value)]
        return ['AnimationCurveNode: %d, "AnimCurveNode::%s", "" {' % (number, name), "Properties70: {", *rows, "}", "}"]

    settings = [("UpAxis", 1), ("UpAxisSign", 1), ("FrontAxis", 2), ("FrontAxisSign", 1), ("CoordAxis", 0), ("CoordAxisSign", 1)]
    corners = [v for face in FACES for v in (face[0], face[2], face[1])]
    text(
        "solid.fbx",
        "; FBX 7.4.0 project file",
        "FBXHeaderExtension: {", "FBXHeaderVersion: 1003", "FBXVersion: 7400", "}",
        "GlobalSettings: {", "Version: 1000", "Properties70: {",
        *('P: "%s", "int", "Integer", "",%d' % pair for pair in settings),
        'P: "UnitScaleFactor", "double", "Number", "",100', 'P: "TimeMode", "enum", "", "",5', "}", "}",
        "Objects: {",
        'Geometry: 1, "Geometry::", "Mesh" {',
        array("Vertices", flat((-x, y, z) for x, y, z in CORNERS)),
        array("PolygonVertexIndex", (-v - 1 if i % 3 == 2 else v for i, v in enumerate(corners))),
        "LayerElementUV: 0 {", "Version: 101", 'Name: "map"', 'MappingInformationType: "ByPolygonVertex"',
        'ReferenceInformationType: "IndexToDirect"', array("UV", flat(UVS)), array("UVIndex", corners), "}",
        "Layer: 0 {", "Version: 100", "LayerElement: {", 'Type: "LayerElementUV"', "TypedIndex: 0", "}", "}",
        "}",
        *model(2, "solid", "Mesh", ("Lcl Scaling", (-1, 1, 1))),
        *model(3, "Hips", "Null", ("Lcl Translation", (0, 1, 0))),
        *model(4, "Head", "Null", ("Lcl Translation", (0, NECK, 0))),
        'AnimationStack: 5, "AnimStack::nod", "" {', "Properties70: {",
        'P: "LocalStart", "KTime", "Time", "",0', 'P: "LocalStop", "KTime", "Time", "",%d' % (second // 2), "}", "}",
        'AnimationLayer: 6, "AnimLayer::base", "" {', "}",
        *curves(7, "T", (0, 1, 0)), *curve(8, (hips[2] for _, hips, _ in SAMPLES)),
        *curves(9, "R", (0, 0, 0)), *curve(10, (angle for _, _, angle in SAMPLES)),
        "}",
        "Connections: {",
        'C: "OO",1,2', 'C: "OO",2,0', 'C: "OO",3,0', 'C: "OO",4,3', 'C: "OO",6,5', 'C: "OO",7,6', 'C: "OO",9,6',
        'C: "OP",7,3, "Lcl Translation"', 'C: "OP",8,7, "d|Z"', 'C: "OP",9,4, "Lcl Rotation"', 'C: "OP",10,9, "d|Y"',
        "}",
    )


def motion():
    text(
        "nod.bvh",
        "HIERARCHY", "ROOT Hips", "{", "\tOFFSET 0 1 0",
        "\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation",
        "\tJOINT Head", "\t{", "\t\tOFFSET 0 %g 0" % NECK, "\t\tCHANNELS 3 Zrotation Xrotation Yrotation",
        "\t\tEnd Site", "\t\t{", "\t\t\tOFFSET 0 0.25 0", "\t\t}", "\t}", "}",
        "MOTION", "Frames: %d" % len(SAMPLES), "Frame Time: %.7f" % (1 / RATE),
        *("%g %g %g 0 0 0 0 0 %r" % (*hips, angle) for _, hips, angle in SAMPLES),
    )
    # A unit of 2.54 / 0.0254 cm is a metre.
    text(
        "nod.asf",
        "# a body of two bones", ":version 1.10", ":name nod", ":units", "  mass 1.0", "  length 0.0254", "  angle deg",
        ":root", "  order TX TY TZ RX RY RZ", "  axis XYZ", "  position 0 0 0", "  orientation 0 0 0",
        ":bonedata",
        "  begin", "    id 1", "    name Spine", "    direction 0 1 0", "    length %g" % NECK, "    axis 0 0 0 XYZ", "  end",
        "  begin", "    id 2", "    name Head", "    direction 0 1 0", "    length 0.25", "    axis 0 0 0 XYZ",
        "    dof rx ry rz", "  end",
        ":hierarchy", "  begin", "    root Spine", "    Spine Head", "  end",
    )
    rows = [line for i, (_, hips, angle) in enumerate(SAMPLES)
            for line in (str(i + 1), "root %g %g %g 0 0 0" % hips, "Head 0 %r 0" % angle)]
    text("nod.amc", ":FULLY-SPECIFIED", ":DEGREES", *rows)

    text(
        "nod_skeleton.tof",
        "TOS 1.00", "",
        "declare Skeleton 1", "  mJoints array instance Skeleton::Joint", "",
        "declare Skeleton::Joint 2", "  mName string", "  mParentName string", "",
        "object Skeleton 00000001", "  2", '    "Hips"', '    ""', '    "Head"', '    "Hips"',
    )

    def keys(name, rows):
        return ['    "%s"' % name, "    %d" % len(rows), *("      %.9g %.9g %.9g %.9g %g %g %g %.9g" % row for row in rows)]

    hips = [(0, 0, 0, 1, *place, time) for time, place, _ in SAMPLES]
    head = [(*turn(angle), 0, NECK, 0, time) for time, _, angle in SAMPLES]
    text(
        "nod.tof",
        "TOS 1.00", "",
        "declare SkeletalAnimation 2", "  mAnimatedJoints array instance SkeletalAnimation::AnimatedJoint",
        "  mIsLooping bool", "",
        "declare SkeletalAnimation::AnimatedJoint 2", "  mJointName string",
        "  mKeyframes array instance SkeletalAnimation::Keyframe", "",
        "declare SkeletalAnimation::Keyframe 3", "  mRotation quat", "  mTranslation vec3", "  mTime float", "",
        "object SkeletalAnimation 00000001", "  2", *keys("Hips", hips), *keys("Head", head), "  false",
    )

    rows = ["%.9g,%g,%g,%g,%.9g,%.9g,%.9g,%.9g" % (time, x, y + NECK, z, *turn(angle)) for time, (x, y, z), angle in SAMPLES]
    text("nod.csv", "# the head itself", "t_s,px_m,py_m,pz_m,qx,qy,qz,qw", *rows)


def cache():
    """docs/cache.md, by the letter. Head space: cm, y up, face along +x, about the solid's middle."""
    in_head = [(100 * z, 100 * (y - 1.5), -100 * x) for x, y, z in POINTS]
    starts = pack("I", [0, 4, 8, 12])
    tag = b"id      " + struct.pack("<Q", 24) + pack("q", [7, 8, 9])
    origin = b"origin  " + struct.pack("<Q", 32) + struct.pack("<fII3fQ", 100, 2, 4, 0, 1.5, 0, len(POINTS))
    name = b"groom.hair"
    groom = pack("I", [len(name), 0]) + name
    groom = b"groom   " + struct.pack("<Q", len(groom)) + groom + bytes(-len(groom) % 8)
    frames, places = [], []
    for _, (x, y, z), angle in SAMPLES:
        head = (100 * z, 100 * (y + NECK), -100 * x)
        frames.append(pack("f", [*head, *turn(angle)]) + pack("f", flat(in_head)))
        sine, cosine = math.sin(math.radians(angle)), math.cos(math.radians(angle))
        places += [(cosine * px + sine * pz, py, cosine * pz - sine * px) for px, py, pz in in_head]
    box = [pick(axis) for pick in (min, max) for axis in zip(*places)]
    bounds = b"bounds  " + struct.pack("<Q6f", 24, *box)
    blocks = starts + tag + origin + groom + bounds
    sums = b"sums    " + struct.pack("<Q", 8 * (len(frames) + 1))
    begin = 64 + len(blocks) + len(sums) + 8 * (len(frames) + 1)
    header = b"NABIKI\r\n" + pack("I", [1, 3, 12, 0]) + struct.pack("<QQd", len(frames), begin, RATE)
    header += bytes(range(16)) + blocks + sums
    sums_of = [xxhash.xxh3_64_intdigest(part) for part in (header, *frames)]
    binary("motion.nabiki", header, pack("Q", sums_of), *frames)


hair()
meshes()
fbx()
motion()
cache()

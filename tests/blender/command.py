"""The same scenes for the command, written by other code than the extension's, and what it makes of them."""

import struct
import subprocess

import bpy
import numpy as np

import scenes

# Blender's axes in nabiki's, for a face that looks along -y: nabiki's x, y, z are Blender's -y, z, -x.
WAY = np.array([[0, -1, 0], [0, 0, 1], [-1, 0, 0]], np.float64)

SETTINGS = """
[motion]
form = "free"
frames = {frames}
frame_rate = {rate}
time_step = 0.16
inertia_length_floor = 14.0

[free]
stiffness = {stiffness}

[wind]
ease = "{ease}"
"""


class Command:
    """The command in a folder of its own."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        folder.mkdir(parents=True, exist_ok=True)

    def __call__(self, *words):
        done = subprocess.run([str(self.program), *map(str, words)], capture_output=True, text=True, cwd=self.folder)
        assert done.returncode == 0, done.stderr
        return done.stdout

    def frames(self, scene, *words):
        """World points (cm, nabiki's axes) of each frame of a scene, float64."""
        cache = self.folder / "motion.nabiki"
        cache.unlink(missing_ok=True)
        self("simulate", scene, "-o", cache, "--quiet", *words)
        data = cache.read_bytes()
        points, _, count, at = struct.unpack_from("<IIQQ", data, 16)
        size = 28 + 12 * points
        return np.array([world(data[at + n * size : at + (n + 1) * size]) for n in range(count)])


def world(row):
    """The points of a row of a cache under its pose."""
    pose = np.frombuffer(row, "<f4", 7).astype(np.float64)
    x, y, z, w = pose[3:]
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    return np.frombuffer(row, "<f4", offset=28).reshape(-1, 3) @ turn.T + pose[:3]


def write_hair(path, points, offsets):
    segments = np.diff(offsets) - 1
    header = struct.pack("<4sIIIIfffff88s", b"HAIR", len(segments), len(points), 3, 0, 0, 0, 0, 0, 0, b"")
    path.write_bytes(header + segments.astype("<u2").tobytes() + np.float32(points).tobytes())


def write_mesh(path, thing, origin):
    """A mesh of triangles where it is in frame 1."""
    matrix = np.array(thing.matrix_world, np.float64)
    corners = np.array([v.co[:] for v in thing.data.vertices], np.float64)
    corners = 100 * (corners @ matrix[:3, :3].T + matrix[:3, 3] - origin) @ WAY.T
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.float32(corners).tolist()]
    lines += ["f " + " ".join(str(c + 1) for c in face.vertices) for face in thing.data.polygons]
    path.write_text("\n".join(lines) + "\n")


def write_track(path, matrices, origin, rate):
    """Where something is in each frame: it is at 0 and unturned in the first."""
    rows = ["t_s,px_m,py_m,pz_m,qx,qy,qz,qw"]
    for frame, matrix in enumerate(matrices):
        way = matrix @ matrices[0].inverted()
        place = WAY @ (np.array(way @ scenes.vector(origin)) - origin)
        turn = way.to_quaternion()
        x, y, z = WAY @ np.array(turn[1:])
        rows.append(",".join(repr(float(number)) for number in [frame / rate, *place, x, y, z, turn[0]]))
    path.write_text("\n".join(rows) + "\n")


def made(command, hair, forces, origin, ease="stepped", stiffness=(3000, 300)):
    """The scene of `scenes.groom` for the command. `forces`: (last frame, vector in Blender's axes) each."""
    scene = bpy.context.scene
    folder, head, ball = command.folder, bpy.data.objects["Head"], bpy.data.objects.get("Ball")
    matrices = {thing.name: [] for thing in [head, hair, ball] if thing}
    for frame in range(scene.frame_start, scene.frame_end + 1):
        scene.frame_set(frame)
        for name, known in matrices.items():
            known.append(bpy.data.objects[name].matrix_world.copy())
    scene.frame_set(scene.frame_start)
    place = np.array(matrices[hair.name][0], np.float64)
    points = scenes.positions(hair.data).astype(np.float64) @ place[:3, :3].T + place[:3, 3]
    points = np.float32(100 * (points - origin) @ WAY.T)
    counts = [curve.points_length for curve in hair.data.curves]
    write_hair(folder / "hair.hair", points, np.concatenate([[0], np.cumsum(counts)]))
    rate = scene.render.fps / scene.render.fps_base
    text = '[head]\nmesh = "head.obj"\norigin = [0, 0, 0]\n'
    write_mesh(folder / "head.obj", head, origin)
    track = 'motion = {{ file = "{}.csv", up = "+y", facing = "+x" }}\n'
    if any(matrix != matrices["Head"][0] for matrix in matrices["Head"]):
        write_track(folder / "head.csv", matrices["Head"], origin, rate)
        text += track.format("head")
    text += '\n[hair]\nfile = "hair.hair"\njoin_within = 0\norigin = [0, 0, 0]\n'
    if ball:
        write_mesh(folder / "ball.obj", ball, origin)
        write_track(folder / "ball.csv", matrices["Ball"], origin, rate)
        text += '\n[[body]]\nmesh = "ball.obj"\nmargin = 0.1\nfriction = 0.1\nstatic_friction = 0.15\n' + track.format("ball")
    frames = scene.frame_end - scene.frame_start
    text += SETTINGS.format(frames=frames, rate=rate, stiffness=list(stiffness), ease=ease)
    for last, vector in forces:
        text += f"\n[[force]]\nthrough = {last}\nvector = {(WAY @ np.array(vector)).tolist()}\n"
    (folder / "scene.toml").write_text(text)
    return folder / "scene.toml"


def rounding(command, scene, hair, *words):
    """How far the motion strays (cm) where the hair starts one rounding of its numbers away."""
    known = command.frames(scene, *words)
    data = bytearray(hair.read_bytes())
    strands, points = struct.unpack_from("<II", data, 4)
    at = 128 + 2 * strands
    numbers = np.frombuffer(bytes(data[at : at + 12 * points]), "<f4")
    data[at : at + 12 * points] = np.nextafter(numbers, np.float32(np.inf)).tobytes()
    hair.write_bytes(data)
    return known, np.abs(command.frames(scene, *words) - known).max()


def in_blender(points, origin):
    return points @ WAY / 100 + origin

"""Heads and hair on skeletons, moved here and by UsdSkel.

    python3 rigs.py write FOLDER      rigs of many kinds, each with a scene
    python3 rigs.py compare FOLDER    holds what `nabiki simulate` exported of each, as a stage and as a layer over the groom, against usd-core
"""

import math
import sys
from pathlib import Path

import numpy as np
from pxr import Gf, Sdf, Usd, UsdGeom, UsdSkel, Vt

FIRST, LAST = 1001, 1007
HEIGHT = 155.0
# Of what is compared, in the unit of the file: a head is 20 cm, and singles a few metres off have these digits.
NEAR = 2e-5

SCENE = """[head]
mesh = "{file}"
groups = ["/stage/char/head"]
facing = "{facing}"
origin = [{origin}]
motion = {{ file = "{file}", node = "{node}", bind_at_start = true }}
[hair]
file = "{file}"
join_within = 0
[motion]
form = "free"
frames = {frames}
frame_rate = 24
inertia_length_floor = 14.0
[free]
drag = 0
gravity = 0
[[force]]
through = {frames}
vector = [0, 0, 0]
"""


def at(x, y, z):
    return Gf.Matrix4d().SetTranslate((x, y, z))


def turned(axis, degrees, place=(0, 0, 0)):
    return Gf.Matrix4d().SetRotate(Gf.Rotation(Gf.Vec3d(*axis), degrees)).SetTranslateOnly(place)


class Rig:
    """A head and hair of one skeleton, in centimetres with y up, looking along z, unless a kind says otherwise."""

    unit = 1.0  # cm
    z_up = False
    length = None  # of a centimetre in the space of the joints, where that is not the file's
    joints_y_up = False  # whatever the file has
    root = ()  # operations of the prims, in order
    skeleton = ()
    mesh = ()
    root_moves = False
    geom_bind = Gf.Matrix4d(1)  # None: not written
    bind_space = Gf.Matrix4d(1)  # of bindTransforms, from the skeleton's
    rest = None  # differs from where joints are bound
    own_joints = None  # skel:joints
    inherited = False  # all of the binding stands above
    per_point = False
    first_turn = 0.0  # degrees by which the first frame is not as bound
    scale = 1.0  # of the joint that carries the head
    hair = "bound"  # or as groomed on the head of the first frame, "first", or as bound, "groomed"
    animated = ("hips", "hips/neck", "hips/neck/head")
    bound_by_ancestor = False  # of the animation
    second_animation = False
    node = "hips/neck/head"

    def __init__(self, name, **changes):
        self.name = name
        for key, value in changes.items():
            assert hasattr(Rig, key), key
            setattr(self, key, value)
        # A centimetre in the space of the joints.
        self.u = self.length or 1.0 / self.unit

    # Places in centimetres, y up, as the file has them.
    def axes(self):
        up = turned((1, 0, 0), 90) if self.z_up and not self.joints_y_up else Gf.Matrix4d(1)
        return Gf.Matrix4d().SetScale(self.u) * up

    def place(self, x, y, z):
        return self.axes().Transform(Gf.Vec3d(x, y, z))

    def joints(self, frame):
        """Where joints are above one another in a frame; `None`: when meshes were bound."""
        t = 0.0 if frame is None else float(frame - FIRST)
        turn = 0.0 if frame is None else self.first_turn + 3.0 * t
        scale = 1.0 if frame is None else self.scale
        axis = self.axes().TransformDir(Gf.Vec3d(0, 1, 0)).GetNormalized()
        nod = self.axes().TransformDir(Gf.Vec3d(1, 0, 0)).GetNormalized()
        up = lambda x, y: self.place(x, y, 0)
        hips = (up(2.0 * t, 90), Gf.Rotation(axis, 0.0), 1.0)
        neck = (up(0, 55), Gf.Rotation(nod, turn), 1.0)
        head = (up(0, HEIGHT - 145), Gf.Rotation(axis, turn), scale)
        return [hips, neck, head]

    @staticmethod
    def matrix(place, turn, scale):
        return Gf.Matrix4d().SetScale(scale) * Gf.Matrix4d().SetRotate(turn).SetTranslateOnly(place)

    def poses(self, frame):
        above, all = Gf.Matrix4d(1), []
        for joint in self.joints(frame):
            above = self.matrix(*joint) * above
            all.append(above)
        return all

    def ellipsoid(self):
        points, faces, n, m = [], [], 20, 12
        for j in range(m + 1):
            t = math.pi * j / m
            for i in range(n):
                p = 2 * math.pi * i / n
                # Longer to one side, so that no turn looks like another.
                x = 7.8 * math.sin(t) * math.cos(p) * (1.15 if math.cos(p) > 0 else 1.0)
                points.append((x, HEIGHT + 11 * math.cos(t), 9.5 * math.sin(t) * math.sin(p)))
        for j in range(m):
            for i in range(n):
                a, b = j * n + i, j * n + (i + 1) % n
                faces.append((a, b, b + n, a + n))
        return points, faces

    def strands(self, points):
        """Strands that stand on every third vertex of the upper half."""
        chosen = [p for p in points[20:120:3]]
        return [[tuple(c + (p - c) * (1 + 0.1 * k) for p, c in zip(root, (0, HEIGHT, 0))) for k in range(8)] for root in chosen]

    def write(self, folder):
        file = folder / f"{self.name}.usda"
        stage = Usd.Stage.CreateNew(str(file))
        UsdGeom.SetStageMetersPerUnit(stage, 0.01 * self.unit)
        UsdGeom.SetStageUpAxis(stage, "Z" if self.z_up else "Y")
        stage.SetStartTimeCode(FIRST), stage.SetEndTimeCode(LAST), stage.SetTimeCodesPerSecond(24)
        UsdGeom.Xform.Define(stage, "/stage")
        root = UsdSkel.Root.Define(stage, "/stage/char")
        operate(root, self.root)
        if self.root_moves:
            way = UsdGeom.Xformable(root).AddTranslateOp(opSuffix="way")
            for frame in range(FIRST, LAST + 1):
                way.Set(Gf.Vec3d(self.place(5.0 * (frame - FIRST), 0, 1)), frame)
        rig = UsdSkel.Skeleton.Define(stage, "/stage/char/rig")
        operate(rig, self.skeleton)
        names = ["hips", "hips/neck", "hips/neck/head"]
        rig.CreateJointsAttr(names)
        rig.CreateBindTransformsAttr([pose * self.bind_space for pose in self.poses(None)])
        rig.CreateRestTransformsAttr(self.rest or [self.matrix(*joint) for joint in self.joints(None)])
        animation = UsdSkel.Animation.Define(stage, "/stage/char/rig/walk")
        numbers = [names.index(joint) for joint in self.animated]
        animation.CreateJointsAttr(list(self.animated))
        for frame in range(FIRST, LAST + 1):
            joints = [self.joints(frame)[number] for number in numbers]
            animation.CreateTranslationsAttr().Set(Vt.Vec3fArray([Gf.Vec3f(place) for place, _, _ in joints]), frame)
            animation.CreateRotationsAttr().Set(Vt.QuatfArray([Gf.Quatf(turn.GetQuat()) for _, turn, _ in joints]), frame)
            animation.CreateScalesAttr().Set(Vt.Vec3hArray([Gf.Vec3h(scale) for _, _, scale in joints]), frame)
        if self.second_animation:
            other = UsdSkel.Animation.Define(stage, "/stage/char/other")
            other.CreateJointsAttr(names)
            other.CreateTranslationsAttr([(0, 0, 0)] * 3), other.CreateRotationsAttr([Gf.Quatf(1)] * 3)
            other.CreateScalesAttr([(1, 1, 1)] * 3)
        bond = UsdSkel.BindingAPI.Apply((root if self.bound_by_ancestor else rig).GetPrim())
        bond.CreateAnimationSourceRel().SetTargets([animation.GetPath()])

        points, faces = self.ellipsoid()
        strands = self.strands(points)
        # What geomBindTransform takes to where bindTransforms are.
        back = self.bind_space * (self.geom_bind or Gf.Matrix4d(1)).GetInverse()
        own = lambda p: Gf.Vec3f(back.Transform(self.place(*p)))
        mesh = UsdGeom.Mesh.Define(stage, "/stage/char/head")
        mesh.CreatePointsAttr([own(p) for p in points])
        mesh.CreateFaceVertexCountsAttr([4] * len(faces))
        mesh.CreateFaceVertexIndicesAttr([corner for face in faces for corner in face])
        mesh.CreateSubdivisionSchemeAttr("none")
        operate(mesh, self.mesh)
        above = "/stage/char" if self.hair == "bound" else "/stage"
        curves = UsdGeom.BasisCurves.Define(stage, f"{above}/hair")
        curves.CreateTypeAttr("linear"), curves.CreateWrapAttr("nonperiodic")
        curves.CreateCurveVertexCountsAttr([len(strand) for strand in strands])
        flat = [p for strand in strands for p in strand]
        if self.hair == "bound":
            curves.CreatePointsAttr([own(p) for p in flat])
            operate(curves, self.mesh)
        else:
            world = self.skinning(stage, None if self.hair == "groomed" else FIRST)
            curves.CreatePointsAttr([Gf.Vec3f(world.Transform(self.place(*p))) for p in flat])
        gprims = [mesh] + ([curves] if self.hair == "bound" else [])
        number = 0 if self.own_joints else 2
        for gprim in [root] if self.inherited else gprims:
            bond = UsdSkel.BindingAPI.Apply(gprim.GetPrim())
            bond.CreateSkeletonRel().SetTargets([rig.GetPath()])
            if self.per_point:
                n = len(UsdGeom.PointBased(gprim).GetPointsAttr().Get())
                bond.CreateJointIndicesPrimvar(False, 2).Set([number, number] * n)
                bond.CreateJointWeightsPrimvar(False, 2).Set([0.75, 0.25] * n)
            else:
                bond.CreateJointIndicesPrimvar(True, 1).Set([number])
                bond.CreateJointWeightsPrimvar(True, 1).Set([1.0])
            if self.own_joints:
                bond.CreateJointsAttr(self.own_joints)
            if self.geom_bind is not None:
                bond.CreateGeomBindTransformAttr(self.geom_bind)
        stage.Save()
        stage.Export(str(folder / f"{self.name}_binary.usdc"))
        # The middle of the head, where the layer has it in the pose in which it is read.
        pose = None if self.hair == "groomed" else FIRST
        middle = self.skinning(stage, pose).Transform(self.place(0, HEIGHT, 0))
        for source in [file.name, f"{self.name}_binary.usdc"]:
            scene = SCENE.format(
                file=source,
                facing="-y" if self.z_up else "+z",
                origin=", ".join(repr(round(x, 9)) for x in middle),
                node=self.node,
                frames=LAST - FIRST,
            )
            (folder / f"{source}.toml").write_text(scene)

    def skinning(self, stage, frame):
        """What takes the head as it was made to the world, in a frame; `None`: as it was bound, in the first."""
        time = FIRST if frame is None else frame
        world = UsdGeom.XformCache(time).GetLocalToWorldTransform(stage.GetPrimAtPath("/stage/char/rig"))
        if frame is None:
            return self.bind_space * world
        return self.poses(None)[2].GetInverse() * self.poses(frame)[2] * world


def operate(prim, operations):
    for kind, value in operations:
        operation = getattr(UsdGeom.Xformable(prim), f"Add{kind}Op")()
        operation.Set(value)


MOVED = (("Translate", Gf.Vec3d(100, 0, -20)),)
TWISTED = (("Translate", Gf.Vec3d(100, 0, -20)), ("RotateXYZ", Gf.Vec3f(20, -50, 10)), ("Scale", Gf.Vec3f(1.5, 1.5, 1.5)))

RIGS = [
    Rig("plain"),
    Rig("root_moved", root=MOVED),
    # The name of the mesh as well as of the joint.
    Rig("named", root=MOVED, node="head"),
    Rig("named_by_the_mesh", root=MOVED, node="/stage/char/head"),
    Rig("root_twisted", root=TWISTED),
    Rig("root_moves", root=TWISTED, root_moves=True),
    Rig("mesh_moved", mesh=TWISTED),
    Rig("skeleton_moved", root=MOVED, skeleton=TWISTED),
    Rig("geom_bind", geom_bind=turned((0, 0, 1), 30, (4, -70, 8)), root=MOVED),
    Rig("no_geom_bind", geom_bind=None, mesh=MOVED, root=MOVED),
    Rig("bound_in_the_world", root=MOVED, bind_space=at(100, 0, -20), geom_bind=at(100, 0, -20)),
    Rig("rest_elsewhere", animated=("hips", "hips/neck"), rest=[at(0, 90, 0), at(0, 55, 0), turned((0, 1, 0), 40, (3, 12, 1))]),
    Rig("not_as_bound", first_turn=25.0, root=MOVED),
    Rig("scaled_joint", scale=1.25, first_turn=10.0),
    Rig("own_joints", own_joints=["hips/neck/head"], root=MOVED),
    Rig("inherited", inherited=True, root=TWISTED, mesh=MOVED),
    Rig("per_point", per_point=True, root=MOVED, mesh=MOVED),
    Rig("in_metres", unit=100.0, root=(("Translate", Gf.Vec3d(1, 0, -0.2)),)),
    Rig("z_up", z_up=True, root=MOVED),
    Rig("z_up_in_metres", z_up=True, unit=100.0, root=(("RotateZ", 30.0),), first_turn=5.0),
    Rig("armature_of_a_hundredth", unit=100.0, z_up=True, length=1.0, joints_y_up=True, root=(("Scale", Gf.Vec3f(0.01)), ("RotateX", 90.0))),
    Rig("animation_from_above", bound_by_ancestor=True, second_animation=True),
    Rig("hair_of_the_first_frame", hair="first", first_turn=25.0, root=MOVED),
    Rig("hair_as_bound", hair="groomed", first_turn=25.0, root=MOVED),
]


def world_of(stage, path, time):
    prim = stage.GetPrimAtPath(path)
    matrix = np.array(UsdGeom.XformCache(time).GetLocalToWorldTransform(prim))
    points = np.array(UsdGeom.PointBased(prim).GetPointsAttr().Get(time), float)
    return points @ matrix[:3, :3] + matrix[3, :3]


def over(folder, name, layer):
    """The stage with a layer over it, of whose hair UsdSkel keeps away."""
    root = Sdf.Layer.CreateNew(str(folder / f"{name}.over.{layer}.usda"))
    root.subLayerPaths = [f"./{name}.{layer}", f"./{name}"]
    stage = Usd.Stage.Open(root)
    char = UsdSkel.Root(stage.GetPrimAtPath("/stage/char"))
    cache = UsdSkel.Cache()
    cache.Populate(char, Usd.PrimDefaultPredicate)
    bindings = cache.ComputeSkelBindings(char, Usd.PrimDefaultPredicate)
    skinned = [str(query.GetPrim().GetPath()) for binding in bindings for query in binding.GetSkinningTargets()]
    assert skinned == ["/stage/char/head"], f"{name}, {layer}: UsdSkel moves {skinned}"
    return stage


def compare(folder):
    for rig in RIGS:
        source = Usd.Stage.Open(str(folder / f"{rig.name}.usda"))
        baked = Usd.Stage.CreateInMemory()
        baked.GetRootLayer().TransferContent(source.GetRootLayer())
        assert UsdSkel.BakeSkinning(baked.Traverse()), rig.name
        for ending in ["usda", "binary.usdc"]:
            name = f"{rig.name}.usda" if ending == "usda" else f"{rig.name}_binary.usdc"
            found = Usd.Stage.Open(str(folder / f"{name}.out.usda"))
            layers = [over(folder, name, layer) for layer in ["layer.usda", "layer.usdc"] if rig.hair == "bound"]
            worst = 0.0
            for frame in range(FIRST, LAST + 1):
                hair = "/stage/char/hair" if rig.hair == "bound" else "/stage/hair"
                expected = world_of(baked, hair, frame)
                if rig.hair != "bound":
                    # Not bound, it stays in the layer: here it goes with the head on which it was groomed.
                    start = rig.skinning(source, None if rig.hair == "groomed" else FIRST)
                    carried = np.array(start.GetInverse() * rig.skinning(source, frame))
                    expected = world_of(source, hair, FIRST) @ carried[:3, :3] + carried[3, :3]
                strands = world_of(found, "/head/hair", frame)
                skin, of_skin = world_of(baked, "/stage/char/head", frame), world_of(found, "/head/skin", frame)
                off = np.abs(strands - expected).max()
                for layer in layers:
                    off = max(off, np.abs(world_of(layer, hair, frame) - expected).max())
                corners = [np.abs(np.array([side(of_skin, 0) - side(skin, 0), side(of_skin, 1) - side(skin, 1)])).max()]
                size = max(np.abs(expected).max(), 20 / rig.unit)
                worst = max(worst, off / size, max(corners) / size)
            assert worst <= NEAR, f"{name}: {worst * size * rig.unit:.4f} cm off"
    print(f"UsdSkel: {len(RIGS)} rigs, text and binary: hair and head where usd-core has them in every frame, layers over them too")


def side(points, which):
    """The lowest or highest corner of the points' box: vertices are numbered anew."""
    return points.max(0) if which else points.min(0)


def main():
    command, folder = sys.argv[1], Path(sys.argv[2])
    if command == "write":
        folder.mkdir(parents=True, exist_ok=True)
        for old in folder.iterdir():
            old.unlink()
        for rig in RIGS:
            rig.write(folder)
    else:
        compare(folder)


if __name__ == "__main__":
    main()

"""Hair on skin that bends: roots are where usd-core has the skin, in every frame.

    python3 skins.py write FOLDER      four heads that bend, each with hair that stands still
    python3 skins.py compare FOLDER    holds what `nabiki simulate` exported of each against usd-core
"""

import math
import sys
from pathlib import Path

import numpy as np
from pxr import Gf, Usd, UsdGeom, UsdSkel, Vt

LAST = 36
ROWS, COLUMNS = 24, 32
HEIGHT = 160.0
# A ten-thousandth of a centimetre: single precision has 2e-5 cm at two metres.
NEAR_CM = 1e-4


def head():
    """Places of a ball (cm, y up), its triangles, and those that carry hair."""
    down, around = np.pi * np.arange(ROWS + 1) / ROWS, 2 * np.pi * np.arange(COLUMNS) / COLUMNS
    down, around = np.meshgrid(down, around, indexing="ij")
    out = np.stack([np.sin(down) * np.cos(around), np.cos(down), np.sin(down) * np.sin(around)], -1).reshape(-1, 3)
    points = out * [9.5, 11.0, 7.8] + [0, HEIGHT, 0]
    triangles = []
    for row in range(ROWS):
        for column in range(COLUMNS):
            a, b = row * COLUMNS + column, row * COLUMNS + (column + 1) % COLUMNS
            triangles += [[a, b, a + COLUMNS], [b, b + COLUMNS, a + COLUMNS]]
    triangles = np.array(triangles)
    middles = points[triangles].mean(1)
    # None of those without an area at the poles, and none on the face.
    grown = [t for t in range(2 * COLUMNS, len(triangles), 7) if middles[t, 1] > HEIGHT - 2 and middles[t, 0] < 4]
    return points, triangles, grown


def turned(axis, degrees):
    return Gf.Quatf(Gf.Rotation(Gf.Vec3d(*axis), degrees).GetQuat())


class Kind:
    def __init__(self, name, joints=False, shapes=False, points=False, metres=False):
        self.name, self.joints, self.shapes, self.points, self.metres = name, joints, shapes, points, metres

    def place(self, points):
        """From centimetres and y up to the file's space."""
        if not self.metres:
            return points
        return np.stack([points[:, 0], -points[:, 2], points[:, 1]], -1) / 100

    def write(self, folder):
        points, triangles, grown = head()
        stage = Usd.Stage.CreateNew(str(folder / f"{self.name}.usda"))
        UsdGeom.SetStageMetersPerUnit(stage, 1.0 if self.metres else 0.01)
        UsdGeom.SetStageUpAxis(stage, "Z" if self.metres else "Y")
        stage.SetStartTimeCode(0)
        stage.SetEndTimeCode(LAST)
        stage.SetTimeCodesPerSecond(24)
        stage.SetFramesPerSecond(24)
        root = UsdSkel.Root.Define(stage, "/char")
        UsdGeom.XformCommonAPI(root).SetTranslate(Gf.Vec3d(*self.place(np.array([[30.0, 0, 5]]))[0]))
        mesh = UsdGeom.Mesh.Define(stage, "/char/head")
        array = lambda values: Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(values, dtype=np.float32))
        mesh.CreatePointsAttr(array(self.place(points)))
        mesh.CreateFaceVertexCountsAttr([3] * len(triangles))
        mesh.CreateFaceVertexIndicesAttr(triangles.reshape(-1).tolist())
        if self.points:
            for n in range(LAST + 1):
                swell = 1 + 0.1 * math.sin(0.4 * n) * np.sin(0.3 * points[:, :1])
                mesh.GetPointsAttr().Set(array(self.place((points - [0, HEIGHT, 0]) * swell + [0, HEIGHT, 0])), n)
        if self.joints or self.shapes:
            self.bind(stage, mesh, points)
        hair = UsdGeom.BasisCurves.Define(stage, "/char/hair")
        hair.CreateTypeAttr("linear")
        roots = (mesh_at(mesh, 0) if self.points else points if not self.metres else self.place(points))
        strands = []
        for t in grown:
            at = roots[triangles[t]].mean(0)
            out = at - roots.mean(0)
            out /= np.linalg.norm(out)
            length = 0.01 if self.metres else 1.0
            strands += [at + i * length * out for i in range(9)]
        hair.CreateCurveVertexCountsAttr([9] * len(grown))
        hair.CreatePointsAttr(array(np.array(strands)))
        stage.Save()

    def bind(self, stage, mesh, points):
        skeleton = UsdSkel.Skeleton.Define(stage, "/char/rig")
        animation = UsdSkel.Animation.Define(stage, "/char/rig/walk")
        names = ["neck", "neck/head"]
        places = self.place(np.array([[0, HEIGHT - 14, 0], [0, HEIGHT - 6, 0.0]]))
        bound = [Gf.Matrix4d().SetTranslate(Gf.Vec3d(*place)) for place in places.tolist()]
        skeleton.CreateJointsAttr(names)
        skeleton.CreateBindTransformsAttr(bound)
        rest = [bound[0], bound[1] * bound[0].GetInverse()]
        skeleton.CreateRestTransformsAttr(rest)
        animation.CreateJointsAttr(names)
        moves, turns = animation.CreateTranslationsAttr(), animation.CreateRotationsAttr()
        animation.CreateScalesAttr([Gf.Vec3h(1, 1, 1)] * 2)
        for n in range(LAST + 1):
            way = [Gf.Vec3f(*matrix.ExtractTranslation()) for matrix in rest]
            way[0] += Gf.Vec3f(*self.place(np.array([[2.0 * n, 2 * abs(math.sin(0.3 * n)), 0]]))[0].tolist())
            moves.Set(Vt.Vec3fArray(way), n)
            turns.Set(Vt.QuatfArray([turned((0, 0, 1), 8 * math.sin(0.3 * n)), turned((0.6, 0.8, 0), 30 * math.sin(0.2 * n))]), n)
        UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().SetTargets(["/char/rig/walk"])
        binding = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
        binding.CreateSkeletonRel().SetTargets(["/char/rig"])
        # The head joint alone, or both over the whole height.
        share = np.clip((points[:, 1] - HEIGHT + 11) / 22, 0, 1) if self.joints else np.ones(len(points))
        weights = np.stack([1 - share, share], -1).astype(np.float32)
        binding.CreateJointIndicesPrimvar(False, 2).Set(Vt.IntArray([0, 1] * len(points)))
        binding.CreateJointWeightsPrimvar(False, 2).Set(Vt.FloatArray.FromNumpy(weights.reshape(-1)))
        if self.shapes:
            animation.CreateBlendShapesAttr(["brows"])
            weigh = animation.CreateBlendShapeWeightsAttr()
            for n in range(LAST + 1):
                weigh.Set([0.5 + 0.5 * math.sin(0.5 * n)], n)
            binding.CreateBlendShapesAttr(["brows"])
            binding.CreateBlendShapeTargetsRel().SetTargets(["/char/head/brows"])
            shape = UsdSkel.BlendShape.Define(stage, "/char/head/brows")
            lifted = np.nonzero(points[:, 1] > HEIGHT)[0]
            offsets = self.place(np.stack([0 * lifted, 1.5 * np.sin(points[lifted, 0]), 0.5 + 0 * lifted], -1))
            shape.CreatePointIndicesAttr(Vt.IntArray.FromNumpy(lifted.astype(np.int32)))
            shape.CreateOffsetsAttr(Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(offsets, dtype=np.float32)))

    def compare(self, folder):
        stage = Usd.Stage.Open(str(folder / f"{self.name}.usda"))
        _, triangles, grown = head()
        if self.joints or self.shapes:
            assert UsdSkel.BakeSkinning(UsdSkel.Root(stage.GetPrimAtPath("/char")), Gf.Interval(0, LAST))
        mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/char/head"))
        moved = Usd.Stage.Open(str(folder / f"{self.name}.out.usda"))
        hair = UsdGeom.BasisCurves(next(prim for prim in moved.Traverse() if prim.GetTypeName() == "BasisCurves"))
        counts = np.array(hair.GetCurveVertexCountsAttr().Get())
        starts = np.concatenate([[0], np.cumsum(counts)[:-1]])
        assert len(starts) == len(grown), (self.name, len(starts), len(grown))
        worst = way = 0.0
        for n in range(LAST + 1):
            expected = world(mesh, mesh_at(mesh, n), n)[triangles[grown]].mean(1)
            found = world(hair, np.array(hair.GetPointsAttr().Get(n), dtype=float), n)[starts]
            off = np.linalg.norm(found - expected, axis=1)
            first = expected if n == 0 else first
            worst, way = max(worst, off.max()), max(way, np.linalg.norm(expected - first, axis=1).max())
        cm = 100.0 if self.metres else 1.0
        print(f"  {self.name}: {len(starts)} roots go up to {way * cm:.1f} cm, at most {worst * cm:.1e} cm from usd-core's skin")
        assert way * cm > 0.5 and worst * cm < NEAR_CM, self.name


def mesh_at(mesh, n):
    return np.array(mesh.GetPointsAttr().Get(n), dtype=float)


def world(prim, points, n):
    matrix = np.array(prim.ComputeLocalToWorldTransform(n))
    return points @ matrix[:3, :3] + matrix[3, :3]


KINDS = [
    Kind("joints", joints=True),
    Kind("shapes", shapes=True),
    Kind("points", points=True),
    Kind("metres", joints=True, shapes=True, metres=True),
]


def main():
    task, folder = sys.argv[1], Path(sys.argv[2])
    if task == "write":
        folder.mkdir(parents=True, exist_ok=True)
        for old in folder.iterdir():
            old.unlink()
    for kind in KINDS:
        getattr(kind, task)(folder)


if __name__ == "__main__":
    main()

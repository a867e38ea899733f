"""Grooms, meshes and motions that usd-core makes, and what it says itself of them, for Nabiki to read.

    made.py write FOLDER            the layers, and beside each what it holds
    made.py compare FOLDER          what Nabiki made of the motions
"""

import sys
from pathlib import Path

import numpy as np
from pxr import Gf, Sdf, Usd, UsdGeom, UsdSkel, Vt

STRANDS = [1_300, 20_000, 100_000]
POINTS = 8
CODES_A_SECOND = 24.0


def stage():
    made = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageMetersPerUnit(made, 0.01)
    UsdGeom.SetStageUpAxis(made, UsdGeom.Tokens.y)
    made.SetTimeCodesPerSecond(CODES_A_SECOND)
    return made


def groom(made, path, strands):
    """Strands that are all alike but for their places: long runs of equal integers."""
    hair = UsdGeom.BasisCurves.Define(made, path)
    hair.CreateTypeAttr("linear")
    hair.CreateCurveVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(strands, POINTS, "i4")))
    along = np.arange(strands * POINTS)
    points = np.stack([np.sin(along // POINTS), 0.5 * (along % POINTS), np.cos(along // POINTS)], 1).astype("f4")
    hair.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points))
    hair.CreateWidthsAttr(Vt.FloatArray([0.008]))
    hair.SetWidthsInterpolation("constant")
    primvars = UsdGeom.PrimvarsAPI(hair)
    group = primvars.CreatePrimvar("groom_group_id", Sdf.ValueTypeNames.IntArray, "uniform")
    group.Set(Vt.IntArray.FromNumpy(np.full(strands, 3, "i4")))
    layer = primvars.CreatePrimvar("layer", Sdf.ValueTypeNames.Int64Array, "uniform")
    layer.Set(Vt.Int64Array.FromNumpy(np.full(strands, 1 << 40, "i8")))
    return points


def grooms(folder):
    for strands in STRANDS:
        made = stage()
        points = groom(made, "/hair", strands)
        made.GetRootLayer().Export(str(folder / f"alike_{strands}.usdc"))
        points.tofile(folder / f"alike_{strands}.f32")
    # A groom that came by reference into a shot, flattened.
    asset = stage()
    points = groom(asset, "/groom/hair", STRANDS[0])
    asset.SetDefaultPrim(asset.GetPrimAtPath("/groom"))
    asset.GetRootLayer().Export(str(folder / "asset.usdc"))
    shot = stage()
    shot.DefinePrim("/shot/groom", "Xform").GetReferences().AddReference(str(folder / "asset.usdc"))
    shot.Flatten().Export(str(folder / "flattened.usdc"))
    points.tofile(folder / "flattened.f32")


def triangles(folder):
    """A strip of triangles: counts that are all 3."""
    made = stage()
    side = 150
    x, y = np.meshgrid(np.arange(side), np.arange(side), indexing="ij")
    points = np.stack([x, y, np.sin(x + y)], -1).reshape(-1, 3).astype("f4")
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).reshape(-1)
    faces = np.stack([corner, corner + side, corner + 1, corner + 1, corner + side, corner + side + 1], 1)
    mesh = UsdGeom.Mesh.Define(made, "/head")
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points))
    mesh.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(faces.size // 3, 3, "i4")))
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(faces.reshape(-1).astype("i4")))
    made.GetRootLayer().Export(str(folder / "triangles.usdc"))


def motion(folder):
    """Every kind of operation, each parent with samples at times of its own."""
    made = stage()
    body = UsdGeom.Xform.Define(made, "/body")
    turn = body.AddRotateXYZOp()
    for time, angles in [(0, (0, 0, 0)), (7, (30, 40, 50)), (20, (-20, 10, 5))]:
        turn.Set(Gf.Vec3f(*angles), time)
    neck = UsdGeom.Xform.Define(made, "/body/neck")
    place = neck.AddTranslateOp()
    for time, at in [(3, (0, 140, 0)), (11, (5, 150, -2))]:
        place.Set(Gf.Vec3d(*at), time)
    pivot = neck.AddTranslateOp(UsdGeom.XformOp.PrecisionFloat, "pivot")
    pivot.Set(Gf.Vec3f(0, 3, 1))
    orient = neck.AddOrientOp(UsdGeom.XformOp.PrecisionDouble)
    for time, axis, angle in [(1, (1, 2, 3), 10), (9, (3, -1, 2), 160), (16, (0, 1, 0), -100)]:
        orient.Set(Gf.Quatd(Gf.Rotation(Gf.Vec3d(*axis), angle).GetQuat()), time)
    neck.AddTranslateOp(UsdGeom.XformOp.PrecisionFloat, "pivot", True)
    head = UsdGeom.Xform.Define(made, "/body/neck/head")
    matrix = head.AddTransformOp()
    for time in (2, 6, 13):
        turned = Gf.Matrix4d().SetRotate(Gf.Rotation(Gf.Vec3d(0, 1, 0), 9 * time))
        matrix.Set(turned * Gf.Matrix4d().SetTranslate(Gf.Vec3d(time, 10, 0)), time)
    for ending in ["usda", "usdc"]:
        made.GetRootLayer().Export(str(folder / f"motion.{ending}"))


def skeleton(folder):
    made = stage()
    root = UsdSkel.Root.Define(made, "/man")
    place = UsdGeom.Xformable(root).AddTranslateOp()
    place.Set(Gf.Vec3d(0, 0, 0), 0)
    place.Set(Gf.Vec3d(0, 0, 60), 12)
    rig = UsdSkel.Skeleton.Define(made, "/man/rig")
    joints = ["hips", "hips/neck", "hips/neck/head"]
    rest = [Gf.Matrix4d().SetTranslate(Gf.Vec3d(0, y, 0)) for y in (90, 50, 10)]
    rig.CreateJointsAttr(joints)
    rig.CreateRestTransformsAttr(rest)
    rig.CreateBindTransformsAttr(rest)
    walk = UsdSkel.Animation.Define(made, "/man/rig/walk")
    walk.CreateJointsAttr([joints[2], joints[0], joints[1]])
    for time, angle in [(0, 0), (5, 40), (12, -70)]:
        turns = [Gf.Quatf(Gf.Rotation(Gf.Vec3d(*axis), angle).GetQuat()) for axis in [(1, 0, 0), (0, 1, 0), (1, 1, 1)]]
        walk.CreateRotationsAttr().Set(Vt.QuatfArray(turns), time)
    walk.CreateTranslationsAttr(Vt.Vec3fArray([Gf.Vec3f(0, 10, 1), Gf.Vec3f(0, 91, 0), Gf.Vec3f(0, 50, 0)]))
    walk.CreateScalesAttr(Vt.Vec3hArray([Gf.Vec3h(1, 1, 1)] * 3))
    UsdSkel.BindingAPI.Apply(rig.GetPrim()).CreateAnimationSourceRel().SetTargets([walk.GetPath()])
    UsdSkel.BindingAPI.Apply(root.GetPrim())
    made.GetRootLayer().Export(str(folder / "skeleton.usdc"))


def known_world(folder, name, node, time):
    made = Usd.Stage.Open(str(folder / name))
    cache = UsdGeom.XformCache(time)
    if name != "skeleton.usdc":
        return cache.GetLocalToWorldTransform(made.GetPrimAtPath(node))
    rig = UsdSkel.Skeleton.Get(made, "/man/rig")
    skeletons = UsdSkel.Cache()
    skeletons.Populate(UsdSkel.Root.Get(made, "/man"), Usd.PrimDefaultPredicate)
    query = skeletons.GetSkelQuery(rig)
    of_joints = query.ComputeJointSkelTransforms(time)
    index = list(query.GetJointOrder()).index(node)
    return of_joints[index] * cache.GetLocalToWorldTransform(rig.GetPrim())


def compare(folder):
    """Positions and rotations that Nabiki read, beside usd-core's at the same times."""
    motions = [("motion.usda", "/body/neck/head"), ("motion.usdc", "/body/neck/head"), ("skeleton.usdc", "hips/neck/head")]
    for name, node in motions:
        rows = np.loadtxt(folder / f"{name}.motion")
        assert len(rows) >= 3, name
        for time, x, y, z, qx, qy, qz, qw in rows:
            world = known_world(folder, name, node, round(time * CODES_A_SECOND, 9)).RemoveScaleShear()
            at, turn = world.ExtractTranslation(), world.ExtractRotationQuat()
            # Numbers that the layers keep as singles, at a distance of 150 cm.
            assert np.abs(np.array(at) - (x, y, z)).max() < 1e-4, f"{name}, {time} s: {at}, read as {x, y, z}"
            same = abs(np.dot([*turn.GetImaginary(), turn.GetReal()], (qx, qy, qz, qw)))
            assert 1 - same < 1e-6, f"{name}, {time} s: turned by {turn}, read as {qx, qy, qz, qw}"
    print(f"usd-core's {len(motions)} motions: the same places and turns at {len(rows)} times and more")


def main():
    folder = Path(sys.argv[2])
    if sys.argv[1] == "compare":
        return compare(folder)
    folder.mkdir(parents=True, exist_ok=True)
    grooms(folder)
    triangles(folder)
    motion(folder)
    skeleton(folder)


if __name__ == "__main__":
    main()

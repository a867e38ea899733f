"""Opens the samples with usd-core: every frame, widths, ids, axes, unit, times, and USD's own validation."""

import sys

import numpy as np
from pxr import Gf, Usd, UsdGeom, UsdValidation

from expected import FRAME_RATE, FRAMES, Expected


def validate(stage, name):
    registry = UsdValidation.ValidationRegistry()
    context = UsdValidation.ValidationContext(registry.GetOrLoadAllValidators())
    complaints = [error.GetMessage() for error in context.Validate(stage)]
    assert not complaints, f"{name}: {complaints}"


def curves(stage, expected, name, moving):
    assert UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.y, name
    assert UsdGeom.GetStageMetersPerUnit(stage) == 0.01, name
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (0, FRAMES - 1), name
    assert stage.GetTimeCodesPerSecond() == FRAME_RATE, name
    assert stage.GetDefaultPrim().GetPath() == "/head", name
    hair = UsdGeom.BasisCurves(stage.GetPrimAtPath("/head/hair"))
    assert hair.GetTypeAttr().Get() == "linear" and hair.GetWrapAttr().Get() == "nonperiodic", name
    assert list(hair.GetCurveVertexCountsAttr().Get()) == list(expected.counts), name
    times = hair.GetPointsAttr().GetTimeSamples()
    assert times == [float(frame) for frame in range(FRAMES)], name
    cache = UsdGeom.XformCache()
    for frame in range(FRAMES):
        points = np.array(hair.GetPointsAttr().Get(frame))
        assert np.array_equal(points, expected.points[frame]), f"{name}: frame {frame}"
        low, high = (np.array(corner) for corner in hair.GetExtentAttr().Get(frame))
        assert (low <= points.min(0)).all() and (high >= points.max(0)).all(), f"{name}: extent of frame {frame}"
        cache.SetTime(frame)
        world = np.array(cache.GetLocalToWorldTransform(hair.GetPrim()))
        expected.near(world, expected.poses[frame] if moving else np.eye(4), f"{name}: transform of frame {frame}")
    expected.near(hair.GetWidthsAttr().Get(), expected.widths, f"{name}: widths")
    assert hair.GetWidthsInterpolation() == "vertex", name
    primvar = lambda word: UsdGeom.PrimvarsAPI(hair).GetPrimvar(word).Get()
    expected.near(primvar("displayColor"), expected.colors, f"{name}: colours")
    expected.near(primvar("st"), expected.root_uvs, f"{name}: root UVs")
    expected.near(primvar("groom_root_uv"), expected.root_uvs, f"{name}: root UVs")
    assert list(primvar("groom_id")) == list(expected.ids), name
    assert list(primvar("groom_group_id")) == list(expected.groups), name
    assert list(primvar("groom_group_name")) == expected.group_names, name
    assert list(primvar("groom_guide")) == list(expected.guides), name
    expected.near(primvar("surface_uv_coordinate"), expected.root_uvs, f"{name}: root UVs")
    if not moving:
        assert not hair.GetVelocitiesAttr().HasAuthoredValue() and not UsdGeom.PrimvarsAPI(hair).HasPrimvar("rest"), name
        return
    assert np.array_equal(np.array(primvar("rest")), expected.points[0]), f"{name}: rest"
    for frame in range(FRAMES):
        # Velocities lead to the next frame; those of the last are those of the one before it.
        first = min(frame, FRAMES - 2)
        velocities = FRAME_RATE * (expected.points[first + 1] - expected.points[first])
        expected.near(hair.GetVelocitiesAttr().Get(frame), velocities, f"{name}: velocities of frame {frame}")


def there_and_back(expected):
    """The layer of a simulated groom lies over the groom: the same points at rest, roots that stay, tips that move."""
    shot = Usd.Stage.CreateInMemory()
    shot.GetRootLayer().subLayerPaths = [str(expected.folder / "trip.usdc"), str(expected.folder / "rest.usda")]
    hair = UsdGeom.BasisCurves(shot.GetPrimAtPath("/head/hair"))
    assert hair.GetPointsAttr().GetTimeSamples() == [0, 1, 2, 3]
    frames = [np.array(hair.GetPointsAttr().Get(frame)) for frame in range(4)]
    expected.near(frames[0], expected.points[0], "trip: rest")
    roots = np.concatenate([[0], np.cumsum(expected.counts)[:-1]])
    expected.near(frames[3][roots], expected.points[0][roots], "trip: roots")
    assert np.abs(frames[3] - frames[0]).max() > 0.01 * expected.size, "trip: nothing moved"


def placed(prim, frame):
    """The points of curves of a number each, in the world."""
    curves = UsdGeom.BasisCurves(prim)
    points = np.array(curves.GetPointsAttr().Get(frame), dtype=float)
    world = np.array(UsdGeom.XformCache(frame).GetLocalToWorldTransform(prim))
    points = (np.column_stack([points, np.ones(len(points))]) @ world)[:, :3]
    return points.reshape(len(curves.GetCurveVertexCountsAttr().Get()), -1, 3)


def spline(expected):
    """The layer over a groom of B-splines that are not pinned draws these from the simulated roots to the simulated tips."""
    shot = Usd.Stage.CreateInMemory()
    shot.GetRootLayer().subLayerPaths = [str(expected.folder / name) for name in ["spline_layer.usdc", "spline.usda"]]
    splines = shot.GetPrimAtPath("/head/hair")
    moving = Usd.Stage.Open(str(expected.folder / "spline_moving.usdc"))
    lines = moving.GetPrimAtPath("/head/hair")
    kind = UsdGeom.BasisCurves(splines)
    assert (kind.GetTypeAttr().Get(), kind.GetBasisAttr().Get()) == ("cubic", "bspline")
    assert len(kind.GetWidthsAttr().Get()) == 10, "spline: widths of the groom below"
    frames = UsdGeom.BasisCurves(lines).GetPointsAttr().GetTimeSamples()
    assert len(frames) == 4
    ends = np.array([1, 4, 1]) / 6
    for frame in frames:
        control, simulated = placed(splines, frame), placed(lines, frame)
        expected.near(ends @ control[:, :3], simulated[:, 0], f"spline: roots of frame {frame}")
        expected.near(ends @ control[:, -3:], simulated[:, -1], f"spline: tips of frame {frame}")


def main():
    expected = Expected(sys.argv[1])
    for name in ["still.usda", "still.usdc", "moving.usda", "moving.usdc"]:
        stage = Usd.Stage.Open(str(expected.folder / name))
        validate(stage, name)
        curves(stage, expected, name, name.startswith("moving"))
        skin = stage.GetPrimAtPath("/head/skin")
        assert bool(skin) == name.startswith("moving"), name
        if skin:
            mesh = UsdGeom.Mesh(skin)
            assert mesh.GetPointsAttr().Get()[1] == Gf.Vec3f(8, 0, 0)
            assert list(mesh.GetFaceVertexIndicesAttr().Get())[:3] == [0, 2, 1], name
    for name in ["layer.usda", "layer.usdc"]:
        shot = Usd.Stage.CreateInMemory()
        shot.GetRootLayer().subLayerPaths = [str(expected.folder / name), str(expected.folder / "rest.usda")]
        hair = UsdGeom.BasisCurves(shot.GetPrimAtPath("/head/hair"))
        for frame in range(FRAMES):
            points = np.array(hair.GetPointsAttr().Get(frame))
            assert np.array_equal(points, expected.points[frame]), f"{name}: frame {frame}"
        expected.near(hair.GetWidthsAttr().Get(), expected.widths, f"{name}: widths of the groom below")
        alone = Usd.Stage.Open(str(expected.folder / name))
        validate(alone, name)
        own = {a.GetName() for a in alone.GetPrimAtPath("/head/hair").GetAuthoredAttributes()}
        # The groom's own velocities are not those of these points.
        blocked = {"velocities", "accelerations"}
        assert own == {"points", "extent"} | blocked, f"{name}: {own}"
        assert all(hair.GetPrim().GetAttribute(a).GetResolveInfo().ValueIsBlocked() for a in blocked), name
    there_and_back(expected)
    spline(expected)
    version = ".".join(map(str, Usd.GetVersion()))
    print(f"usd-core {version}: 4 stages and 2 layers, {FRAMES} frames each, and no complaint from its validators")


if __name__ == "__main__":
    main()

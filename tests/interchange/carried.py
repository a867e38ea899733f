"""Primvars of every type that curves may have, written by usd-core, and what is left of them after Nabiki.

    carried.py write LAYER            the layer
    carried.py compare LAYER BACK     types and values, but for what has no place in Alembic where BACK came through it
"""

import sys

import numpy as np
from pxr import Gf, Sdf, Usd, UsdGeom, Vt

STRANDS, POINTS = 20, 4
TYPES = Sdf.ValueTypeNames


def carried():
    """Name, type, interpolation and value."""
    each = range(STRANDS)
    triples = [Gf.Vec3f(i / 3, 0.25, 1) for i in range(STRANDS * POINTS)]
    return [
        ("loose", TYPES.BoolArray, "uniform", Vt.BoolArray([i % 2 == 0 for i in each])),
        ("byte", TYPES.UCharArray, "uniform", Vt.UCharArray([10 * i for i in each])),
        ("whole", TYPES.IntArray, "uniform", Vt.IntArray([-i for i in each])),
        ("natural", TYPES.UIntArray, "uniform", Vt.UIntArray([2**32 - 1 - i for i in each])),
        ("long", TYPES.Int64Array, "uniform", Vt.Int64Array([-(2**53) - 1 - i for i in each])),
        ("hash", TYPES.UInt64Array, "uniform", Vt.UInt64Array([2**64 - 1 - i for i in each])),
        ("age", TYPES.HalfArray, "uniform", Vt.HalfArray([0.5 * i for i in each])),
        ("mass", TYPES.DoubleArray, "uniform", Vt.DoubleArray([i / 3 for i in each])),
        ("glow", TYPES.Color3hArray, "vertex", Vt.Vec3hArray([Gf.Vec3h(0.5, i % 7, 1) for i in range(STRANDS * POINTS)])),
        ("tint", TYPES.Color3fArray, "vertex", Vt.Vec3fArray(triples)),
        ("nearby", TYPES.Normal3fArray, "vertex", Vt.Vec3fArray(triples)),
        ("UVMap", TYPES.TexCoord2fArray, "uniform", Vt.Vec2fArray([Gf.Vec2f(i / 7, 0.5) for i in each])),
        ("mood", TYPES.StringArray, "uniform", Vt.StringArray([f"mood {i}" for i in each])),
        ("stiffness", TYPES.Float, "constant", 0.1),
        ("combed", TYPES.Bool, "constant", True),
        ("far", TYPES.Int64, "constant", -(2**60) - 1),
        ("pivot", TYPES.Point3f, "constant", Gf.Vec3f(0.1, 0.2, 0.3)),
        ("frame", TYPES.Matrix4d, "constant", Gf.Matrix4d(2)),
        ("side", TYPES.Token, "constant", "left"),
        ("list", TYPES.FloatArray, "constant", Vt.FloatArray([0.5])),
    ]


# Alembic has no tokens, and takes a list of one value for that value.
NOT_IN_ALEMBIC = {"side", "list"}


def write(path):
    made = Usd.Stage.CreateNew(path)
    UsdGeom.SetStageMetersPerUnit(made, 0.01)
    UsdGeom.SetStageUpAxis(made, UsdGeom.Tokens.y)
    hair = UsdGeom.BasisCurves.Define(made, "/hair")
    hair.CreateTypeAttr("linear")
    hair.CreateCurveVertexCountsAttr(Vt.IntArray([POINTS] * STRANDS))
    hair.CreatePointsAttr(Vt.Vec3fArray([Gf.Vec3f(i // POINTS, i % POINTS, 0) for i in range(STRANDS * POINTS)]))
    for name, kind, interpolation, value in carried():
        UsdGeom.PrimvarsAPI(hair).CreatePrimvar(name, kind, interpolation).Set(value)
    made.Save()


def compare(path, back):
    through_alembic = ".abc." in back
    found = Usd.Stage.Open(back)
    primvars = UsdGeom.PrimvarsAPI(found.GetPrimAtPath("/head/hair"))
    known = Usd.Stage.Open(path)
    original = UsdGeom.PrimvarsAPI(known.GetPrimAtPath("/hair"))
    for name, kind, interpolation, _ in carried():
        if through_alembic and name in NOT_IN_ALEMBIC:
            continue
        primvar = primvars.GetPrimvar(name)
        assert primvar.GetTypeName() == kind, f"{back}: {name} is {primvar.GetTypeName()}, was {kind}"
        assert primvar.GetInterpolation() == interpolation, f"{back}: {name} is {primvar.GetInterpolation()}"
        was = original.GetPrimvar(name).Get()
        assert np.array_equal(np.array(primvar.Get()), np.array(was)), f"{back}: {name}: {primvar.Get()}, was {was}"


if __name__ == "__main__":
    if sys.argv[1] == "write":
        write(sys.argv[2])
    else:
        compare(*sys.argv[2:4])

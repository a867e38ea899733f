#!/usr/bin/env python3
"""Writes the archives of this folder with Alembic's own library (the package alembic3d).

    python3 crates/nabiki_alembic/tests/files/make.py

Each holds two strands. In shutter.abc their points are sampled at each of three frames and a quarter of a frame later,
in shutter_xf.abc the transform above them is: z and x are the time in frames. In empty_beside.abc they stand beside
curves that were never given a sample.

In operations.abc a curve lies below each kind of operation of a transform, below three of them, and below a transform
that does not inherit. bases.abc has a cubic curve of every basis that is read, parameters.abc two curves with parameters
of several scopes, and in late.abc a mesh that moves and bends from frame 0 on lies beside curves that begin at frame 5.
In closed.abc open curves lie beside closed ones.

knots.abc has B-splines whose knots stand in the file, as modelling programs write them; hidden.abc curves and meshes that do
not show, by themselves or by what is above them; subd.abc a subdivision surface that moves; others.abc shapes that are not
read beside curves. `make.py NAME...` writes some of them only.
"""

import gc
import pathlib
import sys

from alembic3d import Abc, AbcCoreAbstract, AbcGeom
from imath import (
    Color4f,
    C4fArray,
    FloatArray,
    IntArray,
    M44d,
    UnsignedCharArray,
    UnsignedIntArray,
    V3d,
    V3f,
    V3fArray,
)

HERE = pathlib.Path(__file__).parent
FRAME = 1 / 24
SHUTTER = [0.0, 0.25]
TIMES = [frame + late for frame in range(3) for late in SHUTTER]


def hair(z=0.0, ends=AbcGeom.CurvePeriodicity.kNonPeriodic):
    points, counts = V3fArray(4), IntArray(2)
    for i, (x, y) in enumerate([(0, 0), (0, 1), (1, 0), (1, 1)]):
        points[i] = V3f(x, y, z)
    counts[0] = counts[1] = 2
    linear = AbcGeom.CurveType.kLinear
    nothing = AbcGeom.OFloatGeomParamSample(), AbcGeom.OV2fGeomParamSample(), AbcGeom.ON3fGeomParamSample()
    return AbcGeom.OCurvesSchemaSample(points, counts, linear, ends, *nothing, AbcGeom.BasisType.kNoBasis)


def shutter(archive):
    times = AbcCoreAbstract.TimeVector()
    for late in SHUTTER:
        times.append(late * FRAME)
    cycle = AbcCoreAbstract.TimeSamplingType(len(SHUTTER), FRAME)
    return archive.addTimeSampling(AbcCoreAbstract.TimeSampling(cycle, times))


def moving_points(archive):
    curves = AbcGeom.OCurves(archive.getTop(), "hair", shutter(archive)).getSchema()
    for time in TIMES:
        curves.set(hair(time))


def moving_transform(archive):
    transform = AbcGeom.OXform(archive.getTop(), "head", shutter(archive))
    for time in TIMES:
        sample = AbcGeom.XformSample()
        sample.setTranslation(V3d(time, 0, 0))
        transform.getSchema().set(sample)
    AbcGeom.OCurves(transform, "hair").getSchema().set(hair())


def curve(parent, name="curve", points=((0, 0, 0), (1, 2, 3)), basis=None):
    places, counts = V3fArray(len(points)), IntArray(1)
    for i, point in enumerate(points):
        places[i] = V3f(*point)
    counts[0] = len(points)
    kind = AbcGeom.CurveType.kCubic if basis else AbcGeom.CurveType.kLinear
    nothing = AbcGeom.OFloatGeomParamSample(), AbcGeom.OV2fGeomParamSample(), AbcGeom.ON3fGeomParamSample()
    open_ends = AbcGeom.CurvePeriodicity.kNonPeriodic
    curves = AbcGeom.OCurves(parent, name).getSchema()
    basis = basis or AbcGeom.BasisType.kNoBasis
    curves.set(AbcGeom.OCurvesSchemaSample(places, counts, kind, open_ends, *nothing, basis))
    return curves


def operations(archive):
    kinds = AbcGeom.XformOperationType

    def below(parent, name, *steps, inherits=True):
        transform, sample = AbcGeom.OXform(parent, name), AbcGeom.XformSample()
        for kind, *values in steps:
            sample.addOp(AbcGeom.XformOp(kind), *values)
        sample.setInheritsXforms(inherits)
        transform.getSchema().set(sample)
        return transform

    top = archive.getTop()
    move, scale, turn = kinds.kTranslateOperation, kinds.kScaleOperation, kinds.kRotateZOperation
    cycle = M44d((0, 1, 0, 0), (0, 0, 1, 0), (1, 0, 0, 0), (10, 20, 30, 1))
    curve(below(top, "translate", (move, V3d(10, 20, 30))))
    curve(below(top, "scale", (scale, V3d(2, 3, -4))))
    curve(below(top, "axis", (kinds.kRotateOperation, V3d(0, 0, 1), 90)))
    curve(below(top, "x", (kinds.kRotateXOperation, 90)))
    curve(below(top, "y", (kinds.kRotateYOperation, 90)))
    curve(below(top, "z", (turn, 90)))
    curve(below(top, "matrix", (kinds.kMatrixOperation, cycle)))
    curve(below(top, "several", (move, V3d(10, 0, 0)), (turn, 90), (scale, V3d(5, 1, 1))))
    outer = below(top, "outer", (move, V3d(100, 0, 0)))
    curve(below(outer, "inner", (move, V3d(0, 20, 0))))
    curve(below(outer, "apart", (move, V3d(0, 20, 0)), inherits=False))


def bases(archive):
    points = [(0, 0, 0), (1, 2, 0), (3, 1, -1), (4, 4, 2)]
    for basis in ["Bezier", "Bspline", "Catmullrom"]:
        curve(archive.getTop(), basis, points, getattr(AbcGeom.BasisType, f"k{basis}Basis"))


def closed(archive):
    AbcGeom.OCurves(archive.getTop(), "mane").getSchema().set(hair())
    AbcGeom.OCurves(archive.getTop(), "rein").getSchema().set(hair(1.0, AbcGeom.CurvePeriodicity.kPeriodic))


def filled(array, values):
    for i, value in enumerate(values):
        array[i] = value
    return array


def parameters(archive):
    curves = AbcGeom.OCurves(archive.getTop(), "hair").getSchema()
    curves.set(hair())
    more, scopes = curves.getArbGeomParams(), AbcGeom.GeometryScope

    def put(kind, name, scope, values, indices=None):
        parameter = getattr(AbcGeom, f"O{kind}GeomParam")(more, name, indices is not None, scope, 1)
        sample = getattr(AbcGeom, f"O{kind}GeomParamSample")
        parameter.set(sample(values, scope) if indices is None else sample(values, indices, scope))

    colours = [Color4f(0.125 * i, 0.25, 1, 0.5) for i in range(4)]
    put("C4f", "groom_color", scopes.kVertexScope, filled(C4fArray(4), colours))
    swapped = filled(UnsignedIntArray(2), [1, 0])
    put("Int32", "groom_group_id", scopes.kUniformScope, filled(IntArray(2), [3, 8]), swapped)
    put("Float", "range", scopes.kConstantScope, filled(FloatArray(2), [0.5, 2]))
    put("Float", "each", scopes.kUniformScope, filled(FloatArray(2), [0.5, 2]))


def late(archive):
    def uniform(start):
        return archive.addTimeSampling(AbcCoreAbstract.TimeSampling(FRAME, start * FRAME))

    head = AbcGeom.OXform(archive.getTop(), "head", uniform(0))
    for frame in range(11):
        sample = AbcGeom.XformSample()
        sample.setTranslation(V3d(10 * frame, 0, 0))
        head.getSchema().set(sample)
    curves = AbcGeom.OCurves(head, "hair", uniform(5)).getSchema()
    for frame in range(3):
        curves.set(hair(frame))
    skin = AbcGeom.OPolyMesh(head, "skin", uniform(0)).getSchema()
    corners, counts = filled(IntArray(3), [0, 1, 2]), filled(IntArray(1), [3])
    for frame in range(11):
        places = filled(V3fArray(3), [V3f(0, 0, frame), V3f(1, 0, frame), V3f(0, 1, frame)])
        skin.set(AbcGeom.OPolyMeshSchemaSample(places, corners, counts))


def empty_beside(archive):
    AbcGeom.OCurves(archive.getTop(), "bald")
    AbcGeom.OCurves(archive.getTop(), "hair").getSchema().set(hair())


POINTS = [(0, 0, 0), (1, 2, 0), (3, 1, -1), (4, 4, 2), (4.5, 3, 2)]
CLAMPED = [0, 0, 0, 0, 1, 2, 2, 2, 2]


def splines(parent, name, basis, counts, knots, orders=None, weights=None):
    sample = AbcGeom.OCurvesSchemaSample()
    points = [V3f(*point) for count in counts for point in POINTS[:count]]
    sample.setPositions(filled(V3fArray(len(points)), points))
    sample.setCurvesNumVertices(filled(IntArray(len(counts)), counts))
    types = AbcGeom.CurveType
    sample.setType(types.kVariableOrder if orders else types.kCubic)
    sample.setWrap(AbcGeom.CurvePeriodicity.kNonPeriodic)
    sample.setBasis(basis)
    sample.setKnots(filled(FloatArray(len(knots)), knots))
    if orders:
        sample.setOrders(filled(UnsignedCharArray(len(orders)), orders))
    if weights:
        sample.setPositionWeights(filled(FloatArray(len(weights)), weights))
    AbcGeom.OCurves(parent, name).getSchema().set(sample)


def knots(archive):
    top, bases = archive.getTop(), AbcGeom.BasisType
    splines(top, "clamped", bases.kBsplineBasis, [5, 5], 2 * CLAMPED)
    splines(top, "without_ends", bases.kBsplineBasis, [5, 5], 2 * CLAMPED[1:-1])
    splines(top, "no_basis", bases.kNoBasis, [5, 5], 2 * CLAMPED)
    splines(top, "even", bases.kBsplineBasis, [5, 4], [*range(9), *range(3, 11)], weights=[2] * 9)
    # Straight, quadratic and cubic.
    clamped = [0, 0, 1, 2, 2], [0, 0, 0, 1, 2, 2, 2], [3, 3, 3, 3, 5, 5, 5, 5]
    splines(top, "orders", bases.kNoBasis, [3, 4, 4], sum(clamped, []), [2, 3, 4])
    splines(top, "bezier", bases.kBezierBasis, [4], [0, 0, 0, 0, 1, 1, 1, 1], weights=[1, 2, 1, 1])


def tetrahedron(shift):
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    places = filled(V3fArray(4), [V3f(x + shift, y, z) for x, y, z in corners])
    # Clockwise from outside.
    faces = filled(IntArray(12), [0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2])
    return places, faces, filled(IntArray(4), [3] * 4)


def hidden(archive):
    def transform(parent, name, *said):
        below = AbcGeom.OXform(parent, name)
        if said:
            property = AbcGeom.CreateVisibilityProperty(below, 1)
            for value in said:
                property.setValue(value)
        return below

    archive.addTimeSampling(AbcCoreAbstract.TimeSampling(FRAME, 0))
    top, inherits = archive.getTop(), -1
    off = transform(top, "off", 0)
    curve(transform(off, "inherits", inherits), "a")
    curve(off, "b")
    curve(transform(off, "shows", 1), "c")
    curve(transform(top, "at_times", 1, 0, 1), "d")
    curve(transform(transform(off, "inherits_at_times", 0, inherits), "silent"), "e")
    curve(transform(top, "on", inherits), "f")
    for parent, name, shift in [(top, "skin", 0), (off, "ghost", 5)]:
        AbcGeom.OPolyMesh(parent, name).getSchema().set(AbcGeom.OPolyMeshSchemaSample(*tetrahedron(shift)))


def subd(archive):
    cycle = archive.addTimeSampling(AbcCoreAbstract.TimeSampling(FRAME, 0))
    head = AbcGeom.OXform(archive.getTop(), "head", cycle)
    for frame in range(3):
        sample = AbcGeom.XformSample()
        sample.setTranslation(V3d(10 + frame, 0, 0))
        head.getSchema().set(sample)
    sharp = IntArray(0), IntArray(0), FloatArray(0), IntArray(0), FloatArray(0)
    holes = filled(IntArray(1), [2])
    AbcGeom.OSubD(head, "skin").getSchema().set(AbcGeom.OSubDSchemaSample(*tetrahedron(0), *sharp, holes))
    AbcGeom.OPolyMesh(head, "eye").getSchema().set(AbcGeom.OPolyMeshSchemaSample(*tetrahedron(5)))


def others(archive):
    top = archive.getTop()
    curve(top, "hair")
    for name in ["dust", "dirt"]:
        AbcGeom.OPoints(top, name)
    AbcGeom.ONuPatch(top, "scalp")


ARCHIVES = {
    "shutter": moving_points,
    "shutter_xf": moving_transform,
    "empty_beside": empty_beside,
    "operations": operations,
    "bases": bases,
    "parameters": parameters,
    "late": late,
    "closed": closed,
    "knots": knots,
    "hidden": hidden,
    "subd": subd,
    "others": others,
}

for name in sys.argv[1:] or ARCHIVES:
    fill = ARCHIVES[name]
    archive = Abc.OArchive(str(HERE / f"{name}.abc"))
    fill(archive)
    # It is written whole when nothing holds it.
    del archive
    gc.collect()

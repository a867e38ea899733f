#!/usr/bin/env python3
"""Writes the archives of this folder with Alembic's own library (the package alembic3d).

    python3 crates/nabiki_alembic/tests/files/make.py

Each holds two strands. In shutter.abc their points are sampled at each of three frames and a quarter of a frame later,
in shutter_xf.abc the transform above them is: z and x are the time in frames. In empty_beside.abc they stand beside
curves that were never given a sample.
"""

import gc
import pathlib

from alembic3d import Abc, AbcCoreAbstract, AbcGeom
from imath import IntArray, V3d, V3f, V3fArray

HERE = pathlib.Path(__file__).parent
FRAME = 1 / 24
SHUTTER = [0.0, 0.25]
TIMES = [frame + late for frame in range(3) for late in SHUTTER]


def hair(z=0.0):
    points, counts = V3fArray(4), IntArray(2)
    for i, (x, y) in enumerate([(0, 0), (0, 1), (1, 0), (1, 1)]):
        points[i] = V3f(x, y, z)
    counts[0] = counts[1] = 2
    linear, open_ends = AbcGeom.CurveType.kLinear, AbcGeom.CurvePeriodicity.kNonPeriodic
    nothing = AbcGeom.OFloatGeomParamSample(), AbcGeom.OV2fGeomParamSample(), AbcGeom.ON3fGeomParamSample()
    return AbcGeom.OCurvesSchemaSample(points, counts, linear, open_ends, *nothing, AbcGeom.BasisType.kNoBasis)


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


def empty_beside(archive):
    AbcGeom.OCurves(archive.getTop(), "bald")
    AbcGeom.OCurves(archive.getTop(), "hair").getSchema().set(hair())


for name, fill in [("shutter", moving_points), ("shutter_xf", moving_transform), ("empty_beside", empty_beside)]:
    archive = Abc.OArchive(str(HERE / f"{name}.abc"))
    fill(archive)
    # It is written whole when nothing holds it.
    del archive
    gc.collect()

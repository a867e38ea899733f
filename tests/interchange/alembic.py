"""Opens the samples with alembic3d, Alembic's own reader: every frame, widths, ids, groups, times, transforms."""

import sys

import numpy as np
from alembic3d.Abc import IArchive, IInt16Property, IStringProperty, ISampleSelector
from alembic3d.AbcGeom import (
    CurvePeriodicity,
    CurveType,
    GeometryScope,
    ICurves,
    IInt16GeomParam,
    IInt32GeomParam,
    IP3fGeomParam,
    IPolyMesh,
    IStringGeomParam,
    IV2fGeomParam,
    IV3fGeomParam,
    IXform,
)

from expected import FRAME_RATE, FRAMES, Expected


def at(frame):
    """The sample nearest to a frame's time: alembic3d takes a bare number for seconds."""
    return ISampleSelector(frame / FRAME_RATE)


def rows(values):
    return np.array([[value[i] for i in range(len(value))] for value in values])


def attribute(kind, parameters, name, scope):
    found = kind(parameters, name)
    assert found.getScope() == scope, name
    return list(found.getExpandedValue().getVals())


def curves(schema, expected, name):
    assert schema.getNumSamples() == FRAMES and not schema.isConstant(), name
    times = schema.getTimeSampling()
    for frame in range(FRAMES):
        assert abs(times.getSampleTime(frame) - frame / FRAME_RATE) < 1e-12, name
        sample = schema.getValue(at(frame))
        assert np.array_equal(rows(sample.getPositions()).astype("f4"), expected.points[frame]), f"{name}: {frame}"
        assert list(sample.getCurvesNumVertices()) == list(expected.counts), name
        assert sample.getType() == CurveType.kLinear and sample.getWrap() == CurvePeriodicity.kNonPeriodic, name
        bounds = sample.getSelfBounds()
        expected.near(rows([bounds.min()])[0], expected.points[frame].min(0), f"{name}: bounds of {frame}")
        expected.near(rows([bounds.max()])[0], expected.points[frame].max(0), f"{name}: bounds of {frame}")
    widths = schema.getWidthsParam()
    assert widths.getScope() == GeometryScope.kVertexScope, name
    expected.near(list(widths.getExpandedValue().getVals()), expected.widths, f"{name}: widths")
    uvs = schema.getUVsParam()
    assert uvs.getScope() == GeometryScope.kUniformScope, name
    expected.near(rows(uvs.getExpandedValue().getVals()), expected.root_uvs, f"{name}: root UVs")
    more, uniform = schema.getArbGeomParams(), GeometryScope.kUniformScope
    assert attribute(IInt32GeomParam, more, "groom_id", uniform) == list(expected.ids), name
    assert attribute(IInt32GeomParam, more, "groom_group_id", uniform) == list(expected.groups), name
    assert attribute(IStringGeomParam, more, "groom_group_name", uniform) == expected.group_names, name
    assert attribute(IInt16GeomParam, more, "groom_guide", uniform) == list(expected.guides), name
    expected.near(rows(attribute(IV2fGeomParam, more, "groom_root_uv", uniform)), expected.root_uvs, name)
    expected.near(rows(attribute(IV2fGeomParam, more, "surface_uv_coordinate", uniform)), expected.root_uvs, name)
    expected.near(rows(attribute(IV3fGeomParam, more, "groom_color", GeometryScope.kVertexScope)), expected.colors, name)


def motion(schema, expected, name):
    """Velocities and rest positions of the archive that moves."""
    more = schema.getArbGeomParams()
    rest = rows(attribute(IP3fGeomParam, more, "rest", GeometryScope.kVertexScope))
    assert np.array_equal(rest.astype("f4"), expected.points[0]), name
    for frame in range(FRAMES):
        first = min(frame, FRAMES - 2)
        velocities = FRAME_RATE * (expected.points[first + 1] - expected.points[first])
        expected.near(rows(schema.getValue(at(frame)).getVelocities()), velocities, f"{name}: velocities of {frame}")


def transform(schema, expected, name, moving):
    for frame in range(FRAMES):
        matrix = schema.getValue(at(frame)).getMatrix()
        found = np.array([[matrix[i][j] for j in range(4)] for i in range(4)])
        expected.near(found, expected.poses[frame] if moving else np.eye(4), f"{name}: transform of frame {frame}")
    assert schema.getNumSamples() == FRAMES and schema.isConstant() != moving, name
    groom = schema.getUserProperties()
    assert IInt16Property(groom, "groom_version_major").getValue() == 1, name
    assert IInt16Property(groom, "groom_version_minor").getValue() == 5, name
    assert IStringProperty(groom, "groom_tool").getValue().startswith("Nabiki "), name


def main():
    expected = Expected(sys.argv[1])
    for name in ["still.abc", "moving.abc"]:
        moving = name.startswith("moving")
        top = IArchive(str(expected.folder / name)).getTop()
        head = IXform(top, "head")
        transform(head.getSchema(), expected, name, moving)
        curves(ICurves(head, "hair").getSchema(), expected, name)
        children = [head.getChild(i).getName() for i in range(head.getNumChildren())]
        assert children == (["hair", "skin"] if moving else ["hair"]), name
        if moving:
            motion(ICurves(head, "hair").getSchema(), expected, name)
            mesh = IPolyMesh(head, "skin").getSchema().getValue()
            assert rows(mesh.getPositions())[1].tolist() == [8, 0, 0], name
            assert list(mesh.getFaceIndices())[:3] == [1, 2, 0], name
    print(f"alembic3d: 2 archives, {FRAMES} frames each, every attribute")


if __name__ == "__main__":
    main()

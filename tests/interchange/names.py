"""Attributes of names that USD does not allow, or that become one there: each is in the layer, under a name of its own.

    names.py write ARCHIVE            curves with such attributes, by alembic3d
    names.py compare CONVERTED        a layer, opened by usd-core, or an archive, by alembic3d
"""

import sys

NAMES = [
    "a b", "a_b", "a-b", "a.b", "ns::attr", "ns:attr", ":front", "trailing:", "a:1", "1st", "_", " ", "x:indices",
    "groom id", "display-Color", "quote\"d", "apo'strophe", "back\\slash", "line\nbreak", "esc\x1bape", "#comment",
    "bracket[0]", "brace}", "equals = 1", "<path>", "@asset@", "名前", "名 前", "髪:長さ", "é", "e\u0301", "ÿ·ÿ", "🙂", "😀",
    "long" * 200, "long" * 200 + "er", "float", "timeSamples", "a.timeSamples", "a.connect", "def", "None",
]  # fmt: skip


def value(i):
    return [float(i + 1), float(i) + 0.5]


def write(path):
    from alembic3d.Abc import OArchive
    from alembic3d.AbcGeom import CurvePeriodicity, CurveType, GeometryScope, OCurves, OCurvesSchemaSample
    from alembic3d.AbcGeom import OFloatGeomParam, OFloatGeomParamSample
    from imath import FloatArray, IntArray, V3fArray, V3f

    archive = OArchive(path)
    curves = OCurves(archive.getTop(), "hair")
    points, counts = V3fArray(4), IntArray(2)
    for i in range(4):
        points[i] = V3f(i // 2, i % 2, 0)
    counts[0] = counts[1] = 2
    schema = curves.getSchema()
    schema.set(OCurvesSchemaSample(points, counts, CurveType.kLinear, CurvePeriodicity.kNonPeriodic))
    for i, name in enumerate(NAMES):
        values = FloatArray(2)
        values[0], values[1] = value(i)
        param = OFloatGeomParam(schema.getArbGeomParams(), name, False, GeometryScope.kUniformScope, 1)
        param.set(OFloatGeomParamSample(values, GeometryScope.kUniformScope))


def found_in_layer(path):
    from pxr import Sdf, Usd, UsdGeom

    stage = Usd.Stage.Open(path)
    prim = stage.GetPrimAtPath("/head/hair")
    for name in prim.GetPropertyNames():
        assert Sdf.Path.IsValidNamespacedIdentifier(name), f"{path}: {name}"
    primvars = [p for p in UsdGeom.PrimvarsAPI(prim).GetPrimvars() if p.HasValue()]
    floats = [p for p in primvars if p.GetTypeName() == Sdf.ValueTypeNames.FloatArray]
    return {p.GetPrimvarName(): [float(x) for x in p.Get()] for p in floats}


def found_in_archive(path):
    from alembic3d.Abc import IArchive
    from alembic3d.AbcGeom import ICurves, IFloatGeomParam

    head = IArchive(path).getTop().getChild(0)
    parameters = ICurves(head, "hair").getSchema().getArbGeomParams()
    headers = [parameters.getPropertyHeader(i) for i in range(parameters.getNumProperties())]
    names = [header.getName() for header in headers]
    assert len(set(names)) == len(names), f"{path}: {names}"
    floats = [header for header in headers if IFloatGeomParam.matches(header)]
    return {h.getName(): list(IFloatGeomParam(parameters, h.getName()).getExpandedValue().getVals()) for h in floats}


def compare(path):
    found = found_in_archive(path) if path.endswith(".abc") else found_in_layer(path)
    for i, name in enumerate(NAMES):
        under = [name for name, values in found.items() if values == value(i)]
        assert len(under) == 1, f"{path}: {name!r} is under {under}"
    allowed = ["a_b", "ns:attr", "_", "float", "timeSamples", "def", "None"]
    if not path.endswith(".abc"):
        allowed += ["名前", "髪:長さ", "é", "e\u0301", "ÿ·ÿ"]
    for name in allowed:
        assert found[name] == value(NAMES.index(name)), f"{path}: {name} should be kept"


if __name__ == "__main__":
    {"write": write, "compare": compare}[sys.argv[1]](sys.argv[2])

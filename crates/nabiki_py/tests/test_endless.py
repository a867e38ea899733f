"""What holds itself, lies too deep or stands for more than there is room for is refused, whichever way it comes in."""

import collections
import copy
import pickle
import subprocess
import sys

import numpy
import pytest
from conftest import SCENES

import nabiki

DEEP = 20_000


class Endless:
    """As a dictionary it is another one of its kind."""

    def to_dict(self):
        return {"frames": Endless()}


class Itself:
    def tolist(self):
        return self


class Links(collections.abc.Mapping):
    """A mapping of one's own that leads to itself."""

    def __getitem__(self, key):
        return self

    def __iter__(self):
        return iter(["frames"])

    def __len__(self):
        return 1


def values():
    """Name and maker of each; none is kept, since Python itself follows some of them when it takes them apart."""

    def dictionary():
        d = {}
        d["free"] = d["frames"] = d["mesh"] = d["file"] = d
        return d

    def list_():
        endless = []
        endless.append(endless)
        return endless

    def pair():
        endless = [5]
        endless.append(endless)
        return endless

    def by_way_of_a_tuple():
        endless = []
        endless.append((endless, {"frames": endless}))
        return endless

    def array():
        endless = numpy.empty(2, object)
        endless[0] = endless[1] = endless
        return endless

    def deep_list():
        deep = []
        for _ in range(DEEP):
            deep = [deep]
        return deep

    def deep_tuple():
        deep = ()
        for _ in range(DEEP):
            deep = (5, deep)
        return deep

    def deep_dictionary():
        deep = {}
        for _ in range(DEEP):
            deep = {"frames": deep}
        return deep

    def folded():
        """Two lists deep it is four values, sixty deep more than all memory holds."""
        folded = [1.0]
        for _ in range(60):
            folded = [folded, folded]
        return folded

    def wide():
        wide = [1.0] * 1000
        for _ in range(4):
            wide = [wide] * 1000
        return wide

    return [
        dictionary,
        list_,
        pair,
        by_way_of_a_tuple,
        array,
        deep_list,
        deep_tuple,
        deep_dictionary,
        folded,
        wide,
        Endless,
        Itself,
        Links,
        lambda: range(10**12),
        lambda: numpy.broadcast_to(numpy.float32(1), (10**6, 10**6)),
    ]


WAYS = {
    "key": lambda scene, value: scene.__setitem__("motion.frames", value),
    "table": lambda scene, value: scene.__setitem__("free", value),
    "attribute": lambda scene, value: setattr(scene.motion, "frames", value),
    "table attribute": lambda scene, value: setattr(scene, "free", value),
    "table in a table": lambda scene, value: setattr(scene.hair, "style", value),
    "list": lambda scene, value: setattr(scene, "fan", value),
    "entry": lambda scene, value: scene.fan.append(value),
    "forces": lambda scene, value: setattr(scene, "forces", value),
    "a force": lambda scene, value: setattr(scene, "forces", [value]),
    "vector": lambda scene, value: setattr(scene, "forces", [(5, value)]),
    "bodies": lambda scene, value: setattr(scene, "bodies", [value]),
    "keyword": lambda scene, value: nabiki.Scene(motion=value),
    "head": lambda scene, value: nabiki.Scene(head=value),
    "hair": lambda scene, value: nabiki.Scene(hair=value),
    "mesh": lambda scene, value: setattr(scene, "head", {"mesh": value}),
    "motion": lambda scene, value: setattr(scene.head, "motion", value),
    "matrices": lambda scene, value: setattr(scene.head, "motion", {"file": value}),
    "open": lambda scene, value: nabiki.Scene.open(SCENES / "gust.toml", {"free": value}),
    "wishes": lambda scene, value: scene.solve([{"frame": 3, "strands": value, "moved": (1, 0, 0)}]),
    "a wish": lambda scene, value: scene.solve([value]),
    "unknowns": lambda scene, value: scene.solve([{"frame": 3, "strands": [1], "moved": (1, 0, 0)}], unknowns={"vectors": value}),
    "points": lambda scene, value: scene.force_at(value, 0),
    "head of a step": lambda scene, value: scene.simulate(strands=2).step(head=value),
    "force of a step": lambda scene, value: scene.simulate(strands=2).step(force=value),
    "written hair": lambda scene, value: nabiki.write_hair("a.hair", value, [0, 2]),
    "unit": lambda scene, value: nabiki.convert("a.hair", "b.hair", unit=value),
    "function": lambda scene, value: nabiki.Field(value, 1),
}


@pytest.mark.parametrize("way", WAYS)
def test_what_never_ends_is_refused_and_changes_nothing(way, gust, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    before = gust.settings()
    for make in values():
        # What is no list or dictionary may be of a wrong type for Python.
        kinds = (ValueError, TypeError) if isinstance(make, type) else ValueError
        with pytest.raises(kinds) as refused:
            WAYS[way](gust, make())
        assert "\n" not in str(refused.value) and len(str(refused.value)) < 1000, make
        assert gust.settings() == before
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("make", [make for make in values() if make.__name__ in ("dictionary", "list_", "deep_list", "deep_dictionary")])
def test_a_line_says_that_a_value_holds_itself_or_lies_too_deep(make, gust):
    with pytest.raises(nabiki.Error) as refused:
        gust.free = make()
    error = refused.value
    assert error.thing.startswith("free") and ("within itself" in error.value or "16 lists or tables deep" in error.value)
    assert gust.free.to_dict() == nabiki.Scene.open(SCENES / "gust.toml").free.to_dict()


def test_keys_and_texts_of_any_depth_are_refused(gust):
    for key in ("free." + "a." * 100_000 + "b", "force" + "[0]" * 100_000, "a." * 100_000 + "b"):
        with pytest.raises(nabiki.Error) as refused:
            gust[key] = 1
        assert "so deep" in str(refused.value) and len(str(refused.value)) < 500
        with pytest.raises(nabiki.Error):
            gust[key]
        with pytest.raises(nabiki.Error):
            nabiki.Scene.open(SCENES / "gust.toml", {key: 1})
    for text in ("a = " + "[" * DEEP, "a." * DEEP + "b = 1", "[" + "a." * DEEP + "b]", "a = " + "{a=" * DEEP):
        with pytest.raises(nabiki.Error):
            nabiki.Scene.parse(text)


def test_tables_compare_with_what_holds_itself(gust):
    endless = {}
    endless["frames"] = endless
    assert gust.motion != endless and gust.fan != [endless] and gust.forces != [endless]


INTERPRETER = """
import nabiki, sys
scene = nabiki.Scene.open(sys.argv[1])
deep = {}
for _ in range(int(sys.argv[2])):
    deep = {"a": deep}
endless = []
endless.append(endless)
for value in (deep, endless, {"free": endless}):
    for put in (lambda: setattr(scene, "free", value), lambda: scene.__setitem__("free.stiffness", value)):
        try:
            put()
        except ValueError:
            continue
        sys.exit("was taken")
print("lives")
"""


def test_the_interpreter_lives_on():
    words = [sys.executable, "-c", INTERPRETER, str(SCENES / "gust.toml"), "200000"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout) == (0, "lives\n"), done.stderr[-500:]


def test_tables_and_lists_of_a_scene_are_sent_as_what_they_are(gust):
    for thing in (gust.motion, gust.fan, gust.force, gust.forces, gust.bodies):
        for again in (pickle.loads(pickle.dumps(thing)), copy.deepcopy(thing)):
            assert again == thing

"""Every setting is an attribute, means what it means in a file, and has a doc."""

import copy
import keyword
import pickle

import numpy
import pytest
from conftest import SCENES

import nabiki
from nabiki.settings._table import Table, Tables

WIND = "[[force]]\nthrough = 5\nvector = [1, 2, 3]\n"
SPEED = 'speed = "5 m/s"\n'
MOTION = '{ file = "m.bvh", skeleton = "s.asf", unit_cm = 1.0, up = "+y", facing = "+z", frames_per_second = 30.0 }'
LIE = 'unit = "m"\nup = "+y"\nfacing = "+x"\norigin = [0, 0, 0]\n'
# Between them they have every table that a scene can have.
MOST = f"""{WIND}{SPEED}
[head]
motion = {MOTION}
[gust]
[body_wind]
[flow]
[turbulence]
envelope = [{{ frame = 1, factor = 1.0 }}]
[neighbours]
[[fan]]
position = [0, 0, 0]
direction = [1, 0, 0]
envelope = [{{ frame = 1, factor = 1.0 }}]
[[vortex]]
position = [0, 0, 0]
envelope = [{{ frame = 1, factor = 1.0 }}]
[[point]]
position = [0, 0, 0]
envelope = [{{ frame = 1, factor = 1.0 }}]
[free]
substeps = 3
tie = {{ at = [0, 0, 0], within = 1.0 }}
variation = {{ size = 2.0 }}
[[free.regions]]
name = "fringe"
groups = ["top"]
attribute = "painted"
values = [1]
map = "m.png"
painted = [[8, 4, 0, 1]]
near = [8, 4, 0]
to = [8, 4, 1]
fields = [{{ field = "turbulence", share = 0.5 }}]
[motion]
form = "free"
[hair.style.ponytail]
at = [-12, 0, 0]
[[hair.style.cuts]]
point = [0, 0, 0]
normal = [0, -1, 0]
region = "top"
[[aim]]
region = "fringe"
file = "p.usda"
frame = 4
through = 9
[[aim]]
toward = [1, 2, 3]
[[aim]]
curves = [[[8, 4, 0], [9, 4, 0]]]
[[body]]
mesh = "b.obj"
{LIE}motion = {MOTION}
[picture.camera]
distance = 1.0
height = 1.0
target = [0, 0, 0]
f_stop = 2.0
focus_distance = 1.0
[picture.camera.to]
azimuth = 1.0
elevation = 1.0
distance = 1.0
fov = 1.0
target = [0, 0, 0]
focus_distance = 1.0
[output]
sheet = [0]
first_frame = 1001
[picture.video]
frame_rate = 24.0
"""
IMPORTED = f"""{WIND}
[head]
mesh = "h.obj"
{LIE}[hair]
file = "h.hair"
strands = 5
segments = 5
{LIE}[disturbance]
[[body]]
capsule = {{ from = [0, 0, 0], to = [0, 1, 0], radius = 2.0 }}
"""


def scenes():
    return [nabiki.Scene.parse(text, "all.toml") for text in (MOST, IMPORTED)]


def name_of(key):
    """The attribute of a key: Python has some words for itself."""
    return key + "_" * keyword.iskeyword(key)


def attribute(owner, name):
    """An attribute that is a property with a doc."""
    found = getattr(type(owner), name, None)
    assert isinstance(found, property), f"{type(owner).__name__} has no {name}"
    assert found.__doc__ and found.fset, f"{type(owner).__name__}.{name} says nothing of itself"
    return getattr(owner, name)


def walk(owner, values, path=""):
    """All settings of a table as attributes."""
    for key, value in values.items():
        name = name_of(key)
        found = attribute(owner, name)
        if isinstance(found, Table):
            yield owner, name, found
            yield from walk(found, value, f"{path}{name}.")
        elif isinstance(found, Tables):
            yield owner, name, found
            for entry, below in zip(found, value, strict=True):
                yield from walk(entry, below, f"{path}{name}.")
        else:
            assert found == value, f"{path}{name}"
            yield owner, name, value


def test_every_key_of_a_scene_is_an_attribute_with_a_doc_and_its_value_and_there_are_no_others():
    reached = {(type(owner), name) for scene in scenes() for owner, name, _ in walk(scene, scene.settings())}
    tables = Table.__subclasses__()
    there = {(table, name) for table in tables for name, value in vars(table).items() if isinstance(value, property)}
    assert there - reached == set() and len(tables) > 30


def test_every_attribute_put_back_as_it_is_leaves_the_scene_as_it_was():
    for scene in scenes():
        before, text = scene.settings(), scene.to_toml()
        for owner, name, value in walk(scene, scene.settings()):
            setattr(owner, name, value)
        assert scene.settings() == before and scene.to_toml() == text


@pytest.mark.parametrize(
    ("put", "line"),
    [
        (lambda scene: setattr(scene.motion, "frames", 7), "[motion]\nframes = 7\n"),
        (lambda scene: setattr(scene.free, "stiffness", [2000, 200]), "[free]\nstiffness = [2000, 200]\n"),
        (lambda scene: setattr(scene.free, "gravity", "earth"), '[free]\ngravity = "earth"\n'),
        (lambda scene: setattr(scene.free, "stiffness", ["9 cm", 500]), '[free]\nstiffness = ["9 cm", 500]\n'),
        (lambda scene: setattr(scene.hair.style.curl, "radius", 0.5), "[hair.style.curl]\nradius = 0.5\n"),
        (lambda scene: setattr(scene.gust, "intensity", 0.25), "[gust]\nintensity = 0.25\n"),
        (lambda scene: setattr(scene.picture.hair, "colour", {"rgb": (0.3, 0.1, 0.05)}), "[picture.hair]\ncolour = { rgb = [0.3, 0.1, 0.05] }\n"),
        (lambda scene: scene.vortex.append({"position": (1, 2, 3)}), "[[vortex]]\nposition = [1, 2, 3]\n"),
        (lambda scene: setattr(scene, "turbulence", {"strength": 3}), "[turbulence]\nstrength = 3\n"),
        (lambda scene: setattr(scene, "forces", [(9, (1, 2, 3))]), None),
    ],
)
def test_an_attribute_means_what_it_means_in_a_file(put, line):
    scene = nabiki.Scene.parse(WIND)
    put(scene)
    text = WIND + line if line else WIND.replace("5", "9")
    assert scene.settings() == nabiki.Scene.parse(text).settings()
    assert nabiki.Scene.parse(scene.to_toml()).settings() == scene.settings()


def test_a_refused_value_leaves_the_scene_as_it_was():
    scene = nabiki.Scene.open(SCENES / "gust.toml")
    before = scene.settings()
    for put, thing in [
        (lambda: setattr(scene.motion, "time_step", -1), "motion.time_step"),
        (lambda: setattr(scene.motion, "frames", "many"), "motion.frames"),
        (lambda: setattr(scene.motion, "framez", 5), "motion.framez"),
        (lambda: setattr(scene.picture, "size", (0, 90)), "picture.size"),
        (lambda: setattr(scene, "forces", [(9, (1, 2, 3)), (8, (1, 2, 3))]), None),
        (lambda: scene.gust.intensity, "gust"),
    ]:
        with pytest.raises(nabiki.Error) as refused:
            put()
        assert thing is None or refused.value.thing == thing
        assert scene.settings() == before


def test_tables_come_and_go():
    scene = nabiki.Scene.parse(WIND)
    assert not scene.gust and scene.gust.to_dict() == {}
    scene.gust = {}
    assert scene.gust and scene.gust.seed is not None
    scene.gust = None
    assert not scene.gust
    scene.vortex = [{"position": (1, 2, 3)}, {"position": (4, 5, 6)}]
    scene.vortex.insert(0, {"position": (7, 8, 9)})
    del scene.vortex[1]
    assert [vortex.position for vortex in scene.vortex] == [(7, 8, 9), (4, 5, 6)]
    scene.vortex[1].strength = 12
    assert scene["vortex[1].strength"] == scene.vortex[-1].strength == 12
    scene.vortex = None
    assert len(scene.vortex) == 0 and scene.settings() == nabiki.Scene.parse(WIND).settings()


def test_what_a_scene_has_no_name_for_is_refused():
    scene = nabiki.Scene.parse(WIND)
    with pytest.raises(nabiki.Error, match="did you mean motion.frames"):
        scene["motion.framez"] = 3
    for typo, meant in (("motion.framez", "motion.frames"), ("gust.sead", "gust.seed"), ("picture.tone", "tone_mapping")):
        with pytest.raises(nabiki.Error, match=meant):
            scene[typo]
    # No gust, and no eighth force.
    assert scene["gust.seed"] is scene["force[7].vector"] is scene["gust"] is None


@pytest.mark.parametrize(
    ("owner", "name", "meant"),
    [
        (lambda scene: scene, "motions", "motion"),
        (lambda scene: scene, "time_step", "motion.time_step"),
        (lambda scene: scene, "frames", "motion.frames"),
        (lambda scene: scene, "simulat", "simulate"),
        (lambda scene: scene, "savee", "save"),
        (lambda scene: scene.motion, "framez", "motion.frames"),
        (lambda scene: scene.motion, "to_dic", "to_dict"),
        (lambda scene: scene.gust, "sead", "gust.seed"),
        (lambda scene: scene.picture, "tone", "tone_mapping"),
        (lambda scene: scene.hair.style.length, "topp", "hair.style.length.top"),
        (lambda scene: scene.force[0], "vektor", "force[0].vector"),
        (lambda scene: scene.free, "quite_another", "keys here are"),
    ],
)
def test_an_attribute_that_is_not_there_is_refused_with_what_was_perhaps_meant(owner, name, meant):
    scene = nabiki.Scene.parse(WIND)
    before = scene.settings()
    asked = [lambda: getattr(owner(scene), name), lambda: setattr(owner(scene), name, {})]
    for ask in asked:
        with pytest.raises(AttributeError) as refused:
            ask()
        assert isinstance(refused.value, nabiki.Error) and meant in str(refused.value) and refused.value.thing
        assert pickle.loads(pickle.dumps(refused.value)).thing == refused.value.thing
    assert not hasattr(owner(scene), name) and getattr(owner(scene), name, 5) == 5
    assert scene.settings() == before


def test_attributes_that_cannot_be_set_stay_so(gust):
    for owner, name in [(gust, "file"), (gust, "save"), (gust.motion, "to_dict"), (gust, "_x"), (gust.motion, "__len__")]:
        with pytest.raises(AttributeError):
            setattr(owner, name, 5)
    for owner in (gust.simulate(strands=1), gust.timeline(strands=1)[0], gust.timeline(strands=1)):
        with pytest.raises(AttributeError):
            owner.pointz = 5

    class Shot(nabiki.Scene):
        pass

    shot = Shot.open(SCENES / "gust.toml")
    shot.number = 7
    assert shot.number == 7 and type(shot.copy()) is Shot


def test_copies_change_by_themselves():
    scene = nabiki.Scene.parse(WIND)
    other = scene.copy()
    other.motion.frames = 3
    assert scene.motion.frames != 3 and type(other) is nabiki.Scene


def test_a_scene_is_copied_and_sent_as_other_objects_are(tmp_path):
    (tmp_path / "gust.toml").write_text(WIND + "# kept\n")
    scene = nabiki.Scene.open(tmp_path / "gust.toml")
    scene.motion.frames = 5
    scene.fan = [{"position": (40, 0, 0), "direction": (-1, 0, 0)}]
    for other in (copy.copy(scene), copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        assert type(other) is nabiki.Scene and other.settings() == scene.settings()
        assert other.file == scene.file and "# kept" in other.to_toml()
        other.motion.frames = 3
        assert scene.motion.frames == 5
    made = nabiki.Scene(forces=[(5, (1, 0, 0))])
    assert pickle.loads(pickle.dumps(made)).settings() == made.settings()
    assert copy.deepcopy(scene.motion).frames == 5 and pickle.loads(pickle.dumps(scene.fan[0])) == scene.fan[0]
    assert len(pickle.loads(pickle.dumps(scene.fan))) == 1


def test_what_cannot_be_sent_is_refused_where_it_is(gust):
    gust.output.sheet = [12]
    gust.motion.frames = 3
    with pytest.raises(nabiki.Error, match="sheet"):
        pickle.dumps(gust)
    gust.output.sheet = [0]
    gust.fields = [nabiki.Field(lambda points, frame: (1, 0, 0), strongest=1)]
    with pytest.raises(nabiki.Error, match="Python functions"):
        pickle.dumps(gust)
    assert len(copy.copy(gust).fields) == 1


def test_a_saved_scene_keeps_its_comments_and_its_paths(tmp_path):
    file = tmp_path / "gust.toml"
    file.write_text("[[force]] # back\nthrough = 5\nvector = [-100, 0, 0]\n\n[hair]\nfile = \"groom.hair\"\n")
    scene = nabiki.Scene.open(file)
    scene.forces = [(5, (-80, 0, 0))]
    (tmp_path / "below").mkdir()
    scene.save(tmp_path / "below" / "other.toml")
    text = (tmp_path / "below" / "other.toml").read_text()
    assert "[[force]] # back" in text and "-80" in text and '"../groom.hair"' in text
    assert scene.file == str(tmp_path / "below" / "other.toml")


def test_settings_of_open_go_before_those_of_the_file():
    scene = nabiki.Scene.open(SCENES / "gust.toml", {"motion.frames": 3, "output.sheet": [0], "force.1.vector": (1, 2, 3)})
    assert scene.motion.frames == 3 and scene.force[1].vector == (1, 2, 3)


def test_a_value_that_is_refused_is_not_said_to_be_that_of_open():
    scene = nabiki.Scene.open(SCENES / "gust.toml", {"motion.frames": 3, "output.sheet": [0]})
    for wrong in ("many", -1):
        with pytest.raises(nabiki.Error) as refused:
            scene.motion.frames = wrong
        assert "--set" not in str(refused.value) and str(wrong) in str(refused.value)


def test_tables_of_a_scene_may_be_given_to_itself():
    scene = nabiki.Scene.parse(WIND)
    other = scene.copy()
    other.motion.frames = 7
    scene.motion = other.motion
    scene.motion = scene.motion
    scene.vortex = [{"position": (1, 2, 3)}]
    scene.vortex = [*scene.vortex, scene.vortex[0]]
    assert scene.motion.frames == 7 and len(scene.vortex) == 2 and scene.vortex[0] == scene.vortex[1]


def test_what_is_given_as_a_list_may_be_changed_as_one(gust):
    """A list that is not the scene's own would take what is put into it and lose it."""
    gust.forces = [(5, (1, 0, 0))]
    gust.forces.append((9, numpy.array([0, 2, 0])))
    gust.forces += [(12, (0, 0, 3))]
    assert gust.forces == [(5, (1, 0, 0)), (9, (0, 2, 0)), (12, (0, 0, 3))] == gust.copy().forces
    assert gust.forces.pop(1) == (9, (0, 2, 0)) and gust.force[1].through == 12
    gust.forces[0] = (4, (7, 0, 0))
    del gust.forces[1:]
    assert gust.forces == [(4, (7, 0, 0))] and gust.forces + [1] == [(4, (7, 0, 0)), 1]
    with pytest.raises(nabiki.Error, match=r"force\[1\]\.through"):
        gust.forces.append((3, (1, 0, 0)))
    assert len(gust.forces) == 1
    gust.bodies.append("ball.obj")
    gust.bodies.insert(0, {"mesh": "hand.obj", "margin": 0.2})
    assert [body.mesh for body in gust.body] == ["hand.obj", "ball.obj"] == [body["mesh"] for body in gust.bodies]
    field = nabiki.Field(lambda points, frame: (1, 0, 0), strongest=1)
    gust.fields.append(field)
    assert [own.function for own in gust.fields] == [field.function]
    gust.fields.clear()
    assert gust.fields == [] and not gust.fields


@pytest.mark.parametrize("force", [(5, 1, 2, 3), 5, numpy.zeros(4)])
def test_an_interval_of_another_shape_is_named(gust, force):
    with pytest.raises(nabiki.Error) as refused:
        gust.forces = [(2, (1, 0, 0)), force]
    assert refused.value.thing == "forces[1]" and "(last frame, (x, y, z))" in str(refused.value)


def test_intervals_keep_their_speeds(gust):
    gust.forces = [(5, (-1, 0, 0), "20 km/h"), (9, (0, 2, 0))]
    gust.forces.append((12, (0, 0, 3)))
    assert gust.forces == [(5, (-1, 0, 0), "20 km/h"), (9, (0, 2, 0)), (12, (0, 0, 3))]
    assert gust.force[0].speed == "20 km/h" and gust.force[1].speed is None
    with pytest.raises(nabiki.Error, match=r"force\[0\]\.speed: found \"20 knots\""):
        gust.force[0].speed = "20 knots"


def test_entries_that_are_turned_round_or_taken_out_stay_what_they_are(gust):
    for strength in (10, 20, 30):
        gust.fan.append({"position": (40, 0, 0), "direction": (-1, 0, 0), "strength": strength})
    gust.fan.reverse()
    assert [fan.strength for fan in gust.fan] == [30, 20, 10]
    assert gust.fan.pop(0).strength == 30 and gust.fan.pop().strength == 10
    assert [fan.strength for fan in gust.fan] == [20]
    gust.fan.clear()
    assert len(gust.fan) == 0
    with pytest.raises(IndexError):
        gust.fan.pop()

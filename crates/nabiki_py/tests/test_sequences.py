"""What is like a sequence is one: it has a length, iterates, and gives any of its entries, from either end, and slices."""

import collections.abc
import copy
import pickle

import numpy
import pytest
from conftest import bits

import nabiki


def test_a_timeline_is_a_sequence_of_its_frames(gust):
    timeline, film = gust.timeline(strands=5), gust.timeline(strands=5).play()
    assert isinstance(timeline, nabiki.Timeline) and isinstance(timeline, collections.abc.Sequence)
    assert len(timeline) == len(film) == 13
    assert [frame.number for frame in timeline] == list(range(13)) == [frame.number for frame in timeline]
    assert [frame.number for frame in reversed(timeline)] == list(range(13))[::-1]
    for index in (0, 5, 12, -1, -13, numpy.int64(4), numpy.uint8(3), True):
        assert numpy.array_equal(bits(timeline[index].points), bits(film[int(index)])), index
    for part in (slice(None), slice(3, 7), slice(None, None, 4), slice(None, None, -3), slice(-2, None), slice(40, 50)):
        found = timeline[part]
        assert isinstance(found, list) and [frame.number for frame in found] == list(range(13))[part]
        assert all(numpy.array_equal(bits(frame.points), bits(film[frame.number])) for frame in found)
    rest, first, *_, last = timeline
    assert (rest.number, first.number, last.number) == (0, 1, 12)


@pytest.mark.parametrize("index", [13, -14, 10**30, -(10**30)])
def test_a_frame_that_is_not_there_is_an_index_error(index, gust):
    with pytest.raises(IndexError, match="the frames are 0 to 12"):
        gust.timeline(strands=2)[index]


@pytest.mark.parametrize("index", [1.0, "1", None, (1, 2)])
def test_an_index_of_another_type_is_a_type_error(index, gust):
    with pytest.raises(TypeError):
        gust.timeline(strands=2)[index]


def test_lists_of_a_scene_take_indices_as_lists_do(gust):
    gust.forces = [(n, (n, 0, 0)) for n in range(1, 7)]
    for things in (gust.force, gust.forces):
        whole = list(things)
        assert len(things) == 6 and list(reversed(things)) == whole[::-1]
        for index in (0, -1, numpy.int64(2)):
            assert things[index] == whole[index]
        for part in (slice(2, 4), slice(None, None, -2)):
            assert list(things[part]) == whole[part]
        for wrong in (6, -7, 10**30):
            with pytest.raises(IndexError):
                things[wrong]
        with pytest.raises(TypeError):
            things["1"]


def test_a_motion_iterates_once_and_knows_what_is_left(gust):
    hair = gust.simulate(strands=2)
    assert iter(hair) is hair and len(hair) == 13
    assert [frame.number for frame in hair] == list(range(13)) and list(hair) == []


def test_reprs_say_what_there_is(gust):
    gust.gust = {}
    gust.turbulence = None
    gust.fan = [{"position": (40, 0, 0), "direction": (-1, 0, 0)}] * 2
    scene = repr(gust)
    assert scene.startswith("<nabiki.Scene ") and "gust.toml: free form, " in scene
    assert "frames 0 to 12 at 24 a second" in scene and "1 gust" in scene and "2 fans" in scene and "strands" in scene
    made = nabiki.Scene(hair={"strands": 1, "segments": 3}, forces=[(9, (1, 0, 0))])
    assert repr(made) == "<nabiki.Scene made in Python: the paper's form, 1 strand, frames 0 to 100 at 24 a second, 1 force>"
    assert "no wind" in repr(nabiki.Scene())
    timeline, hair = gust.timeline(strands=5), gust.simulate(strands=5)
    points = len(timeline[0].points)
    whole = f"gust.toml: 13 frames of 5 strands, {points} points (cm)"
    assert whole in repr(timeline) and repr(timeline).startswith("<nabiki.Timeline of ")
    assert whole in repr(hair) and repr(hair).endswith("; at frame 0>")
    hair.step()
    assert repr(hair).endswith("; at frame 1>")
    assert repr(timeline[3]) == f"<nabiki.Frame 3: 5 strands, {points} points (cm, head space)>"
    assert repr(nabiki.Field(wind, strongest=40)) == "<nabiki.Field wind, strongest 40>"
    assert repr(gust.fan[0]).startswith("<fan[0]: {'position': (40") and repr(gust.flow) == "<flow: not in this scene>"
    fan = gust.fan[1]
    gust.fan.clear()
    assert repr(fan) == "<fan[1]: not in this scene>" and repr(gust.fan) == "<fan: []>"
    found = gust.solve([{"frame": 9, "strands": [1], "moved": (0.1, 0, 0)}], search={"iterations": 1, "starts": 1})
    assert repr(found).startswith("<nabiki.Solution: ") and "\n" not in repr(found) and "solved" in str(found)


def wind(points, frame):
    return (40, 0, 0)


def test_what_is_the_same_is_equal(gust, tmp_path):
    assert gust == gust and gust == gust.copy() == copy.deepcopy(gust) == pickle.loads(pickle.dumps(gust))
    assert not gust != gust.copy()
    other = gust.copy()
    other.motion.frames = 11
    assert gust != other and not gust == other
    assert gust.motion != other.motion and gust.free == other.free and gust.force == other.force
    other.motion.frames = 12
    assert gust == other
    gust.save(tmp_path / "a.toml")
    assert gust == nabiki.Scene.open(tmp_path / "a.toml") == other
    for unhashable in (gust, gust.motion, gust.force, gust.forces):
        with pytest.raises(TypeError, match="unhashable"):
            hash(unhashable)
    assert gust != 1 and gust is not None and gust != gust.settings() and gust.motion == gust.motion.to_dict()
    assert gust.force[0] != gust.force[1] and gust.gust != gust.turbulence


def test_one_name_in_two_folders_is_two_files(tmp_path):
    text = '[hair]\nfile = "a.hair"\n[motion]\nform = "free"\n'
    here, there = (nabiki.Scene.parse(text, tmp_path / folder / "a.toml") for folder in ("here", "there"))
    assert here != there
    up = nabiki.Scene.parse(text.replace("a.hair", "../here/a.hair"), tmp_path / "there" / "a.toml")
    assert here == up


def test_fields_are_equal_where_they_ask_the_same_function(gust):
    field = nabiki.Field(wind, strongest=40)
    assert field == nabiki.Field(wind, strongest=40) != nabiki.Field(wind, strongest=41)
    assert field != nabiki.Field(lambda points, frame: (40, 0, 0), strongest=40) and field != 1
    assert len({field, nabiki.Field(wind, strongest=40)}) == 1
    other = gust.copy()
    gust.fields = [field]
    assert gust != other and gust == gust.copy() and field in gust.fields
    other.fields = [nabiki.Field(wind, strongest=40)]
    assert gust == other
    other.fields = [field, field]
    assert gust != other


def test_arrays_of_a_copy_are_those_of_the_scene():
    points, offsets = nabiki.Scene(forces=[(1, (1, 0, 0))]).groom(strands=3)
    scene = nabiki.Scene(hair=(points, offsets), forces=[(1, (1, 0, 0))])
    assert scene == scene.copy()

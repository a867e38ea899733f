"""The motion in Python is the command's, and lies where it was computed."""

import threading

import numpy
import pytest
from conftest import SCENES, STRANDS, bits, cache_frames, command

import nabiki


@pytest.mark.parametrize("name", ["gust", "paper/gust", "head_turn", "curls"])
def test_points_and_poses_are_the_commands_to_the_bit(name, tmp_path):
    scene = SCENES / f"{name}.toml"
    cache = tmp_path / "motion.nabiki"
    small = ["--set", f"hair.strands={STRANDS}", "--set", "output.sheet=[0]", "--frames", 15]
    command("simulate", scene, *small, "--strands", 200, "-o", cache, "--quiet")
    settings = {"hair.strands": STRANDS, "motion.frames": 15, "output.sheet": [0]}
    motion = nabiki.Scene.open(scene, settings).simulate(strands=200)
    there = list(cache_frames(cache))
    assert len(motion) == len(there) == 16
    for frame, (pose, points) in zip(motion, there, strict=True):
        assert numpy.array_equal(bits(frame.points), bits(points)), frame.number
        assert numpy.array_equal(numpy.float32(frame.head_pose[:3, 3]), pose[:3])


def test_frames_of_the_timeline_are_those_of_the_simulation(gust):
    stepped = [frame.points for frame in gust.simulate(strands=100)]
    timeline = gust.timeline(strands=100)
    assert numpy.array_equal(bits(timeline.play()), bits(stepped))
    for frame in [3, 12, 0, -1, 7]:
        assert numpy.array_equal(bits(timeline[frame].points), bits(stepped[frame]))
    with pytest.raises(IndexError):
        timeline[13]


def test_strands_move_as_within_the_whole(gust):
    gust.hair.strands = 400
    gust.motion.frames = 8
    *_, few = some = list(gust.simulate(strands=60))
    *_, all_ = gust.simulate()
    ids = gust.simulate(strands=60).ids
    assert len(some) == 9
    for place, number in enumerate(ids):
        own = few.points[few.offsets[place] : few.offsets[place + 1]]
        among_all = all_.points[all_.offsets[number] : all_.offsets[number + 1]]
        assert numpy.array_equal(bits(own), bits(among_all))


def test_points_are_no_copy_and_cannot_be_written(gust):
    motion = gust.simulate(strands=50)
    frame = next(motion)
    assert numpy.shares_memory(frame.points, frame.points)
    assert not frame.points.flags.owndata and not frame.points.flags.writeable
    with pytest.raises(ValueError):
        frame.points[0] = 0
    copy = frame.points.copy()
    copy[0] = 0
    assert copy.dtype == numpy.float32 and copy.shape == (frame.offsets[-1], 3)


def test_frames_that_are_kept_stay_and_others_take_no_memory(gust):
    points = [frame.points for frame in gust.simulate(strands=50)]
    places = {array.ctypes.data for array in points}
    assert len(places) == len(points)
    again = gust.simulate(strands=50)
    for n, frame in enumerate(again):
        assert numpy.array_equal(bits(frame.points), bits(points[n]))
    used = set()
    for frame in gust.simulate(strands=50):
        used.add(frame.points.ctypes.data)
    assert len(used) <= 3, "the frame at hand, the one before, the one in making"


def test_points_outlive_all_they_came_from(gust):
    points = next(iter(gust.simulate(strands=50))).points
    wanted = gust.timeline(strands=50)[0].points.copy()
    del gust
    assert numpy.array_equal(bits(points), bits(wanted))


def test_world_points_are_the_points_under_the_pose():
    scene = nabiki.Scene.open(SCENES / "head_turn.toml", {"motion.frames": 30, "output.sheet": [0]})
    *_, last = scene.simulate(strands=20)
    pose = last.head_pose
    assert not numpy.array_equal(pose, numpy.eye(4))
    world = last.points @ pose[:3, :3].T + pose[:3, 3]
    # Three products and three sums of numbers below 1,000 cm, each rounded.
    size = numpy.abs(pose[:3, 3]).max() + 100
    assert numpy.abs(last.world_points() - world).max() <= 8 * numpy.finfo(numpy.float32).eps * size


def test_threads_of_python_go_on_and_change_nothing(gust):
    wanted = gust.timeline(strands=300).play()
    found = []
    scenes = [gust.copy() for _ in range(2)]
    threads = [threading.Thread(target=lambda scene=scene: found.append(scene.timeline(strands=300).play())) for scene in scenes]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(numpy.array_equal(bits(film), bits(wanted)) for film in found) and len(found) == 2


def test_a_changed_scene_moves_as_one_read_anew(gust):
    list(gust.simulate(strands=60))
    gust.forces = [(5, (-80, 10, 0)), (12, (0, -150, 20))]
    gust.hair.style.length.top = 12
    gust.free.settle = 10
    fresh = nabiki.Scene.parse(gust.to_toml(), SCENES / "gust.toml")
    # What `open` was told beside the file belongs to the scene, not to the text that it was read from.
    for key in ["hair.strands", "motion.frames", "picture.size", "output.sheet"]:
        fresh[key] = gust[key]
    assert numpy.array_equal(bits(gust.timeline(strands=60).play()), bits(fresh.timeline(strands=60).play()))


@pytest.mark.parametrize("kind", ["timeline", "simulate"])
def test_a_motion_that_is_at_work_says_so_and_still_says_what_it_is(gust, kind):
    heard = []

    def wind(points, frame):
        with pytest.raises(RuntimeError, match=rf"each thread its own, scene\.{kind}\(\)"):
            ask()
        heard.append((len(motion), len(motion.offsets), len(motion.ids)))
        return 0, 0, 0

    gust.fields = [nabiki.Field(wind, strongest=1)]
    motion = getattr(gust, kind)(strands=2)
    ask = (lambda: motion[1]) if kind == "timeline" else (lambda: next(motion))
    ask()
    ask()
    assert set(heard) == {(13, 3, 2)}

"""Motion of arrays is that of files, and of a head that is told."""

import os

import numpy
import pytest
from conftest import bits
from test_live import BALL, FRAMES, HEAD, bare, matrix, table

import nabiki

WAY = numpy.stack([matrix(*pose) for pose in HEAD])
BALLS = numpy.stack([matrix(*pose) for pose in BALL])


def test_matrices_move_head_and_body_as_told_and_as_files(tmp_path):
    scene = bare()
    hair = scene.simulate()
    told = [hair.step(head=WAY[n], bodies=[BALLS[n]]).points for n in range(1, FRAMES + 1)]
    files = bare(head={"motion": table(tmp_path / "head.csv", HEAD)})
    files.body[0].motion = table(tmp_path / "ball.csv", BALL)
    scene.head.motion = WAY
    scene.body[0].motion = BALLS
    found = scene.timeline().play()
    assert numpy.array_equal(bits(found[1:]), bits(told))
    # A turn of float32, and what twelve steps of the hair make of its last digit.
    assert numpy.abs(found - files.timeline().play()).max() < 1e-3
    assert numpy.allclose(scene.timeline()[7].head_pose, WAY[7], atol=1e-6)
    for other in (scene.copy(), bare(head={"motion": WAY.tolist()})):
        if not other.body[0].motion:
            other.bodies = [{**other.body[0].to_dict(), "motion": BALLS}]
        assert numpy.array_equal(bits(other.timeline().play()), bits(found))


def test_matrices_come_as_many_a_second_as_the_scene_has_frames():
    fast = nabiki.Scene(head={"motion": WAY}, motion={"form": "free", "frames": 12, "frame_rate": 48})
    assert numpy.allclose(fast.timeline(strands=1)[12].head_pose, WAY[12], atol=1e-6)
    fast.motion.frame_rate = 96
    fast.head.motion = {"file": WAY, "frames_per_second": 48, "positions": "linear"}
    half = fast.timeline(strands=1)
    assert numpy.allclose(half[8].head_pose, WAY[4], atol=1e-6)
    assert numpy.allclose(half[9].head_pose[:3, 3], (WAY[4, :3, 3] + WAY[5, :3, 3]) / 2, atol=1e-5)
    fast.head.motion.speed = 0.5
    assert numpy.allclose(fast.timeline(strands=1)[12].head_pose, WAY[3], atol=1e-6)


def test_units_and_axes_of_matrices_are_those_of_files():
    """Metres, z up, looking along -y, as Blender has them."""
    turned = numpy.float64([[0, 0, -1, 0], [-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    metres = turned @ WAY @ numpy.linalg.inv(turned)
    metres[:, :3, 3] /= 100
    scene = nabiki.Scene(motion={"form": "free", "frames": FRAMES})
    scene.head.motion = {"file": metres, "unit_cm": 100, "up": "+z", "facing": "-y"}
    for frame in scene.simulate(strands=1):
        assert numpy.allclose(frame.head_pose, WAY[frame.number], atol=1e-5)


def test_files_of_matrices_go_when_no_scene_names_them():
    scene = nabiki.Scene(head={"motion": WAY}, motion={"form": "free", "frames": 3})
    first, kept = scene.head.motion.file, scene.copy()
    scene.head.motion = WAY[:5]
    assert os.path.exists(first) and scene.head.motion.file != first
    kept.head.motion = None
    assert not os.path.exists(first)
    with pytest.raises(nabiki.Error, match="from arrays: write them to files"):
        scene.save("scene.toml")


def test_what_is_no_motion_is_refused_by_its_frame():
    scene = bare()

    def wrong(frame, change):
        way = WAY.copy()
        way[frame] = way[frame] @ change
        return way

    shear = numpy.eye(4)
    shear[0, 1] = 0.1
    broken = WAY.copy()
    broken[4, 1, 3] = numpy.nan
    cases = [
        (WAY[0], "head.motion = an array of shape (4, 4): must have the shape (frames, 4, 4)"),
        (WAY[:, :3], "(13, 3, 4)"),
        (WAY[:0], "(0, 4, 4)"),
        (WAY.astype(str), "numbers"),
        ([[1, 2], 3], "array"),
        (broken, "head.motion frame 4 = a matrix with numbers that are not finite"),
        (wrong(7, numpy.diag([1.1, 1.1, 1.1, 1])), "head.motion frame 7 = a matrix that scales by 1.1000, 1.1000, 1.1000"),
        (wrong(12, shear), "head.motion frame 12 = a matrix that"),
        (wrong(2, numpy.diag([1, 1, -1, 1])), "head.motion frame 2 = a matrix that mirrors"),
        (numpy.swapaxes(WAY, 1, 2), "head.motion frame 1 = a matrix whose last row"),
        ({"file": WAY, "frames_per_second": 0}, "head.motion.frames_per_second = 0"),
        ({"file": WAY, "frames_per_second": "many"}, "head.motion.frames_per_second"),
        ({"file": WAY, "speed": -1}, "head.motion.speed = -1"),
    ]
    for given, words in cases:
        with pytest.raises(nabiki.Error) as refused:
            scene.head.motion = given
        text = str(refused.value)
        assert words in text and "\n" not in text and refused.value.way_out, text
    assert not scene.head.motion
    with pytest.raises(nabiki.Error, match=r"body\[0\]\.motion frame 3"):
        scene.body[0].motion = wrong(3, numpy.diag([2, 2, 2, 1]))
    with pytest.raises(nabiki.Error, match="frames_per_second"):
        nabiki.Scene.open("none.toml", {"head.motion": WAY})
    scene.head.motion = WAY[:5]
    with pytest.raises(nabiki.Error, match="ends at frame 4 and motion.frames = 12"):
        scene.simulate()

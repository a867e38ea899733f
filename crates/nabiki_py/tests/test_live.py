"""A loop that decides on the way: heads, bodies and winds that are told, states that are gone back to."""

import copy
import threading

import numpy
import pytest
from conftest import bits
from test_arrays import sphere

import nabiki

FRAMES = 12


def turn(axis, angle):
    """A quaternion (x, y, z, w)."""
    axis = numpy.float64(axis) / numpy.linalg.norm(axis)
    return numpy.r_[axis * numpy.sin(angle / 2), numpy.cos(angle / 2)]


def matrix(position, quaternion):
    x, y, z, w = quaternion
    pose = numpy.eye(4)
    pose[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    pose[:3, 3] = position
    return pose


HEAD = [((0.3 * n * n, 0.1 * n, -0.2 * n), turn((1, 5, 2), 0.08 * n)) for n in range(FRAMES + 1)]
BALL = [((0.0, 0.2 * n, -1.5 * n), turn((0, 1, 1), 0.1 * n)) for n in range(FRAMES + 1)]


def table(path, poses, rate=24):
    """A table of poses, as `head.motion` reads it."""
    rows = ["t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw"]
    rows += [",".join(repr(float(x)) for x in [n / rate, *p, *q]) for n, (p, q) in enumerate(poses)]
    path.write_text("\n".join(rows) + "\n")
    return {"file": path, "up": "+y", "facing": "+x"}


def bare(form="free", **settings):
    """Hair, and a ball in it, moved by nothing yet."""
    points, faces = sphere(4.0)
    ball = {"mesh": (points + numpy.float32([-11, -4, 14]), faces)}
    bodies = [ball] if form == "free" else None
    return nabiki.Scene(
        motion={"form": form, "frames": FRAMES, "inertia_length_floor": 18},
        hair={"strands": 120},
        forces=[(FRAMES, (-40, 5, 10))],
        bodies=bodies,
        **settings,
    )


def test_what_is_told_moves_hair_as_what_files_say_to_the_bit(tmp_path):
    scene = bare()
    calm = scene.timeline().play()
    told = [hair.step(head=HEAD[n], bodies=[BALL[n]]) for hair in [scene.simulate()] for n in range(1, FRAMES + 1)]
    scene.head.motion = table(tmp_path / "head.csv", HEAD)
    without = scene.timeline().play()
    scene.body[0].motion = table(tmp_path / "ball.csv", BALL)
    frames = list(scene.simulate())
    wanted = [frame.points for frame in frames]
    assert not numpy.array_equal(calm, without) and not numpy.array_equal(without, wanted), "head and ball are felt"
    assert numpy.array_equal(bits([frame.points for frame in told]), bits(wanted[1:]))
    for frame, own in zip(told, frames[1:], strict=True):
        assert frame.number == own.number and numpy.array_equal(frame.head_pose, own.head_pose)
        assert numpy.array_equal(bits(frame.world_points()), bits(own.world_points()))


@pytest.mark.parametrize("form", ["free", "paper"])
def test_what_is_not_told_is_as_in_the_scene(form, tmp_path):
    scene = bare(form, head={"motion": table(tmp_path / "head.csv", HEAD)})
    wanted = scene.timeline().play()
    hair = scene.simulate()
    # By steps, by telling what is so anyway, and as an iterator, in turns.
    ways = [
        lambda n: hair.step(),
        lambda n: hair.step(head=HEAD[n]),
        lambda n: next(hair),
        lambda n: hair.step(force=(-40, 5, 10), bodies=[None] * len(scene.bodies)),
        lambda n: hair.step(force=nabiki.Field(lambda points, frame: (-40, 5, 10), strongest=60)),
    ]
    assert numpy.array_equal(bits(next(hair).points), bits(wanted[0]))
    for n in range(1, FRAMES + 1):
        frame = ways[n % len(ways)](n)
        assert frame.number == n and numpy.array_equal(bits(frame.points), bits(wanted[n]))
    assert next(hair, None) is None
    assert hair.step().number == FRAMES + 1, "a loop has no last frame"


def test_matrices_are_positions_and_turns():
    scene = bare()
    hair, other = scene.simulate(), scene.simulate()
    for n in range(1, FRAMES + 1):
        frame = hair.step(head=matrix(*HEAD[n]), bodies=[matrix(*BALL[n]).tolist()])
        same = other.step(head=HEAD[n], bodies=numpy.stack([matrix(*BALL[n])]))
        # A turn of float32, and what twelve steps of the hair make of its last digit.
        assert numpy.abs(frame.points - same.points).max() < 1e-3
        assert numpy.allclose(frame.head_pose, matrix(*HEAD[n]), atol=1e-6)


@pytest.mark.parametrize("form", ["free", "paper"])
def test_a_branch_is_gone_back_from_to_the_bit(form):
    scene = bare(form)
    if form == "free":
        scene.neighbours = {"carriers": 20}

    def three(hair, sign=1):
        bodies = [BALL[4]] if form == "free" else None
        told = [{"head": HEAD[3]}, {"force": (60 * sign, 0, 20)}, {"head": HEAD[2], "bodies": bodies}]
        return [hair.step(**step) for step in told]

    hair = scene.simulate(strands=100)
    for n in range(1, 5):
        last = hair.step(head=HEAD[n])
    state, twin = hair.state(), hair.copy()
    wanted = three(hair)
    other = three(copy.deepcopy(twin), -1)
    assert not numpy.array_equal(wanted[-1].points, other[-1].points)
    back = hair.restore(state)
    assert back.number == 4 and numpy.array_equal(bits(back.points), bits(last.points))
    assert numpy.array_equal(back.head_pose, last.head_pose) and hair.state() == state
    # A scene made anew, as another process has it, and one that stood elsewhere.
    fresh, far = bare(form), scene.simulate(strands=100)
    if form == "free":
        fresh.neighbours = {"carriers": 20}
    far.step(force=(99, 0, 0), jumped=True)
    fresh = fresh.simulate(strands=100)
    for again in (fresh, far):
        again.restore(state)
    for again in (hair, twin, fresh, far):
        for frame, same in zip(three(again), wanted, strict=True):
            assert frame.number == same.number and numpy.array_equal(bits(frame.points), bits(same.points))


def test_rest_is_a_state_like_any_other(gust):
    hair = gust.simulate(strands=20)
    rest = hair.state()
    first = [frame.points for frame in hair]
    assert len(first) == 13 and hair.__length_hint__() == 0
    assert hair.restore(rest).number == 0 and hair.__length_hint__() == 13
    assert numpy.array_equal(bits([frame.points for frame in hair]), bits(first))


def test_a_head_that_jumps_takes_its_hair_along():
    scene = bare()
    scene.bodies = []
    still, moved, flung = scene.simulate(), scene.simulate(), scene.simulate()
    there = ((300.0, -20.0, 50.0), (0, 0, 0, 1))
    for n in range(1, 6):
        frame, same = still.step(), moved.step(head=there, jumped=n == 1)
        assert numpy.array_equal(bits(frame.points), bits(same.points))
        assert numpy.array_equal(same.head_pose[:3, 3], there[0])
    assert not numpy.array_equal(flung.step(head=there).points, still.restore(scene.simulate().state()).points)


def test_what_cannot_be_told_is_refused_and_nothing_has_happened():
    scene = bare()
    hair = scene.simulate(strands=20)
    hair.step()
    state = hair.state()
    good = matrix(*HEAD[5])

    def with_entry(place, value):
        wrong = good.copy()
        wrong[place] = value
        return wrong

    deaf = bare()
    deaf.body[0].solid = False
    other, paper = bare(), bare("paper")
    other.hair.seed = 9
    cut = state[: len(state) // 2]
    altered = state[:200] + bytes([state[200] ^ 1]) + state[201:]
    block = state[:20] + bytes([state[20] ^ 1]) + state[21:]
    cases = [
        (lambda: hair.step(head=good[:3]), "head = an array of shape (3, 4): must be a matrix of shape (4, 4)"),
        (lambda: hair.step(head=(1, 2, 3)), "(4, 4), or (position, quaternion)"),
        (lambda: hair.step(head="north"), "numbers"),
        (lambda: hair.step(head=with_entry((1, 2), numpy.nan)), "finite"),
        (lambda: hair.step(head=with_entry((0, 3), 1e39)), "finite"),
        (lambda: hair.step(head=good.T), "transpose"),
        (lambda: hair.step(head=good @ numpy.diag([2, 2, 2, 1])), "scales by 2.0000"),
        (lambda: hair.step(head=good @ numpy.diag([1, -1, 1, 1])), "mirrors"),
        (lambda: hair.step(head=good @ (numpy.eye(4) + 0.01 * numpy.eye(4, k=1))), "shears"),
        (lambda: hair.step(head=((0, 0, 0), (0, 0, 0, 2))), "length 2"),
        (lambda: hair.step(head=((0, 0), (0, 0, 0, 1))), "head position"),
        (lambda: hair.step(head=((0, 0, 0), (0, 0, 1))), "head quaternion"),
        (lambda: hair.step(bodies=[BALL[1], BALL[1]]), "bodies[1] = a pose: the scene has 1"),
        (lambda: hair.step(bodies=[None, None]), "bodies[1] = a pose: the scene has 1"),
        (lambda: hair.step(bodies=[good * numpy.nan]), "bodies[0]"),
        (lambda: deaf.simulate(strands=5).step(bodies=[good]), "body[0].solid = true"),
        (lambda: hair.step(force=(1, 2)), "shape (3,)"),
        (lambda: hair.step(force=(0, numpy.inf, 0)), "finite"),
        (lambda: hair.step(force=(1e9, 0, 0)), f"{hair.strongest_force:g}"[:3]),
        (lambda: hair.step(force=nabiki.Field(lambda points, frame: (0, 0, 0), strongest=1e9)), "time_step"),
        (lambda: hair.restore(b"nothing"), "state of hair = 7 bytes: was not"),
        (lambda: hair.restore(state[:30]), "cut short"),
        (lambda: hair.restore(cut), "cut short"),
        (lambda: hair.restore(state[:-4]), "cut short"),
        (lambda: hair.restore(state + bytes(4)), "bytes after its end"),
        (lambda: hair.restore(altered), "checksum"),
        (lambda: hair.restore(block), "checksum"),
        (lambda: scene.simulate(strands=21).restore(state), "other hair"),
        (lambda: other.simulate(strands=20).restore(state), "other hair"),
        (lambda: paper.simulate(strands=20).restore(state), "this scene has 0"),
        (lambda: paper.simulate(strands=20).step(bodies=[good]), "the scene has 0 bodies"),
    ]
    for wrong, words in cases:
        with pytest.raises(nabiki.Error) as refused:
            wrong()
        text = str(refused.value)
        assert words in text and "\n" not in text and refused.value.way_out, text
    assert hair.state() == state
    for wrong in (lambda: hair.restore("text"), lambda: hair.step(good), lambda: hair.step(bodies=5)):
        with pytest.raises(TypeError):
            wrong()


def test_a_step_whose_field_failed_is_gone_back_from():
    scene = bare()
    hair = scene.simulate(strands=10)
    hair.step()
    state = hair.state()
    wanted = hair.step().points

    def wind(points, frame):
        raise ZeroDivisionError

    hair.restore(state)
    with pytest.raises(ZeroDivisionError):
        hair.step(force=nabiki.Field(wind, strongest=5))
    for ask in (hair.step, hair.state, hair.copy, lambda: next(hair)):
        with pytest.raises(RuntimeError, match="start another"):
            ask()
    hair.restore(state)
    assert numpy.array_equal(bits(hair.step().points), bits(wanted))


def test_threads_have_simulations_of_their_own():
    scene = bare()
    hair = scene.simulate(strands=10)
    refused = []

    def wind(points, frame):
        for ask in (hair.step, hair.state, hair.copy, lambda: hair.restore(state)):
            with pytest.raises(RuntimeError, match=r"each thread its own, scene\.simulate\(\)"):
                ask()
        refused.append(frame)
        return 0, 0, 0

    state = hair.state()
    hair.step(force=nabiki.Field(wind, strongest=1))
    assert set(refused) == {1}
    found = []
    twins = [hair.copy() for _ in range(3)]
    threads = [threading.Thread(target=lambda twin=twin: found.append([twin.step().points for _ in range(8)])) for twin in twins]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    wanted = bits([hair.step().points for _ in range(8)])
    assert len(found) == 3 and all(numpy.array_equal(bits(film), wanted) for film in found)

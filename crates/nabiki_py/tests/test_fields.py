"""Functions of Python as fields."""

import numpy
import pytest
from conftest import SCENES, bits

import nabiki

WIND = (-60.0, 25.0, 10.0)


def still(form):
    """A head that stands still, moved by nothing yet."""
    return nabiki.Scene(motion={"form": form, "frames": 10}, hair={"strands": 200})


def constant(points, frame):
    return numpy.full_like(points, WIND)


@pytest.mark.parametrize("form", ["free", "paper"])
def test_a_constant_function_is_the_constant_wind_to_the_bit(form):
    named, given = still(form), still(form)
    named.forces = [(10, WIND)]
    given.fields = [nabiki.Field(constant, strongest=70)]
    wanted = named.timeline(strands=40).play()
    assert not numpy.array_equal(wanted[0], wanted[-1])
    for field in [constant, lambda points, frame: WIND, lambda points, frame: numpy.float64(WIND)]:
        given.fields = [nabiki.Field(field, strongest=70)]
        assert numpy.array_equal(bits(given.timeline(strands=40).play()), bits(wanted))
        stepped = [frame.points for frame in given.simulate(strands=40)]
        assert numpy.array_equal(bits(stepped), bits(wanted))


def test_a_function_hears_places_and_frames():
    asked = set()

    def field(points, frame):
        assert points.shape[1] == 3 and points.dtype == numpy.float32
        asked.add(frame)
        return numpy.where(points[:, 1:2] > 0, WIND, 0)

    scene = still("free")
    scene.fields = [nabiki.Field(field, strongest=70)]
    list(scene.simulate(strands=40))
    assert asked == set(range(1, 11))
    forces = scene.force_at([(0, 5, 0), (0, -5, 0)], 3)
    assert numpy.array_equal(forces, numpy.float32([WIND, (0, 0, 0)]))


def test_fields_add_up_with_those_of_the_settings():
    scene = still("free")
    scene.forces = [(10, (1, 2, 3))]
    scene.fields = [nabiki.Field(constant, strongest=70)] * 2
    assert numpy.array_equal(scene.force_at([(0, 0, 0)], 1), numpy.float32([(1, 2, 3)]) + 2 * numpy.float32([WIND]))


def failing(points, frame):
    if frame == 4:
        raise RuntimeError("in frame 4")
    return WIND


@pytest.mark.parametrize(
    ("field", "error", "words"),
    [
        (failing, RuntimeError, "in frame 4"),
        (lambda points, frame: WIND[:2], nabiki.Error, "shape"),
        (lambda points, frame: points[:3], nabiki.Error, "shape"),
        (lambda points, frame: (71, 0, 0), nabiki.Error, "strongest"),
        (lambda points, frame: (float("nan"), 0, 0), nabiki.Error, "finite forces"),
        (lambda points, frame: None, nabiki.Error, "shape"),
        (lambda points, frame: "wind", ValueError, "convert"),
        (lambda points: WIND, TypeError, "positional"),
    ],
)
def test_what_goes_wrong_in_a_function_is_raised_where_hair_is_moved(field, error, words, tmp_path):
    scene = still("free")
    scene.fields = [nabiki.Field(field, strongest=70)]
    with pytest.raises(error, match=words):
        list(scene.simulate(strands=20))
    with pytest.raises(error, match=words):
        scene.timeline(strands=20).play()
    with pytest.raises(error, match=words):
        scene.export(tmp_path / "wind.usdc", strands=20)
    assert list(tmp_path.iterdir()) == []
    scene.fields = [nabiki.Field(constant, strongest=70)]
    scene.export(tmp_path / "wind.usdc", strands=20)


def test_a_function_too_strong_for_the_hair_is_refused_before_the_first_frame():
    scene = still("free")
    scene.fields = [nabiki.Field(constant, strongest=1e9)]
    with pytest.raises(nabiki.Error, match="1000000000"):
        scene.simulate(strands=20)
    for strongest in [-1, float("nan"), float("inf")]:
        with pytest.raises(nabiki.Error):
            nabiki.Field(constant, strongest=strongest)
    with pytest.raises(nabiki.Error):
        nabiki.Field(WIND, strongest=1)


def test_files_that_cannot_hold_a_function_are_refused(tmp_path):
    scene = nabiki.Scene.open(SCENES / "gust.toml", {"motion.frames": 3, "output.sheet": [0]})
    scene.fields = [nabiki.Field(constant, strongest=70)]
    for refused in [lambda: scene.save(tmp_path / "a.toml"), lambda: scene.export(tmp_path / "a.nabiki", strands=5)]:
        with pytest.raises(nabiki.Error, match="field"):
            refused()
    assert list(tmp_path.iterdir()) == []
    scene.motion.frames = 2
    assert len(scene.fields) == 1, "another setting does not take it out"


def test_a_step_that_failed_is_not_gone_on_from(gust):
    """A field that fails has no force in its step: what comes of that is nobody's motion."""
    fails = False

    def wind(points, frame):
        if fails and frame == 3:
            raise ZeroDivisionError
        return -60, 0, 20

    gust.fields = [nabiki.Field(wind, strongest=70)]
    wanted = gust.timeline(strands=5).play()
    sought, played, motion = gust.timeline(strands=5), gust.timeline(strands=5), gust.simulate(strands=5)
    fails = True
    for ask in (lambda: sought[3], played.play, lambda: list(motion)):
        with pytest.raises(ZeroDivisionError):
            ask()
    fails = False
    for timeline in (sought, played):
        assert numpy.array_equal(bits(timeline[3].points), bits(wanted[3]))
        assert numpy.array_equal(bits(timeline[12].points), bits(wanted[12]))
    with pytest.raises(RuntimeError, match="start another"):
        next(motion)

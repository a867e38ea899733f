"""Whatever a user gets wrong is one line, an exception with its parts, and leaves nothing behind."""

import pickle

import numpy
import pytest
from conftest import SCENES, STRANDS

import nabiki


def test_parts_of_a_refused_setting(tmp_path):
    file = tmp_path / "bad.toml"
    file.write_text("[[force]]\nthrough = 5\nvector = [1, 2, 3]\n[motion]\ntime_step = -0.1\n")
    with pytest.raises(nabiki.Error) as refused:
        nabiki.Scene.open(file)
    error = refused.value
    assert isinstance(error, ValueError)
    assert (error.file, error.line, error.thing, error.value) == (str(file), 5, "motion.time_step", "-0.1")
    assert error.way_out == "must be a finite number above 0"
    assert str(error) == f"{file}:5: motion.time_step = -0.1: must be a finite number above 0"
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error) and vars(again) == vars(error)


def lines():
    """What cannot be, and a word of the way out."""
    gust = nabiki.Scene.open(SCENES / "gust.toml", {"hair.strands": STRANDS, "motion.frames": 3, "output.sheet": [0]})
    points, offsets = gust.groom(strands=3)
    wrong = points.copy()
    wrong[4] = numpy.nan
    made = nabiki.Scene(hair=(points, offsets), forces=[(3, (1, 0, 0))])
    cube = numpy.float32([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    return [
        (lambda: nabiki.Scene.open("none.toml"), "none.toml"),
        (lambda: nabiki.Scene.open(SCENES / "gust.toml", {"motion.framez": 3}), "did you mean"),
        (lambda: nabiki.Scene.parse("[motion"), "TOML"),
        (lambda: nabiki.Scene(motions={}), "motion"),
        (lambda: list(nabiki.Scene().simulate()), "force"),
        (lambda: nabiki.Scene(head="none.obj", forces=[(1, (1, 0, 0))]).groom(), "none.obj"),
        (lambda: nabiki.Scene(hair=(points, offsets[:-1])), "must begin with 0"),
        (lambda: nabiki.Scene(hair=(points, [0, 1, len(points)])), "two points"),
        (lambda: nabiki.Scene(hair=(points, 7)), "shape"),
        (lambda: nabiki.Scene(hair=(points[:, :2], offsets)), "shape"),
        (lambda: nabiki.Scene(hair=(wrong, offsets)), "finite"),
        (lambda: nabiki.Scene(hair=("a", "b")), "array"),
        (lambda: nabiki.Scene(hair=(points,)), "(points, offsets)"),
        (lambda: nabiki.Scene(hair=[points]), "(points, offsets)"),
        (lambda: nabiki.Scene(hair=(points[None], offsets)), f"(1, {len(points)}, 3)"),
        (lambda: nabiki.Scene(hair=(points[:0], [0])), "one strand"),
        (lambda: nabiki.Scene(hair=(points, numpy.r_[0, offsets[1:-1] + 0.7, offsets[-1]])), "whole"),
        (lambda: nabiki.Scene(hair=(points, numpy.where(offsets == 0, numpy.nan, offsets))), "whole"),
        (lambda: nabiki.Scene(hair=(points, offsets.astype(str))), "numbers"),
        (lambda: nabiki.Scene(hair=(points + 1j, offsets)), "complex"),
        (lambda: nabiki.Scene(hair=(numpy.ma.masked_greater(points, 0), offsets)), "masked"),
        (lambda: nabiki.Scene(head=(cube, [(0, 1, 8)])), "0 to 7"),
        (lambda: nabiki.Scene(head=(cube, [0, 1, 2])), "shape"),
        (lambda: nabiki.Scene(head=(cube, [(0, 1)])), "(faces, 3) or (faces, 4)"),
        (lambda: nabiki.Scene(head=(cube, [(0, 1, 2.5)])), "whole"),
        (lambda: nabiki.Scene(head=(cube[:0], [(0, 1, 2)])), "there are none"),
        (lambda: made.save("made.toml"), "write_hair"),
        (lambda: gust.simulate(strands=0), "strands"),
        (lambda: gust.simulate(strands=10**7), "strands"),
        (lambda: gust.render(4), "0 to motion.frames = 3"),
        (lambda: gust.render_png(0, file="none/a.png"), "none"),
        (lambda: gust.render_png(0, file="a.exr"), "scene.render_exr writes OpenEXR"),
        (lambda: gust.render_exr(0, file="a.png"), "scene.render_png writes PNG"),
        (lambda: gust.render_exr(4), "0 to motion.frames = 3"),
        (lambda: gust.export("none/a.usdc"), "none"),
        (lambda: gust.export("a.mp4"), ".usdc"),
        (lambda: gust.export(SCENES), "scenes"),
        (lambda: gust.export("a.usdc", layer="/hair"), "layer"),
        (lambda: gust.export("a.glb", chains=(0, 8)), "chains of joints: 0x8: give at least 1x1"),
        (lambda: gust.export("a.glb", cards=-1), "chains of joints: cards of -1 cm"),
        (lambda: gust.export("a.usdc", springs=True), "springs are for chains of joints: export a .glb with them"),
        (lambda: gust.groom(file="a.txt"), ".hair"),
        (lambda: gust.solve("none.toml"), "none.toml"),
        (lambda: gust.solve([]), "wish"),
        (lambda: gust.solve([{"frame": 1}]), "wish[0]"),
        (lambda: gust.solve([{"frame": 1, "strands": [1], "moved": (1, 0, 0)}], unknowns={}), "may change"),
        (lambda: gust.solve([{"frame": 1, "strands": [1], "moved": (1, 0, 0)}], space="moon"), "world"),
        (lambda: nabiki.convert("none.hair", "a.usdc"), "none.hair"),
        (lambda: nabiki.convert(SCENES / "gust.toml", "a.usdc"), "gust.toml"),
        (lambda: nabiki.convert("none.hair", "a.usdc", unit="mile"), "mile"),
        (lambda: nabiki.info("none.hair"), "none.hair"),
        (lambda: nabiki.write_hair("a.txt", points, offsets), ".hair"),
    ]


@pytest.mark.parametrize("place", range(len(lines())))
def test_what_cannot_be_is_one_line_with_a_way_out(place, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    wrong, word = lines()[place]
    with pytest.raises(nabiki.Error) as refused:
        wrong()
    text = str(refused.value)
    assert word in text and "\n" not in text and text[-1] not in ".:", text
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "wrong",
    [
        lambda scene: setattr(scene.motion, "frames", object()),
        lambda scene: scene.simulate(strands="many"),
        lambda scene: scene.render(1.5),
        lambda scene: scene.simulate(strands=2.0),
        lambda scene: nabiki.Field(wind, "strong"),
        lambda scene: scene.export(5),
        lambda scene: setattr(scene, "fields", [5]),
    ],
)
def test_arguments_of_another_type_are_exceptions_of_python(wrong):
    scene = nabiki.Scene.open(SCENES / "gust.toml", {"hair.strands": STRANDS, "motion.frames": 3, "output.sheet": [0]})
    with pytest.raises(TypeError):
        wrong(scene)


def wind(points, frame):
    return (1, 0, 0)


WISH = {"frame": 1, "strands": [1], "moved": (1, 0, 0)}
# Name and range of each number that is an argument, and a call with it.
NUMBERS = {
    "groom": ("strands", "from 1 to", lambda scene, n: scene.groom(strands=n)),
    "simulate": ("strands", "from 1 to", lambda scene, n: scene.simulate(strands=n)),
    "simulate by place": ("strands", "from 1 to", lambda scene, n: scene.simulate(n)),
    "timeline": ("strands", "from 1 to", lambda scene, n: scene.timeline(strands=n)),
    "render strands": ("strands", "from 1 to", lambda scene, n: scene.render(0, strands=n)),
    "run": ("strands", "from 1 to", lambda scene, n: scene.run("out", strands=n)),
    "preview": ("strands", "from 1 to", lambda scene, n: scene.preview("out", strands=n)),
    "export": ("strands", "from 1 to", lambda scene, n: scene.export("a.usda", strands=n)),
    "solve": ("strands", "from 1 to", lambda scene, n: scene.solve([WISH], strands=n)),
    "solve a file": ("strands", "from 1 to", lambda scene, n: scene.solve("a.toml", strands=n)),
    "render": ("frame", "from 0 to", lambda scene, n: scene.render(n)),
    "render_png": ("frame", "from 0 to", lambda scene, n: scene.render_png(n)),
    "render_exr": ("frame", "from 0 to", lambda scene, n: scene.render_exr(n)),
    "force_at": ("frame", "from 0 to", lambda scene, n: scene.force_at([(0, 0, 0)], n)),
    "convert frame": ("frame", "from 0 to", lambda scene, n: nabiki.convert("a.nabiki", "a.hair", frame=n)),
    "convert segments": ("segments", "from 1 to", lambda scene, n: nabiki.convert("a.hair", "b.hair", segments=n)),
    "convert first": ("first_frame", "from -10000000 to 10000000", lambda scene, n: nabiki.convert("a.abc", "b.abc", first_frame=n)),
    "setting": ("motion.frames", "must", lambda scene, n: setattr(scene.motion, "frames", n)),
    "setting by key": ("hair.strands", "must", lambda scene, n: scene.__setitem__("hair.strands", n)),
    "interval": ("force[0].through", "must", lambda scene, n: setattr(scene, "forces", [(n, (1, 0, 0))])),
    "strongest": ("strongest", "at least 0", lambda scene, n: nabiki.Field(wind, n)),
}


@pytest.mark.parametrize("case", NUMBERS)
def test_a_number_out_of_its_range_is_named_with_its_range(case, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    scene = nabiki.Scene.open(SCENES / "gust.toml", {"hair.strands": STRANDS, "motion.frames": 3, "output.sheet": [0]})
    thing, words, call = NUMBERS[case]
    for wrong in (-(2**31), -(10**30), 10**400, numpy.int64(-(2**40))):
        with pytest.raises(nabiki.Error) as refused:
            call(scene, wrong)
        error = refused.value
        assert error.thing == thing and words in error.way_out and "\n" not in str(error) and len(str(error)) < 300, error
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("wrong", [float("nan"), float("inf"), -float("inf"), 1e300, -1e300])
def test_numbers_that_are_none_are_refused_by_name(wrong):
    scene = nabiki.Scene.open(SCENES / "gust.toml", {"hair.strands": STRANDS, "motion.frames": 3, "output.sheet": [0]})
    before = scene.settings()
    for thing, put in [
        ("motion.time_step", lambda: setattr(scene.motion, "time_step", wrong)),
        ("motion.frames", lambda: setattr(scene.motion, "frames", wrong)),
        ("force[0].vector", lambda: setattr(scene, "forces", [(3, (wrong, 0, 0))])),
        ("free.stiffness", lambda: setattr(scene.free, "stiffness", wrong)),
        ("strongest", lambda: nabiki.Field(wind, wrong)),
        ("force", lambda: scene.simulate(strands=2).step(force=(wrong, 0, 0))),
        ("points", lambda: scene.force_at([(wrong, 0, 0)], 1)),
    ]:
        with pytest.raises(nabiki.Error) as refused:
            put()
        assert (refused.value.thing or "").startswith(thing), refused.value
    assert scene.settings() == before


def test_threads_that_are_not_made_are_refused_in_one_line():
    import os
    import subprocess
    import sys

    code = """
import nabiki
scene = nabiki.Scene(forces=[(1, (1, 0, 0))])
for ask in [lambda: scene.timeline(strands=3), lambda: scene.simulate(strands=3), lambda: scene.groom(strands=3)]:
    try:
        ask()
    except nabiki.Error as refused:
        assert chr(10) not in str(refused) and "RAYON_NUM_THREADS=10000: at most 512 threads" in str(refused), refused
    else:
        raise AssertionError("made")
"""
    ran = subprocess.run([sys.executable, "-c", code], env={**os.environ, "RAYON_NUM_THREADS": "10000"}, capture_output=True, text=True)
    assert ran.returncode == 0 and not ran.stderr, ran.stderr

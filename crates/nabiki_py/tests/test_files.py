"""What the system refuses is an OSError as well as the package's own; what is saved and sent can be read again."""

import errno
import multiprocessing
import os
import pickle

import pytest
from conftest import SCENES, command

import nabiki

WIND = "[[force]]\nthrough = 5\nvector = [1, 2, 3]\n"
LIE = 'unit = "cm"\nup = "+y"\nfacing = "+x"\n'


def parsed(text):
    return nabiki.Scene.parse(text + WIND, "here.toml")


MISSING = {
    "scene": (lambda: nabiki.Scene.open("none.toml"), "none.toml"),
    "scene in no folder": (lambda: nabiki.Scene.open("no/none.toml"), "no/none.toml"),
    "hair": (lambda: nabiki.Scene(hair="none.hair", motion={"form": "free"}).groom(), "none.hair"),
    "tfx": (lambda: nabiki.Scene(hair="none.tfx", motion={"form": "free"}).groom(), "none.tfx"),
    "usd": (lambda: nabiki.Scene(hair="none.usda", motion={"form": "free"}).groom(), "none.usda"),
    "alembic": (lambda: nabiki.Scene(hair="none.abc", motion={"form": "free"}).simulate(), "none.abc"),
    "head": (lambda: nabiki.Scene(head="none.obj", motion={"form": "free"}).timeline(), "none.obj"),
    "gltf": (lambda: nabiki.Scene(head="none.glb", motion={"form": "free"}).timeline(), "none.glb"),
    "motion": (lambda: parsed('[head.motion]\nfile = "none.bvh"\n').simulate(strands=2), "none.bvh"),
    "table": (lambda: parsed('[head.motion]\nfile = "none.csv"\n').simulate(strands=2), "none.csv"),
    "body": (lambda: nabiki.Scene(bodies=["none.ply"], motion={"form": "free"}).simulate(strands=2), "none.ply"),
    "wishes": (lambda: parsed("").solve("none.toml"), "none.toml"),
    "convert": (lambda: nabiki.convert("none.hair", "a.usda"), "none.hair"),
    "info": (lambda: nabiki.info("none.nabiki"), "none.nabiki"),
    "new": (lambda: nabiki.new("new.toml", hair="none.hair"), "none.hair"),
    "save": (lambda: parsed("").save("no/a.toml"), "no/a.toml"),
    "export": (lambda: parsed("").export("no/a.usda", strands=2), "no/a.usda"),
    "picture": (lambda: parsed("").render_png(0, file="no/a.png", strands=2), "no/a.png"),
    "groom": (lambda: parsed("").groom(file="no/a.hair", strands=2), "no/a.hair"),
}


@pytest.mark.parametrize("case", MISSING)
def test_a_missing_file_is_what_python_calls_it(case, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    work, name = MISSING[case]
    with pytest.raises(FileNotFoundError) as refused:
        work()
    error = refused.value
    assert isinstance(error, nabiki.Error) and isinstance(error, ValueError)
    assert error.errno == errno.ENOENT and error.filename == name and error.strerror == os.strerror(errno.ENOENT)
    assert name in str(error) and error.file in (None, name, "here.toml") and "\n" not in str(error)
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is type(error) and str(again) == str(error) and vars(again) == vars(error)
    assert (again.errno, again.filename, again.strerror) == (error.errno, error.filename, error.strerror)
    assert list(tmp_path.iterdir()) == []


def test_folders_and_files_in_the_wrong_place_are_what_python_calls_them(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder.toml").mkdir()
    (tmp_path / "folder.usda").mkdir()
    (tmp_path / "file").write_text("")
    scene = parsed("")
    scene.save("there.toml")
    for kind, number, work in [
        (IsADirectoryError, errno.EISDIR, lambda: nabiki.Scene.open("folder.toml")),
        (IsADirectoryError, errno.EISDIR, lambda: nabiki.Scene(hair="folder.usda", motion={"form": "free"}).groom()),
        (IsADirectoryError, errno.EISDIR, lambda: scene.export("folder.usda", strands=2)),
        (NotADirectoryError, errno.ENOTDIR, lambda: nabiki.Scene.open("file/a.toml")),
        (NotADirectoryError, errno.ENOTDIR, lambda: scene.run("file", strands=2)),
        (FileExistsError, errno.EEXIST, lambda: nabiki.new("there.toml")),
    ]:
        with pytest.raises(kind) as refused:
            work()
        assert isinstance(refused.value, nabiki.Error) and refused.value.errno == number and refused.value.filename


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read everything")
def test_a_file_that_is_closed_is_a_permission_error(tmp_path):
    closed = tmp_path / "closed.toml"
    closed.write_text(WIND)
    closed.chmod(0)
    with pytest.raises(PermissionError) as refused:
        nabiki.Scene.open(closed)
    assert refused.value.errno == errno.EACCES and isinstance(refused.value, nabiki.Error)


@pytest.mark.skipif(not os.path.exists("/proc/self/mem"), reason="a system with /proc")
def test_other_words_of_the_system_are_no_worse(tmp_path):
    """Content that is wrong is not the system's affair."""
    wrong = tmp_path / "wrong.hair"
    wrong.write_bytes(b"HAIR")
    with pytest.raises(nabiki.Error) as refused:
        nabiki.info(wrong)
    assert not isinstance(refused.value, OSError)


def never_opened():
    """Scenes of which every setting is good by itself and the whole is refused: what was done, and what says so."""

    def shorter(scene):
        scene.output.sheet = [5]
        scene.motion.frames = 3

    def eased(scene):
        scene.wind.ease = "smooth"
        scene.forces = []

    def gusty(scene):
        scene.gust = {}
        scene.forces.clear()

    def led(scene):
        scene.flow = {}
        scene.force = None

    def still(scene):
        scene.head.motion = {"file": "m.bvh"}
        scene.body_wind = {}
        scene.head.motion = None

    def windless(scene):
        scene.forces = []
        scene.motion.form = "paper"

    return [
        (shorter, "output.sheet[0]"),
        (eased, "wind.ease"),
        (gusty, "gust"),
        (led, "flow"),
        (still, "body_wind"),
        (windless, "force"),
    ]


@pytest.mark.parametrize(("change", "thing"), never_opened())
def test_what_no_file_can_say_is_neither_moved_nor_saved_nor_sent(change, thing, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.toml").write_text('[motion]\nform = "free"\nframes = 8\n' + WIND)
    scene = nabiki.Scene.open("a.toml")
    change(scene)
    lines = set()
    for work in [
        lambda: scene.save("b.toml"),
        scene.to_toml,
        lambda: pickle.dumps(scene),
        lambda: scene.simulate(strands=2),
        lambda: scene.timeline(strands=2),
        lambda: scene.groom(strands=2),
        lambda: scene.force_at([(0, 0, 0)], 1),
        lambda: scene.render(0, strands=2),
        lambda: scene.export("b.usda", strands=2),
        lambda: scene.export("b.nabiki", strands=2),
        lambda: scene.run("out", strands=2),
        lambda: scene.preview("out", strands=2),
        lambda: scene.solve([{"frame": 1, "strands": [1], "moved": (1, 0, 0)}]),
    ]:
        with pytest.raises(nabiki.Error) as refused:
            work()
        assert refused.value.thing == thing and refused.value.file == "a.toml"
        lines.add(str(refused.value))
    assert len(lines) == 1 and [file.name for file in tmp_path.iterdir()] == ["a.toml"]
    # Inside the process it may be looked at, copied and mended.
    assert scene == scene.copy() and repr(scene)
    scene.motion.frames, scene.output.sheet, scene.wind.ease = 8, None, None
    scene.gust = scene.flow = scene.body_wind = None
    scene.forces = [(5, (1, 2, 3))]
    scene.save("b.toml")
    assert nabiki.Scene.open("b.toml") == scene


def test_the_line_is_that_of_a_file(tmp_path):
    """Two settings may change together, so that the whole is looked at; what it says is what the command says of the same file."""
    text = "[motion]\nframes = {}\n[output]\nsheet = [5]\n" + WIND
    file = tmp_path / "a.toml"
    file.write_text(text.format(8))
    scene = nabiki.Scene.open(file)
    scene.motion.frames = 3
    with pytest.raises(nabiki.Error) as refused:
        scene.simulate(strands=2)
    file.write_text(text.format(3))
    with pytest.raises(nabiki.Error) as of_file:
        nabiki.Scene.open(file)
    assert str(refused.value) == str(of_file.value) and refused.value.line == of_file.value.line == 4
    with pytest.raises(AssertionError, match=r"output\.sheet\[0\] = 5"):
        command("info", file)


def test_a_pool_hears_what_is_wrong_where_it_is_sent(gust):
    gust.output.sheet = [12]
    gust.motion.frames = 3
    with multiprocessing.get_context("spawn").Pool(1) as pool, pytest.raises(nabiki.Error, match="sheet"):
        pool.map(repr, [gust])


@pytest.mark.parametrize("name", ["a.abc", "a.usda", "a.hair", "a.nabiki", "a.mp4", "a.obj"])
def test_a_scene_is_not_saved_under_a_name_that_is_none_of_a_scene(name, tmp_path):
    with pytest.raises(nabiki.Error, match="ends in .toml"):
        parsed("").save(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_a_scene_of_no_file_leads_to_the_same_files_from_wherever_it_is_saved(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    points, offsets = parsed("").groom(strands=3)
    nabiki.write_hair("a.hair", points, offsets)
    (tmp_path / "below").mkdir()
    made = nabiki.Scene(hair={"file": "a.hair", "unit": "cm", "up": "+y", "facing": "+x"}, motion={"form": "free"})
    (tmp_path / "a.toml").write_text(made.to_toml())
    for scene in (made, nabiki.Scene.open("a.toml"), nabiki.Scene.open(tmp_path / "a.toml")):
        scene.save("below/b.toml")
        assert len(nabiki.Scene.open("below/b.toml").groom()[1]) == 4
        assert scene.hair.file == "../a.hair" and scene == nabiki.Scene.open(tmp_path / "below" / "b.toml")


@pytest.mark.skipif(os.name == "nt" or os.uname().sysname == "Darwin", reason="names that are no text")
def test_a_name_that_is_no_text_is_refused_and_not_changed(tmp_path):
    odd = os.fsdecode(os.fsencode(tmp_path) + b"/\xff.hair")
    scene = parsed("")
    for put in (lambda: setattr(scene.hair, "file", odd), lambda: scene.__setitem__("hair", {"file": odd})):
        with pytest.raises(nabiki.Error, match="Unicode"):
            put()
    file = os.fsdecode(os.fsencode(tmp_path) + b"/\xff.toml")
    with open(file, "w") as out:
        out.write(WIND)
    scene = nabiki.Scene.open(file)
    assert scene.file == file and pickle.loads(pickle.dumps(scene)).file == file

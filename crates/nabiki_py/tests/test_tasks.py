"""Pictures, files and answers are the command's; what is stopped leaves nothing."""

import importlib.metadata
import os
import re
import signal
import subprocess
import sys
import threading
import time

import numpy
import pytest
from conftest import ROOT, SCENES, STRANDS, bits, command

import nabiki

GUST = SCENES / "gust.toml"
SMALL = ["--set", "motion.frames=12", "--set", "picture.size=[160,90]", "--set", "output.sheet=[0]", "--quiet"]
SMALL += ["--set", f"hair.strands={STRANDS}"]


def test_the_version_is_that_of_the_crates_and_of_the_package():
    said = re.search(r'^version = "(.*)"$', (ROOT / "Cargo.toml").read_text(), flags=re.M)[1]
    assert nabiki.__version__ == said == importlib.metadata.version("nabiki")


def test_a_picture_is_the_commands(gust, tmp_path):
    command("render", GUST, *SMALL, "--strands", 200, "--frame", 9, "--out", tmp_path)
    wanted = (tmp_path / "gust_0009.png").read_bytes()
    assert gust.render_png(9, strands=200, file=tmp_path / "own.png") == wanted
    assert (tmp_path / "own.png").read_bytes() == wanted
    light = gust.render(9, strands=200)
    assert light.shape == (90, 160, 4) and light.dtype == numpy.float32
    assert 0 <= light.min() and light[..., 3].max() <= 1 + 1e-6 and light.std() > 0


@pytest.mark.parametrize("blurred", [False, True])
def test_a_picture_of_light_is_the_commands(gust, tmp_path, blurred):
    gust.picture.shutter = 0.5 * blurred
    more = ["--set", f"picture.shutter={0.5 * blurred}", "--set", "output.exr_frames=true"]
    command("render", GUST, *SMALL, *more, "--strands", 200, "--frame", 9, "--out", tmp_path)
    wanted = (tmp_path / "gust_0009.exr").read_bytes()
    assert all(name in wanted for name in [b"hair.A", b"direction.X", b"motion.Y"])
    assert gust.render_exr(9, strands=200, file=tmp_path / "own.EXR") == wanted
    assert (tmp_path / "own.EXR").read_bytes() == wanted
    assert not gust.output.exr_frames
    gust.output.exr_frames = True
    assert gust.render_exr(9, strands=200) == wanted


@pytest.mark.parametrize("ending", ["png", "exr"])
def test_a_picture_that_has_no_place_is_not_drawn(gust, tmp_path, ending):
    drawn, render = [], getattr(gust, f"render_{ending}")
    for file, words in [(tmp_path / "none" / f"a.{ending}", "its folder does not exist"), (tmp_path / "a.tif", f"must end in .{ending}")]:
        with pytest.raises(nabiki.Error, match=words):
            render(9, strands=20, file=file, progress=lambda *done: drawn.append(done))
    assert not drawn and not list(tmp_path.iterdir())


@pytest.mark.parametrize("ending", ["usdc", "usda", "abc", "nabiki"])
def test_moving_hair_is_the_commands(gust, tmp_path, ending):
    command("simulate", GUST, *SMALL, "--strands", 50, "-o", tmp_path / f"wanted.{ending}")
    steps = []
    gust.export(tmp_path / f"found.{ending}", strands=50, progress=lambda done, total: steps.append((done, total)))
    assert (tmp_path / f"found.{ending}").read_bytes() == (tmp_path / f"wanted.{ending}").read_bytes()
    assert steps[0] == (0, 13) and steps[-1] == (13, 13) and steps == sorted(steps)


def test_chains_of_joints_are_the_commands(gust, tmp_path):
    chains = ["--export-chains", "12x5", "--export-cards", "0.3", "--export-springs"]
    command("simulate", GUST, *SMALL, "--strands", 50, *chains, "-o", tmp_path / "wanted.glb")
    gust.export(tmp_path / "found.glb", strands=50, chains=(12, 5), cards=0.3, springs=True)
    assert (tmp_path / "found.glb").read_bytes() == (tmp_path / "wanted.glb").read_bytes()


def test_the_groom_is_the_commands(gust, tmp_path):
    command("groom", GUST, *SMALL, "--strands", 50, "-o", tmp_path / "wanted.hair")
    points, offsets = gust.groom(strands=50, file=tmp_path / "found.hair", report=print)
    assert (tmp_path / "found.hair").read_bytes() == (tmp_path / "wanted.hair").read_bytes()
    assert offsets[-1] == len(points) and len(offsets) == 51
    nabiki.write_hair(tmp_path / "written.usda", points, offsets)
    nabiki.convert(tmp_path / "written.usda", tmp_path / "back.hair")
    again = nabiki.Scene(hair={"file": tmp_path / "back.hair", "join_within": 0}, motion={"form": "free"})
    # The built-in head's origin is that of head space, so hair comes back where it was.
    assert numpy.array_equal(bits(again.groom()[0]), bits(points))


def test_movie_and_preview_are_written_and_reported(gust, tmp_path):
    lines = []
    gust.run(tmp_path / "run", strands=50, report=lines.append)
    gust.preview(tmp_path / "preview", strands=30)
    assert (tmp_path / "run" / "gust.mp4").stat().st_size > 0
    assert (tmp_path / "preview" / "gust_preview.mp4").stat().st_size > 0
    assert any("wrote" in line for line in lines) and any("hair" in line for line in lines)


def test_what_looks_wrong_is_a_warning(tmp_path):
    with pytest.warns(UserWarning, match="lost"):
        scene = nabiki.Scene.open(GUST, {"motion.frames": 1, "output.sheet": [0]})
        scene.groom(strands=5, file=tmp_path / "a.hair")


def test_info_is_a_dictionary(gust, tmp_path):
    assert nabiki.info(GUST)["kind"] == "scene"
    gust.export(tmp_path / "a.nabiki", strands=5)
    assert nabiki.info(tmp_path / "a.nabiki")["kind"] == "cache"


def test_a_new_scene_runs(tmp_path):
    nabiki.new(tmp_path / "new.toml")
    scene = nabiki.Scene.open(tmp_path / "new.toml", {"motion.frames": 2, "output.sheet": [0]})
    assert len(list(scene.simulate(strands=5))) == 3
    with pytest.raises(nabiki.Error, match="there already"):
        nabiki.new(tmp_path / "new.toml")


def test_the_wind_that_is_found_is_the_commands(tmp_path):
    scene = nabiki.Scene.open(GUST)
    wishes = SCENES / "wishes" / "gust.toml"
    found = scene.solve(wishes)
    command("solve", GUST, "--wish", wishes, "-o", tmp_path / "solved.toml", "--quiet")
    solved = nabiki.Scene.open(tmp_path / "solved.toml")
    assert found.forces == solved.forces == found.scene.forces != scene.forces
    assert found.after_cm < found.before_cm
    assert [wish["name"] for wish in found.wishes][0] == "wish[0]"


def test_wishes_are_dictionaries_too(gust):
    gust.motion.frames = 20
    wish = {"frame": 20, "near": {"point": (-10, -8, 0), "radius": 4, "frame": 0}, "mean_moved": (-2, 1, 0)}
    found = gust.solve([wish], search={"iterations": 5, "starts": 1})
    assert found.after_cm < found.before_cm and len(found.forces) == len(gust.forces)
    steps = []
    gust.solve([wish], search={"iterations": 5, "starts": 1}, progress=lambda done, total: steps.append((done, total)))
    assert steps[0] == (0, 5) and steps == sorted(steps)

    def stop(done, total):
        if done:
            raise Enough

    with pytest.raises(Enough):
        gust.solve([wish], progress=stop)
    with pytest.raises(nabiki.Error) as refused:
        gust.solve([{"frame": 99, "strands": [1], "moved": (1, 0, 0)}])
    assert refused.value.thing == "wish[0].frame" and refused.value.line is None


def test_places_are_those_of_the_nodes_that_move(gust):
    """All but the root: whoever gives one place too many is told so."""
    timeline = gust.timeline(strands=300)
    start, end = timeline.offsets[3:5]
    there = timeline[12].points[start:end] + numpy.linspace(0, 1, end - start)[:, None] * (0, 1, 0)
    wish = {"frame": 12, "strands": [3], "places": there[1:]}
    assert gust.solve([wish], search={"starts": 1}).before_cm > 0.1
    with pytest.raises(nabiki.Error, match="not counting roots"):
        gust.solve([{**wish, "places": there}])


class Enough(Exception):
    pass


def test_an_exception_of_the_callback_stops_the_work_and_leaves_nothing(gust, tmp_path):
    def stop(done, total):
        if done:
            raise Enough

    gust.motion.frames = 2000
    for work in [
        lambda: gust.export(tmp_path / "a.usdc", strands=20, progress=stop),
        lambda: gust.run(tmp_path / "out", progress=stop),
        lambda: gust.render(1999, progress=stop),
    ]:
        with pytest.raises(Enough):
            work()
        assert list(tmp_path.iterdir()) == []


# Carriers make it slow and not large, since what a disk cannot hold is refused.
STOPPED = """
import signal, sys, nabiki
# What is started in the background of a shell ignores it, and so does all that it starts.
signal.signal(signal.SIGINT, signal.default_int_handler)
scene = nabiki.Scene.open(sys.argv[1], {"motion.frames": 20000, "neighbours.carriers": 4096, "output.sheet": [0]})
if sys.argv[3] == "field":
    scene.fields = [nabiki.Field(lambda points, frame: (1, 0, 0), strongest=1)]
print("begun", flush=True)
try:
    scene.export(sys.argv[2] + "/a.usdc", strands=2)
except KeyboardInterrupt:
    print("stopped", flush=True)
"""


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize("how", ["plain", "field"])
def test_ctrl_c_stops_the_work_and_leaves_nothing(tmp_path, how):
    words = [sys.executable, "-c", STOPPED, str(SCENES / "gust.toml"), str(tmp_path), how]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "begun\n"
        while not any(tmp_path.iterdir()):
            assert process.poll() is None
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "stopped\n"
    assert process.returncode == 0 and list(tmp_path.iterdir()) == []


def test_other_threads_of_python_go_on_meanwhile(gust, tmp_path):
    counted, done = 0, threading.Event()

    def count():
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    gust.export(tmp_path / "a.nabiki", strands=2000)
    done.set()
    thread.join()
    assert counted > 3


def test_the_working_folder_is_pythons(gust, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    gust.export("a.usda", strands=2)
    assert (tmp_path / "a.usda").exists() and not (ROOT / "a.usda").exists()


def test_whoever_is_called_may_ask_the_scene(gust, tmp_path):
    heard = []
    gust.fields = [nabiki.Field(lambda points, frame: (gust.motion.frames, 0, 0), strongest=20)]
    gust.export(tmp_path / "a.usda", strands=5, progress=lambda done, total: heard.append(gust.motion.frames))
    assert set(heard) == {12}
    gust.fields = []
    other = []
    gust.render(2, strands=5, progress=lambda done, total: other.append(len(list(gust.simulate(strands=3)))))
    assert set(other) == {13}


FORKED = """
import multiprocessing, sys, nabiki
scene = nabiki.Scene.open(sys.argv[1], {"hair.strands": 2000, "motion.frames": 3, "picture.size": (64, 36), "output.sheet": [0]})

def motion(_):
    return scene.timeline(strands=300).play().tobytes(), scene.render_png(2, strands=300)

def in_a_fork_of_a_fork(pipe):
    with multiprocessing.get_context("fork").Pool(1) as pool:
        pipe.send(pool.map(motion, [0]))

here = motion(0)
context = multiprocessing.get_context("fork")
with context.Pool(2) as pool:
    assert pool.map(motion, range(4)) == [here] * 4
out, into = context.Pipe(False)
child = context.Process(target=in_a_fork_of_a_fork, args=(into,))
motion(0)
child.start()
assert out.recv() == [here]
child.join()
print("done")
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="forks of POSIX")
def test_a_forked_process_works_though_the_threads_stayed_behind():
    words = [sys.executable, "-W", "ignore", "-c", FORKED, str(SCENES / "gust.toml")]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True, start_new_session=True) as process:
        try:
            assert process.communicate(timeout=60)[0] == "done\n"
        finally:
            # Forks that wait for ever would outlive the one that made them.
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)

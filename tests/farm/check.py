"""Runs the jobs that nabiki farm writes, and compares their results with one machine's, byte for byte.

    python3 tests/farm/check.py            builds, makes its own environment, checks
    python3 tests/farm/check.py --slurm    besides, submits a job to the Slurm of this machine and waits for it
    python3 tests/farm/check.py --nabiki COMMAND    with a command that is built already
    python3 tests/farm/check.py --environment       the environment, and nothing else

openjd-cli comes from PyPI into target/farm. Jobs of Open Job Description are checked and run by it: all steps, then a task
once more, as after a machine was lost. The tasks of a Slurm script are run as Slurm would run them, one after another;
with --slurm by Slurm itself, and one of them is killed and queued again.
"""

import argparse
import os
import shutil
import subprocess
import sys
import time
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
WORK = ROOT / "target" / "farm"
RESULTS = ["{name}.nabiki", "{name}.mp4"]

# Both forms of the motion, the second with carriers and a head that turns; shards and frames that do not divide evenly.
JOBS = [
    ("scenes/paper/gust.toml", [], 3, 4, 11),
    ("scenes/head_turn.toml", ["--set", "picture.shutter=0.5"], 7, 5, 13),
    ("scenes/storm.toml", ["--set", "hair.strands=900", "--strands", "90"], 1, 3, 6),
]


def run(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, cwd=ROOT, **options)


def build():
    """The command, built now."""
    run("cargo", "build", "--quiet", "--release", "-p", "nabiki_cli")
    return Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "nabiki"


def environment():
    """openjd-cli; installed once."""
    openjd = WORK / "venv" / "bin" / "openjd"
    if not openjd.exists():
        venv.create(WORK / "venv", with_pip=True)
        run(WORK / "venv" / "bin" / "python", "-m", "pip", "install", "--quiet", "openjd-cli==0.8.0")
    return openjd


def small(changes, frames):
    """Few strands of a scene, small."""
    few = [] if "--strands" in changes else ["--set", "hair.strands=400"]
    return [*changes, *few, "--set", "picture.size=[160,96]", "--frames", str(frames)]


def same(folder, whole, name):
    for result in (result.format(name=name) for result in RESULTS):
        assert (folder / result).read_bytes() == (whole / result).read_bytes(), f"{folder / result} is another"
    left = [part for part in folder.rglob(".nabiki-part-*")]
    assert not left, f"unfinished files: {left}"


def openjd_run(openjd, template, scene, nabiki, step, *more):
    words = [openjd, "run", template, "--step", step, *more, "-p", f"Scene={scene}", "-p", f"Nabiki={nabiki}"]
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    assert done.returncode == 0, f"{template}: {step}\n{done.stdout}{done.stderr}"


# Names of scenes and changes to them that a template may trip over.
NAMES = [
    "風 \u202ewind\u2028",
    "n" * 240,
    ": - {a} # 'b' \"c\" \\",
    "a\ttab",
    "esc\x1b",
    "{{Param.Scene}}",
    "x}}",
    "-n",
    "!!int 7",
    "\ufeff\ufffe&*",
]
CHANGES = ["picture.camera={to={azimuth=1}}", "picture.size=[320,\t180]", 'head.mesh="{{x}}.obj"']


def names(openjd, nabiki):
    """Each is written as a template that openjd takes, or refused in one line."""
    folder = WORK / "names"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    force = "[hair]\nstrands = 20\n[motion]\nframes = 3\n[[force]]\nthrough = 3\nvector = [0, -9, 0]\n"
    taken = 0
    for name, changes in [(name, []) for name in NAMES] + [("plain", ["--set", change]) for change in CHANGES]:
        scene, template = folder / f"{name}.toml", folder / "job.yaml"
        scene.write_text(force)
        words = [nabiki, "farm", scene, *changes, "--engine", "openjd", "-o", template, "--quiet"]
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
        if done.returncode == 0:
            run(openjd, "check", template, stdout=subprocess.DEVNULL)
            taken += 1
            template.unlink()
        else:
            assert done.returncode == 1 and done.stderr.count("\n") == 1, (name, done.stderr)
    # Braces in pairs, tabs and other control characters that commands would hold are all that is refused.
    assert taken == 8, taken
    print(f"names: {taken} of {len(NAMES) + len(CHANGES)} are taken, and openjd takes their jobs")


def slurm_tasks(script, steps, nabiki):
    """What Slurm does with the script, without Slurm."""
    for step, numbers in steps:
        for number in numbers:
            of_slurm = {**os.environ, "NABIKI": str(nabiki), "SLURM_ARRAY_TASK_ID": str(number)}
            run("bash", script, f"step:{step}", env=of_slurm)


def slurm(folder, job, nabiki):
    """Submits a job; queues a task again while it runs, and waits for the last."""
    told = run("bash", job, env={**os.environ, "NABIKI": str(nabiki)}, capture_output=True, text=True).stdout
    numbers = [line.rsplit(" ", 1)[1] for line in told.splitlines()]

    def tasks(*options):
        return run("squeue", "-h", "-r", "-o", "%i", *options, capture_output=True, text=True).stdout.split()

    killed = None
    while waiting := tasks("-j", ",".join(numbers)):
        running = tasks("-t", "R", "-j", numbers[0])
        unfinished = list(folder.rglob(".nabiki-part-*"))
        if not killed and running and unfinished:
            killed = running[0]
            run("scontrol", "requeue", killed)
        time.sleep(0.2 if not killed else 2)
    print(f"slurm: {told.strip().replace(chr(10), ', ')}; {killed or 'no task'} was killed and queued again")
    return killed


def by_slurm(nabiki):
    """A job of some seconds, so that a task can be caught while it writes."""
    scene, folder = ROOT / "scenes" / "storm.toml", WORK / "by_slurm"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    changes = ["--set", "hair.strands=60000", "--set", "picture.size=[320,180]", "--frames", "60"]
    run(nabiki, "run", scene, *changes, "--out", folder / "whole", "--quiet")
    run(nabiki, "simulate", scene, *changes, "-o", folder / "whole" / "storm.nabiki", "--quiet")
    job = folder / "job.sh"
    run(nabiki, "farm", scene, *changes, "--shards", 5, "--frames-a-task", 8, "--engine", "slurm", "-o", job, "--quiet")
    killed = slurm(folder / "storm", job, nabiki)
    assert killed, "no task was caught while it wrote"
    same(folder / "storm", folder / "whole", "storm")
    print("slurm: the same bytes")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--slurm", action="store_true", help="submit to the Slurm of this machine, too")
    parser.add_argument("--nabiki", type=Path, help="the command, built already")
    parser.add_argument("--environment", action="store_true", help="make the environment, and nothing else")
    arguments = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    openjd = environment()
    if arguments.environment:
        return
    nabiki = arguments.nabiki.resolve() if arguments.nabiki else build()
    names(openjd, nabiki)

    for scene, changes, shards, frames_a_task, frames in JOBS:
        scene = ROOT / scene
        name = scene.stem
        folder = WORK / name
        shutil.rmtree(folder, ignore_errors=True)
        whole = folder / "whole"
        whole.mkdir(parents=True)
        changes = small(changes, frames)
        run(nabiki, "run", scene, *changes, "--out", whole, "--quiet")
        run(nabiki, "simulate", scene, *changes, "-o", whole / f"{name}.nabiki", "--quiet")
        division = ["--shards", shards, "--frames-a-task", frames_a_task]

        template = folder / "job.yaml"
        run(nabiki, "farm", scene, *changes, *division, "--engine", "openjd", "-o", template, "--quiet")
        run(openjd, "check", template, stdout=subprocess.DEVNULL)
        openjd_run(openjd, template, scene, nabiki, "Movie", "--run-dependencies")
        same(folder / name, whole, name)
        # A machine is lost with what it made; its tasks run again.
        lost = folder / name / "shards" / f"{shards}_of_{shards}.nabiki"
        before = lost.read_bytes()
        lost.unlink()
        missing = subprocess.run(
            [nabiki, "join", *(lost.with_name(f"{k}_of_{shards}.nabiki") for k in range(1, shards + 1))]
            + ["-o", folder / "joined.nabiki"],
            capture_output=True,
            text=True,
        )
        assert missing.returncode == 1 and str(lost.name) in missing.stderr, missing.stderr
        openjd_run(openjd, template, scene, nabiki, "Simulate", "--task-param", f"Shard={shards}")
        assert lost.read_bytes() == before, lost
        still = folder / name / f"{name}_frames" / "0001.png"
        before = still.read_bytes()
        still.unlink()
        openjd_run(openjd, template, scene, nabiki, "Render", "-tp", "From=0", "-tp", f"Through={frames_a_task - 1}")
        assert still.read_bytes() == before, still

        script = folder / "job.sh"
        run(nabiki, "farm", scene, *changes, *division, "--engine", "slurm", "--out", folder / "slurm", "-o", script, "--quiet")
        drawing = range(frames // frames_a_task, -1, -1)
        steps = [("Simulate", range(shards, 0, -1)), ("Join", [0]), ("Render", drawing), ("Movie", [0])]
        slurm_tasks(script, steps, nabiki)
        same(folder / "slurm", whole, name)
        print(f"{name}: {shards} shards, {len(drawing)} drawing tasks, by Open Job Description and as Slurm runs them: the same bytes")

    if arguments.slurm:
        by_slurm(nabiki)
    print("farm: all well")


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as failure:
        sys.exit(f"failed: {' '.join(map(str, failure.cmd))}")

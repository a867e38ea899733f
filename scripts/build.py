#!/usr/bin/env python3
"""Builds what a release offers for one kind of machine: archives of both programs, and the Python wheel.

    python3 scripts/build.py --target x86_64-unknown-linux-gnu
    python3 scripts/build.py --only programs     or wheel
    python3 scripts/build.py --compatibility manylinux_2_28     refuses a wheel that other Linux machines could not load

All of it goes to target/dist or to --out FOLDER. What can run on this machine is tried: it is unpacked or installed, and moves
a few strands of a scene. The wheel needs maturin (pip install maturin).
"""

import argparse
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import venv
import zipfile
from pathlib import Path

# Leaves no compiled files among the sources.
sys.dont_write_bytecode = True

import archive
import licences
from version import ROOT, version

OUR_LICENCES = ["LICENSE-MIT", "LICENSE-APACHE"]
PROGRAMS = {"nabiki_cli": "nabiki", "nabiki_studio": "nabiki-studio"}
MOVED = """
import nabiki
scene = nabiki.Scene.open("scenes/gust.toml")
frames = [frame.points.copy() for frame in scene.simulate(strands=10)]
assert len(frames) > 10 and (frames[0] != frames[10]).any()
"""


def run(*command, **options):
    words = [str(word) for word in command]
    print("+", *words, flush=True)
    return subprocess.run(words, check=True, **{"cwd": ROOT, **options})


def this_machine():
    """Rust's name of this machine."""
    lines = subprocess.run(["rustc", "-vV"], check=True, capture_output=True, text=True).stdout.splitlines()
    return next(line.removeprefix("host: ") for line in lines if line.startswith("host: "))


def surroundings(target):
    """The environment of the compilers."""
    changed = dict(os.environ)
    if target.endswith("-msvc"):
        # Otherwise the programs need Microsoft's redistributable libraries.
        changed["RUSTFLAGS"] = f"{changed.get('RUSTFLAGS', '')} -Ctarget-feature=+crt-static".strip()
    if target.endswith("-apple-darwin"):
        changed.setdefault("MACOSX_DEPLOYMENT_TARGET", "11.0")
    return changed


def try_program(packed, program):
    """Unpacks an archive and runs the program in it as a user would."""
    with tempfile.TemporaryDirectory() as folder:
        inside = archive.unpack(packed, Path(folder))
        run(inside / program, "--version", cwd=inside)
        if program.startswith("nabiki-studio"):
            return
        few = ["--strands", "20", "--frames", "3", "--out", "tried", "--quiet"]
        run(inside / program, "preview", "scenes/gust.toml", *few, cwd=inside)
        for result in ["gust_preview.mp4", "gust_preview_sheet.png"]:
            assert (inside / "tried" / result).stat().st_size, f"{result} is empty"


def programs(target, out):
    """Builds both programs and writes their archives."""
    packages = [word for package in PROGRAMS for word in ("-p", package)]
    run("cargo", "build", "--release", "--locked", "--target", target, *packages, env=surroundings(target))
    built = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / target / "release"
    graph = licences.metadata(target)
    for package, name in PROGRAMS.items():
        program = name + (".exe" if "windows" in target else "")
        with tempfile.TemporaryDirectory() as folder:
            listed = Path(folder) / "licences"
            listed.write_text(licences.listed(licences.used(graph, package)), encoding="utf-8", newline="\n")
            packed = archive.pack(built / program, package, target, out, listed)
        if target == this_machine():
            try_program(packed, program)
        else:
            print(f"SKIPPED: {packed.name} cannot be tried on {this_machine()}")


def wheel(target, out, compatibility):
    """Builds the wheel, and tries it where nothing else is installed."""
    if importlib.util.find_spec("maturin") is None:
        sys.exit(f"{sys.executable} has no maturin, which builds the wheel: pip install maturin")
    before = set(out.glob("*.whl"))
    tags = ["--compatibility", compatibility] if compatibility else []
    build = ["build", "--release", "--locked", "--generate-stubs", "--target", target, "--out", out, *tags]
    crate = ROOT / "crates" / "nabiki_py"
    # pyproject.toml names the files in here as license-files. They must lie below it.
    texts = crate / "licences"
    try:
        texts.mkdir(exist_ok=True)
        for name in OUR_LICENCES:
            shutil.copy(ROOT / name, texts)
        listed = licences.listed(licences.used(licences.metadata(target), "nabiki_py"))
        (texts / "THIRD-PARTY.txt").write_text(listed, encoding="utf-8", newline="\n")
        run(sys.executable, "-m", "maturin", *build, cwd=crate, env=surroundings(target))
    finally:
        shutil.rmtree(texts)
    made = set(out.glob("*.whl")) - before
    assert len(made) == 1, f"one wheel was to be built: {', '.join(path.name for path in made) or 'none'}"
    (built,) = made
    inside = {Path(name).name for name in zipfile.ZipFile(built).namelist() if ".dist-info/licenses/" in name}
    assert inside == {*OUR_LICENCES, "THIRD-PARTY.txt"}, f"licences in the wheel: {inside}"
    if target != this_machine():
        return print(f"SKIPPED: the wheel cannot be tried on {this_machine()}")
    with tempfile.TemporaryDirectory() as folder:
        venv.create(folder, with_pip=True)
        python = Path(folder) / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")
        run(python, "-m", "pip", "install", "--quiet", built)
        run(python, "-c", MOVED)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--target", help="Rust's name of the machine to build for (default: this one)")
    parser.add_argument("--only", choices=["programs", "wheel"], help="one of the two (default: both)")
    parser.add_argument("--compatibility", help="the platform tag that maturin holds the wheel to")
    parser.add_argument("--out", type=Path, default=ROOT / "target" / "dist", help="where all goes (default: target/dist)")
    arguments = parser.parse_args()
    target, out = arguments.target or this_machine(), arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    print(f"Nabiki {version()} for {target}")
    if arguments.only != "wheel":
        programs(target, out)
    if arguments.only != "programs":
        wheel(target, out, arguments.compatibility)
    print(*sorted(path.name for path in out.iterdir()), sep="\n")


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as failure:
        sys.exit(f"failed: {' '.join(map(str, failure.cmd))}")

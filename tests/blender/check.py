"""Builds the extension for Blender, installs it as a user would, and tests it without a window.

    python3 tests/blender/check.py                  builds the wheel and the extension, makes its own environment, tests
    python3 tests/blender/check.py --wheel FILE     the same with a wheel that is built already
    python3 tests/blender/check.py --nabiki COMMAND with a command that is built already
    python3 tests/blender/check.py --bpy PYTHON     with another Python, one that has bpy: Blender 4.2, 4.5, 5.0 and 5.2 are known to do

bpy comes from PyPI into target/interchange, where tests/interchange/check.py has it; where it cannot be had this says SKIPPED and
why.
"""

import argparse
import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
WORK = ROOT / "target" / "blender"

# What lines of the tests begin with.
OURS = ("measured: ", "SKIPPED: ", "Blender ")


# Nothing is left beside the sources.
sys.dont_write_bytecode = True


def module(path):
    """A script as a module, whatever it is called."""
    spec = importlib.util.spec_from_file_location(f"{path.parent.name}_{path.stem}", path)
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


def run(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, cwd=ROOT, **options)


def wheel():
    """A wheel of the package, built by the tools that test the package."""
    package = module(ROOT / "tests" / "python" / "check.py")
    package.WORK.mkdir(parents=True, exist_ok=True)
    return package.wheel(package.environment())


def valid(python, archive):
    """Blender's own tool finds nothing to say against the manifest."""
    where = run(python, "-c", "import bpy; print(bpy.utils.resource_path('LOCAL'))", capture_output=True, text=True).stdout.strip()
    (tool,) = Path(where).rglob("bl_pkg/cli/blender_ext.py")
    run(python, tool, "validate", archive)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--wheel", type=Path, help="a wheel that is built already")
    parser.add_argument("--nabiki", type=Path, help="a command that is built already")
    parser.add_argument("--bpy", type=Path, help="a Python that has the package bpy")
    parser.add_argument("tests", nargs="*", help="names of tests; all of them without any")
    arguments = parser.parse_args()

    interchange = module(ROOT / "tests" / "interchange" / "check.py")
    interchange.WORK.mkdir(parents=True, exist_ok=True)
    python, why = interchange.blender(arguments.bpy or os.environ.get("NABIKI_BPY_PYTHON"))
    if python is None:
        print(f"SKIPPED: the extension for Blender: {why}")
        return
    # bpy may bring its own numpy or none.
    if subprocess.run([str(python), "-c", "import numpy"], capture_output=True).returncode:
        run(python, "-m", "pip", "install", "--quiet", "numpy<2")
    build = module(ROOT / "integrations" / "blender" / "build.py")
    archive = build.build([(arguments.wheel or wheel()).resolve()], WORK)
    valid(python, archive)
    if not arguments.nabiki:
        run("cargo", "build", "--quiet", "--release", "-p", "nabiki_cli")

    user = WORK / "user"
    for old in [user, WORK / "tests"]:
        shutil.rmtree(old, ignore_errors=True)
    user.mkdir(parents=True)
    nabiki = (arguments.nabiki or ROOT / "target" / "release" / "nabiki").resolve()
    shared = ROOT / ".." / "shared" / "data"
    # Nothing of the user's own Blender is read or written.
    places = {"BLENDER_USER_RESOURCES": str(user), "PYTHONDONTWRITEBYTECODE": "1"}
    log = WORK / "log.txt"
    with open(log, "w") as out:
        words = [python, HERE / "extension.py", archive, nabiki, WORK, shared.resolve(), *arguments.tests]
        done = subprocess.run(list(map(str, words)), cwd=ROOT, env={**os.environ, **places}, stdout=out, stderr=subprocess.STDOUT)
    lines = log.read_text(errors="replace").splitlines()
    # Blender says much of its own, which is of interest where something has failed.
    print("\n".join(lines if done.returncode else [line for line in lines if line.startswith(OURS)]))
    if done.returncode:
        sys.exit(f"failed: the extension in Blender; {log} has all of the above")
    print("blender: all well")


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as failure:
        sys.exit(f"failed: {' '.join(map(str, failure.cmd))}")

"""Builds the wheel of nabiki, installs it where nothing else is, and tests it as its users have it.

    python3 tests/python/check.py                  wheel, stubs, types, tests, the notebook
    python3 tests/python/check.py --wheel FILE     the same with a wheel that is built already
    python3 tests/python/check.py --profile dev    the same with a wheel of what the tests have compiled, optimised, too
    python3 tests/python/check.py --speed          besides, 20,000 strands x 20 beside the command
    python3 tests/python/check.py --environment    the Python with the tools, and nothing else

maturin, numpy, pytest, mypy and nbclient come from PyPI into target/python.
"""

import argparse
import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
CRATE = ROOT / "crates" / "nabiki_py"
WORK = ROOT / "target" / "python"
TOOLS = ["maturin==1.16.*", "numpy", "pytest", "mypy==2.*", "nbclient", "nbformat", "ipykernel", "matplotlib"]


def run(*command, cwd=ROOT, **options):
    return subprocess.run([str(word) for word in command], check=True, cwd=cwd, **options)


def environment():
    """A Python with the tools; made once for each list of them."""
    python, made = WORK / "venv" / "bin" / "python", WORK / "venv" / "tools"
    if not made.exists() or made.read_text() != "\n".join(TOOLS):
        shutil.rmtree(WORK / "venv", ignore_errors=True)
        venv.create(WORK / "venv", with_pip=True)
        run(python, "-m", "pip", "install", "--quiet", *TOOLS)
        made.write_text("\n".join(TOOLS))
    return python


def wheel(python, profile):
    """The wheel, with its stubs, in a profile of Cargo's."""
    shutil.rmtree(WORK / "wheels", ignore_errors=True)
    build = ["build", "--profile", profile, "--generate-stubs", "--out", WORK / "wheels"]
    # In the tests' profile with the tests' features, too: as_tested/cargo says why.
    first = [str(HERE / "as_tested")] if profile == "dev" else []
    path = os.pathsep.join([*first, os.environ["PATH"]])
    run(python, "-m", "maturin", *build, cwd=CRATE, env={**os.environ, "PATH": path})
    (built,) = (WORK / "wheels").glob("*.whl")
    return built


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--wheel", type=Path, help="a wheel that is built already")
    parser.add_argument("--nabiki", type=Path, help="a command that is built already")
    parser.add_argument("--profile", default="release", help="Cargo's profile of the wheel, release if it is not said")
    parser.add_argument("--speed", action="store_true", help="measure, too")
    parser.add_argument("--environment", action="store_true", help="the Python with the tools, and nothing else")
    arguments = parser.parse_args()

    WORK.mkdir(parents=True, exist_ok=True)
    python = environment()
    if arguments.environment:
        return
    built = arguments.wheel or wheel(python, arguments.profile)
    run(python, "-m", "pip", "install", "--quiet", "--force-reinstall", "--no-deps", built)
    if not arguments.nabiki:
        run("cargo", "build", "--quiet", "--release", "-p", "nabiki_cli")
    nabiki = (arguments.nabiki or ROOT / "target" / "release" / "nabiki").resolve()
    run(python, CRATE / "generate.py", "--check", "--nabiki", nabiki)

    # Beside the sources Python would take these for the package.
    run(python, "-m", "mypy", "--strict", "-p", "nabiki", cwd=WORK)
    run(python, "-m", "mypy", "--strict", HERE / "typed.py", cwd=WORK)
    tests = ["pytest", "-q", "-p", "no:cacheprovider", CRATE / "tests"]
    run(python, "-m", *tests, cwd=WORK, env={**os.environ, "NABIKI": str(nabiki)})
    run(python, HERE / "notebook.py", ROOT / "docs" / "python" / "gust.ipynb", WORK / "gust.ipynb")
    if arguments.speed:
        run(python, HERE / "speed.py")
    print("python: all well")


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as failure:
        sys.exit(f"failed: {' '.join(map(str, failure.cmd))}")

"""The command and small scenes, for tests of the installed wheel."""

import os
import struct
import subprocess
from pathlib import Path

import numpy
import pytest

import nabiki

ROOT = Path(__file__).resolve().parents[3]
SCENES = ROOT / "scenes"
COMMAND = Path(os.environ.get("NABIKI", ROOT / "target" / "release" / "nabiki"))


def command(*words):
    """Runs the command, and returns what it says."""
    done = subprocess.run([COMMAND, *map(str, words)], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def bits(array):
    """Floats as the numbers of their bits: -0 is not 0."""
    return numpy.ascontiguousarray(array, dtype=numpy.float32).view(numpy.uint32)


def cache_frames(path):
    """Poses and points of a motion cache, as docs/cache.md lays it out."""
    data = path.read_bytes()
    points, _, frames, at = struct.unpack_from("<IIQQ", data, 16)
    size = 28 + 12 * points
    for frame in range(frames):
        row = data[at + frame * size : at + (frame + 1) * size]
        pose = numpy.frombuffer(row, "<f4", 7)
        yield pose, numpy.frombuffer(row, "<f4", offset=28).reshape(points, 3)


# Roots are spread for all strands of a scene, of however few are moved: these are enough, and take a hundredth of the time.
STRANDS = 2000


@pytest.fixture
def gust():
    """The gust of the README, fewer strands, few frames and a small picture."""
    settings = {"hair.strands": STRANDS, "motion.frames": 12, "picture.size": (160, 90), "output.sheet": [0]}
    return nabiki.Scene.open(SCENES / "gust.toml", settings)


@pytest.fixture
def paper():
    """The paper's gust."""
    return nabiki.Scene.open(SCENES / "paper" / "gust.toml", {"hair.strands": STRANDS, "motion.frames": 12, "output.sheet": [0]})

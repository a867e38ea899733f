"""Opens what Nabiki writes with tools that are not Nabiki's, and takes hair through every pair of formats.

    python3 tests/interchange/check.py                  builds, makes its own environment, checks
    python3 tests/interchange/check.py --nabiki COMMAND with a command that is built already, and examples/interchange beside it
    python3 tests/interchange/check.py --bpy PYTHON     the Blender part with another Python, one that has bpy
    python3 tests/interchange/check.py --environment    the environments, and nothing else

usd-core, alembic3d and numpy come from PyPI into target/interchange, and three.js from npm where that is. Blender comes along as the package bpy where there
is a Python 3.11, which it wants (a gigabyte once installed, and some shared libraries of a desktop); where it cannot be
had, that part says SKIPPED and why.
"""

import argparse
import os
import shutil
import struct
import subprocess
import sys
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
WORK = ROOT / "target" / "interchange"
FORMATS = ["hair", "tfx", "usda", "usdc", "abc"]


def run(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, cwd=ROOT, **options)


def environment():
    """A Python with usd-core, alembic3d and numpy; made once."""
    python = WORK / "venv" / "bin" / "python"
    if not python.exists():
        venv.create(WORK / "venv", with_pip=True)
        run(python, "-m", "pip", "install", "--quiet", "usd-core==26.11", "alembic3d==1.8.12.1", "numpy")
    return python


def blender(given):
    """A Python that has bpy, or None and why there is none."""
    if given:
        python = Path(given)
    else:
        python = WORK / "bpy" / "bin" / "python"
        base = sys.executable if sys.version_info[:2] == (3, 11) else shutil.which("python3.11")
        if not base:
            return None, "bpy wants Python 3.11, which is not here"
        if not (WORK / "bpy" / "complete").exists():
            shutil.rmtree(WORK / "bpy", ignore_errors=True)
            try:
                run(base, "-m", "venv", WORK / "bpy", capture_output=True)
                install = [python, "-m", "pip", "install", "--quiet", "--retries", "1", "bpy==5.0.1"]
                run(*install, capture_output=True, text=True, timeout=300)
            except subprocess.TimeoutExpired:
                return None, "bpy could not be fetched within five minutes"
            except subprocess.CalledProcessError as failure:
                return None, f"bpy could not be installed: {last_line(failure.stderr)}"
            (WORK / "bpy" / "complete").touch()
    found = subprocess.run([str(python), "-c", "import bpy"], capture_output=True, text=True)
    return (python, "") if found.returncode == 0 else (None, f"{python}: {last_line(found.stderr)}")


def last_line(text):
    if isinstance(text, bytes):
        text = text.decode(errors="replace")
    lines = (text or "").strip().splitlines()
    return lines[-1] if lines else "no reason given"


def points_of(path):
    """The counts and points of a .hair file, as bytes."""
    data = path.read_bytes()
    magic, strands, points, arrays, segments = struct.unpack_from("<4sIIII", data)
    assert magic == b"HAIR", path
    at = 128
    counts = struct.pack("<H", segments) * strands
    if arrays & 1:
        counts = data[at : at + 2 * strands]
        at += 2 * strands
    return counts, data[at : at + 12 * points]


def round_trips(nabiki, samples):
    """In -> out -> in for every pair of formats, and all shared hair through each format: the same bits."""
    folder = WORK / "round_trips"
    folder.mkdir(exist_ok=True)

    def convert(source, target):
        run(nabiki, "convert", source, target, "--unit", "cm", "--quiet")
        return target

    even = samples / "even.usda"
    known = points_of(convert(even, folder / "known.hair"))
    for first in FORMATS:
        there = convert(even, folder / f"there.{first}")
        for second in FORMATS:
            back = convert(there, folder / f"back.{second}")
            found = points_of(convert(back, folder / "found.hair"))
            assert found == known, f"{first} -> {second}"
    print(f"round trips: {len(FORMATS) ** 2} pairs of formats, the same bits")

    shared = ROOT / ".." / "shared" / "data" / "hair"
    if not shared.is_dir():
        print(f"SKIPPED: {shared} is not there, so no real hair goes through")
        return
    files = [f for f in sorted(shared.iterdir()) if f.suffix in (".hair", ".tfx") or f.name.startswith("curly_swatch_f")]
    for source in files:
        known = points_of(convert(source, folder / "known.hair"))
        for ending in ["usda", "usdc", "abc"]:
            there = convert(source, folder / f"real.{ending}")
            found = points_of(convert(there, folder / "found.hair"))
            assert found == known, f"{source.name} -> {ending}"
    print(f"round trips: {len(files)} files of real hair through .usda, .usdc and .abc, the same bits")


SCENE = """
[hair]
file = "samples/rest.usda"
join_within = 0

[motion]
frames = 3

[[force]]
through = 3
vector = [-10, 0, 0]
"""


# B-splines as XGen writes them: drawn between two points fewer than they have.
SPLINE = """#usda 1.0
def Xform "head"
{
    double3 xformOp:translate = (1, 2, 3)
    uniform token[] xformOpOrder = ["xformOp:translate"]

    def BasisCurves "hair"
    {
        uniform token type = "cubic"
        uniform token basis = "bspline"
        uniform token wrap = "nonperiodic"
        int[] curveVertexCounts = [7, 7]
        point3f[] points = [(0, 8, 0), (0, 10, 0), (1, 12, 0), (3, 13, 0), (5, 12, 1), (6, 10, 1), (6, 8, 0),
            (0, 8, 5), (0, 10, 5), (0, 12, 6), (1, 13, 8), (2, 12, 10), (2, 10, 11), (1, 8, 11)]
        float[] widths = [0.1, 0.1, 0.08, 0.06, 0.04, 0.1, 0.1, 0.08, 0.06, 0.04] ( interpolation = "varying" )
    }
}
"""


def made_elsewhere(nabiki, interchange, python):
    """What usd-core makes, read here: grooms whose strands are alike, flattened ones, meshes, motions."""
    folder = WORK / "made"
    run(python, HERE / "made.py", "write", folder)
    grooms = sorted(folder.glob("*.f32"))
    for known in grooms:
        layer = known.with_suffix(".usdc")
        run(nabiki, "convert", layer, folder / "found.hair", "--quiet")
        _, found = points_of(folder / "found.hair")
        assert found == known.read_bytes(), layer.name
    said = run(nabiki, "info", folder / "triangles.usdc", capture_output=True, text=True).stdout
    assert "44402 faces, 22500 points" in said, said
    nodes = {"motion.usda": "/body/neck/head", "motion.usdc": "/body/neck/head", "skeleton.usdc": "hips/neck/head"}
    for name, node in nodes.items():
        with open(folder / f"{name}.motion", "w") as out:
            run(interchange, "motion", folder / name, node, stdout=out)
    run(python, HERE / "made.py", "compare", folder)
    print(f"usd-core's grooms: {len(grooms)} of up to 100,000 strands that are alike, the same bits")


def types_stay(nabiki, python):
    """Primvars of every type, through each format and back, as usd-core sees them."""
    folder = WORK / "carried"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for source in ["all.usdc", "all.usda"]:
        run(python, HERE / "carried.py", "write", folder / source)
        for ending in ["usda", "usdc", "abc"]:
            there = folder / f"{source}.{ending}"
            run(nabiki, "convert", folder / source, there, "--quiet")
            for last in ["usda", "usdc"]:
                back = folder / f"{there.name}.{last}"
                run(nabiki, "convert", there, back, "--unit", "cm", "--quiet")
                run(python, HERE / "carried.py", "compare", folder / source, back)
    print("primvars: 20 types through .usda, .usdc and .abc, the same types and values")


def names_are_allowed(nabiki, python):
    """Attributes of any names, from an archive that alembic3d writes, through each format and back, as the formats' own readers see them."""
    folder = WORK / "names"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    source = folder / "names.abc"
    run(python, HERE / "names.py", "write", source)
    for ending in ["usda", "usdc", "abc"]:
        there = folder / f"there.{ending}"
        run(nabiki, "convert", source, there, "--unit", "cm", "--quiet")
        run(python, HERE / "names.py", "compare", there)
        for last in ["usda", "usdc"]:
            back = folder / f"{there.name}.{last}"
            run(nabiki, "convert", there, back, "--unit", "cm", "--quiet")
            run(python, HERE / "names.py", "compare", back)
    print("names: attributes of any names in layers that usd-core opens and archives that alembic3d does, each under one of its own")


def there_and_back(nabiki, samples):
    """A groom of another tool gets wind, and comes back as a layer over itself."""
    scene = WORK / "trip.toml"
    scene.write_text(SCENE)
    options = ["--export", samples / "trip.usdc", "--export-layer", "/head/hair", "--quiet"]
    run(nabiki, "simulate", scene, "-o", WORK / "trip.nabiki", *options)
    (samples / "spline.usda").write_text(SPLINE)
    scene.write_text(SCENE.replace("rest.usda", "spline.usda"))
    run(nabiki, "simulate", scene, "-o", WORK / "spline.nabiki", "--export", samples / "spline_moving.usdc", "--quiet")
    run(nabiki, "convert", WORK / "spline.nabiki", samples / "spline_layer.usdc", "--export-layer", "/head/hair", "--quiet")


def rigs(nabiki, python):
    """Heads and hair on skeletons are where UsdSkel has them, in every frame."""
    folder = WORK / "rigs"
    run(python, HERE / "rigs.py", "write", folder)
    for scene in sorted(folder.glob("*.toml")):
        layer = scene.with_suffix("")
        options = ["-o", folder / "rig.nabiki", "--export", folder / f"{layer.name}.out.usda", "--quiet"]
        run(nabiki, "simulate", scene, *options)
        # Hair that is not bound stands elsewhere.
        for ending in ["usda", "usdc"] if not layer.name.startswith("hair_") else []:
            over = ["--export", folder / f"{layer.name}.layer.{ending}", "--export-layer", "/stage/char/hair"]
            run(nabiki, "simulate", scene, "-o", folder / "rig.nabiki", *over, "--quiet")
    run(python, HERE / "rigs.py", "compare", folder)


def skins(nabiki, python):
    """Roots ride on skin that bends, where usd-core has it."""
    folder = WORK / "skins"
    run(python, HERE / "skins.py", "write", folder)
    for layer in sorted(folder.glob("*.usda")):
        scene = layer.with_suffix(".toml")
        run(nabiki, "new", scene, "--head", layer, "--hair", layer, stdout=subprocess.DEVNULL)
        export = ["--export", folder / f"{layer.stem}.out.usda"]
        run(nabiki, "simulate", scene, "-o", folder / "skin.nabiki", *export, "--quiet")
    run(python, HERE / "skins.py", "compare", folder)


def fbx(nabiki, bpy):
    """Roots ride on skin that bends, where Blender has it that wrote the FBX."""
    folder = WORK / "fbx"
    run(bpy, HERE / "fbx.py", "write", folder, stdout=subprocess.DEVNULL)
    for scene in sorted(folder.glob("*.toml")):
        export = ["--export", scene.with_suffix(".pc2")]
        run(nabiki, "simulate", scene, "-o", folder / "skin.nabiki", *export, "--quiet")
    run(bpy, HERE / "fbx.py", "compare", folder)


def game(nabiki, python, bpy):
    """Point caches, chains of joints and vertex-animation textures, in Blender and in three.js."""
    folder = WORK / "game"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    simulate = [nabiki, "simulate", ROOT / "scenes" / "head_turn.toml", "--strands", "100", "--frames", "60"]
    told = []
    for name, options in [("few", ["64x8"]), ("all", ["100x12"]), ("lines", ["64x8", "--export-cards", "0"])]:
        file = folder / f"{name}.glb"
        said = run(*simulate, "-o", file, "--export-chains", *options, capture_output=True, text=True).stdout
        [line] = [line for line in said.splitlines() if "the skinned hair is" in line]
        told.append(f"{file.name} {line.split('the skinned hair is ')[1].split()[0]}")
    (folder / "told.txt").write_text("\n".join(told))
    caches = ["--export", folder / "moving.pc2", "--export", folder / "moving.mdd"]
    run(*simulate, "-o", folder / "moving.usdc", *caches, "--export", folder / "ribbons.exr", "--quiet")
    run(*simulate, "-o", folder / "lines.exr", "--export-cards", "0", "--quiet")
    run(python, HERE / "game.py", "points", folder)
    if bpy:
        run(bpy, HERE / "game.py", "blender", folder)
        run(bpy, HERE / "textures.py", "blender", folder)
    else:
        print("SKIPPED: point caches, chains and textures in Blender, which is not here")
    if not three(folder):
        print("SKIPPED: chains and textures in three.js: it wants node and npm")
        return
    run(python, HERE / "game.py", "three", folder)
    run(python, HERE / "textures.py", "three", folder)


def three(folder):
    """Plays chains and textures with three.js, from npm; whether that is there."""
    where = WORK / "three"
    if not (shutil.which("node") and shutil.which("npm")):
        return False
    where.mkdir(exist_ok=True)
    if not (where / "node_modules" / "three").is_dir():
        install = ["npm", "install", "--silent", "--no-audit", "--no-fund", "--prefix", where, "three@0.181.0"]
        if subprocess.run(list(map(str, install)), cwd=where).returncode != 0:
            return False
    script = shutil.copy(HERE / "three.mjs", where)
    run("node", script, "61", "120", folder / "few.glb", folder / "all.glb")
    script = shutil.copy(HERE / "textures.mjs", where)
    run("node", script, "61", folder / "ribbons.exr", folder / "lines.exr")
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bpy", type=Path, help="a Python that has the package bpy")
    parser.add_argument("--nabiki", type=Path, help="a command that is built already, and examples/interchange beside it")
    parser.add_argument("--environment", action="store_true", help="make the environments, and nothing else")
    arguments = parser.parse_args()

    WORK.mkdir(parents=True, exist_ok=True)
    if arguments.environment:
        environment()
        blender(arguments.bpy or os.environ.get("NABIKI_BPY_PYTHON"))
        return
    if arguments.nabiki:
        nabiki = arguments.nabiki.resolve()
    else:
        run("cargo", "build", "--quiet", "--release", "-p", "nabiki_cli", "-p", "nabiki_usd", "--bins", "--examples")
        nabiki = ROOT / "target" / "release" / "nabiki"
    interchange = nabiki.parent / "examples" / "interchange"
    samples = WORK / "samples"
    run(interchange, "write", samples)

    round_trips(nabiki, samples)
    there_and_back(nabiki, samples)
    python = environment()
    types_stay(nabiki, python)
    names_are_allowed(nabiki, python)
    made_elsewhere(nabiki, interchange, python)
    rigs(nabiki, python)
    skins(nabiki, python)
    run(python, HERE / "usd.py", samples)
    run(python, HERE / "alembic.py", samples)

    bpy, why = blender(arguments.bpy or os.environ.get("NABIKI_BPY_PYTHON"))
    game(nabiki, python, bpy)
    if bpy:
        fbx(nabiki, bpy)
        run(bpy, HERE / "blender.py", samples, nabiki)
    else:
        print(f"SKIPPED: Blender: {why}")
    print("interchange: all well")


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as failure:
        sys.exit(f"failed: {' '.join(map(str, failure.cmd))}")

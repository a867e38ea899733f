"""The same motion through Python and without it: milliseconds a frame of 20,000 strands x 20 segments.

    speed.py            the paper's form and the free one

Stepping alone is timed in Rust (an example of nabiki_scene, in a process of its own) and in Python (`for frame in
scene.simulate(): frame.points`); files by the command and by `scene.export`, grooming and start taken out by the difference
between many frames and few. The ways take turns; the figures are medians, and in brackets the least. The machine should have
nothing else to do; ratios in one run are what to trust.
"""

import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import nabiki

ROOT = Path(__file__).resolve().parents[2]
BUILT = ROOT / "target" / "release"
FEW, MANY, ROUNDS = 5, 65, 5
HAIR = {"hair.strands": 20_000, "hair.segments": 20, "output.sheet": [0], "hair.style.variation.length": 0, "hair.style.cuts": []}
HAIR |= {f"hair.style.length.{region}": 20 for region in ["top", "sides", "back", "fringe"]}


def settings(frames):
    return HAIR | {"motion.frames": frames}


def words(frames):
    return [f"{key}={value}" for key, value in settings(frames).items()]


def seconds(work):
    begun = time.perf_counter()
    work()
    return time.perf_counter() - begun


def a_frame(work):
    return (seconds(lambda: work(MANY)) - seconds(lambda: work(FEW))) / (MANY - FEW)


def stepped_in_rust(file, frames=400):
    done = subprocess.run([BUILT / "examples" / "frames", file, *words(frames)], check=True, capture_output=True)
    return float(done.stdout)


def stepped_in_python(file, frames=400):
    motion = nabiki.Scene.open(file, settings(frames)).simulate()

    def all_frames():
        for frame in motion:
            frame.points

    return seconds(all_frames) / (frames + 1)


def written_by_the_command(file, cache, frames):
    options = [f"--set={word}" for word in words(frames)]
    subprocess.run([BUILT / "nabiki", "simulate", file, "-o", cache, "--quiet", *options], check=True)


def compared(name, ways):
    taken = {way: [] for way in ways}
    for _ in range(ROUNDS):
        for way, work in ways.items():
            taken[way].append(work())
    first = next(iter(taken))
    for way, times in taken.items():
        middle, least = statistics.median(times), min(times)
        parts = f"{middle / statistics.median(taken[first]):.3f} ({least / min(taken[first]):.3f})"
        print(f"{name:12} {way:20} {1000 * middle:7.2f} ms a frame ({1000 * least:.2f}), {parts}", flush=True)


def main():
    subprocess.run(["cargo", "build", "--quiet", "--release", "-p", "nabiki_cli"], check=True, cwd=ROOT)
    subprocess.run(
        ["cargo", "build", "--quiet", "--release", "-p", "nabiki_scene", "--example", "frames"], check=True, cwd=ROOT
    )
    for name in ["paper/gust", "gust"]:
        file = ROOT / "scenes" / f"{name}.toml"
        frame = next(nabiki.Scene.open(file, settings(1)).simulate())
        print(f"{name}: {len(frame.offsets) - 1} strands, {len(frame.points)} points")
        compared(name, {"Rust": lambda: stepped_in_rust(file), "Python": lambda: stepped_in_python(file)})
        with tempfile.TemporaryDirectory() as folder:
            cache = Path(folder) / "motion.nabiki"
            files = {
                "nabiki simulate -o": lambda: a_frame(lambda frames: written_by_the_command(file, cache, frames)),
                "scene.export": lambda: a_frame(lambda frames: nabiki.Scene.open(file, settings(frames)).export(cache)),
            }
            compared(name, files)
    motion = nabiki.Scene.open(ROOT / "scenes" / "paper" / "gust.toml", {"motion.frames": 5000, "output.sheet": [0]})
    one = motion.simulate(strands=1)
    print(f"a frame of one strand: {1e6 * seconds(lambda: [frame.points for frame in one]) / 5001:.1f} microseconds")


if __name__ == "__main__":
    main()

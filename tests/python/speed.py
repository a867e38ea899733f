"""The same motion through Python and by the command, a frame of 20,000 strands x 20 segments in milliseconds.

    speed.py            the paper's form and the free one

Grooming and start are taken out: each is run with few frames and with many, and the difference is divided. The ways take turns;
the figures are medians. The machine should have nothing else to do; ratios in one run are what to trust.
"""

import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import nabiki

ROOT = Path(__file__).resolve().parents[2]
COMMAND = ROOT / "target" / "release" / "nabiki"
FEW, MANY, ROUNDS = 5, 105, 5
HAIR = {"hair.strands": 20_000, "hair.segments": 20, "output.sheet": [0], "hair.style.variation.length": 0, "hair.style.cuts": []}
HAIR |= {f"hair.style.length.{region}": 20 for region in ["top", "sides", "back", "fringe"]}


def seconds(work):
    begun = time.perf_counter()
    work()
    return time.perf_counter() - begun


def main():
    for name in ["paper/gust", "gust"]:
        file = ROOT / "scenes" / f"{name}.toml"
        with tempfile.TemporaryDirectory() as folder:
            cache = Path(folder) / "motion.nabiki"

            def command(frames, file=file, cache=cache):
                settings = [f"--set={key}={value}" for key, value in (HAIR | {"motion.frames": frames}).items()]
                subprocess.run([COMMAND, "simulate", file, "-o", cache, "--quiet", *settings], check=True)

            def export(frames, file=file, cache=cache):
                nabiki.Scene.open(file, HAIR | {"motion.frames": frames}).export(cache)

            def arrays(frames, file=file):
                for frame in nabiki.Scene.open(file, HAIR | {"motion.frames": frames}).simulate():
                    frame.points

            ways = {"nabiki simulate": command, "scene.export": export, "scene.simulate": arrays}
            taken = {way: [] for way in ways}
            for _ in range(ROUNDS):
                for way, work in ways.items():
                    taken[way].append((seconds(lambda: work(MANY)) - seconds(lambda: work(FEW))) / (MANY - FEW))
        frame = next(nabiki.Scene.open(file, HAIR | {"motion.frames": 1}).simulate())
        base = statistics.median(taken["nabiki simulate"])
        print(f"{name}: {len(frame.offsets) - 1} strands, {len(frame.points)} points")
        for way, times in taken.items():
            middle = statistics.median(times)
            print(f"    {way:16} {1000 * middle:7.2f} ms a frame, {middle / base:.3f} of the command's")
    one = nabiki.Scene.open(ROOT / "scenes" / "paper" / "gust.toml", {"motion.frames": 5000, "output.sheet": [0]})
    motion = one.simulate(strands=1)
    print(f"a frame of one strand: {1e6 * seconds(lambda: [frame.points for frame in motion]) / 5000:.1f} microseconds")


if __name__ == "__main__":
    main()

"""Holds Nabiki's pictures against Cycles: the same hair, head, camera, lamps, sky and tone curve.

    python3.11 -m venv target/pictures/venv
    target/pictures/venv/bin/pip install bpy==5.0.1 OpenEXR==3.5.3
    cargo build --release -p nabiki_cli
    target/pictures/venv/bin/python tests/pictures/check.py                all cases, against target/release/nabiki
    target/pictures/venv/bin/python tests/pictures/check.py gust0-brown    some

Run by hand. References are rendered once and kept in target/pictures with the motion that they show (--anew makes both again);
`NAME.png` there is Nabiki at the left, Cycles at the right, in display light. It prints for each region Nabiki's luminance over that of Cycles,
Delta E 2000 of the mean colours as displayed, chroma and hue of both, and for all hair the contrast: the 95th over the 5th
percentile of luminance, of means over 5 x 5 pixels, which Cycles' noise does not widen.
"""

import argparse
import os
import subprocess
import time
from pathlib import Path

import numpy as np
import OpenEXR

import cases
import colour

ROOT = Path(__file__).resolve().parent.parent.parent
WORK = ROOT / "target" / "pictures"


def run(*command):
    subprocess.run([str(word) for word in command], check=True, cwd=ROOT, stdout=subprocess.DEVNULL)


def toml(value):
    if isinstance(value, dict):
        return "{" + ",".join(f"{key}={toml(v)}" for key, v in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ",".join(map(toml, value)) + "]"
    return f'"{value}"' if isinstance(value, str) else str(value).lower()


def settings(case):
    """The scene's own groom and motion in the light, and through the camera, of the case."""
    view = case.view
    names = ["azimuth", "elevation", "strength", "colour", "spread"]
    return {
        "motion.frames": max(view.frame, 1),
        "picture.size": list(cases.SIZE),
        "picture.camera": {
            "azimuth": view.azimuth, "elevation": view.elevation, "target": view.target, "distance": view.distance, "fov": view.fov,
        },
        "picture.hair": {
            "colour": case.colour, "width": view.width, "tip": view.tip, "taper": cases.TAPER, "variation": cases.VARIATION,
            "roughness": cases.ROUGHNESS, "azimuthal_roughness": cases.AROUND, "scale_tilt": cases.TILT,
            "refraction": cases.REFRACTION,
        },
        "picture.lights": [dict(zip(names, lamp)) for lamp in case.lamps],
        "picture.sky": {"strength": case.sky, "above": cases.ABOVE, "below": cases.BELOW},
        "picture.head": {"colour": cases.SKIN, "stubble": 0.0, "sheen": 0.0, "softness": 0.0, "face": False},
        "picture.background.transparent": True,
        "picture.shutter": 0.0,
        "output.exr_frames": True,
        "output.movie": False,
        "output.sheet": [],
    }


def nabiki(program, command, case, *rest):
    sets = [word for key, value in settings(case).items() for word in ("--set", f"{key}={toml(value)}")]
    run(program, command, ROOT / "scenes" / f"{case.view.scene}.toml", "--quiet", *sets, *rest)


def channels(path):
    with OpenEXR.File(str(path), separate_channels=True) as file:
        return {name: channel.pixels for name, channel in file.channels().items()}


def rgb(found):
    [prefix] = {name[:-1] for name in found if name.endswith("R")}
    return np.stack([found[prefix + c] for c in "RGB"], -1).astype(float)


def motion(program, case):
    path = WORK / f"{case.view.name}.nabiki"
    if not path.exists():
        nabiki(program, "simulate", case, "--output", path, "--export", WORK / f"{case.view.name}.usdc")
    return path


def reference(case, samples):
    """What Cycles draws; rendered once."""
    path = WORK / f"{case.name}.exr"
    if not path.exists():
        import reference as cycles

        begun = time.time()
        hair = cycles.imported(WORK / f"{case.view.name}.usdc", case.view.frame)
        unfinished = path.with_suffix(".part.exr")
        cycles.render(case, hair, samples, unfinished)
        unfinished.rename(path)
        print(f"{case.name}: {time.time() - begun:.0f} s of Cycles", flush=True)
    return rgb(channels(path))


def own(program, case):
    """What Nabiki draws: light, and the shares of hair and skin."""
    folder = WORK / "own" / case.name
    frame = case.view.frame
    nabiki(program, "render", case, "--motion", motion(program, case), "--frames", f"{frame}..{frame}", "--out", folder)
    [file] = folder.rglob("*.exr")
    found = channels(file)
    shares = found["hair.A"], found["head.A"]
    return rgb({name: found[name] for name in "RGB"}), *shares


def side_by_side(case, ours, theirs, rows):
    import bpy

    pair = colour.srgb(colour.displayed(np.concatenate([ours, theirs], 1)))
    for region in case.view.regions.values():
        for shift in (0, cases.SIZE[0]):
            left, top, right, bottom = region
            for y in (top, bottom - 1):
                pair[y, left + shift : right + shift] = (0.0, 0.8, 0.8)
            for x in (left, right - 1):
                pair[top:bottom, x + shift] = (0.0, 0.8, 0.8)
    pair = pair.repeat(2, 0).repeat(2, 1)[::-1]
    image = bpy.data.images.new("pair", pair.shape[1], pair.shape[0])
    image.colorspace_settings.name = "sRGB"
    image.pixels.foreach_set(np.dstack([pair, np.ones(pair.shape[:2])]).astype("f4").ravel())
    image.filepath_raw = str(WORK / f"{case.name}.png")
    image.file_format = "PNG"
    image.save()
    bpy.data.images.remove(image)


def contrast(light, hair):
    """95th over 5th percentile of the luminance of means over 5 x 5 pixels that are hair throughout."""
    def means(values):
        sums = np.cumsum(np.cumsum(np.pad(values, ((1, 0), (1, 0))), 0), 1)
        return (sums[5:, 5:] - sums[:-5, 5:] - sums[5:, :-5] + sums[:-5, :-5]) / 25

    low, high = np.percentile(means(colour.luminance(light))[means(hair) > 0.97], [5, 95])
    return high / low


def compare(case, program, samples):
    motion(program, case)
    theirs = reference(case, samples)
    ours, hair, head = own(program, case)
    rows = []
    for name, (left, top, right, bottom) in case.view.regions.items():
        within = np.zeros(hair.shape, bool)
        within[top:bottom, left:right] = True
        mask = within & (head > 0.95 if name.startswith("skin") else hair > 0.6)
        n, c = ours[mask].mean(0), theirs[mask].mean(0)
        shown = [colour.lab(colour.displayed(light)) for light in (n, c)]
        (cn, hn), (cc, hc) = map(colour.chroma_and_hue, shown)
        rows.append((name, colour.luminance(n) / colour.luminance(c), colour.apart(*shown), cn, cc, hn, hc))
    print(f"{case.name}: contrast {contrast(ours, hair):.1f} for {contrast(theirs, hair):.1f}")
    for name, ratio, delta, cn, cc, hn, hc in rows:
        print(f"    {name:12} N/C {ratio:5.2f}  Delta E {delta:5.2f}  chroma {cn:4.1f} for {cc:4.1f}  hue {hn:5.1f} for {hc:5.1f}")
    if rows:
        hues = [abs((row[5] - row[6] + 180) % 360 - 180) for row in rows if row[4] > 5]
        print(f"    mean: Delta E {np.mean([row[2] for row in rows]):.2f}, hue off by {np.mean(hues or [0]):.1f}", flush=True)
    side_by_side(case, ours, theirs, rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("cases", nargs="*", help="names of cases (default: all)")
    parser.add_argument("--nabiki", default=ROOT / "target" / "release" / "nabiki", type=Path)
    parser.add_argument("--samples", default=64, type=int, help="rays a pixel")
    parser.add_argument("--anew", action="store_true", help="renders the references again")
    given = parser.parse_args()
    os.nice(5)
    WORK.mkdir(parents=True, exist_ok=True)
    chosen = [case for case in cases.CASES if not given.cases or case.name in given.cases]
    if unknown := set(given.cases) - {case.name for case in chosen}:
        parser.error(f"no such case: {', '.join(sorted(unknown))}; there are {', '.join(case.name for case in cases.CASES)}")
    if given.anew:
        for case in chosen:
            for kept in [case.name + ".exr", case.view.name + ".nabiki", case.view.name + ".usdc"]:
                (WORK / kept).unlink(missing_ok=True)
    for case in chosen:
        compare(case, given.nabiki, given.samples)


if __name__ == "__main__":
    main()

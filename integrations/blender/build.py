# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the extension: the sources beside this file and wheels of the package nabiki, in one .zip that Blender installs.

python3 integrations/blender/build.py                          builds the wheel for this machine
python3 integrations/blender/build.py --wheel A.whl B.whl      takes wheels that are built already, of any platforms
python3 integrations/blender/build.py --out FOLDER             where the .zip goes (default: target/blender)
"""

import argparse
import importlib.util
import re
import subprocess
import sys
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SOURCE = HERE / "nabiki"

# A file of an archive that is built twice is the same, whenever that is.
DATE = (1980, 1, 1, 0, 0, 0)

PLATFORMS = [
    (r"manylinux.*x86_64|linux_x86_64", "linux-x64"),
    (r"manylinux.*aarch64|linux_aarch64", "linux-arm64"),
    (r"win_amd64", "windows-x64"),
    (r"win_arm64", "windows-arm64"),
    (r"macosx.*arm64", "macos-arm64"),
    (r"macosx.*x86_64", "macos-x64"),
]


def built():
    """A wheel for this machine."""
    if importlib.util.find_spec("maturin") is None:
        sys.exit(f"{sys.executable} has no maturin, which builds the wheel: pip install maturin, or name a wheel with --wheel")
    out = ROOT / "target" / "blender" / "wheels"
    build = [sys.executable, "-m", "maturin", "build", "--release", "--generate-stubs", "--out", str(out)]
    subprocess.run(build, check=True, cwd=ROOT / "crates" / "nabiki_py")
    return [max(out.glob("*.whl"), key=lambda wheel: wheel.stat().st_mtime)]


def platform(wheel):
    """Blender's name of the platform that a wheel is for."""
    for pattern, name in PLATFORMS:
        if re.search(pattern, wheel.name):
            return name
    sys.exit(f"{wheel.name}: for none of Blender's platforms; they are {', '.join(name for _, name in PLATFORMS)}")


def manifest(wheels):
    """The manifest with the wheels, and their version."""
    text = (SOURCE / "blender_manifest.toml").read_text()
    version = wheels[0].name.split("-")[1]
    text = re.sub(r"^version = .*$", f'version = "{version}"', text, flags=re.M)
    names = ", ".join(f'"./wheels/{wheel.name}"' for wheel in wheels)
    text = text.replace("wheels = []", f"wheels = [{names}]")
    platforms = ", ".join(f'"{name}"' for name in sorted({platform(wheel) for wheel in wheels}))
    return text.replace("platforms = []", f"platforms = [{platforms}]")


def build(wheels, out):
    """Writes the .zip and returns its path."""
    text = manifest(wheels)
    version = re.search(r'^version = "(.*)"$', text, flags=re.M)[1]
    out.mkdir(parents=True, exist_ok=True)
    archive = out / f"nabiki-{version}-blender.zip"
    part = archive.with_suffix(".part")
    files = {"blender_manifest.toml": text.encode()}
    files |= {source.name: source.read_bytes() for source in sorted(SOURCE.glob("*.py"))}
    files["LICENSE"] = (HERE / "LICENSE").read_bytes()
    files |= {f"wheels/{wheel.name}": wheel.read_bytes() for wheel in wheels}
    # The wheels have a licence of their own, which goes with them.
    files |= {f"wheels/{name}": (ROOT / name).read_bytes() for name in ["LICENSE-MIT", "LICENSE-APACHE"]}
    with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as into:
        for name, data in files.items():
            into.writestr(zipfile.ZipInfo(name, DATE), data, zipfile.ZIP_DEFLATED)
    part.replace(archive)
    return archive


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--wheel", type=Path, nargs="+", help="wheels that are built already")
    parser.add_argument("--out", type=Path, default=ROOT / "target" / "blender")
    arguments = parser.parse_args()
    missing = [wheel for wheel in arguments.wheel or [] if not wheel.is_file()]
    if missing:
        sys.exit(f"{missing[0]}: there is no such wheel; leave --wheel out to build one")
    print(build(arguments.wheel or built(), arguments.out))


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as failure:
        sys.exit(f"failed: {' '.join(failure.cmd)}")

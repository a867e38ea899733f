#!/usr/bin/env python3
"""Packs a built program into the archive that a release offers for download.

    python3 scripts/archive.py target/release/nabiki --package nabiki_cli --target x86_64-unknown-linux-gnu
    python3 scripts/archive.py --check          packs a stand-in for each system, and looks into the archives

The archive is PACKAGE-TARGET-vVERSION.tar.gz, or .zip for Windows, as cargo-binstall looks for it. It holds one folder of
that name with the program, START.txt, README.md, CHANGELOG.md, both licences, the scenes, and with --licences FILE that file as
THIRD-PARTY.txt. Packed twice, the same files make the same archive, byte
for byte.
"""

import argparse
import gzip
import io
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path

# Leaves no compiled files among the sources.
sys.dont_write_bytecode = True

from version import ROOT, version

PAPERS = ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"]
SCENES = [".toml", ".obj", ".csv", ".glb", ".hair", ".md"]

# One date for all files: the earliest that a .zip knows.
DATE = (1980, 1, 1, 0, 0, 0)
SECONDS = 315532800


START = """Nabiki {version}

Open a terminal in this folder: a double click only shows the help for an instant.

    {run} preview scenes/gust.toml      a sheet of pictures and a small movie, in the folder out
    {run} run scenes/gust.toml          the whole movie
    {run} help                          all commands

README.md says what Nabiki does. It was written for the sources, so some of its links and pictures are not here, and its
commands begin with `cargo run --release --`: type {run} instead. Each scene says in its first lines what to look for.
"""

STUDIO = """Nabiki Studio {version}

    {run} scenes/gust.toml              opens a scene in the window; a scene can also be dropped on the program

README.md says what Nabiki does. It was written for the sources, so some of its links and pictures are not here.
"""


def start(program):
    """START.txt: the first steps with this program, with the line ends of its system."""
    windows = program.suffix == ".exe"
    run = f".\\{program.stem}" if windows else f"./{program.name}"
    text = (STUDIO if "studio" in program.stem else START).format(version=version(), run=run)
    return text.replace("\n", "\r\n" if windows else "\n").encode()


def contents(program, licences=None):
    """What goes into the archive: names, bytes, and whether it is a program."""
    files = [(program.name, program.read_bytes(), True), ("START.txt", start(program), False)]
    files += [(name, (ROOT / name).read_bytes(), False) for name in PAPERS]
    if licences:
        files.append(("THIRD-PARTY.txt", licences.read_bytes(), False))
    scenes = sorted(path for path in (ROOT / "scenes").rglob("*") if path.suffix in SCENES)
    return files + [(path.relative_to(ROOT).as_posix(), path.read_bytes(), False) for path in scenes]


def tar_gz(folder, files):
    data = io.BytesIO()
    # The compressed stream would have the date and its file's name.
    with gzip.GzipFile("", "wb", 9, data, SECONDS) as stream, tarfile.open(mode="w", fileobj=stream) as archive:
        for name, content, is_program in files:
            entry = tarfile.TarInfo(f"{folder}/{name}")
            entry.size, entry.mtime, entry.mode = len(content), SECONDS, 0o755 if is_program else 0o644
            archive.addfile(entry, io.BytesIO(content))
    return data.getvalue()


def zipped(folder, files):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content, is_program in files:
            entry = zipfile.ZipInfo(f"{folder}/{name}", DATE)
            # Of Unix, so that the rights are read; otherwise it is by the machine that packs.
            entry.create_system, entry.external_attr = 3, (0o100755 if is_program else 0o100644) << 16
            archive.writestr(entry, content, zipfile.ZIP_DEFLATED, 9)
    return data.getvalue()


def written(archive, data):
    """Writes the file at once, so that no half of it has its name."""
    archive.parent.mkdir(parents=True, exist_ok=True)
    part = archive.with_name(archive.name + ".part")
    part.write_bytes(data)
    part.replace(archive)
    return archive


def pack(program, package, target, out, licences=None):
    """Writes the archive of a program and returns its path."""
    folder = f"{package}-{target}-v{version()}"
    files = contents(program, licences)
    if "windows" in target:
        return written(out / f"{folder}.zip", zipped(folder, files))
    return written(out / f"{folder}.tar.gz", tar_gz(folder, files))


def unpack(archive, into):
    """Unpacks an archive, rights included, and returns its folder."""
    if archive.suffix == ".zip":
        with zipfile.ZipFile(archive) as packed:
            packed.extractall(into)
            for entry in packed.infolist():
                (into / entry.filename).chmod(entry.external_attr >> 16 & 0o777)
        return into / archive.stem
    with tarfile.open(archive) as packed:
        packed.extractall(into, filter="data")
    return into / archive.name.removesuffix(".tar.gz")


def check():
    """Packs a stand-in for each system, unpacks it, and looks for all that must be there."""
    for target, ending in [("x86_64-unknown-linux-gnu", ""), ("aarch64-apple-darwin", ""), ("x86_64-pc-windows-msvc", ".exe")]:
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            program, licences = folder / f"nabiki{ending}", folder / "licences"
            program.write_bytes(b"a program")
            licences.write_bytes(b"licences")
            archive = pack(program, "nabiki_cli", target, folder / "out", licences)
            again = pack(program, "nabiki_cli", target, folder / "again", licences)
            assert archive.read_bytes() == again.read_bytes(), f"{archive.name} differs from one packing to the next"
            name = f"nabiki_cli-{target}-v{version()}"
            assert archive.name == name + (".zip" if ending else ".tar.gz"), archive.name
            assert [path.name for path in archive.parent.iterdir()] == [archive.name], "unfinished files"
            inside = unpack(archive, folder / "unpacked")
            assert [path.name for path in inside.parent.iterdir()] == [name], "more than one folder"
            assert (inside / program.name).read_bytes() == b"a program"
            assert (inside / "THIRD-PARTY.txt").read_bytes() == b"licences"
            assert b"scenes/gust.toml" in (inside / "START.txt").read_bytes()
            # Windows knows no rights.
            assert sys.platform == "win32" or (inside / program.name).stat().st_mode & 0o777 == 0o755
            files = ["gust.toml", "paper/gust.toml", "motion/hand.obj", "characters/walker.glb", "characters/fur.hair"]
            for expected in PAPERS + [f"scenes/{file}" for file in files]:
                assert (inside / expected).read_bytes() == (ROOT / expected).read_bytes(), expected
            print(f"{archive.name}: {sum(path.is_file() for path in inside.rglob('*'))} files, as they should be")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path, nargs="?", help="the built program")
    parser.add_argument("--package", help="the package that it is built from")
    parser.add_argument("--target", help="Rust's name of the machine that it is built for")
    parser.add_argument("--licences", type=Path, help="what goes in as THIRD-PARTY.txt; scripts/licences.py prints it")
    parser.add_argument("--out", type=Path, default=ROOT / "target" / "dist", help="where the archive goes (default: target/dist)")
    parser.add_argument("--check", action="store_true", help="check the packing, with stand-ins for programs")
    arguments = parser.parse_args()
    if arguments.check:
        return check()
    if not (arguments.program and arguments.package and arguments.target):
        parser.error("a program, --package and --target are needed")
    if not arguments.program.is_file():
        sys.exit(f"{arguments.program}: there is no such program; build it first")
    print(pack(arguments.program, arguments.package, arguments.target, arguments.out, arguments.licences))


if __name__ == "__main__":
    main()

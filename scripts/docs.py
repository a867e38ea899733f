#!/usr/bin/env python3
"""Packs the documents of a release: the pages of docs/ and, built by cargo doc, the reference of the crates.

    python3 scripts/docs.py               builds the reference, writes target/dist/nabiki-docs-vVERSION.zip
    python3 scripts/docs.py --built       takes target/doc as it is
    python3 scripts/docs.py --out FOLDER  where the archive goes
"""

import argparse
import os
import subprocess
import sys
from pathlib import Path

# Leaves no compiled files among the sources.
sys.dont_write_bytecode = True

import archive
from version import ROOT, version

READMES = sorted(path.relative_to(ROOT).as_posix() for path in ROOT.glob("crates/*/README.md"))
PAGES = [*archive.PAPERS, "ARCHITECTURE.md", "CONTRIBUTING.md", *READMES]


def pages(reference):
    """Names and bytes of all pages. They keep their places, so that links between them hold."""
    folders = [(ROOT / "docs", "docs"), (ROOT / "scenes", "scenes"), (reference, "reference")]
    files = [(name, (ROOT / name).read_bytes(), False) for name in PAGES]
    for folder, name in folders:
        for path in sorted(path for path in folder.rglob("*") if path.is_file() and not path.name.startswith(".")):
            files.append((f"{name}/{path.relative_to(folder).as_posix()}", path.read_bytes(), False))
    return files


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--built", action="store_true", help="take target/doc as it is")
    parser.add_argument("--out", type=Path, default=ROOT / "target" / "dist", help="where the archive goes (default: target/dist)")
    arguments = parser.parse_args()
    reference = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "doc"
    if not arguments.built:
        subprocess.run(["cargo", "doc", "--workspace", "--no-deps", "--locked"], check=True, cwd=ROOT)
    if not reference.is_dir():
        sys.exit(f"{reference}: there is no such folder; leave --built out to build it")
    folder = f"nabiki-docs-v{version()}"
    print(archive.written(arguments.out / f"{folder}.zip", archive.zipped(folder, pages(reference))))


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as failure:
        sys.exit(f"failed: {' '.join(failure.cmd)}")

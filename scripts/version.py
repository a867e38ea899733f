#!/usr/bin/env python3
"""Checks that all files state the same version, and prints what a release needs to know of it.

    python3 scripts/version.py                  checks the files against each other, prints the version
    python3 scripts/version.py --tag v0.1.0     also checks that the tag and a section of CHANGELOG.md are of that version
    python3 scripts/version.py --notes          prints the version's section of CHANGELOG.md
"""

import argparse
import re
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# The other files that state the version, each with the pattern of its line.
STATED = {
    "integrations/blender/nabiki/blender_manifest.toml": r'^version = "(.*)"$',
    "CITATION.cff": r'^version: "?([^"\n]*)"?$',
}
WORKFLOWS = [".github/workflows/ci.yml", ".github/workflows/release.yml"]


def workspace():
    return tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))["workspace"]


def version():
    """The version of the workspace."""
    return workspace()["package"]["version"]


def problems():
    """A line for each file that disagrees with Cargo.toml."""
    package, wanted = workspace()["package"], version()
    for name, dependency in workspace()["dependencies"].items():
        if isinstance(dependency, dict) and "path" in dependency and dependency.get("version") != wanted:
            yield f"Cargo.toml: {name} is {dependency.get('version')}, the workspace is {wanted}"
    for file, pattern in STATED.items():
        found = re.findall(pattern, (ROOT / file).read_text(encoding="utf-8"), flags=re.M)
        if found != [wanted]:
            yield f"{file}: its version is {', '.join(found) or 'missing'}, Cargo.toml's is {wanted}"
    for file in WORKFLOWS:
        found = set(re.findall(r'^\s*RUST: "(.*)"$', (ROOT / file).read_text(encoding="utf-8"), flags=re.M))
        if found != {package["rust-version"]}:
            yield f"{file}: RUST is {', '.join(found) or 'missing'}, Cargo.toml's rust-version is {package['rust-version']}"


def notes(wanted):
    """The section of CHANGELOG.md of a version, without its heading, or None."""
    sections = re.split(r"^## +", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), flags=re.M)[1:]
    for section in sections:
        heading, _, text = section.partition("\n")
        if re.match(rf"\[?v?{re.escape(wanted)}\]?(?![\w.-])", heading):
            return text.strip()
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tag", help="the tag of a release, which must be of the files' version")
    parser.add_argument("--notes", action="store_true", help="print the version's section of CHANGELOG.md")
    arguments = parser.parse_args()
    wrong, wanted = list(problems()), version()
    if arguments.tag and arguments.tag != f"v{wanted}":
        wrong.append(f"the tag is {arguments.tag}, Cargo.toml's version is {wanted}")
    text = notes(wanted)
    if (arguments.tag or arguments.notes) and not text:
        wrong.append(f"CHANGELOG.md: no section '## {wanted}', or an empty one")
    if wrong:
        sys.exit("\n".join(wrong))
    print(text if arguments.notes else wanted)


if __name__ == "__main__":
    main()

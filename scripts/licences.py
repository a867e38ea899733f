#!/usr/bin/env python3
"""Prints the licences of all crates that a package of the workspace is built of.

    python3 scripts/licences.py nabiki_cli --target x86_64-unknown-linux-gnu > THIRD-PARTY.txt

Licences as MIT's and BSD's ask that their text goes with every program, so archives have this list as THIRD-PARTY.txt. It
comes from `cargo metadata` and from the sources of the crates. Crates that are used only to build or to test are left out.
"""

import argparse
import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TEXTS = re.compile(r"(licen[cs]e|copying|notice|unlicense|ofl|ufl|copyright)([-._].*)?", re.I)
# Sources and pages that only have such a name.
NOT_TEXTS = {".rs", ".py", ".c", ".h", ".cpp", ".html", ".json", ".toml", ".yml", ".yaml"}


def metadata(target):
    command = ["cargo", "metadata", "--locked", "--format-version", "1", "--filter-platform", target]
    done = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE)
    return json.loads(done.stdout)


def used(graph, package):
    """The packages that end up in the program, by name."""
    packages = {found["id"]: found for found in graph["packages"]}
    nodes = {node["id"]: node for node in graph["resolve"]["nodes"]}
    (first,) = [key for key in graph["workspace_members"] if packages[key]["name"] == package] or [None]
    if first is None:
        sys.exit(f"{package}: no package of the workspace")
    seen, waiting = {first}, [first]
    while waiting:
        for dependency in nodes[waiting.pop()]["deps"]:
            normal = any(kind["kind"] is None for kind in dependency["dep_kinds"])
            macro = any("proc-macro" in target["kind"] for target in packages[dependency["pkg"]]["targets"])
            if normal and not macro and dependency["pkg"] not in seen:
                seen.add(dependency["pkg"])
                waiting.append(dependency["pkg"])
    ours = set(graph["workspace_members"])
    return sorted((packages[key] for key in seen - ours), key=lambda found: (found["name"], found["version"]))


def texts(package):
    """The licence texts in the sources of a crate, of what it brings along too."""
    folder = Path(package["manifest_path"]).parent
    for path in sorted(folder.rglob("*")):
        if TEXTS.fullmatch(path.name) and path.suffix.lower() not in NOT_TEXTS and path.is_file():
            yield path.read_text(encoding="utf-8", errors="replace").replace("\r\n", "\n").strip()


def listed(packages):
    """One text: the crates with their licences, then each different licence text once, with the crates that have it."""
    lines = ["This program contains the following Rust crates, each with its licence:", ""]
    users = {}
    for package in packages:
        title = f"{package['name']} {package['version']}"
        licence = package["license"] or "see its text below"
        lines.append(f"{title}: {licence}, {package['repository'] or 'https://crates.io/crates/' + package['name']}")
        for text in texts(package):
            users.setdefault(text, [])
            if title not in users[text]:
                users[text].append(title)
    for text, titles in users.items():
        lines += ["", "=" * 80, *titles, "-" * 80, text]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("package", help="a package of the workspace")
    parser.add_argument("--target", required=True, help="Rust's name of the machine that the program is for")
    arguments = parser.parse_args()
    sys.stdout.reconfigure(encoding="utf-8", newline="\n")
    sys.stdout.write(listed(used(metadata(arguments.target), arguments.package)))


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as failure:
        sys.exit(f"failed: {' '.join(failure.cmd)}")

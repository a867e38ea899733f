"""Writes python/nabiki/settings/ and docs/settings.md from the doc comments of the structs that a scene is read into.

    python3 crates/nabiki_py/generate.py            writes the modules and the page
    python3 crates/nabiki_py/generate.py --check    says whether they are current

The Rust structs are the only place where a setting has its type, unit, range and default in words.
"""

import argparse
import keyword
import re
import sys
import textwrap
from dataclasses import dataclass, field
from pathlib import Path

from settings_page import Source, page

HERE = Path(__file__).resolve().parent
CRATES = HERE.parent
TARGET = HERE / "python" / "nabiki" / "settings"
PAGE = CRATES.parent / "docs" / "settings.md"

# The structs of the tables that several share, which the scene takes apart itself: the table's docs, then its keys.
SHARED = {
    "head": ("HeadSettings", ["AnyHead", "ImportedHead"]),
    "hair": ("HairSettings", ["AnyHair", "GrownHair", "ImportedHair"]),
    "motion": ("Motion", ["Motion", "FormKey"]),
}
# Keys of private structs are explained where the public type has them.
EXPLAINED = {
    "AnyHead.ellipsoid": "HeadSettings.ellipsoid",
    "AnyHead.shell": "HeadSettings.shell",
    "AnyHead.motion": "HeadSettings.motion",
    "AnyHair.segment_length": "HairSettings.segment_length",
    "FormKey.form": "Scene.form",
}
# Types that read themselves from more than one kind of value: what is read, what may be given.
SPECIAL = {
    "EllipsoidChoice": ("str | dict[str, Any]", "str | Mapping[str, Any]"),
    "HairColour": ("str | dict[str, Any]", "str | Mapping[str, Any]"),
    "Profile": ("float | tuple[float, ...]", "float | Numbers"),
    "Gravity": ("float | str", "float | str"),
    "Unit": ("str | float", "str | float"),
    "Axis": ('Literal["+x", "-x", "+y", "-y", "+z", "-z"]',) * 2,
}
# Which module holds a table of the scene.
MODULES = {
    "hair": ["hair"],
    "picture": ["picture", "output"],
    "wind": ["force", "wind", "gust", "body_wind", "flow", "turbulence", "point", "vortex", "fan"],
    "motion": ["motion", "free", "contact", "neighbours", "pseudo_force", "disturbance"],
    "head": ["head", "body"],
}
OPTIONAL_DOC = "Not there unless it is given."


@dataclass
class Field:
    name: str
    type: str
    doc: str
    must: bool = False


@dataclass
class Struct:
    name: str
    doc: str
    fields: list = field(default_factory=list)


def sources():
    """The text of every file of the crates that scenes are made of, by path."""
    crates = [CRATES / crate / "src" for crate in ["nabiki", "nabiki_io", "nabiki_render", "nabiki_scene"]]
    return {file: file.read_text() for crate in crates for file in sorted(crate.rglob("*.rs"))}


def parse(files):
    """Structs and enums by name."""
    structs, enums = {}, {}
    item = re.compile(
        r"(?P<head>(?:[ \t]*(?:///.*|#\[.*\])\n)+)[ \t]*(?:pub(?:\([^)]*\))? )?(?P<kind>struct|enum) (?P<name>\$?\w+) \{(?P<body>(?:\n.*)*?)\n[ \t]*\}",
    )
    for file, text in files.items():
        for found in item.finditer(text):
            head, name = found["head"], found["name"]
            if "Deserialize" not in head and name not in ["HeadSettings", "HairSettings", "Scene"]:
                continue
            if found["kind"] == "struct":
                must = "Deserialize" in head and not re.search(r"serde\(.*\bdefault\b", head)
                struct = Struct(name, docs(head), list(fields(found["body"], must)))
                if name in structs and structs[name] != struct:
                    raise SystemExit(f"two structs are called {name}: {file}")
                structs[name] = struct
            else:
                enums[name] = variants(head, found["body"])
        for found in re.finditer(r"by_region!\(\n(?P<head>(?:\s*///.*\n)+)\s*(?P<name>\w+),", text):
            structs[found["name"]] = Struct(found["name"], docs(found["head"]), structs["$name"].fields)
    return structs, enums


def docs(text):
    """The words of doc comments, without the links of Rust."""
    lines = [line.strip()[3:].strip() for line in text.splitlines() if line.strip().startswith("///")]
    text = " ".join(line or "\n\n" for line in lines)
    text = re.sub(r"\[`([^`]*)`\](\([^)]*\))?", r"`\1`", text)
    return "\n\n".join(part.strip() for part in text.split("\n\n"))


def fields(body, must):
    """The fields of a struct; `must`: those without a default of their own must be given."""
    doc, name, optional = [], None, False
    for line in body.splitlines():
        line = line.strip()
        if line.startswith("///"):
            doc.append(line)
        elif found := re.match(r'#\[serde\(rename = "(\w+)"\)\]', line):
            name = found[1]
        elif line.startswith("#[serde(skip)]"):
            name = ""
        elif re.match(r"#\[serde\(.*\bdefault\b", line):
            optional = True
        elif found := re.match(r"(?:pub )?(\w+): (.*),$", line):
            if name != "":
                yield Field(name or found[1], found[2], docs("\n".join(doc)), must and not optional)
            doc, name, optional = [], None, False


def variants(head, body):
    """The words of an enum that has no others; none where it has."""
    style = re.search(r'rename_all = "([\w-]+)"', head)
    words = []
    for line in body.splitlines():
        line = line.strip()
        if found := re.match(r"(\w+),$", line):
            snake = re.sub(r"(?<!^)(?=[A-Z])", "_", found[1]).lower()
            joint = {"lowercase": "", "kebab-case": "-", "snake_case": "_"}.get(style and style[1], "_")
            words.append(snake.replace("_", joint))
        elif line and not line.startswith(("///", "#[")):
            return None
    return words


class Writer:
    def __init__(self, structs, enums):
        self.structs, self.enums = structs, enums
        self.classes = {}

    def type_of(self, rust, place):
        """What is read and what may be given, and the table below if it is one."""
        if found := re.fullmatch(r"Option<(.*)>", rust):
            read, given, table = self.type_of(found[1], place)
            return (read, given, table) if table else (f"{read} | None", given, None)
        if found := re.fullmatch(r"Vec<(.*)>", rust):
            read, _, table = self.type_of(found[1], place)
            if table:
                return f"Tables[{table}]", f"Iterable[{table} | Mapping[str, Any]]", f"[{table}]"
            return f"tuple[{read}, ...]", f"Sequence[{read}]", None
        if found := re.fullmatch(r"\[(\w+); (\d)\]", rust):
            read, _, _ = self.type_of(found[1], place)
            return f"tuple[{', '.join([read] * int(found[2]))}]", "Numbers", None
        if rust in ("f32", "f64"):
            return "float", "float", None
        if re.fullmatch(r"[ui](8|16|32|64|size)", rust):
            return "int", "int", None
        simple = {"bool": "bool", "String": "str"}.get(rust)
        if simple:
            return simple, simple, None
        if rust == "PathBuf":
            arrays = place in ("ImportedHead.mesh", "BodySettings.mesh", "ImportedHair.file")
            return "str", "File | Arrays" if arrays else "File", None
        if rust in ("Vec3", "Vec2"):
            return f"tuple[{', '.join(['float'] * int(rust[-1]))}]", "Numbers", None
        if rust in SPECIAL:
            return *SPECIAL[rust], None
        if self.enums.get(rust):
            words = f"Literal[{', '.join(f'{chr(34)}{word}{chr(34)}' for word in self.enums[rust])}]"
            return words, words, None
        if rust in self.structs:
            self.table(rust)
            arrays = " | Matrices" if rust == "MotionSource" else ""
            return rust, f"{rust} | Mapping[str, Any]{arrays}", rust
        raise SystemExit(f"{place}: what is a {rust} in Python?")

    def table(self, name, doc=None, parts=None):
        """The class of a table."""
        if name in self.classes:
            return
        self.classes[name] = ""
        struct = self.structs[name]
        lines = [f"class {name}(Table):", doc_string(doc or struct.doc, 4), "", "    __slots__ = ()"]
        seen = set()
        for part in parts or [name]:
            for entry in self.structs[part].fields:
                if entry.name in seen:
                    continue
                seen.add(entry.name)
                lines += self.setting(part, entry, "self._key_of({name!r})")
        self.classes[name] = "\n".join(lines) + "\n"

    def setting(self, part, entry, key):
        place = f"{part}.{entry.name}"
        doc = entry.doc
        if place in EXPLAINED:
            struct, name = EXPLAINED[place].split(".")
            doc = next(field.doc for field in self.structs[struct].fields if field.name == name)
        read, given, table = self.type_of(entry.type, place)
        key = key.format(name=entry.name)
        owner = "self._scene" if key.startswith("self._key_of") else "self"
        name = entry.name + "_" * keyword.iskeyword(entry.name)
        if table and table.startswith("["):
            value = f"Tables({owner}, {key}, {table[1:-1]})"
        elif table:
            value = f"{table}({owner}, {key})"
        else:
            value = f"self._get({entry.name!r})"
        if owner == "self._scene":
            put = f"self._set({entry.name!r}, value)"
        else:
            put = f"self[{key}] = value"
        body = f"        return {value}"
        if not table:
            body = f"        value: {read} = {value}\n        return value"
        return [
            "",
            "    @property",
            f"    def {name}(self) -> {read}:",
            doc_string(doc, 8),
            body,
            "",
            f"    @{name}.setter",
            f"    def {name}(self, value: {given} | None) -> None:",
            f"        {put}",
        ]


def doc_string(doc, indent):
    pad = " " * indent
    doc = doc.replace("\\", "\\\\") or "(see the scene file)"
    parts = [textwrap.fill(part, 118 - indent) for part in doc.split("\n\n")]
    lines = '"""' + "\n\n".join(parts) + '"""'
    if len(parts) > 1 or "\n" in parts[0]:
        lines = lines[:-3] + '\n"""'
    return "\n".join(pad + line if line else "" for line in lines.splitlines())


HEADER = '''"""{title} Written by generate.py from the doc comments of the Rust structs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal

from ._table import Arrays, File, Matrices, Numbers, Table, Tables
{imports}
__all__ = {names}
'''

TITLES = {
    "hair": "How hair lies at rest: `scene.hair`.",
    "picture": "What is drawn: `scene.picture`, `scene.output`.",
    "wind": "What pushes the hair: `scene.wind`, `scene.gust`, `scene.fan`, ...",
    "motion": "How hair answers: `scene.motion`, `scene.free`, ...",
    "head": "The head and other bodies: `scene.head`, `scene.body`.",
}


def modules(structs, enums):
    """The text of every module by its file's name."""
    writer = Writer(structs, enums)
    tables = {field.name: field for field in structs["Tables"].fields}
    scene_docs = {field.name: field.doc for field in structs["Scene"].fields}
    scene_docs |= {field.name: field.doc for field in structs["FieldSettings"].fields}
    scene_docs["body"] = scene_docs["bodies"]
    written, where, scene, tables_given = {}, {}, [], []
    for module, keys in MODULES.items():
        for key in keys:
            entry = tables.pop(key)
            if key in SHARED:
                name, parts = SHARED[key]
                writer.table(name, parts=parts)
                entry = Field(key, name, "")
            entry = Field(key, entry.type, re.sub(r"\s*`\[+[\w.]+\]+`:?\s*", " ", scene_docs[key]).strip())
            if not entry.doc:
                struct = re.sub(r"Option<|Vec<|>", "", entry.type)
                entry.doc = re.sub(r"^`\[+[\w.]+\]+`: ", "", structs[struct].doc).strip()
            if entry.type.startswith("Option<"):
                entry.doc += " " + OPTIONAL_DOC
            entry.doc = entry.doc[:1].upper() + entry.doc[1:]
            scene.append("\n".join(writer.setting("Tables", entry, "{name!r}")))
            if key not in ("head", "hair"):
                tables_given.append((key, writer.type_of(entry.type, "Tables")[1]))
        new = {name: text for name, text in writer.classes.items() if name not in where}
        # A class stands after those that it makes.
        where |= dict.fromkeys(new, module)
        written[module] = new
    if tables:
        raise SystemExit(f"no module for the tables {', '.join(tables)}")
    result = {}
    for module, classes in written.items():
        used = {}
        for name, home in where.items():
            if home != module and any(re.search(rf"\b{name}\(", text) for text in classes.values()):
                used.setdefault(home, []).append(name)
        imports = "".join(f"from .{home} import {', '.join(sorted(names))}\n" for home, names in sorted(used.items()))
        names = "[" + ", ".join(f'"{name}"' for name in sorted(classes)) + "]"
        if len(names) > 100:
            names = "[\n" + "".join(f'    "{name}",\n' for name in sorted(classes)) + "]"
        text = HEADER.format(title=TITLES[module], imports=imports, names=names)
        result[f"{module}.py"] = text + "".join("\n\n" + text for text in classes.values())
    homes = "".join(
        f"from .{module} import {', '.join(sorted(classes))}\n" for module, classes in sorted(written.items())
    )
    result["__init__.py"] = (
        '"""Every setting of a scene as an attribute. Written by generate.py from the doc comments of the Rust structs."""\n\n'
        "from __future__ import annotations\n\nfrom collections.abc import Iterable, Mapping\nfrom typing import Any, TypedDict\n\n"
        "from .. import _nabiki\nfrom ._table import Table, Tables\n" + homes + "\n\n"
        "class SceneTables(TypedDict, total=False):\n"
        '    """What may be said of a scene that is put together, but for what the scene itself names."""\n\n'
        + "".join(f"    {key}: {given} | None\n" for key, given in tables_given)
        + "\n\n"
        "class SceneSettings(_nabiki.Scene):\n"
        '    """The tables of a scene by the names that they have in a file."""\n\n    __slots__ = ()\n'
        + "\n".join(scene)
        + "\n"
    )
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing")
    check = parser.parse_args().check
    files = sources()
    structs, enums = parse(files)
    wanted = {TARGET / name: text for name, text in modules(structs, enums).items()}
    wanted[PAGE] = page(structs, enums, SHARED, EXPLAINED, Source(files.values(), docs))
    old = sorted(set(TARGET.glob("*.py")) - wanted.keys() - {TARGET / "_table.py"})
    for path, text in wanted.items():
        if not path.exists() or path.read_text() != text:
            old.append(path)
            if not check:
                path.write_text(text)
    if check and old:
        names = ", ".join(path.name for path in old)
        sys.exit(f"{names}: not what the Rust structs say; run python3 crates/nabiki_py/generate.py")
    print(f"settings: {len(wanted) - 1} modules and a page, {'current' if check or not old else 'written'}")


if __name__ == "__main__":
    main()

"""Writes python/nabiki/settings/, docs/settings.md and what Blender's panels show of settings from the schema of scenes, which `nabiki schema --json` prints.

    python3 crates/nabiki_py/generate.py            writes them
    python3 crates/nabiki_py/generate.py --check    says whether they are current

With --nabiki it asks a command that is built already, otherwise the one that cargo builds.
"""

import argparse
import keyword
import re
import sys
import textwrap
from pathlib import Path

import schema as schemas
from settings_page import page

HERE = Path(__file__).resolve().parent
TARGET = HERE / "python" / "nabiki" / "settings"
PAGE = schemas.ROOT / "docs" / "settings.md"
BLENDER = schemas.ROOT / "integrations" / "blender" / "nabiki" / "declared.py"
# Settings that Blender's panels have.
SHOWN = """gust.intensity gust.time_scale gust.seed flow.thickness body_wind.drag wind.ease free.stiffness free.hold free.settle free.gravity
free.drag free.substeps free.regions.stiffness free.regions.hold free.regions.settle free.regions.wind free.regions.drag
motion.slow motion.inertia_length_floor contact.margin contact.friction contact.static_friction neighbours.pressure
neighbours.cohesion""".split()

# Tables of several kinds, by the classes that have the keys of all.
CLASSES = {"head": "HeadSettings", "hair": "HairSettings"}
# Files that may be given as arrays.
ARRAYS = ["HeadSettings.mesh", "BodySettings.mesh", "HairSettings.file"]
# Which module holds a table of the scene.
MODULES = {
    "hair": ["hair"],
    "picture": ["picture", "output"],
    "wind": ["force", "wind", "gust", "body_wind", "flow", "turbulence", "point", "vortex", "fan"],
    "motion": ["motion", "free", "contact", "neighbours", "aim", "pseudo_force", "disturbance"],
    "head": ["head", "body"],
}


def types(schema):
    """What is read and what may be given, of what is no table."""
    if "anyOf" in schema:
        kinds = [("str", "str") if "enum" in kind else types(kind) for kind in schema["anyOf"]]
        return tuple(" | ".join(dict.fromkeys(kind[i] for kind in kinds)) for i in (0, 1))
    if "$ref" in schema:
        return "dict[str, Any]", "Mapping[str, Any]"
    if "enum" in schema:
        words = f"Literal[{', '.join(f'{chr(34)}{word}{chr(34)}' for word in schema['enum'])}]"
        return words, words
    if schema["type"] == "array":
        read, inner = types(schema["items"])
        if count := schema.get("maxItems"):
            return f"tuple[{', '.join([read] * count)}]", "Numbers"
        if schema["items"].get("type") == "array":
            return f"tuple[{read}, ...]", f"Sequence[{inner}]"
        given = [] if read == "float" else [f"Sequence[{read}]"]
        return f"tuple[{read}, ...]", " | ".join(["Numbers"] * read.startswith("float") + given)
    if schema.get("format") == "path":
        return "str", "File"
    name = {"number": "float", "integer": "int", "boolean": "bool", "string": "str"}[schema["type"]]
    return name, name


class Writer:
    def __init__(self, schema):
        self.schema = schema
        self.classes = {}

    def type_of(self, setting, place):
        """What is read and what may be given, and the class of a table below if it is one."""
        if name := setting.table or CLASSES.get(setting.key):
            if setting.table:
                self.table(name, self.schema.defs[name]["description"], self.schema.settings(name))
            if setting.many:
                return f"Tables[{name}]", f"Iterable[{name} | Mapping[str, Any]]", name
            return name, f"{name} | Mapping[str, Any]" + " | Matrices" * (name == "MotionSource"), name
        read, given = types(setting.schema)
        return read + " | None" * setting.optional, given + " | Arrays" * (place in ARRAYS), None

    def table(self, name, doc, settings):
        """The class of a table."""
        if name in self.classes:
            return
        self.classes[name] = ""
        lines = [f"class {name}(Table):", doc_string(doc, 4), "", "    __slots__ = ()"]
        for setting in settings.values():
            lines += self.setting(name, setting, f"self._key_of({setting.key!r})")
        self.classes[name] = "\n".join(lines) + "\n"

    def setting(self, owner, setting, key):
        read, given, table = self.type_of(setting, f"{owner}.{setting.key}")
        scene, put = ("self._scene", f"self._set({setting.key!r}, value)") if owner else ("self", f"self[{key}] = value")
        name = setting.key + "_" * keyword.iskeyword(setting.key)
        if setting.many:
            body = f"        return Tables({scene}, {key}, {table})"
        elif table:
            body = f"        return {table}({scene}, {key})"
        else:
            body = f"        value: {read} = self._get({setting.key!r})\n        return value"
        return [
            "",
            "    @property",
            f"    def {name}(self) -> {read}:",
            doc_string(told(setting), 8),
            body,
            "",
            f"    @{name}.setter",
            f"    def {name}(self, value: {given} | None) -> None:",
            f"        {put}",
        ]


def told(setting):
    """The words of a setting, with what may be given and what is taken where nothing is."""
    if setting.table or "title" not in setting.schema:
        return setting.doc
    default = setting.default()
    facts = f"{setting.value()}; {'' if setting.must else 'default: '}{default}" if default else setting.value()
    facts = facts.replace("`", "")
    return f"{setting.doc} {facts[:1].upper()}{facts[1:]}."


def doc_string(doc, indent):
    pad = " " * indent
    parts = [textwrap.fill(part, 118 - indent) for part in doc.replace("\\", "\\\\").split("\n\n")]
    lines = '"""' + "\n\n".join(parts) + '"""'
    if len(parts) > 1 or "\n" in parts[0]:
        lines = lines[:-3] + '\n"""'
    return "\n".join(pad + line if line else "" for line in lines.splitlines())


HEADER = '''"""{title} Written by generate.py from the schema of scenes."""

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


def modules(schema):
    """The text of every module by its file's name."""
    writer = Writer(schema)
    tables = {table.key: table for table in schema.tables}
    written, where, scene, tables_given = {}, {}, [], []
    for module, keys in MODULES.items():
        for key in keys:
            table = tables.pop(key)
            if key in CLASSES:
                merged = {}
                for _, settings in schema.kinds(table):
                    # What may be a file's path is one, whichever kind is looked at first.
                    merged |= {name: of for name, of in settings.items() if name not in merged or of.schema.get("format") == "path"}
                writer.table(CLASSES[key], table.doc, merged)
            scene.append("\n".join(writer.setting("", table, repr(key))))
            if key not in ("head", "hair"):
                tables_given.append((key, writer.type_of(table, "")[1]))
        new = {name: text for name, text in writer.classes.items() if name not in where}
        # A class stands after those that it makes.
        where |= dict.fromkeys(new, module)
        written[module] = new
    if tables:
        raise SystemExit(f"no module for {', '.join(tables)}: name each table in MODULES of generate.py")
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
    homes = "".join(f"from .{module} import {', '.join(sorted(classes))}\n" for module, classes in sorted(written.items()))
    result["__init__.py"] = (
        '"""Every setting of a scene as an attribute. Written by generate.py from the schema of scenes."""\n\n'
        "from __future__ import annotations\n\nfrom collections.abc import Iterable, Mapping\nfrom typing import Any, TypedDict\n\n"
        "from .. import _nabiki\nfrom ._table import Table, Tables\n" + homes + "\n\n"
        "class SceneTables(TypedDict, total=False):\n"
        '    """What may be said of a scene that is put together, but for what the scene itself names."""\n\n'
        + "".join(f"    {key}: {given} | None\n" for key, given in tables_given)
        + "\n\n"
        "class SceneSettings(_nabiki.Scene):\n"
        '    """The tables of a scene by the names that they have in a file."""\n\n    __slots__ = ()\n' + "\n".join(scene) + "\n"
    )
    return result


def flat(schema):
    """What a setting may be, choices within choices one after another."""
    for kind in schema.get("anyOf", []):
        yield from flat(kind)
    if "anyOf" not in schema:
        yield schema


def blender(schema):
    """The module of the extension: what a property of each setting is made with."""
    tables = {table.key: schema.kinds(table)[0][1] for table in schema.tables if not table.many}
    lines = [
        "# SPDX-License-Identifier: GPL-3.0-or-later",
        '"""Settings as the scene declares them. Written by crates/nabiki_py/generate.py."""',
        "",
        "SETTINGS = {",
    ]
    for key in SHOWN:
        table, *below, name = key.split(".")
        settings = tables[table]
        for list_ in below:
            settings = schema.settings(settings[list_].table)
        setting = settings[name]
        kinds = list(flat(setting.schema))
        number = next((kind for kind in kinds if kind.get("type") in ("number", "integer")), {})
        unit = setting.schema.get("x-unit")
        values = {
            "name": setting.schema["title"].title() + (f" ({unit})" if unit == "cm" else ""),
            # Blender ends it with a point.
            "description": setting.doc.split(". ")[0].removesuffix("."),
            "default": setting.schema.get("default"),
            "min": number.get("minimum", number.get("exclusiveMinimum")),
            "max": number.get("maximum"),
        }
        lines += [f'    "{key}": {{', *(f"        {name!r}: {value!r},".replace("'", '"', 2) for name, value in values.items() if value is not None), "    },"]
    ease = tables["wind"]["ease"].schema
    items = [(word, word.title(), said.removesuffix(".")) for word, said in zip(ease["enum"], ease["enumDescriptions"], strict=True)]
    lines += ["}", "", "EASE = [", *(f"    {item!r}," for item in items), "]", ""]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing")
    parser.add_argument("--nabiki", type=Path, help="a command that is built already")
    arguments = parser.parse_args()
    schema = schemas.read(arguments.nabiki and arguments.nabiki.resolve())
    wanted = {TARGET / name: text for name, text in modules(schema).items()}
    wanted |= {PAGE: page(schema), BLENDER: blender(schema)}
    old = sorted(set(TARGET.glob("*.py")) - wanted.keys() - {TARGET / "_table.py"})
    for path, text in wanted.items():
        if not path.exists() or path.read_text() != text:
            old.append(path)
            if not arguments.check:
                path.write_text(text)
    if arguments.check and old:
        names = ", ".join(path.name for path in old)
        sys.exit(f"{names}: not what the structs declare; run python3 crates/nabiki_py/generate.py")
    print(f"settings: {len(wanted)} files, {'current' if arguments.check or not old else 'written'}")


if __name__ == "__main__":
    main()

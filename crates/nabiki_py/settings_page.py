"""Writes docs/settings.md: every table of a scene with its keys, out of the schema. Called by generate.py."""

import re

from schema import in_words

INTRODUCTION = """# Settings

This page lists every setting of a scene file, table by table in the order of the file. You can leave out all tables and nearly all keys.

Set a value in the scene file (TOML), or for one run on the command line with `--set KEY=VALUE`. Write the full key and the value in TOML.
Entries in a list of tables count from 0. You can repeat `--set`:

    nabiki simulate scene.toml -o m.nabiki --set motion.time_step=0.05 --set 'force.0.vector=[0,-100,0]' --set 'picture.hair.colour="red"'

- Head space is in cm, with y up, the face along +x and the character's right hand along +z.
- Paths are relative to the scene file.
- Lists are in brackets, texts and paths in quotes.
- F is the unit of forces, the strength of the wind. It has no dimension: with the default settings, 30 is a breeze and 100 a strong wind.
  In a scene of `nabiki new` the numbers are [far larger](motion-forms.md#choosing).

`nabiki info scene.toml` prints what a scene contains. `nabiki schema` prints these settings in a terminal. `nabiki schema --json` prints a
JSON Schema, which lets editors complete and check scenes. Save it as `scene.schema.json` and make `#:schema scene.schema.json` the
first line of the scene.

`python3 crates/nabiki_py/generate.py` writes this page from the doc comments of the Rust structs. Change the text there.
"""
HEAD = ["| key | value | default | what it does |", "|---|---|---|---|"]


class Page:
    def __init__(self, schema):
        self.schema, self.homes, self.sections = schema, {}, []

    def section(self, key, doc, kinds, many=False):
        """The section of one table, then those of the tables in it."""
        place = len(self.sections)
        self.sections.append("")
        text = [f"{'#' * min(key.count('.') + 2, 4)} `{f'[[{key}]]' if many else f'[{key}]'}`", "", doc]
        shared = {}
        if len(kinds) > 1:
            first, *others = (settings for _, settings in kinds)
            shared = {name for name, of in first.items() if all(name in kind and kind[name].schema == of.schema for kind in others)}
            text += ["", *HEAD, *(self.row(key, of) for name, of in first.items() if name in shared)]
        for about, settings in kinds:
            if len(kinds) > 1:
                text += ["", about]
            text += ["", *HEAD, *(self.row(key, of) for name, of in settings.items() if name not in shared)]
        self.sections[place] = "\n".join(text) + "\n"

    def row(self, key, setting):
        about = [setting.doc]
        words = setting.schema.get("enum", [])
        # An axis says itself what it is.
        for word, said in zip(words, setting.schema.get("enumDescriptions", []) if "+x" not in words else [], strict=False):
            about.append(f'`"{word}"`: {said}')
        for kind in setting.schema.get("anyOf", []):
            if "$ref" in kind:
                name = kind["$ref"].rpartition("/")[2]
                keys = ", ".join(f"{of.key} = {inner(of, self.schema)}" for of in self.schema.settings(name).values())
                about.append(f"`{{ {keys} }}`: {self.schema.defs[name]['description']}")
        value = self.table(key, setting) if setting.table else setting.value()
        cells = [f"`{setting.key}`", value, setting.default(), " ".join(about)]
        return "| " + " | ".join(cell(text) for text in cells) + " |"

    def table(self, key, setting):
        kind = "tables" if setting.many else "table"
        if setting.table in self.homes:
            home = self.homes[setting.table]
            return f"{kind}, keys as in [`{home}`](#{anchor(home)})"
        own = f"{key}.{setting.key}"
        self.homes[setting.table] = f"[[{own}]]" if setting.many else f"[{own}]"
        doc = self.schema.defs[setting.table]["description"]
        self.section(own, doc, [(doc, self.schema.settings(setting.table))], setting.many)
        return f"[{kind}](#{anchor(own)})"


def inner(setting, schema):
    """What stands for a setting of a table in braces."""
    if setting.table:
        return "{ " + ", ".join(f"{of.key} = {inner(of, schema)}" for of in schema.settings(setting.table).values()) + " }"
    return "[x, y, z]" if setting.schema.get("maxItems") == 3 else in_words(setting.schema).split(",")[0]


def anchor(key):
    """What a heading of this key is called by GitHub."""
    return re.sub(r"[^\w-]", "", key.lower())


def cell(text):
    """Text in a cell of a table."""
    return text.replace("\n\n", " ").replace("|", "\\|")


def page(schema):
    """The text of the page."""
    result = Page(schema)
    for table in schema.tables:
        result.section(table.key, table.doc, schema.kinds(table), table.many)
    return INTRODUCTION + "\n" + "\n".join(result.sections)

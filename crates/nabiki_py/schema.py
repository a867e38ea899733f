"""The schema of scenes as `nabiki schema --json` prints it: tables with their settings, and what may be said of each in words."""

import json
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
OPTIONAL = "Off unless the scene has this table."


class Setting:
    """A setting, or a table at the top of a scene."""

    def __init__(self, key, schema, must=False):
        self.key, self.schema, self.must = key, schema, must
        self.doc = schema["description"]
        self.open = schema.get("x-open")

    @property
    def many(self):
        """Whether it is a list of tables."""
        return "$ref" in self.schema.get("items", {})

    @property
    def table(self):
        """The name of the struct that it is, or is a list of; none where it is no table alone."""
        ref = self.schema.get("$ref") or self.schema.get("items", {}).get("$ref")
        return ref and ref.rpartition("/")[2]

    @property
    def optional(self):
        return self.open is not None

    def value(self):
        """What may be given, in words."""
        unit = self.schema.get("x-unit")
        return in_words(self.schema) + (f" ({unit})" if unit else "")

    def default(self):
        """What is taken where nothing is given, in words."""
        if self.must:
            return "must be given"
        if self.optional:
            return self.open
        default = self.schema.get("default")
        if default is None:
            return ""
        return f"`{in_toml(default)}`" if default not in ("", []) else "none"


class Schema:
    def __init__(self, text):
        schema = json.loads(text)
        self.defs = schema["$defs"]
        self.tables = [Setting(key, table) for key, table in schema["properties"].items()]
        for table in self.tables:
            if "default" not in table.schema and not table.many:
                table.doc += " " + OPTIONAL

    def kinds(self, table):
        """The structs that a table may be: their settings by key, and their docs."""
        names = [ref["$ref"].rpartition("/")[2] for ref in table.schema.get("anyOf", [])] or [table.table]
        return [(self.defs[name]["description"], self.settings(name)) for name in names]

    def settings(self, name):
        must = self.defs[name].get("required", [])
        return {key: Setting(key, schema, key in must) for key, schema in self.defs[name]["properties"].items()}


def read(command=None):
    """The schema of `command`, or of the one that cargo builds."""
    command = [command] if command else ["cargo", "run", "--quiet", "-p", "nabiki_cli", "--"]
    told = subprocess.run([*command, "schema", "--json"], cwd=ROOT, check=True, capture_output=True, text=True)
    return Schema(told.stdout)


def number(value):
    """A number without a point where it needs none."""
    return str(int(value)) if value == int(value) and abs(value) < 1e15 else repr(value)


def in_toml(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return number(value)
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, list):
        return "[" + ", ".join(map(in_toml, value)) + "]"
    return "{ " + ", ".join(f"{key} = {in_toml(of)}" for key, of in value.items()) + " }"


def choice(words):
    if len(words) < 2:
        return "".join(words)
    return ", ".join(words[:-1]) + (", or " if any("," in word for word in words) else " or ") + words[-1]


def bounds(schema):
    """Where a number lies, in words."""
    above, least, most = (schema.get(name) for name in ("exclusiveMinimum", "minimum", "maximum"))
    if least is not None and most is not None:
        return f", {number(least)} to {number(most)}"
    if above is not None:
        return f" above {number(above)}" + (f", at most {number(most)}" if most is not None else "")
    if least is not None:
        return f" of at least {number(least)}" if schema["type"] == "number" or least > 0 else ""
    return f" of at most {number(most)}" if most is not None else ""


def in_words(schema):
    if "anyOf" in schema:
        kinds = schema["anyOf"]
        # What a list of several kinds holds was said just before.
        said = [in_words(of) if of.get("items", {}).get("anyOf") is None else "a list of them" for of in kinds]
        return choice(said)
    if "$ref" in schema:
        return f"a table of `{schema['$ref'].rpartition('/')[2]}`"
    if "enum" in schema:
        return choice([f'`"{word}"`' for word in schema["enum"]])
    if "x-units" in schema:
        return choice([f'`"... {unit}"`' for unit in schema["x-units"]])
    kind = schema["type"]
    if kind == "array":
        items, count = schema["items"], schema.get("maxItems")
        if "type" not in items:
            return f"list: {in_words(items)}"
        if items["type"] == "array":
            inner = in_words(items)
            return "list of " + (f"lists{inner.removeprefix('list')}" if inner.startswith("list") else f"groups of {inner}")
        plural = {"number": "numbers", "integer": "whole numbers", "string": "texts"}[items["type"]]
        return (f"{count} {plural}" if count else f"list of {plural}") + (", each" + bounds(items).removeprefix(",") if bounds(items) else "")
    if kind == "string":
        return "path" if schema.get("format") == "path" else "text"
    return {"number": "number", "integer": "whole number", "boolean": "`true` or `false`"}[kind] + bounds(schema)

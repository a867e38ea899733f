"""Writes docs/settings.md: every table of a scene with its keys, in the words of the doc comments. Called by generate.py."""

import re

INTRODUCTION = """# Settings

Every setting of a scene, by the tables of its file, in the order in which files have them; all tables and nearly all keys may be left out. A setting is
given in the scene (TOML), under its table, or on the command line as `--set KEY=VALUE`, as often as wanted, with the whole key and the value in
TOML; an entry of a list of tables is counted from 0:

    nabiki simulate scene.toml -o m.nabiki --set motion.time_step=0.05 --set 'force.0.vector=[0,-100,0]' --set 'picture.hair.colour="red"'

`nabiki info scene.toml` says what a scene holds. Head space is in cm, y up, the face along +x, the character's right hand along +z. Paths are relative to
the scene file. Several numbers stand in brackets, text and paths in quotes. This page is written by
`python3 crates/nabiki_py/generate.py` from the doc comments of the Rust structs: change the words there.
"""
# What a number, a list or a text is called.
VALUES = {
    "bool": "`true` or `false`",
    "String": "text",
    "PathBuf": "path",
    "Vec3": "3 numbers",
    "Vec2": "2 numbers",
    "Axis": '`"+x"`, `"-x"`, `"+y"`, `"-y"`, `"+z"` or `"-z"`',
}
# Tables whose parts exclude each other; those of other tables that are made of several are one list.
PARTED = ["head", "hair"]
# Types that read themselves, by the enum that says what they expect.
READ_BY = {"Unit": "UnitText"}
# Defaults that no doc comment and no literal says.
DEFAULTS = {"ImportedHead.mesh": '`"builtin:bust"`, the built-in bust'}
# Keys that are asked for though their structs can do without them.
ASKED = ["BodySettings.mesh", "MotionSource.file"]
NOT_THERE = "Not there unless it is given."


class Source:
    """What the Rust sources say beside the structs: words of enums with their docs, what types expect, defaults."""

    def __init__(self, files, docs):
        self.expected, self.words, self.defaults = {}, {}, {}
        for text in files:
            for found in re.finditer(r'expecting = "((?:[^"\\]|\\.)*)"[^]]*\)\]\n(?:pub )?(?:enum|struct) (\w+)', text):
                wanted = found[1].replace('\\"', '"').removeprefix("must be ")
                self.expected[found[2]] = re.sub(r'("[\w ]+"|\{.*?\}(?= or |$))', r"`\1`", wanted)
            for found in re.finditer(r"pub(?:\([^)]*\))? enum (\w+) \{\n(.*?)\n\}", text, re.S):
                variants = r"((?:    ///.*\n)+)((?:    #\[.*\]\n)*)    (\w+)"
                self.words[found[1]] = [
                    (variant[3], docs(variant[1]), "#[default]" in variant[2])
                    for variant in re.finditer(variants, found[2] + "\n")
                ]
            for found in re.finditer(r"impl Default for (\w+) \{\n    fn default\(\) -> Self \{(.*?)\n    \}\n", text, re.S):
                values = found[2].rpartition("Self {")[2].rpartition("}")[0]
                parts = re.findall(r"(\w+): ((?:[^,(]|\([^)]*\))+)", values)
                self.defaults |= {f"{found[1]}.{name}": value.strip() for name, value in parts}

    def default(self, place, words_of):
        """The default of a key in TOML, where it is a literal."""
        value = self.defaults.get(place, "")
        if re.fullmatch(r"-?[\d_]+(\.\d+)?|true|false", value):
            return value.replace("_", "").removesuffix(".0")
        if found := re.fullmatch(r"Vec\d::new\((.*)\)", value):
            return f"`[{re.sub(r'[.]0(?=,|$)', '', found[1])}]`"
        if re.fullmatch(r"Vec\d::ZERO", value):
            return f"`[{', '.join('0' * int(value[3]))}]`"
        if found := re.fullmatch(r'"(.+)"\.to_owned\(\)', value):
            return f'`"{found[1]}"`'
        if found := re.fullmatch(r"(\w+)::(\w+)(\(\))?", value):
            for (name, _, first), word in zip(self.words.get(found[1], []), words_of(found[1]), strict=False):
                if name == found[2] or (found[3] and first):
                    return f'`"{word}"`'
        return None


class Page:
    def __init__(self, structs, enums, explained, source):
        self.structs, self.enums, self.explained, self.source = structs, enums, explained, source
        self.homes = {}
        self.sections = []

    def words(self, name):
        """The words of an enum in a file."""
        if self.enums.get(name):
            return self.enums[name]
        return [variant.lower() for variant, _, _ in self.source.words.get(name, [])]

    def section(self, key, doc, parts, many=False):
        """The section of one table, then those of the tables in it."""
        brackets = f"[[{key}]]" if many else f"[{key}]"
        place = len(self.sections)
        self.sections.append("")
        text = [f"{'#' * min(key.count('.') + 2, 4)} `{brackets}`"]
        if doc:
            text += ["", doc]
        rows, seen = [], set()
        for part in parts:
            struct = self.structs[part]
            if rows and key in PARTED:
                text += ["", *rows]
                rows = []
                seen = set()
            if not rows:
                lead = [struct.doc, ""] if key in PARTED and struct.doc else []
                rows = [*lead, "| key | value | what it is |", "|---|---|---|"]
            for entry in struct.fields:
                if entry.name not in seen:
                    rows.append(self.row(key, part, entry))
                seen.add(entry.name)
        self.sections[place] = "\n".join([*text, "", *rows]) + "\n"

    def row(self, key, part, entry):
        place = f"{part}.{entry.name}"
        doc = entry.doc
        if place in self.explained:
            struct, name = self.explained[place].split(".")
            doc = next(field.doc for field in self.structs[struct].fields if field.name == name)
        about = [told(doc)]
        inner = re.sub(r"Option<|Vec<|>", "", entry.type)
        words = self.source.words.get(inner, [])
        if self.enums.get(inner) and inner != "Axis":
            about += [f'`"{word}"`: {said}' for word, (_, said, _) in zip(self.words(inner), words, strict=True)]
        else:
            about += [said for _, said, _ in words if said.startswith(f"`{entry.name} = {{")]
        default = DEFAULTS.get(place) or self.source.default(place, self.words)
        if "efault" not in " ".join(about) and default:
            about.append(f"Default {default}.")
        if place in ASKED or entry.must and not entry.type.startswith("Option<"):
            about.append("Must be given.")
        about = [part if part.endswith((".", ":")) or not part else part + "." for part in about]
        return f"| `{entry.name}` | {cell(self.value(key, entry))} | {cell(' '.join(about))} |"

    def value(self, key, entry):
        """What may be given; the section of a table."""
        rust, many = entry.type, False
        if found := re.fullmatch(r"Option<(.*)>", rust):
            rust = found[1]
        if found := re.fullmatch(r"Vec<(.*)>", rust):
            rust, many = found[1], True
        number = {"f": "number", "u": "whole number", "i": "whole number"}
        if found := re.fullmatch(r"([fui])(8|16|32|64|size)", rust):
            return number[found[1]] + "s" * many
        if found := re.fullmatch(r"\[([fui])\d+; (\d)\]", rust):
            return f"{found[2]} {number[found[1]]}s"
        if rust in VALUES:
            return VALUES[rust] + "s" * many
        if expected := self.source.expected.get(READ_BY.get(rust, rust)):
            return expected
        if self.enums.get(rust):
            return " or ".join(", ".join(f'`"{word}"`' for word in self.enums[rust]).rsplit(", ", 1))
        if rust not in self.structs:
            raise SystemExit(f"{key}.{entry.name}: what is a {rust} in a file?")
        kind = "tables" if many else "table"
        if rust in self.homes:
            home = self.homes[rust]
            return f"{kind}, keys as in [`{home}`](#{anchor(home)})"
        own = f"{key}.{entry.name}"
        self.homes[rust] = f"[[{own}]]" if many else f"[{own}]"
        self.section(own, told(self.structs[rust].doc), [rust], many)
        return f"[{kind}](#{anchor(own)})"


def told(doc):
    """The words of a doc comment without the key that it is about, and with formulas as Markdown has them."""
    rest = re.sub(r"^`\[*[\w.]+\]*`(: |\.?$|\. )", "", doc)
    rest = re.sub(r"\s*Scene key: `[\w.]+`\.| ?Key: `\w+`\.", "", rest)
    rest = re.sub(r"```text\s*(.*?)\s*```", r"`\1`", rest)
    return rest if rest[:1] == doc[:1] else rest[:1].upper() + rest[1:]


def anchor(key):
    """What a heading of this key is called by GitHub."""
    return re.sub(r"[^\w-]", "", key.lower())


def cell(text):
    """Text in a cell of a table."""
    return text.replace("\n\n", " ").replace("|", "\\|")


def page(structs, enums, shared, explained, source):
    """The text of the page."""
    result = Page(structs, enums, explained, source)
    scene = {field.name: field.doc for field in structs["Scene"].fields + structs["FieldSettings"].fields}
    scene["body"] = scene["bodies"]
    for entry in structs["Tables"].fields:
        inner = re.sub(r"Option<|Vec<|>", "", entry.type)
        name, parts = shared.get(entry.name, (inner, [inner]))
        doc = told(structs[name].doc)
        if not doc:
            doc = told(re.sub(r"\s*`\[+[\w.]+\]+`:?\s*", " ", scene[entry.name]).strip())
        if entry.type.startswith("Option<"):
            doc += f" {NOT_THERE}"
        many = entry.type.startswith("Vec<")
        result.section(entry.name, doc, parts, many)
    return INTRODUCTION + "\n" + "\n".join(result.sections)

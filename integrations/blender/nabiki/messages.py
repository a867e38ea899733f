# SPDX-License-Identifier: GPL-3.0-or-later
"""What a person is told: one line each, in the words of the panels."""

import re

# Settings of nabiki by their keys, and what they are called in the panels.
LABELS = {
    "motion.inertia_length_floor": "Settings > Short Hair",
    "motion.time_step": "Settings > Speed",
    "free.gravity": "Settings > Weight",
    "contact.margin": "Collisions > Margin",
    "contact.friction": "Collisions > Friction",
    "contact.static_friction": "Collisions > Static Friction",
    "head.mesh": "Head",
    "hair.file": "Hair",
    "hair.unit": "Scene Properties > Units > Unit Scale",
    "head.unit": "Scene Properties > Units > Unit Scale",
    "head.origin": "the position of the head",
    "hair.origin": "the position of the hair",
    "motion.frames": "the frame range",
}


class Mistake(Exception):
    """Something that a person can put right. Its text is one line."""


class Cancelled(Exception):
    """Somebody pressed Esc."""


def one_line(text):
    return " ".join(str(text).split())


def sentence(text):
    """A line as Blender shows it, with a capital first."""
    line = one_line(text)
    return line[:1].upper() + line[1:]


def in_words(text, names):
    """A line of nabiki's with the names of Blender's things. `names`: what files and entries of the scene are called."""
    text = one_line(text)
    unstable = re.match(r"(\S+) = .*?unstable.*?keep (?:\|F\||gravity) below ([\d.e+]+)", text)
    if unstable:
        text = f"{unstable[1]}: is too strong for this hair: keep it below {float(unstable[2]):.4g}, lower motion.time_step, or raise "
        text += "motion.inertia_length_floor"
    for name in sorted(names, key=len, reverse=True):
        # An entry of a list is meant, whichever of its settings is named.
        pattern = rf'"?{re.escape(name)}"?' if "/" in name or "\\" in name else rf"(?<![\w.]){re.escape(name)}(\.\w+)*"
        text = re.sub(pattern, names[name].replace("\\", r"\\"), text)
    text = re.sub(r"\bwish\[(\d+)\](\.\w+)?", lambda found: f"moved strand {int(found[1]) + 1}", text)
    for key, label in LABELS.items():
        text = re.sub(rf"(?<![\w.]){re.escape(key)}(?![\w.])", label, text)
    # A head is its mesh, and named once.
    return re.sub(r'^(?:Head = )?(the \w+ ".*?") = ', r"\1: ", re.sub(r"^Head = (?=the head)", "", text))

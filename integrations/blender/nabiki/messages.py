"""What a person is told: one line each, in the words of the panels."""

import re

# Settings of nabiki by their keys, and what they are called in the panels.
LABELS = {
    "motion.inertia_length_floor": "Settings > Short Hair Moves As",
    "motion.time_step": "Settings > Speed",
    "free.stiffness": "Settings > Stiffness",
    "free.gravity": "Settings > Weight",
    "contact.margin": "Collisions > Margin",
    "contact.friction": "Collisions > Friction",
    "contact.static_friction": "Collisions > Static Friction",
    "head.mesh": "Head",
    "hair.file": "Hair",
    "hair.unit": "Scene Properties > Units > Unit Scale",
    "head.unit": "Scene Properties > Units > Unit Scale",
    "head.origin": "the place of the head",
    "hair.origin": "the place of the hair",
    "motion.frames": "the frame range",
}


class Mistake(Exception):
    """Something that a person can put right. Its text is one line."""


class Cancelled(Exception):
    """Somebody pressed Esc."""


def one_line(text):
    return " ".join(str(text).split())


def in_words(text, names):
    """A line of nabiki's with the names of Blender's things. `names`: what the files of the scene hold, by their paths."""
    text = one_line(text)
    for path in sorted(names, key=len, reverse=True):
        text = text.replace(f'"{path}"', names[path]).replace(path, names[path])
    text = re.sub(r"\bforce\[(\d+)\](\.\w+)?", lambda found: f"Wind > Interval {int(found[1]) + 1}", text)
    text = re.sub(r"\bwish\[(\d+)\](\.\w+)?", lambda found: f"moved strand {int(found[1]) + 1}", text)
    for key, label in LABELS.items():
        text = re.sub(rf"(?<![\w.]){re.escape(key)}(?![\w.])", label, text)
    return text

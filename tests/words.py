#!/usr/bin/env python3
"""Measures how long the sentences of the documents are: `python3 tests/words.py [FILE ...]`.

Prints the words per sentence and the share of sentences over 30 words of each Markdown file, and fails where a file passes
either limit. Code, tables, headings, pictures and comments are left out; each list item is a paragraph of its own. It is a
floor, not the goal: short sentences can still be bad ones.
"""

import re
import subprocess
import sys
from pathlib import Path

MEAN, LONG, SHARE = 17.0, 30, 0.05
# Whole sentences that end in one of these have not ended.
ABBREVIATIONS = ("e.g", "i.e", "cf", "vs", "etc", "Fig", "Figs", "eq", "al", "approx")


def paragraphs(text):
    """The prose of a Markdown text, one string a paragraph or list item."""
    text = re.sub(r"<!--.*?-->", "", text, flags=re.S)
    text = re.sub(r"^(```|~~~).*?^\1", "", text, flags=re.S | re.M)
    held, blank, listed = [], True, False
    for line in text.splitlines() + [""]:
        bare = line.strip()
        item = re.match(r"\s*([-*+]|\d+[.)])\s+", line)
        code = line.startswith("    ") and blank and not (listed and item)
        if not bare or code or bare.startswith(("|", "#", "![", "<")) or item:
            if held:
                yield " ".join(held)
            held = []
        if code:
            continue
        blank = not bare
        listed = bool(item) or listed and (blank or line.startswith(" "))
        if bare and not bare.startswith(("|", "#", "![", "<", "---")):
            held.append(line[item.end():].strip() if item else bare)


def sentences(paragraph):
    """The number of words of each sentence of a paragraph."""
    plain = re.sub(r"`[^`]*`", "code", paragraph)
    plain = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", plain)
    plain = re.sub(rf"\b({'|'.join(ABBREVIATIONS)})\.", r"\1", plain)
    for sentence in re.split(r"(?<=[.!?])[\"')*_]*\s+|:\s*$", plain):
        if words := len(re.findall(r"\w[\w'’.,/-]*", sentence)):
            yield words


def measured(path):
    """Words per sentence of a file, and its share of long sentences."""
    lengths = [n for paragraph in paragraphs(path.read_text(encoding="utf-8")) for n in sentences(paragraph)]
    count = max(len(lengths), 1)
    return sum(lengths) / count, sum(n > LONG for n in lengths) / count


def main():
    files = sys.argv[1:] or subprocess.run(["git", "ls-files", "*.md"], check=True, capture_output=True, text=True).stdout.split()
    too_long = False
    for path in map(Path, files):
        mean, share = measured(path)
        over = mean > MEAN or share > SHARE
        too_long |= over
        print(f"{mean:5.1f} words, {share:4.0%} over {LONG}  {path}{'  TOO LONG' if over else ''}")
    sys.exit(too_long)


if __name__ == "__main__":
    main()

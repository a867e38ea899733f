# SPDX-License-Identifier: GPL-3.0-or-later
"""Nabiki: hair that goes where you want it in the wind."""

from . import jobs, operators, panels, playing, properties

PARTS = [properties, jobs, operators, panels, playing]


def register():
    for part in PARTS:
        part.register()


def unregister():
    for part in reversed(PARTS):
        part.unregister()

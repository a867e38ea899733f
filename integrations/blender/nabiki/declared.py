# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings as the scene declares them. Written by crates/nabiki_py/generate.py."""

SETTINGS = {
    "gust.intensity": {
        "name": 'Intensity',
        "description": 'How much the wind changes: 0.15 as in open country, 0.4 as in a town',
        "default": 0.3,
        "min": 0.0,
    },
    "gust.time_scale": {
        "name": 'Time Scale',
        "description": 'How long a gust takes',
        "default": 2.0,
        "min": 0.0,
    },
    "gust.seed": {
        "name": 'Seed',
        "description": 'Seed of the phases: another number, other gusts',
        "default": 1,
        "min": 0,
    },
    "flow.thickness": {
        "name": 'Thickness (cm)',
        "description": 'How far the hair on the head stands out from the head ellipsoid: the wind goes round that, too',
        "default": 0.0,
        "min": 0.0,
        "max": 100.0,
    },
    "body_wind.drag": {
        "name": 'Drag',
        "description": 'Force for each cm/s of the head, against its way',
        "default": 0.3,
        "min": 0.0,
    },
    "wind.ease": {
        "name": 'Ease',
        "description": 'How one vector follows another',
        "default": 'stepped',
    },
    "free.stiffness": {
        "name": 'Stiffness',
        "description": 'How firmly hair keeps its shape: at 36 times the wind, hair of 18 cm bends within about 6 cm',
        "default": [12000.0, 1000.0],
        "min": 0.0,
        "max": 1000000000.0,
    },
    "free.hold": {
        "name": 'Hold',
        "description": 'How firmly hair keeps its place on the head, as with hair spray',
        "default": 30.0,
        "min": 0.0,
        "max": 1000000000.0,
    },
    "free.settle": {
        "name": 'Settle',
        "description": 'Frames in which a swing falls to 1/e: 7 is wet hair, 20 swings over once, 60 goes on waving, 0 has no air',
        "default": 20.0,
        "min": 0.0,
    },
    "free.gravity": {
        "name": 'Weight',
        "description": 'How fast moved hair falls',
        "default": 100.0,
        "min": 0.0,
        "max": 1000000000.0,
    },
    "free.drag": {
        "name": 'Drag',
        "description": 'How far a head that moves leaves hair behind: 0 rides along, 1 is as in life, more exaggerates',
        "default": 1.0,
        "min": 0.0,
        "max": 10.0,
    },
    "free.substeps": {
        "name": 'Substeps',
        "description": 'Steps that a frame is divided into',
        "min": 1,
        "max": 32,
    },
    "motion.slow": {
        "name": 'Slow Motion',
        "description": 'Slow motion of the hair: 4 is hair filmed at four times the frame rate',
        "default": 1.0,
        "min": 0.1,
        "max": 100.0,
    },
    "motion.inertia_length_floor": {
        "name": 'Shortest Inertia (cm)',
        "description": 'Hair shorter than this has the inertia of hair this long: its longer neighbours hold it',
        "default": 0.0,
        "min": 0.0,
    },
    "contact.margin": {
        "name": 'Margin (cm)',
        "description": 'How far from the skin nodes are kept',
        "default": 0.1,
        "min": 0.0,
        "max": 5.0,
    },
    "contact.friction": {
        "name": 'Friction',
        "description": 'The part of a push that sliding hair loses of its speed along the skin (Coulomb)',
        "default": 0.1,
        "min": 0.0,
        "max": 10.0,
    },
    "contact.static_friction": {
        "name": 'Static Friction',
        "description": 'The same for hair that does not slide, at least `friction`: it stays as long as what would move it is below this part of the push',
        "default": 0.15,
        "min": 0.0,
        "max": 10.0,
    },
    "neighbours.pressure": {
        "name": 'Pressure',
        "description": 'How firmly hair keeps its volume: pushes it out of places fuller than at rest',
        "default": 40.0,
        "min": 0.0,
    },
    "neighbours.cohesion": {
        "name": 'Cohesion',
        "description": 'How firmly strands drag their neighbours along: pulls a node toward the mean velocity about it, in the unit of F for each cm a frame',
        "default": 40.0,
        "min": 0.0,
    },
}

EASE = [
    ('stepped', 'Stepped', "Each vector holds through its interval: the paper's way"),
    ('linear', 'Linear', 'Each is reached in the middle of its interval, on straight lines: e(t) = t'),
    ('smooth', 'Smooth', 'Each is reached in the middle of its interval, and set out for and arrived at gently: e(t) = 3 t^2 - 2 t^3'),
]

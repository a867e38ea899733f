# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings as the scene declares them. Written by crates/nabiki_py/generate.py."""

SETTINGS = {
    "gust.intensity": {
        "name": 'Intensity',
        "description": 'How much the wind changes: 0.15 for open country, 0.4 for a town',
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
        "description": 'Random seed of the gusts',
        "default": 1,
        "min": 0,
    },
    "flow.thickness": {
        "name": 'Thickness (cm)',
        "description": 'Thickness of the hair on the head ellipsoid: the wind flows around this layer too',
        "default": 0.0,
        "min": 0.0,
        "max": 100.0,
    },
    "body_wind.drag": {
        "name": 'Drag',
        "description": "Force per cm/s of the head's speed, opposite to its direction",
        "default": 0.3,
        "min": 0.0,
    },
    "wind.ease": {
        "name": 'Ease',
        "description": 'How the wind changes from one vector to the next',
        "default": 'stepped',
    },
    "free.stiffness": {
        "name": 'Stiffness',
        "description": 'How firmly hair keeps its shape: at 36 times the strength of the wind, hair of 18 cm bends over about 6 cm',
        "default": [12000.0, 1000.0],
        "min": 0.0,
        "max": 1000000000.0,
    },
    "free.hold": {
        "name": 'Hold',
        "description": 'How firmly hair returns to its groomed place on the head, like hair spray',
        "default": 30.0,
        "min": 0.0,
        "max": 1000000000.0,
    },
    "free.settle": {
        "name": 'Settle',
        "description": 'Number of frames in which a swing falls to 1/e: 7 looks like wet hair, 20 swings over once, 60 keeps waving, 0 removes the air',
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
        "description": 'How far a moving head leaves the hair behind: 0 moves hair with the head, 1 is realistic, more exaggerates',
        "default": 1.0,
        "min": 0.0,
        "max": 10.0,
    },
    "free.substeps": {
        "name": 'Substeps',
        "description": 'Number of steps per frame',
        "min": 1,
        "max": 32,
    },
    "motion.slow": {
        "name": 'Slow Motion',
        "description": 'Slow motion of the hair: 4 shows hair as if filmed at four times the frame rate',
        "default": 1.0,
        "min": 0.1,
        "max": 100.0,
    },
    "motion.inertia_length_floor": {
        "name": 'Inertia Floor (cm)',
        "description": 'Hair shorter than this gets the inertia of hair this long, as if longer neighbours held it',
        "default": 0.0,
        "min": 0.0,
    },
    "contact.margin": {
        "name": 'Margin (cm)',
        "description": 'Distance that nodes keep from the skin',
        "default": 0.1,
        "min": 0.0,
        "max": 5.0,
    },
    "contact.friction": {
        "name": 'Friction',
        "description": 'Friction of sliding hair: the share of the push that it loses as speed along the skin (Coulomb)',
        "default": 0.1,
        "min": 0.0,
        "max": 10.0,
    },
    "contact.static_friction": {
        "name": 'Static Friction',
        "description": 'Friction of hair that does not slide, at least `friction`',
        "default": 0.15,
        "min": 0.0,
        "max": 10.0,
    },
    "neighbours.pressure": {
        "name": 'Pressure',
        "description": 'How firmly hair keeps its volume: it pushes hair out of places that are fuller than at rest',
        "default": 40.0,
        "min": 0.0,
    },
    "neighbours.cohesion": {
        "name": 'Cohesion',
        "description": 'How firmly strands drag their neighbours along: raise it if neighbours drift apart',
        "default": 40.0,
        "min": 0.0,
    },
}

EASE = [
    ('stepped', 'Stepped', 'Each vector applies throughout its interval, as in the paper'),
    ('linear', 'Linear', 'Straight lines between the middles of the intervals: e(t) = t'),
    ('smooth', 'Smooth', 'Smooth curves between the middles of the intervals: e(t) = 3 t^2 - 2 t^3'),
]

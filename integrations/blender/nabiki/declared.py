"""Settings as the scene declares them. Written by crates/nabiki_py/generate.py."""

SETTINGS = {
    "gust.intensity": {
        "name": 'Intensity',
        "description": 'Root mean square of the factor about 1',
        "default": 0.3,
        "min": 0.0,
    },
    "gust.time_scale": {
        "name": 'Time Scale',
        "description": 'T: the length scale of the turbulence over the mean speed of the wind',
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
        "description": 'How far what the wind goes round stands out from the head ellipsoid, as hair itself does',
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
        "description": 'From one vector to the next',
        "default": 'stepped',
    },
    "free.stiffness": {
        "name": 'Stiffness',
        "description": 'K: the moment with which a joint turns its two segments toward their rest shape, each as much as the other',
        "default": [12000.0, 1000.0],
        "min": 0.0,
    },
    "free.hold": {
        "name": 'Hold',
        "description": "H: what turns a segment toward its rest direction in the head's frame, as hair spray does",
        "default": 30.0,
        "min": 0.0,
    },
    "free.settle": {
        "name": 'Settle',
        "description": 'Frames in which a small swing dies to 1/e; 0: never',
        "default": 20.0,
        "min": 0.0,
    },
    "free.gravity": {
        "name": 'Weight',
        "description": 'The weight of hair that has been moved: a strength, or "earth" for that of the earth at `motion.frame_rate`',
        "default": 100.0,
        "min": 0.0,
    },
    "free.lag": {
        "name": 'Lag',
        "description": 'How far tips stay behind a head that turns; 0: not at all',
        "default": 1.0,
        "min": 0.0,
        "max": 8.0,
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
        "description": 'What pushes hair out of places fuller than at rest',
        "default": 40.0,
        "min": 0.0,
    },
    "neighbours.cohesion": {
        "name": 'Cohesion',
        "description": 'What pulls a node toward the mean velocity about it, so that hair takes the hair beside it along',
        "default": 40.0,
        "min": 0.0,
    },
}

EASE = [
    ('stepped', 'Stepped', "Each vector holds through its interval: the paper's way"),
    ('linear', 'Linear', 'e(t) = t: each is reached in the middle of its interval, on straight lines'),
    ('smooth', 'Smooth', 'e(t) = 3 t^2 - 2 t^3: it sets out and arrives gently'),
]

"""Hair in the wind: scenes, their motion as NumPy arrays, pictures, files for other programs.

    import nabiki

    scene = nabiki.Scene.open("scenes/gust.toml")
    scene.forces = [(50, (-100, 0, 0)), (100, (-15, -150, 0))]
    for frame in scene.simulate(strands=300):
        frame.points  # (P, 3) float32, no copy
"""

from ._error import Error
from ._nabiki import Field, Frame, Simulation, Solution, __version__, convert, info, new, write_hair
from ._scene import Scene
from ._timeline import Timeline

__all__ = [
    "Error",
    "Field",
    "Frame",
    "Scene",
    "Simulation",
    "Solution",
    "Timeline",
    "__version__",
    "convert",
    "info",
    "new",
    "write_hair",
]

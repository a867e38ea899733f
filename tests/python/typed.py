"""What a user writes, as mypy sees it; it is not run."""

from collections.abc import Iterator

import numpy
import numpy.typing

import nabiki


def wind(points: numpy.typing.NDArray[numpy.float32], frame: int) -> numpy.typing.NDArray[numpy.float32]:
    return numpy.zeros_like(points)


def tips(scene: nabiki.Scene) -> Iterator[numpy.typing.NDArray[numpy.float32]]:
    scene.motion.frames = 20
    scene.motion.form = "free"
    scene.free.stiffness = [2000, 200]
    scene.forces = [(50, (-100, 0, 0)), (100, numpy.array([-15, -150, 0]))]
    scene.gust = {"intensity": 0.3}
    scene.gust.seed = 2
    scene.fan.append({"position": (40, 0, 0), "direction": (-1, 0, 0)})
    scene.fan[0].falloff.law = "smooth"
    scene.fields = [nabiki.Field(wind, strongest=10)]
    for frame in scene.simulate(strands=300):
        yield frame.points[frame.offsets[1:] - 1]


def answer(scene: nabiki.Scene) -> list[tuple[int, tuple[float, float, float]]]:
    found = scene.solve([{"frame": 20, "strands": [3], "mean_moved": (-6, 0, 0)}])
    found.scene.picture.size = (320, 180)
    picture: bytes = found.scene.render_png(20, progress=lambda done, total: None)
    assert picture
    return found.forces


def game(scene: nabiki.Scene, head: numpy.typing.NDArray[numpy.float64]) -> bytes:
    hair = scene.simulate(strands=300)
    start: bytes = hair.state()
    scene.head.motion = numpy.stack([head] * 101)
    scene.body[1].motion = {"file": [head] * 101, "frames_per_second": 30}
    hair.step(head=head, bodies=[None, head], force=(-100, 0, 0))
    hair.step(head=((0, 10, 0), (0, 0, 0, 1)), force=nabiki.Field(wind, strongest=10), jumped=True)
    branch = hair.copy()
    light: bytes = scene.render_exr(0, file="light.exr", strands=300)
    assert light
    frame: nabiki.Frame = hair.restore(start)
    assert frame.number == 0 and hair.strongest_force > 100
    return branch.state()


def refused(scene: nabiki.Scene) -> str | None:
    scene.motion.frames = "many"  # type: ignore[assignment]
    scene.motion.form = "fluid"  # type: ignore[assignment]
    try:
        scene.save("scene.toml")
    except nabiki.Error as error:
        return error.way_out
    return None

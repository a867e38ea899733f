"""What a user writes, as mypy sees it; it is not run.

Lines that must be errors are marked as ignored, each with its code: mypy --strict takes a mark without an error for one.
"""

from collections.abc import Iterator, Sequence

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
    hair.step(skin=numpy.zeros((8, 3)))
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


def sequences(scene: nabiki.Scene) -> Sequence[nabiki.Frame]:
    timeline: nabiki.Timeline = scene.timeline(strands=300)
    last: nabiki.Frame = timeline[-1]
    some: list[nabiki.Frame] = timeline[10:20]
    numbers: list[int] = [frame.number for frame in timeline] + [frame.number for frame in scene.simulate()]
    backward: list[nabiki.Frame] = list(reversed(timeline))
    for place, frame in enumerate(timeline):
        assert frame.number == place < len(timeline) and len(numbers) == len(backward)
    film: numpy.typing.NDArray[numpy.float32] = timeline.play()
    assert film.shape[0] == len(timeline) and last.number == len(some)
    through: int = scene.force[0].through
    strengths: list[float] = [fan.strength for fan in scene.fan[1:]]
    forces: list[tuple[int, tuple[float, float, float]] | tuple[int, tuple[float, float, float], str]] = scene.forces[1:]
    scene.forces[0] = (4, numpy.array([7, 0, 0]))
    scene.forces.append((through, [1, 0, 0]))
    scene.forces += [(12, (0, 0, 3))]
    scene.fan[0] = {"position": (40, 0, 0), "direction": (-1, 0, 0)}
    scene.fan[1:] = [scene.fan[0], {"position": (0, 0, 0), "direction": (1, 0, 0)}]
    assert strengths and forces
    return timeline


def made() -> nabiki.Scene:
    scene = nabiki.Scene(
        head=(numpy.zeros((8, 3)), numpy.zeros((12, 3), int)),
        hair="groom.usdc",
        forces=[(100, (-50, 0, 0))],
        motion={"form": "free"},
        fan=[{"position": (40, 0, 0), "direction": (-1, 0, 0)}],
    )
    return scene if scene == scene.copy() else nabiki.Scene()


def missing() -> str | None:
    try:
        nabiki.Scene.open("none.toml")
    except nabiki.Error as error:
        if isinstance(error, FileNotFoundError):
            return str(error.filename)
        return error.file
    except FileNotFoundError as error:
        return str(error.filename)
    return None


def errors(scene: nabiki.Scene) -> None:
    """Each of these is one to mypy."""
    scene.motionz  # type: ignore[attr-defined]
    scene.motionz = {}  # type: ignore[attr-defined]
    scene.frames = 5  # type: ignore[attr-defined]
    scene.simulat()  # type: ignore[attr-defined]
    scene.motion.framez  # type: ignore[attr-defined]
    scene.motion.framez = 5  # type: ignore[attr-defined]
    scene.gust.sead = 2  # type: ignore[attr-defined]
    scene.hair.style.length.topp = 3  # type: ignore[attr-defined]
    scene.fan[0].strenght = 3  # type: ignore[attr-defined]
    scene.force[0].vektor  # type: ignore[attr-defined]
    scene.motion.to_dic()  # type: ignore[attr-defined]
    nabiki.open("gust.toml")  # type: ignore[attr-defined]
    nabiki.Scene.load("gust.toml")  # type: ignore[attr-defined]
    nabiki.Scene(motionz={})  # type: ignore[call-arg]
    nabiki.Scene(motion=5)  # type: ignore[arg-type]
    scene.simulate(strands="many")  # type: ignore[arg-type]
    scene.simulate(strand=300)  # type: ignore[call-arg]
    scene.timeline(300.5)  # type: ignore[arg-type]
    scene.timeline()["1"]  # type: ignore[call-overload]
    scene.timeline().pointz  # type: ignore[attr-defined]
    scene.timeline()[0:2].points  # type: ignore[attr-defined]
    scene.timeline()[0].point  # type: ignore[attr-defined]
    scene.simulate().steps()  # type: ignore[attr-defined]
    scene.simulate()[0]  # type: ignore[index]
    scene.simulate().step(skin=None, skins=[])  # type: ignore[call-arg]
    scene.forces[0].through  # type: ignore[union-attr]
    scene.forces = [(5, 1, 2, 3)]  # type: ignore[list-item]
    scene.forces.append(5)  # type: ignore[arg-type]
    scene.fan.append(5)  # type: ignore[arg-type]
    scene.fields = [wind]  # type: ignore[list-item]
    nabiki.Field(5, strongest=1)  # type: ignore[arg-type]
    scene.solve([]).force  # type: ignore[attr-defined]
    scene.render_png(0, file=5)  # type: ignore[arg-type]
    scene.file = "other.toml"  # type: ignore[misc]

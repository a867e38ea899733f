"""Skin that a program bends from step to step: the head's vertices are told, and roots ride on them."""

import numpy
import pytest
from conftest import ROOT, bits
from test_arrays import hair, sphere
from test_live import HEAD

import nabiki

FRAMES = 8
# A power of two: then the times of frames are exact, and no frame of a file lies between two samples.
RATE = 32


def bent(n, points=None):
    """The head's vertices in a frame: one side swells."""
    points = sphere(10.0)[0] if points is None else points
    return numpy.float32(points * (1 + 0.02 * n * numpy.maximum(points[:, 2:], 0) / 10))


def layer(path):
    """The head as a mesh of USD whose points move."""

    def numbers(points):
        return ", ".join(f"({x!r}, {y!r}, {z!r})" for x, y, z in numpy.float64(points).tolist())

    _, faces = sphere(10.0)
    samples = ", ".join(f"{n}: [{numbers(bent(n))}]" for n in range(FRAMES + 1))
    path.write_text(
        f'#usda 1.0\n( metersPerUnit = 0.01\n upAxis = "Y"\n startTimeCode = 0\n endTimeCode = {FRAMES}\n'
        f" timeCodesPerSecond = {RATE}\n framesPerSecond = {RATE} )\n"
        f'def Mesh "face" {{ point3f[] points.timeSamples = {{ {samples} }}\n'
        f" int[] faceVertexCounts = [{', '.join(['3'] * len(faces))}]\n"
        f" int[] faceVertexIndices = [{', '.join(map(str, faces.ravel().tolist()))}] }}\n"
    )
    return path


def scene(form, strands=None, **head):
    head = {"mesh": sphere(10.0), "ellipsoid": {"center": (0, 0, 0), "half_axes": (10, 10, 10)}, "origin": (0, 0, 0)} | head
    return nabiki.Scene(
        motion={"form": form, "frames": FRAMES, "frame_rate": RATE, "inertia_length_floor": 18},
        head=head,
        hair=hair(10.0) if strands is None else strands,
        forces=[(FRAMES, (-40, 5, 10))],
    )


def of_file(form, folder):
    file = layer(folder / "face.usda")
    return scene(form, mesh=file, motion={"file": file, "node": "/face", "facing": "+x", "bind_at_start": True})


def film(frames):
    return bits([frame.points for frame in frames])


@pytest.mark.parametrize("form", ["free", "paper"])
def test_shapes_that_are_told_move_hair_as_those_of_a_file_to_the_bit(form, tmp_path):
    moved = of_file(form, tmp_path)
    frames = list(moved.simulate())
    assert all(numpy.array_equal(frame.head_pose, numpy.eye(4)) for frame in frames), "only the skin moves"
    wanted = film(frames)
    told, some, still = moved.simulate(), moved.simulate(), moved.simulate()
    numbers = range(1, FRAMES + 1)
    assert numpy.array_equal(film(told.step(skin=bent(n)) for n in numbers), wanted[1:])
    # What is not told follows the scene.
    assert numpy.array_equal(film(some.step(skin=bent(n) if n % 3 == 2 else None) for n in numbers), wanted[1:])
    assert not numpy.array_equal(film(still.step(skin=bent(0)) for n in numbers), wanted[1:])

    # The head of the other scene does not bend by itself. Hair keeps out of it at rest, which only the free form feels.
    live = scene(form).simulate()
    assert numpy.array_equal(bits(next(live).points), wanted[0])
    found = film(live.step(skin=bent(n)) for n in numbers)
    roots = live.offsets[:-1]
    assert numpy.array_equal(found[:, roots], wanted[1:, roots])
    assert not numpy.array_equal(found[-1, roots], wanted[0, roots])
    if form == "paper":
        assert numpy.array_equal(found, wanted[1:])


@pytest.mark.parametrize("form", ["free", "paper"])
def test_a_skin_at_rest_changes_no_bit(form):
    """In metres, z up, looking along -y, as Blender has them."""

    def turned(points):
        return numpy.stack([-points[:, 2], -points[:, 0], points[:, 1]], axis=1) / 100

    (points, faces), (strands, offsets) = sphere(10.0), hair(10.0)
    points = numpy.float32(turned(points))
    still = scene(form, (turned(strands), offsets), mesh=(points, faces), unit="m", up="+z", facing="-y")
    plain = film(still.simulate())
    live = still.simulate()
    # It may begin in any frame.
    frames = [live.step(skin=points if n >= 3 else None) for n in range(1, FRAMES + 1)]
    assert numpy.array_equal(film(frames), plain[1:])
    lists = still.simulate()
    assert numpy.array_equal(film(lists.step(skin=points.tolist()) for _ in range(FRAMES)), plain[1:])


def test_vertices_are_those_of_the_mesh_seams_and_all():
    points, faces = sphere(10.0)
    torn = faces.copy()
    torn[:10] = len(points) + numpy.arange(30).reshape(10, 3)
    more = numpy.concatenate([points, points[faces[:10].ravel()]])
    whole, seams = scene("free").simulate(), scene("free", mesh=(more, torn)).simulate()
    for n in range(1, FRAMES + 1):
        frame, same = whole.step(skin=bent(n)), seams.step(skin=bent(n, more))
        assert numpy.array_equal(bits(frame.points), bits(same.points))


@pytest.mark.parametrize("form", ["free", "paper"])
def test_a_state_keeps_the_skin(form):
    still = scene(form)
    plain = still.simulate()
    for n in range(1, 4):
        plain.step(head=HEAD[n])
    before = plain.state()
    without = film([plain.step(head=HEAD[4]), plain.step(head=HEAD[5])])

    live = still.simulate()
    live.restore(before)
    last = [live.step(head=HEAD[n], skin=bent(n)) for n in (4, 5)][-1]
    state, branch = live.state(), live.copy()

    def goes_on(hair):
        return film([hair.step(head=HEAD[6], skin=bent(6)), hair.step(head=HEAD[7]), hair.step(skin=bent(8))])

    wanted = goes_on(live)
    fresh, rides = scene(form).simulate(), still.simulate()
    rides.step(skin=bent(3))
    for again in (live, fresh, rides):
        back = again.restore(state)
        assert back.number == 5 and numpy.array_equal(bits(back.points), bits(last.points))
    for again in (branch, live, fresh, rides):
        assert numpy.array_equal(goes_on(again), wanted)
    # A state from before the skin was told knows of none.
    live.restore(before)
    assert numpy.array_equal(film([live.step(head=HEAD[4]), live.step(head=HEAD[5])]), without)


def test_a_skin_may_jump():
    still = scene("free")
    flung, taken = still.simulate(), still.simulate()
    frame, along = flung.step(skin=bent(20)), taken.step(skin=bent(20), jumped=True)
    roots = flung.offsets[:-1]
    assert numpy.array_equal(bits(frame.points[roots]), bits(along.points[roots]))
    assert not numpy.array_equal(frame.points, along.points)


def test_what_is_no_skin_is_refused_and_nothing_has_happened():
    still = scene("free")
    live = still.simulate()
    live.step(skin=bent(1))
    state = live.state()
    broken, far = bent(1), bent(1) / 100
    broken[7, 1], far[7, 1] = numpy.nan, 3e38
    points, faces = sphere(10.0)
    a, b, c = faces[0]
    middle = len(points)
    more = numpy.concatenate([points, [points[[a, b, c]].mean(axis=0)]])
    other = scene("free", mesh=(more, numpy.concatenate([[(a, b, middle), (b, c, middle), (c, a, middle)], faces[1:]])))
    metres = scene("free", (hair(10.0)[0] / 100, hair(10.0)[1]), mesh=(points / 100, faces), unit="m")
    bust = nabiki.Scene(hair={"strands": 20}, motion={"form": "free", "frames": FRAMES}).simulate()
    cases = [
        (lambda: live.step(skin=bent(2)[1:]), "skin = 361 vertices: head.mesh has 362: give all of them, in its order"),
        (lambda: live.step(skin=bent(2)[:, :2]), "skin = an array of shape (362, 2): must have the shape (points, 3)"),
        (lambda: live.step(skin=bent(2)[0]), "skin = an array of shape (3,): must have the shape (points, 3)"),
        (lambda: live.step(skin=broken), "at 7: every point must be finite"),
        (lambda: live.step(skin="bent"), "numbers"),
        (lambda: metres.simulate().step(skin=far), "at 7: leaves the range of f32 when converted to cm: check head.unit"),
        (lambda: bust.step(skin=bent(1)), 'head.mesh = "builtin:bust": keeps its shape: to give a skin, set head.mesh'),
        (lambda: other.simulate().restore(state), "state of hair = skin of 362 vertices: this head has 363"),
        (lambda: live.restore(state[:-4]), "cut short"),
        (lambda: live.restore(state[:300] + bytes([state[300] ^ 1]) + state[301:]), "checksum"),
    ]
    for wrong, words in cases:
        with pytest.raises(nabiki.Error) as refused:
            wrong()
        text = str(refused.value)
        assert words in text and "\n" not in text and refused.value.way_out, text
    assert live.state() == state
    with pytest.raises(nabiki.Error):
        bust.step(skin=bent(1))
    assert bust.step().number == 1


def test_the_example_of_the_page_runs():
    blocks = (ROOT / "docs" / "python.md").read_text(encoding="utf-8").split("```python\n")[1:]
    (block,) = [code for code in (block.split("```")[0] for block in blocks) if "skin=" in code]
    names = {}
    exec(block, names)
    rest, last = names["hair"].offsets, names["frame"]
    assert last.number == 48 and len(last.points) == rest[-1]

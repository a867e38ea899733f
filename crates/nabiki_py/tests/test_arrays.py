"""Heads and hair of arrays are those of files."""

import numpy
import pytest
from conftest import bits

import nabiki


def sphere(radius):
    """A closed mesh in quads and triangles, triangles only."""
    rings, sides = 16, 24
    points = [(0, radius, 0)]
    for ring in range(1, rings):
        for side in range(sides):
            a, b = numpy.pi * ring / rings, 2 * numpy.pi * side / sides
            points.append((radius * numpy.sin(a) * numpy.cos(b), radius * numpy.cos(a), radius * numpy.sin(a) * numpy.sin(b)))
    points.append((0, -radius, 0))
    faces, last = [], len(points) - 1
    for side in range(sides):
        after = (side + 1) % sides
        faces.append((0, 1 + after, 1 + side))
        faces.append((last, last - sides + side, last - sides + after))
        for ring in range(rings - 2):
            a, b = 1 + ring * sides, 1 + (ring + 1) * sides
            faces += [(a + side, a + after, b + after), (a + side, b + after, b + side)]
    return numpy.float32(points), numpy.int32(faces)


def hair(radius):
    """Strands that stand up from a sphere."""
    points, offsets = [], [0]
    for i in range(40):
        a, b = 0.2 + 0.03 * i, 2.4 * i
        way = numpy.array([numpy.sin(a) * numpy.cos(b), numpy.cos(a), numpy.sin(a) * numpy.sin(b)])
        points += [(radius + k) * way for k in range(3 + i % 5)]
        offsets.append(len(points))
    return numpy.float32(points), numpy.array(offsets)


def write_obj(path, points, faces):
    lines = [f"v {x} {y} {z}" for x, y, z in points.tolist()]
    lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")


def test_a_scene_of_arrays_moves_as_the_same_scene_of_files(tmp_path):
    write_obj(tmp_path / "head.obj", *sphere(10.0))
    write_obj(tmp_path / "ball.obj", *sphere(3.0))
    nabiki.write_hair(tmp_path / "hair.hair", *hair(10.0))
    rest = {"motion": {"form": "free", "frames": 8, "inertia_length_floor": 18}, "forces": [(8, (-60, 0, 0))]}
    head = {"origin": (0, 0, 0), "ellipsoid": {"center": (0, 0, 0), "half_axes": (10, 10, 10)}}
    ball = {"origin": (14, 0, 0)}
    arrays = nabiki.Scene(
        head={"mesh": sphere(10.0), **head}, hair=hair(10.0), bodies=[{"mesh": sphere(3.0), **ball}], **rest
    )
    files = nabiki.Scene(
        head={"mesh": tmp_path / "head.obj", **head},
        hair=tmp_path / "hair.hair",
        bodies=[{"mesh": tmp_path / "ball.obj", **ball}],
        **rest,
    )
    wanted = files.timeline().play()
    assert not numpy.array_equal(wanted[0], wanted[-1])
    assert numpy.array_equal(bits(arrays.timeline().play()), bits(wanted))
    assert numpy.array_equal(bits(arrays.copy().timeline().play()), bits(wanted))
    points, offsets = arrays.groom()
    assert numpy.array_equal(bits(points), bits(hair(10.0)[0])) and numpy.array_equal(offsets, hair(10.0)[1])


def test_units_and_axes_of_arrays_are_those_of_files():
    """Metres, z up, looking along -y, as Blender has them."""
    points, offsets = hair(10.0)
    turned = numpy.stack([-points[:, 2], -points[:, 0], points[:, 1]], axis=1) / 100
    space = {"unit": "m", "up": "+z", "facing": "-y"}
    scene = nabiki.Scene(hair={"file": (turned, offsets), **space}, motion={"form": "free"})
    found, _ = scene.groom()
    # Divided by 100 and multiplied again: two roundings.
    assert numpy.abs(found - points).max() <= 4 * numpy.finfo(numpy.float32).eps * numpy.abs(points).max()


def ends_on_the_skin():
    """Strands whose last points lie on the skin of a sphere and whose first stand off it: by the skin alone they are tip first."""
    points, offsets = hair(10.0)
    for start, end in zip(offsets, offsets[1:]):
        points[start:end] = points[start:end][::-1].copy()
    return points, offsets


def test_arrays_are_root_first_wherever_they_lie(tmp_path):
    points, offsets = ends_on_the_skin()
    head = {"mesh": sphere(10.0), "up": "+y", "facing": "+x", "ellipsoid": {"center": [0, 0, 0], "half_axes": [10, 10, 10]}, "origin": (0, 0, 0)}

    free = {"form": "free"}

    def groomed(scene):
        return bits(scene.groom()[0])

    for given in [(points, offsets), {"file": (points, offsets)}]:
        scene = nabiki.Scene(head=head, motion=free, hair=given)
        assert scene.hair.root == "first" and numpy.array_equal(groomed(scene), bits(points))
    # What is said beside them is obeyed, and afterwards, too.
    asked = nabiki.Scene(head=head, motion=free, hair={"file": (points, offsets), "root": "skin"})
    assert asked.hair.root == "skin" and not numpy.array_equal(groomed(asked), bits(points))
    scene.hair.root = "skin"
    scene.hair.file = (points, offsets)
    assert scene.hair.root == "skin"
    # A file is as files are, before the arrays and after them.
    nabiki.write_hair(tmp_path / "a.hair", points, offsets)
    scene = nabiki.Scene(head=head, motion=free, hair=tmp_path / "a.hair")
    assert scene.hair.root == "skin" and not numpy.array_equal(groomed(scene), bits(points))
    scene.hair.file = (points, offsets)
    assert scene.hair.root == "first" and numpy.array_equal(groomed(scene), bits(points))
    scene.hair.file = tmp_path / "a.hair"
    assert scene.hair.root == "skin"
    (tmp_path / "a.toml").write_text('[hair]\nfile = "a.hair"\n[[force]]\nthrough = 1\nvector = [0, 1, 0]\n')
    scene = nabiki.Scene.open(tmp_path / "a.toml", {"hair.file": (points, offsets)})
    assert scene.hair.root == "first"


def test_arrays_go_with_the_last_scene_that_names_them():
    import os

    scene = nabiki.Scene(hair=hair(10.0), motion={"form": "free", "frames": 2})
    file, other = scene.hair.file, scene.copy()
    del scene
    assert os.path.exists(file)
    del other
    assert not os.path.exists(file)


def test_files_of_arrays_that_no_scene_names_any_more_are_gone():
    """A sweep over grooms would fill the disk."""
    import os

    scene = nabiki.Scene(hair=hair(10.0), motion={"form": "free", "frames": 2})
    first, kept = scene.hair.file, scene.copy()
    scene.hair.file = hair(11.0)
    second = scene.hair.file
    assert os.path.exists(first) and os.path.exists(second)
    kept.hair.file = scene.hair.file = hair(12.0)
    assert not os.path.exists(first) and not os.path.exists(second)
    with pytest.raises(nabiki.Error):
        scene.hair = {"file": hair(10.0), "strands": -1}
    assert len(scene.groom()[1]) == 41


def test_arrays_may_be_lists_and_settings_of_a_scene_that_is_opened(tmp_path):
    scene = nabiki.Scene(hair=list(hair(10.0)), motion={"form": "free"})
    (tmp_path / "head.toml").write_text('[motion]\nform = "free"\n')
    opened = nabiki.Scene.open(tmp_path / "head.toml", {"hair.file": hair(10.0), "head.mesh": sphere(10.0)})
    for found in (scene, opened):
        assert numpy.array_equal(found.groom()[1], hair(10.0)[1])

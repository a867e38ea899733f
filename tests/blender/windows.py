"""What a window would do: panels are drawn, and work goes on step by step while the window does, until it ends or Esc is pressed."""

import importlib
from types import SimpleNamespace

import bpy
import numpy as np

import motions
import scenes


def part(name):
    return importlib.import_module(f"bl_ext.user_default.nabiki.{name}")


class Layout:
    """Takes what a panel draws, and refuses what Blender would."""

    def __init__(self):
        self.drawn = []

    def prop(self, data, name, **options):
        assert name in data.bl_rna.properties, name
        self.drawn.append(name)

    def prop_search(self, data, name, among, collection, **options):
        assert name in data.bl_rna.properties and collection in among.bl_rna.properties
        self.drawn.append(name)

    def operator(self, name, **options):
        group, own = name.split(".")
        assert getattr(getattr(bpy.ops, group), own).get_rna_type()
        self.drawn.append(name)

    def template_list(self, kind, number, data, name, active_data, active, **options):
        assert hasattr(bpy.types, kind) and name in data.bl_rna.properties and active in active_data.bl_rna.properties

    def label(self, text="", **options):
        self.drawn.append(text)

    def progress(self, factor=0.0, text=""):
        self.drawn.append(text)

    def row(self, **options):
        return self

    column = row


def test_panels_draw_whatever_there_is(command, shared):
    hair = scenes.groom(8, moving=False)
    hair.nabiki.stiffness = (3000, 300)
    panels = part("panels")
    seen = set()
    for state in ["new", "winds", "simulated", "changed", "of the preview", "mesh"]:
        if state == "winds":
            scenes.interval(hair, 5, (0, 40, 0))
            bpy.ops.nabiki.interval_add()
            assert hair.nabiki.intervals[1].through > 5
            bpy.ops.nabiki.region_add()
        if state == "simulated":
            bpy.ops.nabiki.interval_remove()
            bpy.ops.nabiki.region_remove()
            motions.simulated(hair, 10)
        if state == "changed":
            hair.nabiki.hold = 31
        if state == "of the preview":
            scenes.active(hair.nabiki.preview)
            rig = scenes.linked("Rig", bpy.data.armatures.new("Rig"))
            bpy.data.objects["Head"].modifiers.new("Armature", "ARMATURE").object = rig
        if state == "mesh":
            scenes.active(bpy.data.objects["Head"])
        for known in panels.CLASSES:
            if issubclass(known, bpy.types.UIList):
                continue
            assert known.bl_label and known.__name__ == known.bl_idname if hasattr(known, "bl_idname") else known.__name__
            shown = known.poll(bpy.context)
            # Notes are there where a motion has some.
            assert known is panels.NABIKI_PT_notes or shown == (state != "mesh")
            if shown:
                self = SimpleNamespace(layout=Layout())
                if hasattr(known, "draw_header"):
                    known.draw_header(self, bpy.context)
                known.draw(self, bpy.context)
                seen |= set(self.layout.drawn)
    settings = {name for name in hair.nabiki.bl_rna.properties.keys() if name not in HIDDEN}
    assert settings <= seen, settings - seen
    assert {"attribute", "vertex_group", "wind"} <= seen
    assert {"nabiki.simulate", "nabiki.solve", "nabiki.bake", "nabiki.clear"} <= seen and any("At rest" in line for line in seen)


def test_nothing_below_the_buttons_moves_while_they_work(command, shared):
    """Who changes a wind has the mouse on it when its motion is computed: rows above it neither come nor go."""
    hair = scenes.groom(8, moving=False)
    panels, progress = part("panels"), bpy.context.window_manager.nabiki

    def rows():
        layout = Layout()
        panels.buttons(layout, bpy.context, hair)
        return len(layout.drawn)

    none = rows()
    hair.nabiki.stiffness = (12000, 1000)
    motions.simulated(hair, 10)
    known = panels.film_of(bpy.context, hair)
    known.notes.append("a note that is far too long for one line of a narrow panel, and is shown in several")
    moving = rows()
    hair.nabiki.hold = 31
    at_rest = rows()
    progress.text = "moving hair"
    try:
        assert {none, moving, at_rest, rows()} == {none}
    finally:
        progress.text = ""
    hair.nabiki.hold = 30
    layout = Layout()
    panels.notes(layout, bpy.context, hair)
    assert " ".join(layout.drawn).lower() == " ".join(known.notes).lower() and len(layout.drawn) > len(known.notes)


def test_a_first_wind_blows_against_the_face_and_the_next_is_a_lull(command, shared):
    hair = scenes.groom(8, moving=False)
    for facing, axis, sign in [("-y", 1, 1), ("+y", 1, -1), ("-x", 0, 1), ("+x", 0, -1)]:
        hair.nabiki.intervals.clear()
        hair.nabiki.facing = facing
        bpy.ops.nabiki.interval_add()
        bpy.ops.nabiki.interval_add()
        first, second = hair.nabiki.intervals
        assert sign * first.vector[axis] > 0 and np.count_nonzero(first.vector) == 1
        assert not any(second.vector) and second.through > first.through


# What is drawn as a list, or belongs to no user.
HIDDEN = {"rna_type", "name", "intervals", "active_interval", "regions", "active_region", "preview", "baked", "shown_before", "of"}


def test_every_setting_and_button_says_what_it_does(command, shared):
    """Tooltips are there, begin with a capital, and end without a full stop, as Blender's do."""
    hair = scenes.groom(8, moving=False)
    scenes.interval(hair, 5, (0, 0, 0))
    bpy.ops.nabiki.region_add()
    for group in [hair.nabiki, hair.nabiki.intervals[0], hair.nabiki.regions[0]]:
        for known in group.bl_rna.properties:
            if known.identifier not in HIDDEN:
                assert known.description and known.description[0].isupper() and not known.description.endswith("."), known.identifier
                assert known.name and known.name[0].isupper(), known.identifier
    for name in ["simulate", "solve", "bake", "clear", "interval_add", "interval_remove", "region_add", "region_remove", "write_scene"]:
        kind = getattr(bpy.ops.nabiki, name).get_rna_type()
        assert name != "simulate" or {"name", "beside"} <= set(kind.properties.keys())
        assert kind.description and not kind.description.endswith(".") and kind.name.istitle() or kind.name == "Find the Wind", name


class Window:
    """A context whose window records what it is told."""

    def __init__(self):
        self.said, self.timers = [], 0
        self.window, self.scene, self.view_layer = None, bpy.context.scene, bpy.context.view_layer
        self.window_manager = SimpleNamespace(
            event_timer_add=self._add, event_timer_remove=self._remove, progress_begin=lambda a, b: None, progress_update=lambda now: None
        )
        self.window_manager.progress_end = lambda: None
        self.window_manager.modal_handler_add = lambda operator: None
        self.window_manager.nabiki, self.window_manager.windows = SimpleNamespace(part=0.0, text=""), []
        self.workspace = SimpleNamespace(status_text_set=self.said.append)

    def _add(self, seconds, window):
        self.timers += 1
        return "timer"

    def _remove(self, timer):
        self.timers -= 1

    def __getattr__(self, name):
        return getattr(bpy.context, name)


def pressed(name, thing):
    """A button of the extension, outside of Blender's own loop."""
    operators, jobs = part("operators"), part("jobs")

    class Pressed(jobs.Working):
        def __init__(self):
            self.reports, self.name = [], thing.name

        def report(self, kind, line):
            self.reports.append((kind, line))

        steps = getattr(operators, name).steps

    return Pressed()


TIMER, ESC, OTHER = (SimpleNamespace(type=kind, value="PRESS") for kind in ["TIMER", "ESC", "MOUSEMOVE"])


def in_window(jobs, operator, window, events):
    """Presses the button and lets events come, then timers until it ends. A window is pretended."""
    was, jobs.bpy = jobs.bpy, SimpleNamespace(app=SimpleNamespace(background=False))
    try:
        answer = operator.invoke(window, None)
        events = iter(events)
        while answer in ({"RUNNING_MODAL"}, {"PASS_THROUGH"}):
            answer = operator.modal(window, next(events, TIMER))
        return answer
    finally:
        jobs.bpy = was


def test_in_a_window_work_goes_step_by_step(command, shared):
    jobs = part("jobs")
    hair = scenes.groom(12)
    hair.nabiki.stiffness, hair.nabiki.preview_strands = (3000, 300), 20
    scenes.active(hair)
    window, operator = Window(), pressed("NABIKI_OT_simulate", hair)
    was, jobs.SLICE = jobs.SLICE, 1e-9
    try:
        assert in_window(jobs, operator, window, [TIMER, OTHER, TIMER]) == {"FINISHED"}
    finally:
        jobs.SLICE = was
    assert window.timers == 0 and jobs.running is None and window.said[-1] is None and window.window_manager.nabiki.text == ""
    assert any("reading frame" in line for line in window.said[:-1]), window.said
    assert operator.reports[0][0] == {"INFO"} and "20 strands, 12 frames" in operator.reports[0][1]
    assert bpy.context.scene.frame_current == 1


def test_esc_ends_it_and_leaves_nothing(command, shared):
    jobs = part("jobs")
    for name in ["NABIKI_OT_simulate", "NABIKI_OT_bake"]:
        hair = scenes.groom(12)
        hair.nabiki.stiffness, hair.nabiki.cache_path = (3000, 300), str(command.folder / "a.usdc")
        scenes.active(hair)
        objects = bpy.data.objects.keys()
        for before in [[ESC], [TIMER, ESC], [TIMER] * 3 + [OTHER, ESC]]:
            window, operator = Window(), pressed(name, hair)
            was, jobs.SLICE = jobs.SLICE, 1e-9
            try:
                assert in_window(jobs, operator, window, before) == {"CANCELLED"}
            finally:
                jobs.SLICE = was
            assert operator.reports == [({"INFO"}, "Cancelled, nothing was changed")]
            assert bpy.data.objects.keys() == objects and not list(command.folder.iterdir())
            assert window.timers == 0 and jobs.running is None and not hair.hide_viewport


def test_a_second_button_waits_and_mistakes_are_lines(command, shared):
    jobs = part("jobs")
    hair = scenes.groom(8, moving=False)
    hair.nabiki.head = None
    scenes.active(hair)
    window, operator = Window(), pressed("NABIKI_OT_simulate", hair)
    assert in_window(jobs, operator, window, []) == {"CANCELLED"}
    assert operator.reports[0][0] == {"ERROR"} and "has no head" in operator.reports[0][1] and jobs.running is None
    jobs.running = operator
    try:
        other = pressed("NABIKI_OT_bake", hair)
        assert in_window(jobs, other, window, []) == {"CANCELLED"} and "still working" in other.reports[0][1]
    finally:
        jobs.running = None
    # A wind that is found while somebody looks for another is stopped, too: its steps are those of the solver.
    hair.nabiki.head = bpy.data.objects["Head"]
    scenes.interval(hair, 8, (0, 50, 0))
    preview = motions.simulated(hair, 10)
    bpy.context.scene.frame_set(6)
    points = scenes.positions(preview.data)
    points.reshape(-1, scenes.POINTS, 3)[:, -2:] += np.float32([0.03, 0.01, 0.0])
    preview.data.attributes["position"].data.foreach_set("vector", points.ravel())
    solving = pressed("NABIKI_OT_solve", hair)
    assert in_window(jobs, solving, window, [TIMER, ESC]) == {"CANCELLED"}
    assert tuple(hair.nabiki.intervals[0].vector) == (0, 50, 0)
    assert np.array_equal(scenes.positions(preview.data), points), "what was moved by hand stays"


def beside(hair, window, events):
    """What the timer starts once settings are calm."""
    operator = pressed("NABIKI_OT_simulate", hair)
    operator.beside = True
    return in_window(part("jobs"), operator, window, events), operator


def test_what_runs_beside_the_user_adds_and_removes_no_data_block(command, shared):
    """No step of Undo follows it: a data-block that came or went between two steps is the end of Blender where they are undone."""
    hair = scenes.groom(12, moving=False)
    scenes.interval(hair, 12, (0, 70, 20))
    preview = motions.simulated(hair, 40)
    bpy.context.scene.frame_set(8)
    bpy.ops.ed.undo_push(message="frame")
    blocks = {block.session_uid for kind in [bpy.data.objects, bpy.data.hair_curves, bpy.data.materials] for block in kind}
    changes = [("gravity", 160, 40), ("preview_strands", 60, 60), ("preview_strands", 25, 25)]
    # Curves of Blender 4.2 cannot become others: other strands wait for the button there.
    changes = changes if "remove_curves" in bpy.types.Curves.bl_rna.functions else changes[:1]
    for name, value, strands in changes:
        setattr(hair.nabiki, name, value)
        bpy.ops.ed.undo_push(message=name)
        assert at_rest(preview)
        answer, operator = beside(hair, Window(), [])
        assert answer == {"CANCELLED"} and operator.reports == []
        assert len(preview.data.curves) == strands and not at_rest(preview)
        now = {block.session_uid for kind in [bpy.data.objects, bpy.data.hair_curves, bpy.data.materials] for block in kind}
        assert now == blocks
    # What is left after Undo may have the strands of another step: it is at rest, and shown once its motion is there again.
    for undone in range(len(changes)):
        bpy.ops.ed.undo()
        hair = bpy.data.objects["Hair"]
        preview = hair.nabiki.preview
        if not part("panels").film_of(bpy.context, hair):
            assert at_rest(preview)
            beside(hair, Window(), [])
        assert not at_rest(preview) and len(preview.data.curves) == hair.nabiki.preview_strands, undone


def at_rest(preview):
    return np.array_equal(scenes.positions(preview.data), scenes.vectors(preview.data, "nabiki_rest"))


def test_a_motion_of_settings_that_have_changed_meanwhile_is_not_shown(command, shared):
    hair = scenes.groom(12, moving=False)
    scenes.interval(hair, 12, (0, 70, 20))
    preview = motions.simulated(hair, 40)
    bpy.context.scene.frame_set(8)
    hair.nabiki.gravity = 160

    def changes():
        yield TIMER
        hair.nabiki.gravity = 180
        while True:
            yield TIMER

    jobs = part("jobs")
    was, jobs.SLICE = jobs.SLICE, 1e-9
    try:
        answer, operator = beside(hair, Window(), changes())
    finally:
        jobs.SLICE = was
    assert answer == {"CANCELLED"} and operator.reports == [] and at_rest(preview)
    assert part("panels").film_of(bpy.context, hair) is None
    # It was computed, though, and is there where the setting is.
    hair.nabiki.gravity = 160
    assert not at_rest(preview)

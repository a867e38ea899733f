# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work: step by step while the window goes on, with progress, until it has ended or somebody pressed Esc."""

import threading
import time

import bpy
import nabiki

from . import scene_files
from .messages import Cancelled, Mistake, sentence

# Seconds that may be spent before the window is drawn again.
SLICE = 0.03

running = None
"""The operator that works now; there is one at most."""


class Thread:
    """Work that asks nothing of Blender, on a thread of its own."""

    def __init__(self, work):
        self.result, self.error, self.stop = None, None, threading.Event()
        self.done, self.total = 0, 1
        self.thread = threading.Thread(target=self._run, args=(work,), daemon=True)

    def _run(self, work):
        try:
            self.result = work(self.progress)
        except BaseException as error:  # It is raised where the work is waited for.
            self.error = error

    def progress(self, done, total):
        """Called by the work; ends it once it is not wanted any more."""
        self.done, self.total = done, max(total, 1)
        if self.stop.is_set():
            raise Cancelled

    def wait(self, text):
        """Yields how far it is until it has ended, and that there is nothing to do meanwhile; returns what it returned."""
        self.thread.start()
        try:
            while self.thread.is_alive():
                yield self.done / self.total, text, True
        finally:
            self.stop.set()
            self.thread.join()
        if self.error is not None:
            raise self.error
        return self.result


def on_thread(work, text):
    return (yield from Thread(work).wait(text))


class Working:
    """An operator of many steps. `steps(context)` yields (part done, what is done), and True where a thread is at work, and returns what
    to report: a line, and notes."""

    timer, told = None, ""
    made = None
    """The scene of nabiki at hand, whose files errors may name."""
    beside = False
    """Whether nobody has asked for it, so that it goes on beside what the user does, and says nothing."""

    def execute(self, context):
        """All at once, for scripts and where there is no window."""
        try:
            steps = self.steps(context)
            while True:
                _, _, *waits = next(steps)
                if waits:
                    time.sleep(0.001)
        except StopIteration as ended:
            return self._ended(context, ended.value)
        except EXPECTED as error:
            return self._refused(context, error)

    def invoke(self, context, event):
        global running
        if bpy.app.background:
            return self.execute(context)
        if running is not None:
            if self.beside:
                return {"CANCELLED"}
            self.report({"ERROR"}, "Nabiki is still working: wait, or press Esc")
            return {"CANCELLED"}
        running, self.unwanted = self, False
        self.generator = self.steps(context)
        window_manager = context.window_manager
        self.timer = window_manager.event_timer_add(SLICE, window=context.window)
        if not self.beside:
            window_manager.progress_begin(0, 100)
        window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC" and event.value == "PRESS":
            self.unwanted = True
        if event.type != "TIMER":
            # Nothing else is done while frames are read: they must not change under the reader's hands.
            return {"PASS_THROUGH"} if self.beside else {"RUNNING_MODAL"}
        try:
            if self.unwanted:
                self.generator.throw(Cancelled())
            until = time.monotonic() + SLICE
            part, text, *waits = next(self.generator)
            while not waits and time.monotonic() < until:
                part, text, *waits = next(self.generator)
            self._tell(context, part, text)
            return {"PASS_THROUGH"} if self.beside else {"RUNNING_MODAL"}
        except StopIteration as ended:
            self._leave(context)
            return self._ended(context, ended.value)
        except EXPECTED as error:
            self._leave(context)
            return self._refused(context, error)
        except BaseException:
            self._leave(context)
            raise

    def cancel(self, context):
        """Blender is about to close, or opens another file."""
        self.generator.close()
        self._leave(context)

    def _tell(self, context, part, text):
        line = f"Nabiki: {text}, {100 * part:.0f} %  (Esc cancels)"
        if line == self.told:
            return
        self.told, state = line, context.window_manager.nabiki
        state.part, state.text = part, text
        if not self.beside:
            context.window_manager.progress_update(100 * part)
        context.workspace.status_text_set(line)
        redraw(context)

    def _leave(self, context):
        global running
        running = None
        context.window_manager.event_timer_remove(self.timer)
        if not self.beside:
            context.window_manager.progress_end()
        context.workspace.status_text_set(None)
        context.window_manager.nabiki.text = ""
        redraw(context)

    def _ended(self, context, outcome):
        line, notes = outcome
        if self.beside:
            # Undo has nothing to take back: the setting that was changed has a step of its own.
            return {"CANCELLED"}
        # What was not carried over, or done otherwise than it was set, is worth a look.
        self.report({"WARNING"} if notes else {"INFO"}, sentence("; ".join([line, *notes])))
        return {"FINISHED"}

    def _refused(self, context, error):
        if self.beside and not isinstance(error, nabiki.Error):
            return {"CANCELLED"}
        if isinstance(error, (Cancelled, KeyboardInterrupt)):
            self.report({"INFO"}, "Cancelled, nothing was changed")
        elif isinstance(error, nabiki.Error):
            self.report({"ERROR"}, sentence(scene_files.line(error, self.made)))
        elif isinstance(error, MemoryError):
            self.report({"ERROR"}, "The motion does not fit into memory: show fewer strands or frames")
        else:
            self.report({"ERROR"}, sentence(error))
        return {"CANCELLED"}


# A ReferenceError is of an object that was deleted meanwhile.
EXPECTED = (Mistake, nabiki.Error, Cancelled, KeyboardInterrupt, OSError, MemoryError, ReferenceError)


def redraw(context):
    """Draws the panels anew; the view beside them would take its time from the work."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            for region in area.regions:
                if (area.type, region.type) in {("PROPERTIES", "WINDOW"), ("VIEW_3D", "UI")}:
                    region.tag_redraw()


class NabikiProgress(bpy.types.PropertyGroup):
    part: bpy.props.FloatProperty(options={"SKIP_SAVE"})
    text: bpy.props.StringProperty(options={"SKIP_SAVE"})


def register():
    bpy.utils.register_class(NabikiProgress)
    bpy.types.WindowManager.nabiki = bpy.props.PointerProperty(type=NabikiProgress)


def unregister():
    del bpy.types.WindowManager.nabiki
    bpy.utils.unregister_class(NabikiProgress)

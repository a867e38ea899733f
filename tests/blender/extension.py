"""The extension, as a user has it: installed from its .zip, pressed by its buttons, in a Blender without a window."""

import os
import sys
import traceback
from pathlib import Path

import bpy

import mistakes
import motions
import others
import regions
import windows
import winds
from command import Command


def install(archive):
    """What Edit > Preferences > Get Extensions > Install from Disk does."""
    found = bpy.ops.extensions.package_install_files(repo="user_default", filepath=str(archive), enable_on_install=True)
    assert found == {"FINISHED"}, found
    assert "bl_ext.user_default.nabiki" in bpy.context.preferences.addons, list(bpy.context.preferences.addons.keys())
    assert hasattr(bpy.types, "NABIKI_PT_main")


def disable():
    """What the check box beside it does: nothing of it is left."""
    bpy.ops.preferences.addon_disable(module="bl_ext.user_default.nabiki")
    assert not hasattr(bpy.types, "NABIKI_PT_main") and not hasattr(bpy.types.Object, "nabiki") and not hasattr(bpy.types.WindowManager, "nabiki")
    handlers = [
        known for name in dir(bpy.app.handlers) if isinstance(getattr(bpy.app.handlers, name), list) for known in getattr(bpy.app.handlers, name)
    ]
    assert not [known for known in handlers if "nabiki" in getattr(known, "__module__", "")], handlers


def laws(*modules):
    return [getattr(module, name) for module in modules for name in vars(module) if name.startswith("test_")]


def main():
    archive, nabiki, work, shared = (Path(word) for word in sys.argv[1:5])
    install(archive)
    failed, skipped, passed = [], [], 0
    for law in laws(motions, winds, regions, others, windows, mistakes):
        if sys.argv[5:] and law.__name__ not in sys.argv[5:]:
            continue
        try:
            why = law(Command(nabiki, work / "tests" / law.__name__), shared)
        except Exception:  # All of them are shown, and the others go on.
            traceback.print_exc()
            failed.append(law.__name__)
            continue
        if why:
            skipped.append(f"{law.__name__}: {why}")
        else:
            passed += 1
    disable()
    for line in skipped:
        print(f"SKIPPED: {line}")
    print(f"Blender {bpy.app.version_string}: {passed} passed, {len(failed)} failed, {len(skipped)} skipped")
    if failed:
        print(f"failed: {', '.join(failed)}")
    return 1 if failed else 0


if __name__ == "__main__":
    status = main()
    sys.stdout.flush()
    # The module bpy of Blender 4.2 cannot end once an operator was registered; Blender can.
    os._exit(status)

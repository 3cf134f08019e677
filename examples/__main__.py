# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Runs a scene: ``python -m examples NAME [options]``; without a name, lists the scenes."""

from __future__ import annotations

import ast
import importlib
import sys
from pathlib import Path

GROUPS = {
    "hands on": ("interactive",),
    "to start from": ("minimal", "keyframed", "own_mesh", "texture", "extrude"),
    "after the paper": ("starfish", "dude", "key", "octopus", "jelly", "sphere", "gingerbread"),
    "more": ("bunny", "loaf", "surgery", "worlds"),
}
SCENES = tuple(name for group in GROUPS.values() for name in group)


def scene_path(name: str) -> Path:
    """Return the file of a scene, which stands in this folder or in one below."""
    return next(Path(__file__).parent.glob(f"**/{name}.py"))


def description(name: str) -> str:
    """Return a scene's docstring, without importing it."""
    return ast.get_docstring(ast.parse(scene_path(name).read_text()))


def scene_class(name: str) -> type:
    """Return the class of a scene."""
    parts = scene_path(name).relative_to(Path(__file__).parent).with_suffix("").parts
    return importlib.import_module("." + ".".join(parts), __package__).Example


def run(name: str) -> object:
    """Run a scene with the options of the command line, and return it as it is at the end."""
    scene = scene_class(name)
    if hasattr(scene, "main"):
        return scene.main()
    import newton.examples

    viewer, args = newton.examples.init()  # a scene of its own, without the base class
    example = scene(viewer, args)
    newton.examples.run(example, args)
    return example


def scene_list() -> str:
    """Return the scenes with one line each, from their docstrings."""
    lines = [f"usage: python -m {__package__} NAME [options]; NAME --help shows the options"]
    for group, names in GROUPS.items():
        lines += ["", f"{group}:", *(f"  {name:<12} {description(name).splitlines()[0]}" for name in names)]
    return "\n".join(lines)


def main() -> object:
    """Run the scene that the command line names, and return it as it is at the end."""
    names = sys.argv[1:2]
    if not names or names[0] in ("-h", "--help"):
        print(scene_list())
        return None
    if names[0] not in SCENES:
        sys.exit(f"there is no scene {names[0]!r}\n{scene_list()}")
    sys.argv = [f"examples {names[0]}", *sys.argv[2:]]
    return run(names[0])


if __name__ == "__main__":
    main()

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Runs a scene: ``python -m examples NAME [options]``; without a name, lists the scenes."""

from __future__ import annotations

import ast
import importlib
import sys
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from examples.scene import CutScene

SCENES = ("starfish", "bunny", "gingerbread")


def scene_list() -> str:
    """Return the scenes with one line each, from their docstrings, without importing them."""
    lines = ["usage: python -m examples NAME [options]; NAME --help shows the options", ""]
    for name in SCENES:
        module = ast.parse((Path(__file__).parent / f"{name}.py").read_text())
        lines.append(f"  {name:<12} {ast.get_docstring(module).splitlines()[0]}")
    return "\n".join(lines)


def main() -> CutScene | None:
    """Run the scene that the command line names, and return it as it is at the end."""
    names = sys.argv[1:2]
    if not names or names[0] in ("-h", "--help"):
        print(scene_list())
        return None
    if names[0] not in SCENES:
        sys.exit(f"there is no scene {names[0]!r}\n{scene_list()}")
    sys.argv = [f"examples {names[0]}", *sys.argv[2:]]
    return importlib.import_module(f"examples.{names[0]}").Example.main()


if __name__ == "__main__":
    main()

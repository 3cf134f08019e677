# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Scripts that hold a scene."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType


def loaded_script(path: Path) -> ModuleType:
    """Run a script and return it as a module, which has a function ``build(builder)``.

    Args:
        path: The script.

    Raises:
        OSError: It is not there.
        ValueError: It has no such function.
    """
    if not path.is_file():
        raise FileNotFoundError(f"there is no script {path}")
    spec = importlib.util.spec_from_file_location(f"_report_scene_{path.stem}", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    if not callable(getattr(module, "build", None)):
        raise ValueError(f"{path} has no function build(builder) that adds a cage body to a newton.ModelBuilder")
    return module

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Scenes that commands are given by name: a script with ``build(builder)``, or an example of a checkout."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable
from pathlib import Path

import newton
import warp as wp

from ...solver import SolverCageCut
from .script import loaded_script

Build = Callable[[newton.ModelBuilder], object]


def build_of(name: str, *, walks: int | None = None) -> Build:
    """What adds a scene's bodies to a builder that has the attributes of ``SolverCageCut``.

    Args:
        name: Path of a script that has a function ``build(builder)``, or the name of an example.
        walks: Walks a point of an example's bodies; on a CPU those of the examples by default, on CUDA the solver's.

    Raises:
        OSError: There is no such script.
        ValueError: There is no such example, or the script has no ``build``.
    """
    path = Path(name)
    if path.suffix == ".py":
        return loaded_script(path).build
    folder = Path.cwd() / "examples"
    example = next((file for file in folder.glob("**/*.py") if file.stem == name), None)
    if example is None:
        raise ValueError(
            f"there is no scene {name!r}: give the path of a script with build(builder), or, in a checkout, the name "
            "of an example"
        )
    if str(Path.cwd()) not in sys.path:
        sys.path.insert(0, str(Path.cwd()))
    kind = getattr(
        importlib.import_module(".".join(example.relative_to(Path.cwd()).with_suffix("").parts)), "Example", None
    )
    if not hasattr(kind, "add_bodies"):
        raise ValueError(f"{example} is not a scene: it has no Example with add_bodies(builder)")

    if walks is None and wp.get_device().is_cpu:
        walks = importlib.import_module("examples.base.options").CPU_WALKS

    def build(builder: newton.ModelBuilder) -> None:
        scene = object.__new__(kind)  # without a viewer and all else that showing it takes
        scene.walks = walks
        scene.add_bodies(builder)
        builder.add_ground_plane()

    return build


def built(build: Build) -> newton.ModelBuilder:
    """A builder with the attributes of ``SolverCageCut`` and a scene's bodies.

    Args:
        build: Adds the bodies.
    """
    builder = newton.ModelBuilder()
    SolverCageCut.register_custom_attributes(builder)
    build(builder)
    return builder


def definitions_in(builder: newton.ModelBuilder) -> dict[int, object]:
    """What the bodies of a builder are made of, by their indices; the builder keeps rows in a list or a mapping.

    Args:
        builder: The builder.
    """
    rows = builder.custom_attributes["cagecut:definition"].values or []
    return dict(rows) if isinstance(rows, dict) else dict(enumerate(rows))

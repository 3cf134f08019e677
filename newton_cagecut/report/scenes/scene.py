# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Scenes to measure: those of a checkout by their names, and scripts with ``build(builder)``."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

import numpy as np

from ...cage import Cage
from ...section import Blade
from ..paper.published import PaperRow
from .script import loaded_script

_TABLE = "benchmarks.report_scenes"  # of a checkout
_STAGES = (".usd", ".usda", ".usdc", ".usdz")


class Scene(Protocol):
    """A cage, points in it, and cuts.

    Attributes:
        name: Its name.
        cage: The cage before the cuts.
        points: Vertices of the embedded mesh [m], shape (n, dimension).
        blades: The cuts, one after the other; one at least.
        paper: The paper's row, of its own scenes.
    """

    name: str
    cage: Cage
    points: np.ndarray
    blades: Sequence[Blade]
    paper: PaperRow | None


@dataclass(frozen=True)
class PlainScene:
    """A scene that is what it holds; see :class:`Scene`."""

    name: str
    cage: Cage
    points: np.ndarray
    blades: tuple[Blade, ...]
    paper: PaperRow | None = field(default=None)


def load_scenes(names: Sequence[str], default: Sequence[str]) -> list[Scene]:
    """Load scenes.

    Args:
        names: Names of a checkout's scenes, or paths of scripts.
        default: Names that are taken if there are none; all of the checkout's if there are none either.

    Raises:
        OSError: A script is not there.
        ValueError: There is no such scene, or a script builds none.
    """
    table = _checkout_table()
    if not names and not table:
        raise ValueError(
            "name a scene: a script with build(builder); the project's own scenes have names only in a checkout of it"
        )
    return [_loaded(name, table) for name in names or default or list(table)]


def _checkout_table() -> Mapping[str, Callable[[], Scene]]:
    """The scenes by their names, where the command runs in a checkout."""
    if not (Path.cwd() / _TABLE.replace(".", "/")).with_suffix(".py").is_file():
        return {}
    if str(Path.cwd()) not in sys.path:
        sys.path.insert(0, str(Path.cwd()))
    return importlib.import_module(_TABLE).SCENES


def _loaded(name: str, table: Mapping[str, Callable[[], Scene]]) -> Scene:
    if name in table:
        return table[name]()
    suffix = Path(name).suffix.lower()
    if suffix in _STAGES:
        raise ValueError(
            f"{name}: a stage cannot be measured, because cages of stages do not say which body they move; write a "
            "script with build(builder) that adds the body"
        )
    if suffix == ".py":
        return _scripted(Path(name))
    known = f"the names are {', '.join(table)}" if table else "names are known in a checkout only"
    raise ValueError(f"there is no scene {name!r}: {known}; or give a script (.py) with build(builder)")


def _scripted(path: Path) -> Scene:
    """The first cage body that a script builds, cut by its ``blades`` or else across its middle."""
    from .building import built, definitions_in

    module = loaded_script(path)
    definitions = definitions_in(built(module.build))
    if not definitions:
        raise ValueError(f"{path}: build(builder) added no cage body; call newton_cagecut.add_cage_body in it")
    body = definitions[min(definitions)]
    blades = tuple(getattr(module, "blades", ())) or (blade_across(body.cage),)
    return PlainScene(path.stem, body.cage, np.asarray(body.surface.points), blades)


def blade_across(cage: Cage, place: float = 0.5) -> Blade:
    """Return a blade through a cage, square to its longest side.

    Args:
        cage: The cage.
        place: Where along that side, as a share of it.
    """
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    order = np.argsort(low - high, kind="stable")  # axes, the longest first
    axes = np.eye(cage.dimension)
    down = -axes[order[-1]]
    origin = 0.5 * (low + high) + (high - low)[order[-1]] * axes[order[-1]]
    origin += (place - 0.5) * (high - low)[order[0]] * axes[order[0]]
    return Blade(origin, down) if cage.dimension == 2 else Blade(origin, axes[order[1]], down)

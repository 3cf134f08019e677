# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Cages with harmonic coordinates that can be cut while they move, as a solver for Newton.

The rooms, from the bottom up: ``geometry``, ``section``, ``cage``, ``harmonic``, ``surface``, ``elastic``, ``usd``,
``wrap``, ``solver``. The names here are the public ones. The method is "Fast Cutting of Cage Based Deformation with
Walk on Spheres"; bit-identical updates and harmonic control variates go past it.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .cage import Cage, CageEdit, Cut
    from .elastic import Material
    from .harmonic import HarmonicCoordinates, UpdateStats
    from .section import Blade
    from .solver import Capacity, CutReport, SolverCageCut, add_cage_body
    from .surface import Surface
    from .wrap import wrap_cage

_ROOMS = {
    "Blade": "section",
    "Cage": "cage",
    "CageEdit": "cage",
    "Capacity": "solver",
    "Cut": "cage",
    "CutReport": "solver",
    "HarmonicCoordinates": "harmonic",
    "Material": "elastic",
    "SolverCageCut": "solver",
    "Surface": "surface",
    "UpdateStats": "harmonic",
    "add_cage_body": "solver",
    "wrap_cage": "wrap",
}

__all__ = [
    "Blade",
    "Cage",
    "CageEdit",
    "Capacity",
    "Cut",
    "CutReport",
    "HarmonicCoordinates",
    "Material",
    "SolverCageCut",
    "Surface",
    "UpdateStats",
    "add_cage_body",
    "wrap_cage",
]


def __getattr__(name: str) -> object:
    """Import a public name's room when it is first used: coordinates alone never import Newton."""
    if name not in _ROOMS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f".{_ROOMS[name]}", __name__), name)

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Cages with harmonic coordinates that can be cut while they move, as a solver for Newton.

The rooms, from the bottom up: ``geometry``, ``section``, ``cage``, ``harmonic``, ``surface``, ``elastic``, ``usd``,
``files``, ``wrap``, ``solver``, ``stage``, ``report``. The names here are the public ones. The method is "Fast Cutting
of Cage Based Deformation with Walk on Spheres"; bit-identical updates and harmonic control variates go past it.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

from ._version import __version__ as __version__

if TYPE_CHECKING:  # for type checkers; the table says the same to Python
    from .cage import Cage as Cage
    from .cage import CageEdit as CageEdit
    from .cage import Cut as Cut
    from .elastic import ConstitutiveModel as ConstitutiveModel
    from .elastic import Material as Material
    from .files import read_cage as read_cage
    from .files import read_mesh as read_mesh
    from .harmonic import HarmonicCoordinates as HarmonicCoordinates
    from .harmonic import UpdateStats as UpdateStats
    from .section import Blade as Blade
    from .solver import BodyCut as BodyCut
    from .solver import BodyPiece as BodyPiece
    from .solver import BodySnapshot as BodySnapshot
    from .solver import CageBody as CageBody
    from .solver import Capacity as Capacity
    from .solver import CutReport as CutReport
    from .solver import PlanEntry as PlanEntry
    from .solver import SolverCageCut as SolverCageCut
    from .solver import add_cage_body as add_cage_body
    from .stage import add_usd as add_usd
    from .surface import Surface as Surface
    from .wrap import wrap_cage as wrap_cage

_ROOMS = {
    "Blade": "section",
    "BodyCut": "solver",
    "BodyPiece": "solver",
    "BodySnapshot": "solver",
    "Cage": "cage",
    "CageBody": "solver",
    "CageEdit": "cage",
    "Capacity": "solver",
    "ConstitutiveModel": "elastic",
    "Cut": "cage",
    "CutReport": "solver",
    "HarmonicCoordinates": "harmonic",
    "Material": "elastic",
    "PlanEntry": "solver",
    "SolverCageCut": "solver",
    "Surface": "surface",
    "UpdateStats": "harmonic",
    "add_cage_body": "solver",
    "add_usd": "stage",
    "read_cage": "files",
    "read_mesh": "files",
    "wrap_cage": "wrap",
}

__all__ = ["__version__", *_ROOMS]


def __getattr__(name: str) -> object:
    """Import a public name's room when it is first used: coordinates alone never import Newton."""
    if name not in _ROOMS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f".{_ROOMS[name]}", __name__), name)


def __dir__() -> list[str]:
    """The public names, those that have not been imported yet among them."""
    return sorted(__all__)

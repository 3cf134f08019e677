# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The six scenes of Table 1 of the paper: cages, embedded meshes and cuts, with the paper's figures beside them.

The shapes are those of ``assets/``, with the paper's counts. Where the paper places its cuts can only be seen in its
figures 1, 11, 12 and 16 to 19. These here are of the same kinds, at places where about as many walks are walked again
as the paper says.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from assets.dude import HAT_HEIGHT
from assets.octopus import arm_curve
from newton_cagecut import Blade, Cage
from newton_cagecut.report.paper.published import TABLE_1, PaperRow
from newton_cagecut.usd import read_cage, read_mesh

ASSETS = Path(__file__).parent.parent / "assets"
DOWN = (0.0, 0.0, -1.0)


@dataclass(frozen=True)
class BenchmarkScene:
    """A cage, what is in it, and how it is cut.

    Attributes:
        name: The paper's name of it, in small letters; that of its files too.
        description: What is cut, in a few words.
        blades: The cuts, one after the other.
        paper: What the paper measured.
    """

    name: str
    description: str
    blades: tuple[Blade, ...]
    paper: PaperRow

    @property
    def cage_path(self) -> Path:
        """The file of the cage."""
        return ASSETS / f"{self.name}_cage.usda"

    @property
    def mesh_path(self) -> Path:
        """The file of the embedded mesh."""
        return ASSETS / f"{self.name}.usdc"

    @cached_property
    def cage(self) -> Cage:
        """The cage before the cuts."""
        return read_cage(self.cage_path)

    @cached_property
    def points(self) -> np.ndarray:
        """Vertices of the embedded mesh [m], shape ``(n, 3)``."""
        return read_mesh(self.mesh_path).points


def across_octopus_arm(arm: int, share: float, *, width: float | None = None) -> Blade:
    """Return a blade that goes down through an arm of the octopus, square to it.

    Args:
        arm: Which arm.
        share: Where, as a share of the arm's length.
        width: Of the blade [m]; one without ends meets other arms too at many places.
    """
    places, _, across = arm_curve(arm, 101)
    k = round(100 * share)
    return Blade(places[k], across[k], DOWN, width=width)


_CUTS = {
    "dude": (
        "loses his hat, cut off level from the side",
        Blade((0.0, 0.0, HAT_HEIGHT), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)),
    ),
    "starfish": (
        "loses an arm, 0.36 m from its middle",
        Blade((0.0, 0.36, 0.0), (1.0, 0.0, 0.0), DOWN),
    ),
    "key": (
        "cut through in three places: between its teeth, twice, and before them",
        *(Blade((place, 0.0, 0.0), (0.0, 1.0, 0.0), DOWN) for place in (0.365, 0.235, 0.02)),
    ),
    "octopus": (
        "loses the last sixth of an arm",
        across_octopus_arm(4, 0.84),
    ),
    "jelly": (
        "cut in half (adversarial)",
        Blade((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), DOWN),
    ),
    "sphere": (
        "cut in half (adversarial)",
        Blade((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), DOWN),
    ),
}

SCENES: dict[str, BenchmarkScene] = {
    name: BenchmarkScene(name, description, tuple(blades), TABLE_1[name])
    for name, (description, *blades) in _CUTS.items()
}
"""The scenes by their names, in the order of the table."""

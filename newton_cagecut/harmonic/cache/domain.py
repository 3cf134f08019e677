# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The domain of the walks: what they see of a cage, for all coordinates that follow the same edits of it."""

from __future__ import annotations

import numpy as np
import warp as wp

from ...cage import Cage, CageEdit
from ...geometry import as_choice, as_instance
from ..faces.face_tables import FaceTables
from ..options import DISTANCES, QUADS, as_device
from ..walls.frame import UnitFrame
from ..walls.grid import CandidateGrid
from ..walls.walls import Walls
from .domain_state import DomainState


class Domain:
    """Walls, grid and faces of a cage on a device; several sets of coordinates can share one.

    It owns the cage as it is now, ``quads`` and ``distance``. Coordinates hold the state that their weights are for,
    the present one unless they have missed an edit.

    Args:
        cage: The cage; it may have cuts already.
        quads: "mean_value" or "harmonic": how convex quads interpolate.
        distance: "grid" or "all": how the nearest wall is found.
        grid_resolution: Cells of the grid along the cage's longest side; by default, what suits the number of walls.
        device: Where to put them; Warp's current device by default.
        walls: The walls as edits have left them, of which a cut cage does not tell all; by default those of its faces.

    Raises:
        ValueError: An option is none of its choices.
    """

    def __init__(
        self,
        cage: Cage,
        *,
        quads: str = "mean_value",
        distance: str = "grid",
        device: wp.context.Devicelike = None,
        grid_resolution: int | None = None,
        walls: Walls | None = None,
    ) -> None:
        as_choice(distance, DISTANCES, "distance")
        as_choice(quads, QUADS, "quads")
        self.now = DomainState.of(
            cage,
            quads=quads,
            distance=distance,
            grid_resolution=grid_resolution,
            device=as_device(device),
            walls=walls,
        )

    @property
    def cage(self) -> Cage:
        """The cage as it is now."""
        return self.now.cage

    @property
    def quads(self) -> str:
        """How convex quads interpolate."""
        return self.now.quads

    @property
    def distance(self) -> str:
        """How the nearest wall is found."""
        return self.now.distance

    @property
    def device(self) -> wp.context.Device:
        """Where everything is."""
        return self.now.device

    @property
    def dimension(self) -> int:
        """Dimension of the space."""
        return self.cage.dimension

    @property
    def frame(self) -> UnitFrame:
        """The unit frame: that of the cage before any edit."""
        return self.now.frame

    @property
    def walls(self) -> Walls:
        """The walls as they are now."""
        return self.now.walls

    @property
    def grid(self) -> CandidateGrid:
        """The walls, indexed."""
        return self.now.grid

    @property
    def faces(self) -> FaceTables:
        """The cage's faces as they are now."""
        return self.now.faces

    @property
    def gated(self) -> bool:
        """Whether walls have become gates."""
        return self.walls.gate_count > 0

    @property
    def has_nested_faces(self) -> bool:
        """Whether any face needs a nested walk."""
        return self.faces.nested_count > 0

    def distance_to_walls(self, points: np.ndarray) -> np.ndarray:
        """Distance of rest positions [m] to the nearest wall [m], shape (n,)."""
        return self.now.distance_to_walls(points)

    def after(self, edit: CageEdit) -> DomainState:
        """The state after an edit, which is the present one if other coordinates have brought the edit here already.

        Raises:
            ValueError: The edit starts from another cage than the present one, or walls were retired too often.
        """
        change = self.now.change
        return self.now if change is not None and change.edit is edit else self.now.after(edit)


def domain_of(cage: Cage | Domain, *, quads: str | None, distance: str | None, device: wp.context.Devicelike) -> Domain:
    """The domain that was passed, or a new one around a cage.

    Args:
        cage: The cage or the domain.
        quads: See ``Domain``; None for what it has, or by default.
        distance: Likewise.
        device: Likewise.

    Raises:
        TypeError: It is neither.
        ValueError: The domain has another one of them.
    """
    as_instance(cage, (Cage, Domain), "cage", hint="the cage comes first: HarmonicCoordinates(cage, points)")
    given = {"quads": quads, "distance": distance, "device": None if device is None else as_device(device)}
    given = {name: value for name, value in given.items() if value is not None}
    if not isinstance(cage, Domain):
        return Domain(cage, **given)
    for name, value in given.items():
        own = getattr(cage, name)
        if value != own:
            raise ValueError(
                f"{name}={str(value)!r}, but the domain has {str(own)!r}: leave it out, or make another domain"
            )
    return cage

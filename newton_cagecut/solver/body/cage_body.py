# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""A cage body as users see it."""

from __future__ import annotations

import newton
import numpy as np
import warp as wp

from ...cage import Cage
from ...elastic import Energy, Material
from ...geometry import as_points, check_finite
from ...harmonic import HarmonicCoordinates
from ...surface import Surface
from .body_pieces import BodyPiece, body_pieces
from .simulated_body import SimulatedBody


class CageBody:
    """A view of one body of a solver; see ``SolverCageCut.bodies``.

    What it hands out is the body as it is now. Cages and surfaces are immutable: cuts replace them.
    """

    def __init__(self, simulated: SimulatedBody) -> None:
        self._simulated = simulated

    def __repr__(self) -> str:
        return f"CageBody(label={self.label!r}, cage={self.cage!r})"

    @property
    def label(self) -> str:
        """Name of the body."""
        return self._simulated.label

    @property
    def cage(self) -> Cage:
        """The cage, in its rest frame."""
        return self._simulated.cage

    @property
    def surface(self) -> Surface:
        """The embedded surface, in the cage's rest frame."""
        return self._simulated.surface

    @property
    def pieces(self) -> tuple[BodyPiece, ...]:
        """The pieces that the body is in, in the order of their lowest cage vertices."""
        return body_pieces(self._simulated)

    @property
    def material(self) -> Material:
        """The elastic material."""
        return self._simulated.definition.material

    @property
    def fixed(self) -> np.ndarray:
        """Which cage vertices are fixed, shape (vertex_count,), bool; a copy."""
        return self._simulated.fixed.numpy()[: self.cage.vertex_count] != 0

    @property
    def coordinates(self) -> HarmonicCoordinates:
        """The harmonic coordinates: of the quadrature points first, then of the surface's points."""
        return self._simulated.coordinates

    @property
    def surface_weights(self) -> np.ndarray:
        """Weights of the sites of the surface, shape (site_count, vertex_count), float32; a copy."""
        first = self._simulated.surface_row
        return self.coordinates.weights[first : first + self.surface.site_count]

    @property
    def quadrature_count(self) -> int:
        """Number of quadrature points, spare ones included; 0 without elasticity."""
        return self._simulated.quadrature_count

    @property
    def device(self) -> wp.Device:
        """Where the body is simulated."""
        return self._simulated.device

    @property
    def is_plane(self) -> bool:
        """Whether the body is a plane one, in plane strain."""
        return self._simulated.is_plane

    @property
    def vertices(self) -> slice:
        """The particles that stand for the cage's vertices, with those reserved for cuts at the end."""
        return self._simulated.vertices

    @property
    def surface_particles(self) -> slice | None:
        """The particles that stand for the surface's points, with those reserved; None without a contact radius."""
        return self._simulated.surface_particles if self._simulated.has_contact else None

    def energy(self, state: newton.State) -> Energy:
        """Elastic and kinetic energy in a state [J], read on the host.

        Args:
            state: A state of the body's model.

        Raises:
            ValueError: The state missed an edit of the body.
        """
        return self._simulated.energy(state)

    def to_world(self, points: np.ndarray) -> np.ndarray:
        """Rest positions in the world [m], shape (n, 3), of points of the cage's rest frame.

        Args:
            points: The points [m], shape (n, dimension).

        Raises:
            TypeError: They are not numbers.
            ValueError: They have another shape or are not finite.
        """
        points = as_points(points, "points", rows="n", widths=(self.cage.dimension,))
        check_finite(points, "points", row="point")
        return self._simulated.to_world(points)

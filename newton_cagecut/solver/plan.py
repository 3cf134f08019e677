# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The plan of a scene: what is on, what was left out and why, and the bytes of each."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from .body.simulated_body import SimulatedBody


class PlanEntry(NamedTuple):
    """One feature of one body.

    Args:
        body: Label of the body.
        feature: The feature.
        on: Whether the scene uses it.
        reason: Why.
        byte_count: Bytes that it takes on the device.
    """

    body: str
    feature: str
    on: bool
    reason: str
    byte_count: int

    def __str__(self) -> str:
        """One line of a table."""
        mark = "on " if self.on else "off"
        return f"{self.body:<20} {self.feature:<16} {mark} {self.byte_count / 1e6:>9.2f} MB  {self.reason}"


def plan_of(body: SimulatedBody) -> list[PlanEntry]:
    """The plan of one body."""
    definition, memory = body.definition, body.coordinates.memory()
    cuttable, elastic, contact = definition.cuttable, body.system is not None, body.contact is not None
    rows = (
        ("weights", True, f"{body.coordinates.point_count} points", memory["weights"]),
        (
            "walk cache",
            cuttable,
            "the body can be cut" if cuttable else "cuttable=False",
            memory["landings"] + memory["bounds"],
        ),
        ("walls and grid", True, "distance queries", memory["walls"] + memory["grid"]),
        (
            "elasticity",
            elastic,
            f"{body.quadrature_count} quadrature points" if elastic else "quadrature=0: the cage is keyframed",
            memory["gradients"],
        ),
        ("third dimension", not body.is_plane, _space_reason(body), 0),
        (
            "nested walks",
            body.coordinates.walks > 0 and body.coordinates.domain.has_nested_faces,
            _faces_reason(body),
            0,
        ),
        (
            "contact",
            contact,
            "contact_radius was given" if contact else "no contact_radius",
            body.contact.byte_count if contact else 0,
        ),
    )
    return [PlanEntry(body.label, *row) for row in rows]


def _space_reason(body: SimulatedBody) -> str:
    """Why a body has a third dimension, or has none."""
    if body.is_plane:
        return f"a plane cage: plane strain, {body.definition.thickness:g} m thick, no caps"
    return "the body is solid"


def _faces_reason(body: SimulatedBody) -> str:
    """Why walks go on in faces, or do not."""
    if body.is_plane:
        return "all faces are segments"
    if body.coordinates.walks == 0:
        return "the weights are fitted, nothing is walked"
    if body.coordinates.domain.has_nested_faces:
        return "faces with slits or more than four sides"
    return "all faces are triangles or convex quads"

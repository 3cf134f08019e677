# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The plan of a scene: what is on, what was left out and why, and the bytes of each.

The bytes are those of every array that a body holds, whoever made it: each is counted once, for the feature whose
attributes lead to it, and what is there for later cuts alone counts as room for cuts.
"""

from __future__ import annotations

import sys
from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

from ..harmonic import choose_correction
from .held_arrays import HeldArray, held_arrays

if TYPE_CHECKING:
    from .body.edit_stamps import EditStamps
    from .body.simulated_body import SimulatedBody
    from .body.step_watch import StepWatch

_USD = f"{__package__.split('.')[0]}.usd"


class PlanEntry(NamedTuple):
    """One feature of one body, or of the whole scene.

    Args:
        body: Label of the body; empty for the scene.
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
        return f"{self.body or '(scene)':<20} {self.feature:<16} {mark} {self.byte_count / 1e6:>9.2f} MB  {self.reason}"


def plan_of(body: SimulatedBody) -> list[PlanEntry]:
    """The plan of one body; the bytes of all entries sum to those of all arrays that it holds.

    Args:
        body: The body.
    """
    sizes = _sizes(body)
    rows = (
        ("weights", True, f"{body.coordinates.point_count} points"),
        ("gradients", body.quadrature_count > 0, _quadrature_reason(body, "quadrature points alone have them")),
        ("walk cache", body.definition.cuttable, _cache_reason(body)),
        ("walls and grid", True, "distance queries"),
        ("fitted weights", _is_fitted(body), _fit_reason(body)),
        ("nested walks", body.coordinates.walks > 0 and body.coordinates.domain.has_nested_faces, _faces_reason(body)),
        ("quadrature", body.quadrature_count > 0, _quadrature_reason(body, f"{body.quadrature_count} points")),
        ("elasticity", body.system is not None, _quadrature_reason(body, f"{body.definition.material.model}")),
        ("third dimension", not body.is_plane, _space_reason(body)),
        ("surface", True, f"{len(body.surface.triangles)} triangles"),
        ("caps", not body.is_plane and body.definition.cuttable, _caps_reason(body)),
        ("contact", body.contact is not None, _contact_reason(body)),
        ("room for cuts", sizes["room for cuts"] > 0, _room_reason(body)),
        ("vertices", True, f"{body.cage.vertex_count} of the cage"),
    )
    assert set(sizes) <= {feature for feature, *_ in rows}
    return [PlanEntry(body.label, feature, on, reason, sizes[feature]) for feature, on, reason in rows]


def plan_of_scene(stamps: EditStamps, watch: StepWatch) -> list[PlanEntry]:
    """What all bodies of a scene have in common.

    Args:
        stamps: The numbers of the bodies' edits.
        watch: The statistics of their steps.
    """
    usd = _USD in sys.modules
    size = sum(held.byte_count for held in held_arrays(stamps))
    counts = sum(held.byte_count for held in held_arrays(watch, without=tuple(watch.systems)))
    reason = "elastic steps are counted" if watch.systems else "no body is elastic"
    return [
        PlanEntry("", "edit numbers", True, "states that missed an edit are told apart", size),
        PlanEntry("", "step statistics", bool(watch.systems), reason, counts),
        PlanEntry("", "USD", usd, "its room was imported" if usd else "nothing has imported its room", 0),
    ]


def _sizes(body: SimulatedBody) -> Counter:
    """Bytes of each feature."""
    sizes, axes = Counter({"room for cuts": 0}), _axes(body)
    for held in held_arrays(body, without=(body.model, body._stamps)):
        used = held.byte_count
        for length in held.array.shape:
            capacity_use = axes.get(length)
            if capacity_use is not None:
                used = used * capacity_use // length
        sizes[_feature(held)] += used
        sizes["room for cuts"] += held.byte_count - used
    return sizes


def _axes(body: SimulatedBody) -> dict[int, int]:
    """Lengths of axes that have room to spare, and how much of each is in use."""
    capacity, quadrature = body.capacity, body.quadrature_count
    used_quadrature = body.quadrature.used_count if body.quadrature is not None else 0
    points, used_points = quadrature + capacity.surface_points, used_quadrature + body.surface.site_count
    walks = body.definition.walks
    pairs = (
        (capacity.surface_triangles, len(body.surface.triangles)),
        (capacity.surface_points, body.surface.site_count),
        (capacity.vertices, body.cage.vertex_count),
        (quadrature, used_quadrature),
        (points, used_points),
        (points * walks, used_points * walks),
    )
    return {length: used for length, used in pairs if used < length}


def _feature(held: HeldArray) -> str:
    """The feature that an array belongs to."""
    first, path = held.path[0], set(held.path)
    if first == "system":
        return "elasticity"
    if first == "contact":
        return "contact"
    if first == "uncut":
        return "walk cache"
    if first in ("_triangles", "_surface_buffer"):
        return "surface"
    if first != "coordinates":
        return "vertices"
    if path & {"fit", "residuals", "memory", "fitted_rows"}:
        return "fitted weights"
    if "records" in path:
        return "walk cache"
    if held.path[-1] == "gradients":
        return "gradients"
    return "walls and grid" if path & {"domain", "_state"} else "weights"


def _is_fitted(body: SimulatedBody) -> bool:
    """Whether the weights are those of a boundary fit."""
    return body.definition.options.get("correction") == "fitted"


def _fit_reason(body: SimulatedBody) -> str:
    """Why there is a boundary fit, or none, and what suits the cage."""
    choice = choose_correction(body.definition.cage)
    if _is_fitted(body):
        return f'correction="fitted"; {choice.reason}'
    hint = ', which correction="auto" would choose' if choice.correction == "fitted" else ""
    return f"the weights are walked for; {choice.reason}{hint}"


def _cache_reason(body: SimulatedBody) -> str:
    """Why walks are kept, or are not."""
    return "the body can be cut" if body.definition.cuttable else "cuttable=False"


def _quadrature_reason(body: SimulatedBody, reason: str) -> str:
    """The reason given, or why there are no quadrature points."""
    return reason if body.quadrature_count else "quadrature=0: the cage is keyframed"


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


def _caps_reason(body: SimulatedBody) -> str:
    """Why cuts get caps, or do not."""
    if body.is_plane:
        return "a plane surface has an edge where it is cut"
    return "cuts close the surface" if body.definition.cuttable else "cuttable=False"


def _contact_reason(body: SimulatedBody) -> str:
    """Why shapes push the body, or do not."""
    return "contact_radius was given" if body.has_contact else "no contact_radius"


def _room_reason(body: SimulatedBody) -> str:
    """What room is reserved."""
    if not body.definition.cuttable:
        return "cuttable=False"
    vertices = body.capacity.vertices - body.cage.vertex_count
    return f"{vertices} vertices, {body.capacity.surface_points - body.surface.site_count} surface points to come"

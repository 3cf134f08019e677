# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Checks that the segments of a plane cage are closed loops that touch neither themselves nor each other.

Section 4 of the paper works in cages of line segments. As in space, input is checked once, and the culprits named.
"""

from __future__ import annotations

import numpy as np

from ...geometry import PolygonMesh, edge_distances, near_pairs


def check_closed(mesh: PolygonMesh) -> None:
    """Check that at every vertex one segment arrives and one leaves.

    Args:
        mesh: The cage's segments.

    Raises:
        ValueError: If a loop is open, branches or changes its direction.
    """
    start, end = mesh.face_vertex[0::2], mesh.face_vertex[1::2]
    leaving = np.bincount(start, minlength=mesh.vertex_count)
    arriving = np.bincount(end, minlength=mesh.vertex_count)
    bad = np.flatnonzero((leaving != 1) | (arriving != 1))
    if len(bad) == 0:
        return
    by_count = bad[np.argsort(-(leaving + arriving)[bad], kind="stable")]
    vertex = int(by_count[0])
    faces = np.flatnonzero((start == vertex) | (end == vertex)).tolist()
    if len(faces) > 2:
        raise ValueError(
            f"vertex {vertex} of the cage joins {len(faces)} segments (faces {faces}), but a loop has two there; "
            "give each loop a vertex of its own"
        )
    if len(faces) == 2:
        what = "end at" if arriving[vertex] else "start from"
        raise ValueError(
            f"faces {faces[0]} and {faces[1]} of the cage both {what} vertex {vertex}: they are not consistently "
            "oriented; reverse one of them"
        )
    raise ValueError(
        f"the cage is open: vertex {vertex} belongs to face {faces[0]} only; close the loop so that one segment "
        "arrives there and one leaves"
    )


def check_crossings(mesh: PolygonMesh, tolerance: float) -> None:
    """Check that no segment crosses or touches another, except its neighbours at their common vertices.

    Args:
        mesh: The cage's segments, in closed loops.
        tolerance: Length below which two things coincide [m].

    Raises:
        ValueError: If two segments meet.
    """
    ends = mesh.vertices[mesh.face_vertex].reshape(-1, 2, 2)
    follower = np.empty(mesh.face_count, dtype=np.int64)
    follower[np.argsort(mesh.face_vertex[1::2])] = np.argsort(mesh.face_vertex[0::2])
    _check_folds(mesh, ends[:, 1] - ends[:, 0], follower, tolerance)
    for one, other in near_pairs(ends, ends, tolerance):
        apart = (one < other) & (follower[one] != other) & (follower[other] != one)
        one, other = one[apart], other[apart]
        meet = np.flatnonzero(edge_distances(ends[one], ends[other]) <= tolerance)
        if len(meet):
            _refuse(mesh, int(one[meet[0]]), int(other[meet[0]]), "meet; move the vertices apart")


def _check_folds(mesh: PolygonMesh, out: np.ndarray, follower: np.ndarray, tolerance: float) -> None:
    """Check that no segment runs back along the one before it."""
    onward = out[follower]
    turn = out[:, 0] * onward[:, 1] - out[:, 1] * onward[:, 0]
    longer = np.maximum(np.hypot(*out.T), np.hypot(*onward.T))
    back = np.flatnonzero((np.abs(turn) <= tolerance * longer) & ((out * onward).sum(axis=1) < 0.0))
    if len(back):
        _refuse(mesh, int(back[0]), int(follower[back[0]]), "run back along each other; remove the spike")


def _refuse(mesh: PolygonMesh, one: int, two: int, what: str) -> None:
    ends = mesh.face_vertex.reshape(-1, 2)
    first, second = (f"{face} {tuple(ends[face].tolist())}" for face in (one, two))
    raise ValueError(f"faces {first} and {second} of the cage {what}")

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The section of the segments around a plane body with the line that a blade sweeps.

Section 4 of the paper cuts cages of line segments. Nodes are crossed segments; chords are the intervals of the line
inside the body, from the node where the line enters to the one where it leaves. They run through no face, so that the
tip of a cut lies inside the body, and only the segments at their ends are split.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..geometry import PolygonMesh
from .blade import BladePlane
from .hinge import Hinge
from .nodes import Nodes
from .pairing import alternate
from .section import Section


def section_of_segments(
    mesh: PolygonMesh,
    plane: BladePlane,
    *,
    vertex_piece: np.ndarray,
    hinge: Hinge | None = None,
    start: float = -np.inf,
    tolerance: float = 0.0,
) -> Section:
    """Cut a plane body's segments with a line.

    Args:
        mesh: The segments, in closed loops.
        plane: The line.
        vertex_piece: Solid piece of each vertex, shape (vertex_count,).
        hinge: Tip of an earlier cut from which this one goes on, at ``s = 0``.
        start: Coordinate s behind which nothing is cut [m].
        tolerance: Distance that the start keeps from nodes [m].

    Raises:
        ValueError: If the start lies inside the body, or the section does not close at the hinge.
    """
    distance = plane.distance(mesh.vertices)
    origin, end = mesh.face_vertex[0::2], mesh.face_vertex[1::2]
    crosses = (distance[origin] >= 0.0) != (distance[end] >= 0.0)
    parted = np.zeros(0, dtype=np.int64)
    if hinge is not None:
        on_hinge = np.zeros(mesh.vertex_count, dtype=bool)
        on_hinge[hinge.vertices] = True
        crosses &= ~(on_hinge[origin] | on_hinge[end])
        parted = 2 * np.flatnonzero(on_hinge[origin])
    half_edge = 2 * np.flatnonzero(crosses)
    nodes = Nodes.on_edges(mesh, plane, distance, half_edge)
    if hinge is not None:
        half_edge = half_edge[nodes.coordinates[:, 1] > 0.0]
        nodes = Nodes.on_edges(mesh, plane, distance, half_edge)
    enters = np.append(distance[mesh.face_vertex[half_edge]] >= 0.0, np.ones(len(parted), dtype=bool))
    parted_node = nodes.count + np.arange(len(parted))
    nodes = nodes.with_vertices(mesh, plane, parted)
    chords = _join_chords(mesh, vertex_piece, nodes, enters)
    count, none = len(chords), np.zeros(0, dtype=np.int64)
    section = Section(
        mesh=mesh,
        plane=plane,
        nodes=nodes,
        arrive=half_edge,
        leave=mesh.next[half_edge],
        chord_slot=np.full((count, 2), -1),
        chord_face=np.full(count, -1),
        chord_node=chords,
        chord_next=np.full(count, -1),
        chord_group=np.zeros(count, dtype=np.int64),
        parted=parted,
        parted_node=parted_node,
        hinge_corner=none,
    )
    return _begun_at(section, start, tolerance) if np.isfinite(start) else section


def _join_chords(mesh: PolygonMesh, vertex_piece: np.ndarray, nodes: Nodes, enters: np.ndarray) -> np.ndarray:
    """Pair entries and exits, piece by piece; nodes of the chords in the order of the line, shape (chord_count, 2)."""
    vertex = mesh.face_vertex[nodes.half_edge]
    piece, along, pairs = vertex_piece[vertex], nodes.coordinates[:, 1], [np.zeros((0, 2), dtype=np.int64)]
    for number in np.unique(piece).tolist():
        mine = np.flatnonzero(piece == number)
        entries = np.count_nonzero(enters[mine])
        if 2 * entries != len(mine):
            raise ValueError(
                "the section does not close at the tip of the cut before it: the line leaves the piece of vertex "
                f"{vertex[mine[0]]} {len(mine) - entries} times and enters it {entries} times; move the blade a "
                "little, or begin a new cut where the cage has grown across the tip"
            )
        pairs.append(mine[np.array(alternate(along[mine], enters[mine]))])
    chords = np.concatenate(pairs)
    return chords[np.argsort(along[chords[:, 0]], kind="stable")]


def _begun_at(section: Section, start: float, tolerance: float) -> Section:
    """The section without the chords that end before the blade's start, which must not lie inside one."""
    first, last = section.nodes.coordinates[section.chord_node, 1].T
    ahead = first > start - tolerance
    inside = ~ahead & (last > start + tolerance)
    if inside.any():
        low, high = first[inside][0], last[inside][0]
        raise ValueError(
            f"the blade starts inside the body, at {start:g} between {low:g} and {high:g} along its line: the cut "
            "would touch no face; move the start to where the line is outside"
        )
    used = np.zeros(section.node_count, dtype=bool)
    used[section.chord_node[ahead]] = True
    place = np.cumsum(used) - 1
    goes_on = used[section.parted_node]
    return replace(
        section,
        nodes=section.nodes.only(np.flatnonzero(used)),
        chord_slot=section.chord_slot[ahead],
        chord_face=section.chord_face[ahead],
        chord_node=place[section.chord_node[ahead]],
        chord_next=section.chord_next[ahead],
        chord_group=section.chord_group[ahead],
        parted=section.parted[goes_on],
        parted_node=place[section.parted_node[goes_on]],
        window=(-np.inf, np.inf, start),
    )

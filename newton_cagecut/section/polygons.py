# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The section of a polygon mesh with the plane of a blade.

Section 5.2 of the paper. Which crossings a chord joins is decided by entering and leaving, never by comparing positions
of features that coincide; so earlier cuts, whose two sides coincide, need no care.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import PolygonMesh, dots
from .blade import BladePlane
from .hinge import Hinge, corner_ahead, corners_to_part, crosses_ahead
from .nodes import Nodes
from .pairing import alternate
from .section import Section

_NONE = np.zeros(0, dtype=np.int64)


@dataclass(frozen=True, eq=False)
class _Crossings:
    """Where loops of the mesh pass through the plane, those at a hinge's vertices last."""

    arrive: np.ndarray
    leave: np.ndarray
    goes_down: np.ndarray
    node: np.ndarray
    plain_count: int
    """Number of those that are not at a hinge."""


@dataclass(frozen=True, eq=False)
class _Start:
    """What of a section begins at a hinge."""

    corner: np.ndarray
    parted: np.ndarray
    parted_node: np.ndarray
    chords: np.ndarray
    """Nodes from and to which the section runs along the hinge, shape (edge_count, 2)."""


def section_of_polygons(
    mesh: PolygonMesh,
    plane: BladePlane,
    *,
    face_group: np.ndarray | None = None,
    hinge: Hinge | None = None,
    tolerance: float = 0.0,
) -> Section:
    """Cut a mesh's edges with a plane.

    Args:
        mesh: The polygons, closed or open.
        plane: The plane.
        face_group: Number of the solid that each face bounds, where solids may overlap, shape (face_count,).
        hinge: Front of an earlier cut from which this one goes on, at ``s = 0``.
        tolerance: Distance up to which vertices count as on the plane [m].

    Raises:
        ValueError: If the section does not close at the hinge.
    """
    distance = plane.distance(mesh.vertices)
    distance[np.abs(distance) <= tolerance] = 0.0
    crossings, nodes = _find_crossings(mesh, plane, distance, hinge)
    start = _Start(_NONE, _NONE, _NONE, np.zeros((0, 2), dtype=np.int64))
    if hinge is not None:
        crossings, nodes, start = _go_on_from(mesh, plane, hinge, crossings, nodes)
    slot, face = _join_chords(mesh, plane, crossings, nodes)
    none = np.full_like(start.chords, -1)
    chord_node = np.concatenate([crossings.node[slot], start.chords])
    chord_slot, chord_face = np.concatenate([slot, none]), np.concatenate([face, none[:, 0]])
    chord_next = _follow(mesh, crossings, chord_slot, chord_node, nodes.count)
    return Section(
        mesh=mesh,
        plane=plane,
        nodes=nodes,
        arrive=crossings.arrive,
        leave=crossings.leave,
        chord_slot=chord_slot,
        chord_face=chord_face,
        chord_node=chord_node,
        chord_next=chord_next,
        chord_group=_groups(face_group, chord_face, chord_next),
        parted=start.parted,
        parted_node=start.parted_node,
        hinge_corner=start.corner,
    )


def _find_crossings(
    mesh: PolygonMesh, plane: BladePlane, distance: np.ndarray, hinge: Hinge | None
) -> tuple[_Crossings, Nodes]:
    """The half-edges that cross the plane, ahead of the hinge if there is one, and a node for each edge."""
    positive = distance >= 0.0
    starts_positive = positive[mesh.face_vertex]
    crosses = starts_positive != starts_positive[mesh.next]
    if hinge is None:
        half_edge = np.flatnonzero(crosses)
    else:
        on_hinge = np.zeros(mesh.vertex_count, dtype=bool)
        on_hinge[hinge.vertices] = True
        half_edge = np.flatnonzero(crosses & ~(on_hinge[mesh.face_vertex] | on_hinge[mesh.destination]))
        s = Nodes.on_edges(mesh, plane, distance, half_edge).coordinates[:, 1]
        half_edge = half_edge[crosses_ahead(mesh, plane, on_hinge, half_edge, s)]
    twin = mesh.twin[half_edge]
    edge, node = np.unique(np.where(twin >= 0, np.minimum(twin, half_edge), half_edge), return_inverse=True)
    crossings = _Crossings(half_edge, mesh.next[half_edge], starts_positive[half_edge], node, len(half_edge))
    return crossings, Nodes.on_edges(mesh, plane, distance, edge)


def _go_on_from(
    mesh: PolygonMesh, plane: BladePlane, hinge: Hinge, crossings: _Crossings, nodes: Nodes
) -> tuple[_Crossings, Nodes, _Start]:
    """Add nodes at the hinge's vertices, and crossings in the faces into which the section goes on from them.

    Those are the faces that the plane enters and does not leave, or the other way round.
    """
    sign = np.where(crossings.goes_down, 1.0, -1.0)
    balance = np.bincount(mesh.face[crossings.arrive], weights=sign, minlength=mesh.face_count)
    corner = _corners_ahead(mesh, plane, hinge, balance)
    vertex, down = mesh.face_vertex[corner], balance[mesh.face[corner]] < 0.0
    number = nodes.count + np.arange(len(corner))
    node_at = np.full(mesh.vertex_count, -1)
    node_at[vertex] = number
    chords = np.stack([node_at[mesh.destination[hinge.edges]], node_at[mesh.face_vertex[hinge.edges]]], axis=1)
    edges = np.concatenate([hinge.edges, mesh.twin[hinge.edges]])
    parted = [corners_to_part(mesh, edges, *item) for item in zip(corner.tolist(), down.tolist(), strict=True)]
    if (chords < 0).any():
        raise ValueError("the plane does not go on from all of the front of the cut before it; turn it less")
    previous = np.empty_like(mesh.next)
    previous[mesh.next] = np.arange(len(previous))
    joined = _Crossings(
        np.concatenate([crossings.arrive, previous[corner]]),
        np.concatenate([crossings.leave, mesh.next[corner]]),
        np.concatenate([crossings.goes_down, down]),
        np.concatenate([crossings.node, number]),
        crossings.plain_count,
    )
    start = _Start(
        corner,
        np.array([c for part in parted for c in part], dtype=np.int64),
        np.repeat(number, [len(part) for part in parted]),
        chords,
    )
    return joined, nodes.with_vertices(mesh, plane, corner), start


def _corners_ahead(mesh: PolygonMesh, plane: BladePlane, hinge: Hinge, balance: np.ndarray) -> np.ndarray:
    """The corner at each of the hinge's vertices into which the section goes on, in order of the vertices.

    Args:
        mesh: The polygons.
        plane: The plane.
        hinge: The hinge.
        balance: Crossings of each face that go down, less those that go up, shape (face_count,).
    """
    on_hinge = np.zeros(mesh.vertex_count, dtype=bool)
    on_hinge[hinge.vertices] = True
    corner = np.flatnonzero(on_hinge[mesh.face_vertex] & (balance[mesh.face] != 0.0))
    _, chosen, count = np.unique(mesh.face_vertex[corner], return_index=True, return_counts=True)
    several = mesh.face_vertex[corner[chosen[count > 1]]].tolist()
    of_several = {vertex: corner[mesh.face_vertex[corner] == vertex].tolist() for vertex in several}
    corner = corner[chosen]
    corner[count > 1] = [corner_ahead(mesh, of_several[vertex], plane) for vertex in several]
    if len(corner) != np.abs(balance).sum():
        raise ValueError(
            "the section does not close at the front of the cut before it: faces "
            f"{np.flatnonzero(balance).tolist()[:4]} have no corner of their own there; move the blade a "
            "little, or begin a new cut where the cage has grown across the front"
        )
    return corner


def _join_chords(
    mesh: PolygonMesh, plane: BladePlane, crossings: _Crossings, nodes: Nodes
) -> tuple[np.ndarray, np.ndarray]:
    """Pair the crossings of each face: crossings from and to which chords run, and the face of each chord."""
    face = mesh.face[crossings.arrive]
    slot = np.arange(len(face))
    down, up = slot[crossings.goes_down], slot[~crossings.goes_down]
    crowded = np.bincount(face, minlength=mesh.face_count) // 2 > 1
    plain_down, plain_up = down[~crowded[face[down]]], up[~crowded[face[up]]]
    plain_down = plain_down[np.argsort(face[plain_down], kind="stable")]
    plain_up = plain_up[np.argsort(face[plain_up], kind="stable")]
    pairs = [np.stack([plain_down, plain_up], axis=1)]
    for f in np.flatnonzero(crowded).tolist():
        mine = slot[face == f]
        line = np.cross(plane.normal, mesh.face_area_vector[f])
        position = nodes.position[crossings.node[mine]] - mesh.vertices[mesh.face_vertex[mesh.face_start[f]]]
        pairs.append(mine[np.array(alternate(dots(position, line), crossings.goes_down[mine]))])
    joined = np.concatenate(pairs)
    joined = joined[np.argsort(joined[:, 0], kind="stable")]
    return joined, face[joined[:, 0]]


def _follow(
    mesh: PolygonMesh, crossings: _Crossings, slots: np.ndarray, nodes: np.ndarray, node_count: int
) -> np.ndarray:
    """Chord that continues each chord, -1 at an open edge, shape (chord_count,)."""
    plain = crossings.plain_count
    chord_at = np.full(len(crossings.arrive) + 1, -1)
    in_face, along = np.flatnonzero(slots[:, 0] >= 0), np.flatnonzero(slots[:, 0] < 0)
    chord_at[slots[in_face, 0]] = in_face
    end = slots[in_face, 1]
    twin = np.where(end < plain, mesh.twin[crossings.arrive[end]], -1)
    slot = np.searchsorted(crossings.arrive[:plain], twin)
    following = np.full(len(slots), -1)
    following[in_face] = np.where(twin >= 0, chord_at[np.minimum(slot, plain)], -1)
    if len(along):
        node_chord = np.full(node_count, -1)
        node_chord[nodes[along, 0]] = along
        ends_there = in_face[end >= plain]
        following[ends_there] = node_chord[nodes[ends_there, 1]]
        starts_there = in_face[slots[in_face, 0] >= plain]
        node_chord[nodes[starts_there, 0]] = starts_there
        following[along] = node_chord[nodes[along, 1]]
    return following


def _groups(face_group: np.ndarray | None, chord_face: np.ndarray, chord_next: np.ndarray) -> np.ndarray:
    """Number of the solid of each chord; those along the hinge are of the next one's, shape (chord_count,)."""
    if face_group is None:
        return np.zeros(len(chord_face), dtype=np.int64)
    group = face_group[chord_face]
    along = np.flatnonzero(chord_face < 0)
    group[along] = group[chord_next[along]]
    return group

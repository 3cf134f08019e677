# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Triangles of a surface that a cut splits or slits, and the caps of what it opens.

Section 6.3 of the paper splits the triangles that the cut crosses. In each triangle the cut is one segment: it splits
the triangle, slits it from an edge, or, where a knife ends inside it, slits it without meeting an edge. What becomes of
the triangle follows from that alone, whatever lengths are rounded to zero.
"""

from __future__ import annotations

import numpy as np

from ..geometry import triangulate
from ..section import Opening


def split_triangles(opening: Opening) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Split the triangles of the mesh of an opened section.

    Args:
        opening: The opened section of a triangle mesh.

    Returns:
        Triangles in the places of the old ones, shape (triangle_count, 3), further ones, shape (added_count, 3), and
        the old one of each of those, shape (added_count,).
    """
    kept = opening.faces.face_vertex.reshape(-1, 3).copy()
    if not len(opening.faces.touched):
        return kept, np.zeros((0, 3), dtype=np.int64), np.zeros(0, dtype=np.int64)
    inside = {int(opening.section.chord_face[chord]): (chord, slit) for chord, slit in opening.faces.slits}
    loops = [
        loop
        for face, loop in zip(opening.faces.touched.tolist(), opening.faces.first_loops, strict=True)
        if face not in inside
    ]
    owner = np.concatenate(
        [opening.faces.touched[~np.isin(opening.faces.touched, list(inside))], opening.faces.extra_face]
    ).astype(np.int64)
    loops += opening.faces.extra_loops
    size = np.array([len(loop) for loop in loops], dtype=np.int64)
    is_end = _slit_ends(opening)
    parts = [_around_slit(opening, chord, slit) for chord, slit in inside.values()]
    owners = [np.repeat(np.array(list(inside), dtype=np.int64), 7)]
    for corners in np.unique(size).tolist():
        which = np.flatnonzero(size == corners)
        parts.append(_split_alike(np.array([loops[i] for i in which]), opening, is_end))
        owners.append(np.repeat(owner[which], corners - 2))
    triangles, owners = np.concatenate(parts), np.concatenate(owners)
    order = np.argsort(owners, kind="stable")
    triangles, owners = triangles[order], owners[order]
    is_first = np.concatenate([[True], owners[1:] != owners[:-1]])
    kept[owners[is_first]] = triangles[is_first]
    return kept, triangles[~is_first], owners[~is_first]


def cap_triangles(opening: Opening) -> tuple[np.ndarray, np.ndarray]:
    """Triangles of both sides of an opened section, shape (triangle_count, 3), and the side of each.

    No edge within a cap joins two vertices that both sides share: it would be an edge of the other cap too.

    Args:
        opening: The opened section.
    """
    minus, plus = opening.vertices.sides
    parts, sides = [np.zeros((0, 3), dtype=np.int64)], [np.zeros(0, dtype=np.int8)]
    for loop in opening.region.polygons:
        corners = np.array(loop)
        corners = corners[triangulate(opening.region.coordinates[loop], apart=minus[corners] == plus[corners])]
        parts += [minus[corners], plus[corners[:, ::-1]]]
        sides += [np.full(len(corners), side, dtype=np.int8) for side in (0, 1)]
    return np.concatenate(parts), np.concatenate(sides)


def _slit_ends(opening: Opening) -> np.ndarray:
    """Whether each vertex, old or created, is one inside a triangle that sees all of it, where a slit ends or bends.

    Shape (vertex_count,).
    """
    section, numbering, region = opening.section, opening.vertices.numbering, opening.region
    is_end = np.zeros(section.mesh.vertex_count + opening.vertices.count, dtype=bool)
    pinned = np.flatnonzero(section.nodes.pinned & region.swept)
    is_end[numbering.plus[pinned]] = True
    is_end[numbering.tip[opening.vertices.tip_chords]] = True
    free = region.middles[~section.nodes.pinned[section.chord_node[region.middles]].any(axis=1)]
    is_end[numbering.middle_plus[free]] = is_end[numbering.middle_minus[free]] = True
    return is_end


def _split_alike(polygons: np.ndarray, opening: Opening, is_end: np.ndarray) -> np.ndarray:
    """Split polygons of equally many corners; the triangles of each come one after the other.

    Those with a slit's end start there: it sees all of the triangle, so that they are fans, which bend at the vertices
    beside the end where there are some.
    """
    count = polygons.shape[1]
    ends = is_end[polygons]
    if count == 3:
        return polygons
    if not ends.any():
        return _split_quads(polygons, opening)
    turned = np.take_along_axis(polygons, (ends.argmax(axis=1)[:, None] + np.arange(count)) % count, axis=1)
    fan = [[0, k, k + 1] for k in range(1, count - 1)]
    if count == 8:
        fan = [[0, 1, 3], [1, 2, 3], [0, 3, 4], [0, 4, 5], [0, 5, 7], [5, 6, 7]]
    return turned[:, fan].reshape(-1, 3)


def _split_quads(polygons: np.ndarray, opening: Opening) -> np.ndarray:
    """Quads, which are convex, split along their shorter diagonals."""
    points = opening.vertices.positions_of(polygons)
    across = np.linalg.norm(points[:, [0, 1]] - points[:, [2, 3]], axis=2)
    turned = np.where((across[:, 0] <= across[:, 1])[:, None], polygons, np.roll(polygons, -1, axis=1))
    return turned[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)


def _around_slit(opening: Opening, chord: int, slit: list[int]) -> np.ndarray:
    """The seven triangles around a slit that meets no edge of its triangle, shape (7, 3).

    The cut's line has one corner on one side and two on the other; the one sees its side of the slit whole, the two
    each the end that is nearer.
    """
    mesh, vertex = opening.section.mesh, opening.faces.face_vertex
    leaving, coming = opening.section.arrive[opening.section.chord_slot[chord]]
    near, side, far, other = slit
    if mesh.next[leaving] == coming:
        leaving, coming = coming, leaving
        near, side, far, other = far, other, near, side
    corner, left, right = vertex[leaving], vertex[mesh.next[leaving]], vertex[coming]
    return np.array(
        [
            [corner, near, side],
            [corner, side, far],
            [corner, left, near],
            [right, corner, far],
            [left, right, other],
            [right, far, other],
            [left, other, near],
        ]
    )

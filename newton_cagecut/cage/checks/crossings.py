# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Checks that a cage's faces do not cross themselves or each other.

Section 3 of the paper assumes it. Control cages in circulation often fail, so that input is checked once, and the
culprits named.
"""

from __future__ import annotations

import numpy as np

from ...geometry import PolygonMesh, edge_pierces, near_pairs, segments_meet

_CHUNK = 1 << 20


def check_simple_faces(mesh: PolygonMesh, corner: np.ndarray, tolerance: float) -> None:
    """Check that no face's loop crosses or touches itself.

    Args:
        mesh: The cage's polygons.
        corner: In-plane coordinates of every half-edge's origin, shape (half_edge_count, 2) [m].
        tolerance: Length below which two things coincide [m].

    Raises:
        ValueError: If two edges of a face that are not neighbours meet.
    """
    for size in np.unique(mesh.face_size[mesh.face_size > 3]).tolist():
        faces = np.flatnonzero(mesh.face_size == size)
        start = corner[mesh.face_start[faces][:, None] + np.arange(size)]
        end = np.roll(start, -1, axis=1)
        i, j = np.triu_indices(size, 2)
        apart = (i > 0) | (j < size - 1)
        i, j = i[apart], j[apart]
        step = max(1, _CHUNK // len(i))
        for begin in range(0, len(faces), step):
            block = slice(begin, begin + step)
            meet = segments_meet(start[block, i], end[block, i], start[block, j], end[block, j], tolerance)
            bad, pair = np.nonzero(meet)
            if len(bad):
                face = faces[begin + bad[0]]
                loop = mesh.face_vertex[mesh.face_start[face] : mesh.face_start[face + 1]].tolist()
                one, two = (f"({loop[k]}, {loop[(k + 1) % size]})" for k in (i[pair[0]], j[pair[0]]))
                raise ValueError(
                    f"face {face} of the cage intersects itself: its edges {one} and {two} meet; split the face"
                )


def check_face_pairs(mesh: PolygonMesh, triangles: np.ndarray, triangle_face: np.ndarray, tolerance: float) -> None:
    """Check that no edge of a face passes through another face.

    Args:
        mesh: The cage's polygons.
        triangles: The faces' triangles as vertex ids, shape (triangle_count, 3).
        triangle_face: Face of each triangle, shape (triangle_count,).
        tolerance: Length below which two things coincide [m].

    Raises:
        ValueError: If two faces intersect.
    """
    half = np.flatnonzero(np.arange(len(mesh.twin)) < mesh.twin)
    start, end = mesh.vertices[mesh.face_vertex[half]], mesh.vertices[mesh.destination[half]]
    corners = mesh.vertices[triangles]
    for row, column in near_pairs(np.stack([start, end], axis=1), corners, 0.0):
        through = edge_pierces(start[row], end[row], corners[column], tolerance)
        if through.any():
            hit = int(np.argmax(through))
            h = int(half[row[hit]])
            a, b = int(mesh.face_vertex[h]), int(mesh.destination[h])
            raise ValueError(
                f"faces {mesh.face[h]} and {triangle_face[column[hit]]} of the cage intersect: edge ({a}, {b}) of the "
                "first passes through the second; move the vertices apart"
            )


def check_nesting(vertices: np.ndarray, component: np.ndarray, volumes: np.ndarray, winding) -> None:
    """Check that bodies are side by side and cavities inside a body.

    Args:
        vertices: Positions, shape (vertex_count, dimension) [m].
        component: Component of each vertex, shape (vertex_count,).
        volumes: Volume, in 2D area, of each component, negative for a cavity, shape (component_count,) [m^d].
        winding: Function of points that gives their winding numbers about each component.

    Raises:
        ValueError: If a body lies inside another or a cavity outside every body.
    """
    if len(volumes) < 2:
        return
    first = np.unique(component, return_index=True)[1]
    number = np.rint(winding(vertices[first]))
    np.fill_diagonal(number, 0.0)
    around = number.sum(axis=1)
    bad = np.flatnonzero(around != np.where(volumes < 0.0, 1.0, 0.0))
    if len(bad):
        what = "inside out" if volumes[bad[0]] < 0.0 else "inside another one"
        size = "area" if vertices.shape[1] == 2 else "volume"
        raise ValueError(
            f"the component of vertex {first[bad[0]]} of the cage ({size} {volumes[bad[0]]:.6g}) lies {what}; "
            "reverse its faces, move it or remove it"
        )

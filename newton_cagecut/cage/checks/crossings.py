# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Checks that a cage's faces do not cross themselves or each other.

Section 3 of the paper assumes it. Control cages in circulation often fail, so that input is checked once, and the
culprits named.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...geometry import PolygonMesh

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
            meet = _segments_meet(start[block, i], end[block, i], start[block, j], end[block, j], tolerance)
            bad, pair = np.nonzero(meet)
            if len(bad):
                face = faces[begin + bad[0]]
                loop = mesh.face_vertex[mesh.face_start[face] : mesh.face_start[face + 1]].tolist()
                one, two = (f"({loop[k]}, {loop[(k + 1) % size]})" for k in (i[pair[0]], j[pair[0]]))
                raise ValueError(
                    f"face {face} of the cage intersects itself: its edges {one} and {two} meet; split the face"
                )


def _segments_meet(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray, tolerance: float) -> np.ndarray:
    """Whether closed segments a-b and c-d come within the tolerance by crossing, shape (...,)."""

    def side(p, q, r):
        u, v = q - p, r - p
        value = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
        return np.where(np.abs(value) <= tolerance * np.hypot(u[..., 0], u[..., 1]), 0.0, np.sign(value))

    crossing = (side(a, b, c) * side(a, b, d) <= 0) & (side(c, d, a) * side(c, d, b) <= 0)
    overlap = (np.minimum(a, b) <= np.maximum(c, d) + tolerance) & (np.minimum(c, d) <= np.maximum(a, b) + tolerance)
    return crossing & overlap.all(axis=-1)


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


def near_pairs(one: np.ndarray, other: np.ndarray, tolerance: float) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Pairs of which the bounding boxes come within a tolerance of each other.

    Args:
        one: Corners of the first things, shape (one_count, corner_count, dimension) [m].
        other: Corners of the second things, shape (other_count, corner_count, dimension) [m].
        tolerance: Gap between boxes up to which they count as meeting [m].

    Yields:
        Indices of the first and of the second thing of each pair, block by block of the first, shapes (pair_count,).
    """
    one_low, one_high = one.min(axis=1) - tolerance, one.max(axis=1) + tolerance
    low, high = other.min(axis=1), other.max(axis=1)
    step = max(1, _CHUNK // max(1, len(other)))
    for begin in range(0, len(one), step):
        block = slice(begin, begin + step)
        near = np.ones((len(one[block]), len(other)), dtype=bool)
        for axis in range(one.shape[2]):
            near &= one_low[block, axis, None] <= high[:, axis]
            near &= one_high[block, axis, None] >= low[:, axis]
        row, column = np.nonzero(near)
        yield begin + row, column


def edge_pierces(p: np.ndarray, q: np.ndarray, corners: np.ndarray, tolerance: float) -> np.ndarray:
    """Whether segments p-q pass from one side of their triangles to the other within them, shape (pair_count,).

    Args:
        p: Starts of the segments, shape (pair_count, 3) [m].
        q: Ends of the segments, shape (pair_count, 3) [m].
        corners: Triangles, shape (pair_count, 3, 3) [m].
        tolerance: Length below which two things coincide [m].
    """
    normal = _unit_normals(corners)
    from_p, from_q = (np.einsum("ij,ij->i", x - corners[:, 0], normal) for x in (p, q))
    opposite = (np.minimum(from_p, from_q) < -tolerance) & (np.maximum(from_p, from_q) > tolerance)
    difference = np.where(opposite, from_p - from_q, 1.0)
    return opposite & _lies_over(p + (from_p / difference)[:, None] * (q - p), corners, normal, tolerance)


def point_touches(points: np.ndarray, corners: np.ndarray, tolerance: float) -> np.ndarray:
    """Whether points lie within a tolerance above or below their triangles, shape (pair_count,).

    Args:
        points: Points, shape (pair_count, 3) [m].
        corners: Triangles, shape (pair_count, 3, 3) [m].
        tolerance: Length below which two things coincide [m].
    """
    normal = _unit_normals(corners)
    height = np.einsum("ij,ij->i", points - corners[:, 0], normal)
    return (np.abs(height) <= tolerance) & _lies_over(points, corners, normal, tolerance)


def _unit_normals(corners: np.ndarray) -> np.ndarray:
    """Unit normals of triangles, zero where there is no area, shape (triangle_count, 3)."""
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normal, axis=1)
    return normal / np.where(area > 0.0, area, 1.0)[:, None]


def _lies_over(points: np.ndarray, corners: np.ndarray, normal: np.ndarray, tolerance: float) -> np.ndarray:
    """Whether points lie over their triangles, looking along the normals, shape (pair_count,)."""
    inside = normal.any(axis=1)
    for k in range(3):
        u, along = corners[:, k], corners[:, (k + 1) % 3] - corners[:, k]
        height = np.einsum("ij,ij->i", np.cross(normal, along), points - u)
        inside &= height >= -tolerance * np.linalg.norm(along, axis=1)
    return inside


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

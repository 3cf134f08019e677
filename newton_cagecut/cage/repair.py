# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Cages that come from elsewhere, made whole: faces that are not planar are cut into triangles, inside turned out."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..geometry import polygon_triangles, units

Loops = list[list[int]]


def repaired(
    positions: np.ndarray,
    face_start: np.ndarray,
    face_vertex: np.ndarray,
    tolerance: float,
    build: Callable[[Loops], object],
) -> Loops:
    """Cut the faces that are not planar into triangles, and reverse all faces if they enclose a negative volume.

    Quads are cut so that they bulge outwards, which holds more; where that makes faces cross, as flat as they go, or
    inwards.

    Args:
        positions: Positions, shape (vertex_count, dimension) [m].
        face_start: First corner of each face and the end of the last, shape (face_count + 1,).
        face_vertex: Vertex of each corner.
        tolerance: How far corners may be off their face's plane [m].
        build: Called with faces; raises if they are no cage.

    Returns:
        The faces.

    Raises:
        ValueError: If there is no cage in it; the text is that of the first way to cut.
    """
    corners, ends = face_vertex.tolist(), face_start.tolist()
    loops = [corners[begin:end] for begin, end in zip(ends[:-1], ends[1:])]
    simplices = np.array(loops) if positions.shape[1] == 2 else polygon_triangles(positions, *_flat(loops))
    if np.linalg.det(positions[simplices] - positions.mean(axis=0)).sum() < 0.0:
        loops = [loop[::-1] for loop in loops]
    if positions.shape[1] == 2:
        return loops
    bent = [len(loop) > 3 and not _is_planar(positions[loop], tolerance) for loop in loops]
    first = None
    for cut in (_bulging, _flattest, _hollow) if any(bent) else ():
        faces = [part for loop, is_bent in zip(loops, bent) for part in (cut(positions, loop) if is_bent else [loop])]
        try:
            build(faces)
        except ValueError as error:
            first = first or error
        else:
            return faces
    if first is not None:
        raise first
    return loops


def _flat(loops: Loops) -> tuple[np.ndarray, np.ndarray]:
    return np.array([len(loop) for loop in loops]), np.array([vertex for loop in loops for vertex in loop])


def _is_planar(corners: np.ndarray, tolerance: float) -> bool:
    """Whether corners lie in the plane of their area, as a cage asks."""
    offset = corners - corners.mean(axis=0)
    normal = units(np.cross(offset, np.roll(offset, -1, axis=0)).sum(axis=0)[None])[0]
    return bool(np.ptp(offset @ normal) <= tolerance)


def _flattest(positions: np.ndarray, loop: list[int]) -> Loops:
    """The triangles of a face as those of meshes are cut."""
    return polygon_triangles(positions, *_flat([loop])).tolist()


def _bulging(positions: np.ndarray, loop: list[int]) -> Loops:
    """The two triangles of a quad whose common edge is a ridge; other faces as they are cut anyway."""
    if len(loop) != 4:
        return _flattest(positions, loop)
    a, b, c, d = loop
    edges = positions[[b, c, d]] - positions[a]
    return [[a, b, c], [a, c, d]] if np.linalg.det(edges) < 0.0 else [[a, b, d], [b, c, d]]


def _hollow(positions: np.ndarray, loop: list[int]) -> Loops:
    """The two triangles of a quad whose common edge is a valley; other faces as they are cut anyway."""
    if len(loop) != 4:
        return _flattest(positions, loop)
    a, b, c, d = loop
    return [[a, b, d], [b, c, d]] if _bulging(positions, loop)[0] == [a, b, c] else [[a, b, c], [a, c, d]]

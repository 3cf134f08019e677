# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The faces of a cage as landings see them: loops in their wall's plane, listed by wall and side.

A landing is (wall, side, point). Faces are looked up from it, so that splitting a face changes which vertices a
landing speaks for, never the landing (design: "walls are append-only, faces change").
"""

from __future__ import annotations

import numpy as np
import warp as wp

from ...cage import Cage
from ...geometry import lifted
from ..walls.frame import UnitFrame

wp.set_module_options({"enable_backward": False})

TRIANGLE = wp.constant(0)
"""Barycentric coordinates."""
QUAD = wp.constant(1)
"""Mean value coordinates of a convex quad (paper, equation 4)."""
NESTED = wp.constant(2)
"""A walk on the face (paper, section 5.1): slits, concave and many-sided faces, and quads on request."""
SEGMENT = wp.constant(3)
"""Linear, in 2D."""


@wp.struct
class FaceTables:
    """Faces of one cage, and the planes of its walls, in the unit frame.

    The loop of face f is rows loop_start[f] to loop_start[f + 1] of ``loop_vertex`` (cage vertices) and ``loop_point``
    (in the wall's plane; in 2D along its line). The faces of key 2 * wall + side are rows key_start[key] to
    key_start[key + 1] of ``key_face``.
    """

    loop_start: wp.array[wp.int32]
    loop_vertex: wp.array[wp.int32]
    loop_point: wp.array[wp.vec2]
    kind: wp.array[wp.int32]
    nested_count: int
    orientation: wp.array[float]
    face_piece: wp.array[wp.int32]
    vertex_piece: wp.array[wp.int32]
    key_start: wp.array[wp.int32]
    key_face: wp.array[wp.int32]
    wall_origin: wp.array[wp.vec3]
    wall_axis_0: wp.array[wp.vec3]
    wall_axis_1: wp.array[wp.vec3]
    rest: wp.array[wp.vec3d]


@wp.func
def cross2(u: wp.vec2, v: wp.vec2) -> float:
    """Third component of the cross product of two plane vectors."""
    return u[0] * v[1] - u[1] * v[0]


@wp.func
def plane_point(tables: FaceTables, wall: int, x: wp.vec3) -> wp.vec2:
    """Coordinates of a point in a wall's plane."""
    offset = x - tables.wall_origin[wall]
    return wp.vec2(wp.dot(tables.wall_axis_0[wall], offset), wp.dot(tables.wall_axis_1[wall], offset))


def build_face_tables(cage: Cage, frame: UnitFrame, *, quads: str, device: wp.context.Device) -> FaceTables:
    """Put a cage's faces on a device.

    Args:
        cage: The cage as it is now.
        frame: The unit frame of the cage before any cut.
        quads: "mean_value" or "harmonic": how convex quads interpolate.
        device: Where to put them.
    """
    start = np.asarray(cage.mesh.face_start)
    vertex = np.asarray(cage.mesh.face_vertex)
    length = np.diff(start)
    face_of_row = np.repeat(np.arange(cage.face_count), length)
    wall_of_row = np.asarray(cage.face_wall)[face_of_row]
    origin = np.array([frame.to_unit(wall.origin) for wall in cage.walls])
    axes = np.array([wall.axes for wall in cage.walls])
    local = np.einsum("rij,rj->ri", axes[wall_of_row], frame.to_unit(cage.vertices)[vertex] - origin[wall_of_row])
    if cage.dimension == 2:
        local, origin = np.pad(local, ((0, 0), (0, 1))), lifted(origin)
        axes = np.pad(axes, ((0, 0), (0, 1), (0, 1)))  # the second axis is zero
    orientation = 1.0 - 2.0 * np.asarray(cage.face_side, dtype=np.float64)
    key = 2 * np.asarray(cage.face_wall) + np.asarray(cage.face_side)
    key_count = np.bincount(key, minlength=2 * len(cage.walls))

    kinds = _kinds(local, start, orientation, quads=quads)
    tables = FaceTables()
    tables.nested_count = int(np.count_nonzero(kinds == NESTED))
    integers = {
        "loop_start": start,
        "loop_vertex": vertex,
        "kind": kinds,
        "face_piece": cage.face_piece,
        "vertex_piece": cage.vertex_piece,
        "key_start": np.concatenate([[0], np.cumsum(key_count)]),
        "key_face": np.argsort(key, kind="stable"),
    }
    for name, values in integers.items():
        setattr(tables, name, wp.array(np.asarray(values, dtype=np.int32), dtype=wp.int32, device=device))
    tables.loop_point = wp.array(local.astype(np.float32), dtype=wp.vec2, device=device)
    tables.orientation = wp.array(orientation.astype(np.float32), dtype=float, device=device)
    tables.wall_origin = wp.array(origin.astype(np.float32), dtype=wp.vec3, device=device)
    tables.wall_axis_0 = wp.array(axes[:, 0].astype(np.float32), dtype=wp.vec3, device=device)
    tables.wall_axis_1 = wp.array(axes[:, 1].astype(np.float32), dtype=wp.vec3, device=device)
    tables.rest = wp.array(lifted(frame.to_unit(cage.vertices)), dtype=wp.vec3d, device=device)
    return tables


def _kinds(local: np.ndarray, start: np.ndarray, orientation: np.ndarray, *, quads: str) -> np.ndarray:
    """How each face interpolates: by its number of sides and, for quads, convexity."""
    length = np.diff(start)
    kinds = np.full(len(length), NESTED, dtype=np.int32)
    kinds[length == 2] = SEGMENT
    kinds[length == 3] = TRIANGLE
    if quads == "mean_value":
        faces = np.flatnonzero(length == 4)
        corners = local[start[faces][:, None] + np.arange(4)]
        edge = np.roll(corners, -1, axis=1) - corners
        after = np.roll(edge, -1, axis=1)
        turn = (edge[..., 0] * after[..., 1] - edge[..., 1] * after[..., 0]) * orientation[faces][:, None]
        scale = np.linalg.norm(edge, axis=2) * np.linalg.norm(after, axis=2)
        kinds[faces[(turn > 1.0e-6 * scale).all(axis=1)]] = QUAD
    return kinds


@wp.func
def _edge_distance_squared(a: wp.vec2, b: wp.vec2, x: wp.vec2) -> float:
    ab = b - a
    t = wp.clamp(wp.dot(ab, x - a) / wp.max(wp.dot(ab, ab), 1.0e-30), 0.0, 1.0)
    return wp.length_sq(x - a - ab * t)


@wp.func
def distance_outside(tables: FaceTables, face: int, x: wp.vec2) -> float:
    """Squared distance of a point from a face: 0 inside (even-odd rule, so slits and bridges count for nothing)."""
    first = tables.loop_start[face]
    last = tables.loop_start[face + 1]
    inside = bool(False)
    nearest = float(1.0e30)
    a = tables.loop_point[last - 1]
    for row in range(first, last):
        b = tables.loop_point[row]
        if (a[1] > x[1]) != (b[1] > x[1]):
            if x[0] < (b[0] - a[0]) * (x[1] - a[1]) / (b[1] - a[1]) + a[0]:
                inside = not inside
        nearest = wp.min(nearest, _edge_distance_squared(a, b, x))
        a = b
    if inside:
        return 0.0
    return nearest


@wp.func
def face_of_landing(tables: FaceTables, key: int, x: wp.vec2, piece: int) -> int:
    """The face of a wall's side that holds a landing, among those of the walk's piece.

    Restricting it to the piece makes the weights of other pieces zero exactly, whatever is rounded.
    ``piece`` -1 means any.
    """
    first = tables.key_start[key]
    last = tables.key_start[key + 1]
    if last - first == 1 and piece < 0:
        return tables.key_face[first]
    best = int(-1)
    nearest = float(2.0e30)
    for row in range(first, last):
        face = tables.key_face[row]
        if piece < 0 or tables.face_piece[face] == piece:
            distance = distance_outside(tables, face, x)
            if distance < nearest:
                best = face
                nearest = distance
            if distance == 0.0:
                return face
    return best

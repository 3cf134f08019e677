# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Walls: the triangles, in 2D segments, that stop walks, append-only.

The cage's faces are walls from the start; every swept piece of a cut is appended (design: "walls are append-only,
faces change"). A triangle knows its wall; a wall is a plane with one side (a face of the cage) or two (a cut).

A wall that an extending edit has removed stays on as a gate (paper, section 8: "extending operations (e.g., extrusions)
can simply resume walks"): it limits a walk's spheres until the walk has come to it, and that walk ignores it from then
on. So a walk stays a function of the walls and the seed.

In 2D everything lies in the plane z = 0, and a segment is a triangle of which two corners are the same.
"""

from __future__ import annotations

import numpy as np
import warp as wp

from ...geometry import lifted, triangle_normals, units
from .frame import UnitFrame

wp.set_module_options({"enable_backward": False})

MOST_GATES = 31
"""Gates that one set of walls may have: a walk keeps a bit for each."""


@wp.struct
class WallTriangle:
    """A triangle in the unit frame.

    ``inward_k`` is the unit normal, in the plane, of the edge that starts at corner k, and points into the triangle.
    ``gate`` is the number of the gate that the triangle belongs to, -1 for walls.
    """

    corner_0: wp.vec3
    corner_1: wp.vec3
    corner_2: wp.vec3
    inward_0: wp.vec3
    inward_1: wp.vec3
    inward_2: wp.vec3
    normal: wp.vec3
    wall: wp.int32
    two_sided: wp.int32
    gate: wp.int32


@wp.struct
class WallTriangles:
    """All triangles: what a query needs of one lies side by side."""

    rows: wp.array[WallTriangle]
    count: int


@wp.func
def closest_point_on_segment(a: wp.vec3, b: wp.vec3, x: wp.vec3) -> wp.vec3:
    """Closest point of the segment from ``a`` to ``b``."""
    ab = b - a
    length_squared = wp.dot(ab, ab)
    if length_squared <= 0.0:
        return a
    return a + ab * wp.clamp(wp.dot(ab, x - a) / length_squared, 0.0, 1.0)


@wp.func
def inward_distances(triangles: WallTriangles, t: int, x: wp.vec3) -> wp.vec3:
    """Signed distances from the planes through a triangle's edges, across its own plane; negative outside."""
    return wp.vec3(
        wp.dot(triangles.rows[t].inward_0, x - triangles.rows[t].corner_0),
        wp.dot(triangles.rows[t].inward_1, x - triangles.rows[t].corner_1),
        wp.dot(triangles.rows[t].inward_2, x - triangles.rows[t].corner_2),
    )


@wp.func
def plane_distance(triangles: WallTriangles, t: int, x: wp.vec3) -> float:
    """Signed distance from the triangle's plane, measured from a corner to keep the digits."""
    return wp.dot(triangles.rows[t].normal, x - triangles.rows[t].corner_0)


@wp.func
def closest_point(triangles: WallTriangles, t: int, x: wp.vec3, off: float, inward: wp.vec3) -> wp.vec3:
    """Closest point of a triangle, by the edges that x is outside of.

    Outside is decided against unit edge normals that were made in float64, so the slivers that cuts leave are as
    exact as any other triangle (products of barycentric areas are not, in float32).
    """
    if inward[0] >= 0.0 and inward[1] >= 0.0 and inward[2] >= 0.0:
        return x - triangles.rows[t].normal * off
    a = triangles.rows[t].corner_0
    b = triangles.rows[t].corner_1
    c = triangles.rows[t].corner_2
    best = a
    best_squared = float(1.0e30)
    if inward[0] < 0.0:
        point = closest_point_on_segment(a, b, x)
        best = point
        best_squared = wp.length_sq(x - point)
    if inward[1] < 0.0:
        point = closest_point_on_segment(b, c, x)
        squared = wp.length_sq(x - point)
        if squared < best_squared:
            best = point
            best_squared = squared
    if inward[2] < 0.0:
        point = closest_point_on_segment(c, a, x)
        squared = wp.length_sq(x - point)
        if squared < best_squared:
            best = point
            best_squared = squared
    return best


@wp.func
def closest_point_on_triangle(triangles: WallTriangles, t: int, x: wp.vec3) -> wp.vec3:
    """Closest point of a triangle."""
    return closest_point(triangles, t, x, plane_distance(triangles, t, x), inward_distances(triangles, t, x))


class Walls:
    """The walls of one cage and of its cuts, on a device.

    Args:
        frame: The unit frame of the cage.
        device: Where the triangles live.
    """

    def __init__(self, frame: UnitFrame, *, device: wp.context.Device) -> None:
        self.frame = frame
        self.device = device
        self.triangle_count = 0
        self._rows: dict[str, np.ndarray] = {}
        self.data = WallTriangles()

    @classmethod
    def of_rows(cls, frame: UnitFrame, rows: dict[str, np.ndarray], *, device: wp.context.Device) -> Walls:
        """Walls that were there before, by their ``rows``."""
        walls = cls(frame, device=device)
        walls._rows, walls.triangle_count = rows, len(rows["wall"])
        walls._upload()
        return walls

    @property
    def rows(self) -> dict[str, np.ndarray]:
        """The triangles on the host: an array for each field of ``WallTriangle``."""
        return self._rows

    def append(self, corners: np.ndarray, walls: np.ndarray, normals: np.ndarray, two_sided: np.ndarray) -> range:
        """Append triangles and return their indices.

        Args:
            corners: Rest positions [m], shape (t, dimension, dimension).
            walls: Wall of each triangle, shape (t,).
            normals: The wall's unit normal for each triangle, shape (t, dimension).
            two_sided: Whether walks land on both sides, shape (t,).
        """
        first = self.triangle_count
        rows = _wall_rows(self.frame.to_unit(corners), normals)
        rows["wall"] = walls.astype(np.int32)
        rows["two_sided"] = two_sided.astype(np.int32)
        rows["gate"] = np.full(len(corners), -1, dtype=np.int32)
        self._rows = {
            name: np.concatenate([self._rows[name], row]) if self._rows else row for name, row in rows.items()
        }
        self.triangle_count = first + len(corners)
        self._upload()
        return range(first, self.triangle_count)

    @property
    def gate_count(self) -> int:
        """Number of gates."""
        return int(self._rows["gate"].max()) + 1

    def retire(self, walls: np.ndarray) -> None:
        """Make gates of walls that bound the cage no longer.

        Args:
            walls: Their numbers, shape (wall_count,).
        """
        gate = self._rows["gate"].copy()
        for number, wall in enumerate(walls.tolist(), start=self.gate_count):
            gate[self._rows["wall"] == wall] = number
        self._rows = {**self._rows, "gate": gate}
        self._upload()

    def gate_of_wall(self) -> wp.array:
        """Number of the gate that each wall has become, -1 for none, shape (wall_count,)."""
        gates = np.full(int(self._rows["wall"].max()) + 1, -1, dtype=np.int32)
        gates[self._rows["wall"]] = self._rows["gate"]
        return wp.array(gates, dtype=wp.int32, device=self.device)

    def box(self, first: int = 0) -> tuple[np.ndarray, np.ndarray]:
        """Least and greatest coordinates of the triangles from the first on in the unit frame, shape (3,) each."""
        corners = np.concatenate([self._rows[f"corner_{k}"][first:] for k in range(3)])
        return corners.min(axis=0), corners.max(axis=0)

    def state(self) -> tuple:
        """The walls as they are; appending replaces what this refers to, and never writes to it."""
        return self.triangle_count, self._rows, self.data

    def restore(self, state: tuple) -> None:
        """Forget the walls that were appended since a state."""
        self.triangle_count, self._rows, self.data = state

    def _upload(self) -> None:
        data = WallTriangles()
        rows = np.zeros(self.triangle_count, dtype=WallTriangle.numpy_dtype())
        for name, values in self._rows.items():
            rows[name] = values
        data.rows = wp.array(rows, dtype=WallTriangle, device=self.device)
        data.count = self.triangle_count
        self.data = data

    @property
    def byte_count(self) -> int:
        """Bytes on the device."""
        return sum(rows.nbytes for rows in self._rows.values())


def _wall_rows(corners: np.ndarray, normals: np.ndarray) -> dict[str, np.ndarray]:
    """Corners, edge normals and normals in float32, from unit-frame corners in float64."""
    if corners.shape[1] == 2:
        inward = _segment_ends(corners)
        corners = lifted(corners[:, [0, 1, 0]])
    else:
        corners = _wound(corners, normals)
        inward = [units(np.cross(normals, corners[:, (k + 1) % 3] - corners[:, k])) for k in range(3)]
    rows = {"normal": lifted(normals).astype(np.float32)}
    for k in range(3):
        rows[f"corner_{k}"] = corners[:, k].astype(np.float32)
        rows[f"inward_{k}"] = inward[k].astype(np.float32)
    return rows


def _segment_ends(corners: np.ndarray) -> list[np.ndarray]:
    """Directions into segments from their ends, which bound them as edges bound a triangle."""
    along = lifted(units(corners[:, 1] - corners[:, 0]))
    return [np.zeros_like(along), -along, along]


def _wound(corners: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Triangles of which the winding agrees with the wall's normal, so that edge normals point inward."""
    area = np.einsum("ij,ij->i", triangle_normals(corners), normals)
    return np.where((area < 0.0)[:, None, None], corners[:, ::-1], corners)

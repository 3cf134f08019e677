# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Walls: what stops walks, append-only.

The cage's faces are walls from the start; every swept piece of a cut is appended (design: "walls are append-only,
faces change"). A triangle, in 2D a segment, knows its wall; a wall is a plane with one side (a face of the cage) or two
(a cut).

A wall that an extending edit has removed stays on as a gate (paper, section 8: "extending operations (e.g., extrusions)
can simply resume walks"): it limits a walk's spheres until the walk has come to it, and that walk ignores it from then
on. So a walk stays a function of the walls and the seed.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
import warp as wp

from ...geometry import lifted, triangle_normals, units
from .frame import UnitFrame
from .wall_triangles import WallTriangle, WallTriangles

MOST_GATES = 31
"""Gates that one set of walls may have: a walk keeps a bit for each."""


class Walls:
    """The walls of one cage and of its cuts, on a device; an edit makes others of them and never writes to these.

    Args:
        frame: The unit frame of the cage.
        rows: The triangles on the host: an array for each field of ``WallTriangle``.
        device: Where the triangles live.
    """

    def __init__(self, frame: UnitFrame, rows: dict[str, np.ndarray], *, device: wp.context.Device) -> None:
        self.frame, self.rows, self.device = frame, rows, device
        self.triangle_count = len(rows["wall"])
        self.data = WallTriangles()
        values = np.zeros(self.triangle_count, dtype=WallTriangle.numpy_dtype())
        for name, column in rows.items():
            values[name] = column
        self.data.rows = wp.array(values, dtype=WallTriangle, device=device)
        self.data.count = self.triangle_count

    @classmethod
    def of_triangles(
        cls,
        frame: UnitFrame,
        corners: np.ndarray,
        walls: np.ndarray,
        normals: np.ndarray,
        two_sided: np.ndarray,
        *,
        device: wp.context.Device,
    ) -> Walls:
        """The first walls; the arguments are as for ``appended``."""
        return cls(frame, _wall_rows(frame, corners, walls, normals, two_sided), device=device)

    def appended(self, corners: np.ndarray, walls: np.ndarray, normals: np.ndarray, two_sided: np.ndarray) -> Walls:
        """These walls and further triangles behind them.

        Args:
            corners: Rest positions [m], shape (t, dimension, dimension).
            walls: Wall of each triangle, shape (t,).
            normals: The wall's unit normal for each triangle, shape (t, dimension).
            two_sided: Whether walks land on both sides, shape (t,).
        """
        added = _wall_rows(self.frame, corners, walls, normals, two_sided)
        rows = {name: np.concatenate([self.rows[name], row]) for name, row in added.items()}
        return Walls(self.frame, rows, device=self.device)

    def retired(self, walls: np.ndarray) -> Walls:
        """These walls, of which some bound the cage no longer and are gates.

        Args:
            walls: Their numbers, shape (wall_count,).
        """
        gate = self.rows["gate"].copy()
        for number, wall in enumerate(walls.tolist(), start=self.gate_count):
            gate[self.rows["wall"] == wall] = number
        return Walls(self.frame, {**self.rows, "gate": gate}, device=self.device)

    @property
    def dimension(self) -> int:
        """Dimension of the space."""
        return len(self.frame.center)

    @property
    def gate_count(self) -> int:
        """Number of gates."""
        return int(self.rows["gate"].max()) + 1

    @cached_property
    def gate_of_wall(self) -> wp.array:
        """Number of the gate that each wall has become, -1 for none, shape (wall_count,)."""
        gates = np.full(int(self.rows["wall"].max()) + 1, -1, dtype=np.int32)
        gates[self.rows["wall"]] = self.rows["gate"]
        return wp.array(gates, dtype=wp.int32, device=self.device)

    def box(self, first: int = 0) -> tuple[np.ndarray, np.ndarray]:
        """Least and greatest coordinates of the triangles from the first on in the unit frame, shape (3,) each."""
        corners = np.concatenate([self.rows[f"corner_{k}"][first:] for k in range(3)])
        return corners.min(axis=0), corners.max(axis=0)

    @property
    def byte_count(self) -> int:
        """Bytes on the device."""
        return sum(rows.nbytes for rows in self.rows.values())


def _wall_rows(
    frame: UnitFrame, corners: np.ndarray, walls: np.ndarray, normals: np.ndarray, two_sided: np.ndarray
) -> dict[str, np.ndarray]:
    """Triangles that are no gates, in float32 from unit-frame corners in float64."""
    rows = _plane_rows(frame.to_unit(corners), normals)
    rows["wall"] = walls.astype(np.int32)
    rows["two_sided"] = two_sided.astype(np.int32)
    rows["gate"] = np.full(len(corners), -1, dtype=np.int32)
    return rows


def _plane_rows(corners: np.ndarray, normals: np.ndarray) -> dict[str, np.ndarray]:
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

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The densities with which layers meet given boundary functions, all functions at once.

A harmonic function with boundary values phi is the single layer of its normal derivative less the double layer of phi.
The double layers are known; the densities of the single ones are found by Galerkin's method: on every panel the
residual of the boundary values, weighted with each hat function, has no mean. Where two sides of a cut coincide, one
sheet of charges stands for the sum of both normal derivatives, and either side's values may be met: the double layers
bring the jump.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import warp as wp

from ...launch import launch
from .layer_rows import make_layer_rows
from .products import LANE, WIDTH, lane_count, multiply_lanes
from .solve import System

wp.set_module_options({"enable_backward": False})

_INWARD = 1e-10
"""How far inside of their panels test points lie, in units of the frame's: that tells the sides of double layers."""
_SAME = 1e-10
"""Length below which corners are the same, in units of the frame's."""
_BATCH = 2048
"""Points whose rows are held at a time."""
# Where the residual is tested, as hat functions there, and with what weights: exact for polynomials of degree 2.
_TEST_HATS = {
    2: np.array([[0.5 + np.sqrt(0.15), 0.5 - np.sqrt(0.15)], [0.5, 0.5], [0.5 - np.sqrt(0.15), 0.5 + np.sqrt(0.15)]]),
    3: (np.ones((3, 3)) + 3.0 * np.eye(3)) / 6.0,
}
_TEST_WEIGHTS = {2: np.array([5.0, 8.0, 5.0]) / 18.0, 3: np.ones(3) / 3.0}


@dataclass(frozen=True)
class ChargePanels:
    """Panels with unknown densities.

    Args:
        corners: Corners of the panels, counterclockwise seen from outside, in the plane with the inside to the left,
            shape (panel_count, dimension, dimension).
        nodes: The unknown at each corner, shape (panel_count, dimension); those that share it are continuous.
    """

    corners: np.ndarray
    nodes: np.ndarray

    @property
    def node_count(self) -> int:
        """Number of unknowns."""
        return int(self.nodes.max()) + 1

    @property
    def test_points(self) -> np.ndarray:
        """Points inside each panel, at which boundary values are met, shape (panel_count, 3, dimension)."""
        return _combined(_TEST_HATS[self.corners.shape[1]], self.corners)


@dataclass(frozen=True)
class DipolePanels:
    """Panels with known densities, linear on each.

    Args:
        corners: Corners of the panels, as those of ``ChargePanels``.
        start: First item of each panel, and the end of the last, shape (panel_count + 1,).
        column: Function that each item belongs to, shape (item_count,).
        density: Its values at the panel's corners, shape (item_count, dimension).
    """

    corners: np.ndarray
    start: np.ndarray
    column: np.ndarray
    density: np.ndarray


@wp.kernel(enable_backward=False)
def _test_rows(
    offset: int,
    start: wp.array[wp.int32],
    row: wp.array[wp.int32],
    weight: wp.array[wp.float64],
    rows: wp.array2d[LANE],
    first_lane: int,
    out: wp.array2d[LANE],
):
    """Sum rows with weights, a thread a lane of a sum."""
    t = offset + wp.tid()
    i = t // rows.shape[1]
    lane = t % rows.shape[1]
    total = LANE()
    for item in range(start[i], start[i + 1]):
        total += weight[item] * rows[row[item], lane]
    out[i, first_lane + lane] = total


class _Rows:
    """A matrix that is filled number by number and read lane by lane."""

    def __init__(self, count: int, columns: int, device: wp.context.Device) -> None:
        self.numbers = wp.zeros((count, lane_count(columns) * WIDTH), dtype=wp.float64, device=device)
        shape = (count, lane_count(columns))
        self.lanes = wp.array(ptr=self.numbers.ptr, shape=shape, dtype=LANE, device=device, copy=False)


class DensityFit:
    """Harmonic functions with given boundary values, by layers.

    Args:
        charges: Panels with unknown densities.
        dipoles: Panels with the boundary values as densities.
        values: Boundary values at ``charges.test_points``, shape (panel_count, 3, column_count).
        device: Where to compute.

    Raises:
        ValueError: There is no solution.
    """

    def __init__(
        self, charges: ChargePanels, dipoles: DipolePanels, values: np.ndarray, device: wp.context.Device
    ) -> None:
        self.device = device
        self.dimension = charges.corners.shape[1]
        self.column_count = values.shape[2]
        self.node_count = charges.node_count
        kit = self._kit = make_layer_rows(self.dimension)
        corners, nodes, dipoles = _merged(charges, dipoles)
        self.panel_count = len(corners)
        self._panels = [
            kit.make_panels(corners, device),
            kit.make_far_panels(corners, device),
            wp.array(nodes.astype(np.int32), dtype=kit.Nodes, device=device),
            wp.array(dipoles.start.astype(np.int32), dtype=wp.int32, device=device),
            wp.array(dipoles.column.astype(np.int32), dtype=wp.int32, device=device),
            wp.array(dipoles.density, dtype=kit.Vector, device=device),
        ]
        self._density = self._solved(charges, values)

    def _solved(self, charges: ChargePanels, values: np.ndarray) -> wp.array:
        """Densities of the nodes, a row each and fill rows of 0."""
        inward, size = _inward(charges.corners)
        points = (charges.test_points + _INWARD * inward[:, None]).reshape(-1, self.dimension)
        system = System(self.node_count, self.column_count, self.device)
        test = self._test(charges, size)
        known = _Rows(len(points), self.column_count, self.device)
        filled = np.zeros(known.numbers.shape)
        filled[:, : self.column_count] = values.reshape(len(points), -1)
        known.numbers.assign(-filled)
        unknown = _Rows(len(points), self.node_count, self.device)
        self._run(self._kit.layers, points, unknown, known)
        self._apply(test, known, system.first_lane, system.matrix, -1.0)
        self._apply(test, unknown, 0, system.matrix, 1.0)
        density = wp.clone(system.solve())
        if not np.isfinite(density.numpy()).all():
            raise ValueError(
                "the fit of this cage has no solution: faces of no area, or walls that all but coincide; "
                "take correction='harmonic'"
            )
        return density

    def _test(self, charges: ChargePanels, size: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """What the test points count for each node: first item of a node, points and weights, by node and point."""
        hats, weights = _TEST_HATS[self.dimension], _TEST_WEIGHTS[self.dimension]
        count = len(weights)
        weight = size[:, None, None] * (weights[:, None] * hats)
        node = np.broadcast_to(charges.nodes[:, None], weight.shape).ravel()
        row = np.broadcast_to(np.arange(len(size) * count).reshape(-1, count, 1), weight.shape).ravel()
        order = np.argsort(node, kind="stable")
        start = np.concatenate([[0], np.cumsum(np.bincount(node, minlength=self.node_count))])
        return start, row[order], weight.ravel()[order]

    def _apply(self, test: tuple, rows: _Rows, first_lane: int, out: wp.array, sign: float) -> None:
        start, row, weight = test
        inputs = [
            wp.array(start.astype(np.int32), dtype=wp.int32, device=self.device),
            wp.array(row.astype(np.int32), dtype=wp.int32, device=self.device),
            wp.array(sign * weight, dtype=wp.float64, device=self.device),
            rows.lanes,
            first_lane,
            out,
        ]
        launch(_test_rows, self.node_count * rows.lanes.shape[1], inputs, device=self.device)

    def _run(self, kernel: wp.Kernel, points: np.ndarray, unknown: _Rows, known: _Rows) -> None:
        at = wp.array(points, dtype=self._kit.Vector, device=self.device)
        inputs = [*self._panels, at, unknown.numbers, known.numbers]
        launch(kernel, len(points), inputs, device=self.device, smallest_chunk=8)

    def values(self, points: np.ndarray) -> np.ndarray:
        """The functions at points inside, shape (point_count, column_count)."""
        return self._evaluated(points, self._kit.layers, 1)

    def gradients(self, points: np.ndarray) -> np.ndarray:
        """Gradients of the functions at points inside, shape (point_count, column_count, dimension)."""
        rows = self._evaluated(points, self._kit.slopes, self.dimension)
        return np.swapaxes(rows.reshape(len(points), self.dimension, self.column_count), 1, 2)

    def _evaluated(self, points: np.ndarray, kernel: wp.Kernel, rows_each: int) -> np.ndarray:
        out = np.empty((len(points) * rows_each, self.column_count))
        batch = max(1, _BATCH // rows_each)
        for first in range(0, len(points), batch):
            some = points[first : first + batch]
            left = _Rows(len(some) * rows_each, self.node_count, self.device)
            total = _Rows(len(some) * rows_each, self.column_count, self.device)
            self._run(kernel, some, left, total)
            lanes = total.lanes
            count = -(-lanes.shape[0] // 4) * lanes.shape[1]
            inputs = [left.lanes, self._density, left.lanes.shape[1], lanes]
            launch(multiply_lanes, count, inputs, device=self.device, smallest_chunk=16)
            part = total.numbers.numpy()[:, : self.column_count]
            out[first * rows_each : first * rows_each + len(part)] = part
        return out


def _merged(charges: ChargePanels, dipoles: DipolePanels) -> tuple[np.ndarray, np.ndarray, DipolePanels]:
    """Panels that carry charges, dipoles or both: corners, nodes that are -1 without charges, and dipoles."""
    corners = np.concatenate([charges.corners, dipoles.corners])
    key = np.round(corners / _SAME).astype(np.int64).reshape(len(corners), -1)
    _, first, panel = np.unique(key, axis=0, return_index=True, return_inverse=True)
    charged, panel = np.split(panel.reshape(-1), [len(charges.corners)])
    nodes = np.full((len(first), charges.nodes.shape[1]), -1)
    nodes[charged] = charges.nodes
    owner = np.repeat(panel, np.diff(dipoles.start))
    order = np.argsort(owner, kind="stable")
    start = np.searchsorted(owner[order], np.arange(len(first) + 1))
    merged = DipolePanels(corners[first], start, dipoles.column[order], dipoles.density[order])
    return merged.corners, nodes, merged


def _combined(hats: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Points of panels at given hat functions, shape (panel_count, point_count, dimension), summed in a fixed order."""
    return sum(hats[:, k, None] * corners[:, None, k] for k in range(corners.shape[1]))


def _inward(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unit normals of panels that point inside, and the panels' sizes."""
    edge = corners[:, 1] - corners[:, 0]
    if corners.shape[1] == 2:
        normal = edge[:, ::-1] * [-1.0, 1.0]
        size = np.sqrt((normal**2).sum(axis=1))
        return normal / size[:, None], size
    normal = -np.cross(edge, corners[:, 2] - corners[:, 0])
    size = np.sqrt((normal**2).sum(axis=1))
    return normal / size[:, None], size / 2.0

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Sheets of panels: what a face or an outline brings into a fit, whatever else is there."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import warp as wp

from .layer_rows import SheetRange, make_layer_rows
from .spans import in_spans

_INWARD = 1e-10
"""How far inside of their panels test points lie, in units of the frame's: that tells the sides of double layers."""
_SAME = 1e-10
"""Length below which corners are the same, in units of the frame's."""
# Where the residual is tested, as hat functions there, and with what weights: exact for polynomials of degree 2.
_TEST_HATS = {
    2: np.array([[0.5 + np.sqrt(0.15), 0.5 - np.sqrt(0.15)], [0.5, 0.5], [0.5 - np.sqrt(0.15), 0.5 + np.sqrt(0.15)]]),
    3: (np.ones((3, 3)) + 3.0 * np.eye(3)) / 6.0,
}
_TEST_WEIGHTS = {2: np.array([5.0, 8.0, 5.0]) / 18.0, 3: np.ones(3) / 3.0}


def test_points_of(corners: np.ndarray) -> np.ndarray:
    """Points inside each panel, at which boundary values are met.

    Args:
        corners: Corners of the panels, shape (panel_count, dimension, dimension).

    Returns:
        Positions, shape (panel_count, 3, dimension), summed in a fixed order.
    """
    hats = _TEST_HATS[corners.shape[1]]
    return sum(hats[:, k, None] * corners[:, None, k] for k in range(corners.shape[1]))


@dataclass(frozen=True, eq=False)
class Sheet:
    """Panels with unknown densities, the charges, and panels with known ones, the dipoles, of some functions.

    Corners are counterclockwise seen from outside, in the plane with the inside to the left.

    Args:
        charge_corners: Corners of the panels with charges, shape (charge_count, dimension, dimension).
        nodes: The unknown at each corner, shape (charge_count, dimension); those that share it are continuous.
        dipole_corners: Corners of the panels with dipoles, shape (dipole_count, dimension, dimension).
        density: The functions at these corners, linear in between, shape (dipole_count, dimension, function_count).
        values: The functions at the test points of the charges, shape (charge_count, 3, function_count).
    """

    charge_corners: np.ndarray
    nodes: np.ndarray
    dipole_corners: np.ndarray
    density: np.ndarray
    values: np.ndarray

    @property
    def dimension(self) -> int:
        """Dimension of the space."""
        return self.dipole_corners.shape[2]

    @cached_property
    def node_count(self) -> int:
        """Number of unknowns."""
        return int(self.nodes.max(initial=-1)) + 1

    @property
    def function_count(self) -> int:
        """Number of functions."""
        return self.density.shape[2]

    @property
    def column_count(self) -> int:
        """Columns of its layers: a charge's a node, then a dipole's a function."""
        return self.node_count + self.function_count

    @cached_property
    def rows(self) -> dict[str, np.ndarray]:
        """Its panels, those that carry charges and dipoles together once, as rows of ``Panels``."""
        corners = np.concatenate([self.charge_corners, self.dipole_corners])
        key = np.round(corners / _SAME).astype(np.int64).reshape(len(corners), -1)
        _, first, panel = np.unique(key, axis=0, return_index=True, return_inverse=True)
        charged, valued = np.split(panel.reshape(-1), [len(self.charge_corners)])
        nodes = np.full((len(first), self.dimension), -1, dtype=np.int32)
        nodes[charged] = self.nodes
        item = np.full(len(first), -1, dtype=np.int32)
        item[valued] = self.function_count * np.arange(len(valued))
        kit = make_layer_rows(self.dimension)
        return {
            "near": kit.panel_rows(corners[first]),
            "far": kit.far_rows(corners[first]),
            "nodes": nodes,
            "item": item,
            "density": np.swapaxes(self.density, 1, 2).reshape(-1, self.dimension),
        }

    @cached_property
    def test_places(self) -> np.ndarray:
        """Its test points a little inside, in whole spans, shape (n, dimension)."""
        if not len(self.charge_corners):
            return np.zeros((0, self.dimension))
        points = test_points_of(self.charge_corners) + _INWARD * self._inward[0][:, None]
        return in_spans(points.reshape(-1, self.dimension))

    @cached_property
    def test(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """What test points count for each node: first item of a node, points and weights, by node and point."""
        hats, weights = _TEST_HATS[self.dimension], _TEST_WEIGHTS[self.dimension]
        weight = self._inward[1][:, None, None] * (weights[:, None] * hats)
        node = np.broadcast_to(self.nodes[:, None], weight.shape).ravel()
        row = np.broadcast_to(np.arange(len(self.nodes) * len(weights)).reshape(-1, len(weights), 1), weight.shape)
        order = np.argsort(node, kind="stable")
        start = np.concatenate([[0], np.cumsum(np.bincount(node, minlength=self.node_count))])
        return start, row.ravel()[order], weight.ravel()[order]

    @cached_property
    def tested_values(self) -> np.ndarray:
        """Integrals of the functions with each node's hat function, shape (node_count, function_count)."""
        start, row, weight = self.test
        out = np.zeros((self.node_count, self.function_count))
        values = weight[:, None] * self.values.reshape(-1, self.function_count)[row]
        for function in range(self.function_count):
            out[:, function] = np.bincount(
                np.repeat(np.arange(len(out)), np.diff(start)), values[:, function], len(out)
            )
        return out

    @cached_property
    def _inward(self) -> tuple[np.ndarray, np.ndarray]:
        """Unit normals of the charges' panels that point inside, and the panels' sizes."""
        corners = self.charge_corners
        edge = corners[:, 1] - corners[:, 0]
        if self.dimension == 2:
            normal = edge[:, ::-1] * [-1.0, 1.0]
            size = np.sqrt((normal**2).sum(axis=1))
            return normal / size[:, None], size
        normal = -np.cross(edge, corners[:, 2] - corners[:, 0])
        size = np.sqrt((normal**2).sum(axis=1))
        return normal / size[:, None], size / 2.0


class SheetBatch:
    """Sheets on a device.

    Args:
        sheets: The sheets, at least one.
        device: Where to put them.
    """

    def __init__(self, sheets: list[Sheet], device: wp.context.Device) -> None:
        self.sheets, self.device = sheets, device
        kit = make_layer_rows(self.dimension)
        self.panels, rows = kit.Panels(), [sheet.rows for sheet in sheets]
        for name, dtype in kit.panel_types.items():
            numbers = _joined([row[name] for row in rows])
            setattr(self.panels, name, wp.array(numbers, dtype=dtype, device=device))
        self.ranges = ranges = np.zeros(len(rows), dtype=SheetRange.numpy_dtype())
        last = np.cumsum([len(row["item"]) for row in rows])
        ranges["first"], ranges["last"] = np.append(0, last[:-1]), last
        ranges["first_item"] = np.cumsum([0, *(len(row["density"]) for row in rows[:-1])])
        ranges["charge_count"] = [sheet.node_count for sheet in sheets]
        ranges["dipole_count"] = [sheet.function_count for sheet in sheets]

    def chosen(self, numbers: list[int]) -> SheetBatch:
        """Some of the sheets; their panels are not put on the device again.

        Args:
            numbers: Which of them.
        """
        batch = copy(self)
        batch.sheets, batch.ranges = [self.sheets[number] for number in numbers], self.ranges[numbers]
        return batch

    @property
    def dimension(self) -> int:
        """Dimension of the space."""
        return self.sheets[0].dimension


def _joined(parts: list[np.ndarray]) -> np.ndarray:
    """Arrays one after the other; NumPy's own way loses the layout of structs."""
    out = np.empty((sum(map(len, parts)), *parts[0].shape[1:]), dtype=parts[0].dtype)
    first = 0
    for part in parts:
        out[first : first + len(part)] = part
        first += len(part)
    return out

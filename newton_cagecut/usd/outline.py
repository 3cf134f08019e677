# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Plane cages as curves: linear and periodic ones, each a loop of segments, in a plane normal to z."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pxr import Usd, UsdGeom

from .layers import points_at

_FLAT = 1e-6  # of the size: how far points may lie off the plane


def outline_loops(label: str, segments: Sequence[Sequence[int]], point_count: int) -> tuple[np.ndarray, ...]:
    """Return the loops of vertices that segments make.

    Args:
        label: What the errors call the cage.
        segments: Pairs of vertices, each from one vertex of a loop to the next.
        point_count: Number of vertices.

    Raises:
        ValueError: The segments do not make loops that go through each vertex once.
    """
    following = {int(start): int(end) for start, end in segments}
    every = set(range(point_count))
    if len(segments) != point_count or set(following) != every or set(following.values()) != every:
        raise ValueError(
            f"{label} is no outline: just one segment must start and one end at each of its {point_count} vertices; "
            f"there are {len(segments)} segments"
        )
    loops = []
    while following:
        loop, vertex = [], min(following)
        while vertex in following:
            loop.append(vertex)
            vertex = following.pop(vertex)
        loops.append(np.array(loop))
    return tuple(loops)


def define_outline(stage: Usd.Stage, path: str) -> UsdGeom.BasisCurves:
    """Return new curves for the loops of a plane cage, as a guide.

    Args:
        stage: The stage.
        path: Path of the prim.
    """
    curves = UsdGeom.BasisCurves.Define(stage, path)
    curves.CreateTypeAttr(UsdGeom.Tokens.linear)
    curves.CreateWrapAttr(UsdGeom.Tokens.periodic)
    curves.CreatePurposeAttr(UsdGeom.Tokens.guide)
    return curves


def read_outline(label: str, curves: UsdGeom.BasisCurves) -> tuple[np.ndarray, np.ndarray]:
    """Return the points of curves, shape ``(n, 3)``, and the segments of their loops, shape ``(n, 2)``.

    Args:
        label: What the errors call the curves.
        curves: Linear and periodic curves; animated ones are read at their first sample.

    Raises:
        ValueError: The curves are of another kind, or their counts do not fit their points.
    """
    first = Usd.TimeCode.EarliestTime()
    kind = (curves.GetTypeAttr().Get(), curves.GetWrapAttr().Get())
    if kind != (UsdGeom.Tokens.linear, UsdGeom.Tokens.periodic):
        raise ValueError(f"{label}: a plane cage is linear and periodic curves, these are {kind[0]} and {kind[1]}")
    points = points_at(curves, first)
    sizes = np.array(curves.GetCurveVertexCountsAttr().Get(first) or [], dtype=np.int64)
    if len(points) == 0 or sizes.sum() != len(points):
        raise ValueError(f"{label}: curveVertexCounts add up to {sizes.sum()}, but there are {len(points)} points")
    here = np.arange(len(points))
    following = here + 1
    last = np.cumsum(sizes) - 1
    following[last] = last - sizes + 1
    return points, np.stack([here, following], axis=1)


def flat_points(label: str, points: np.ndarray) -> np.ndarray:
    """Return x and y of points that lie in a plane normal to z, shape ``(n, 2)``.

    Args:
        label: What the errors call their owner.
        points: The points, shape ``(n, 3)``.

    Raises:
        ValueError: The points do not lie in such a plane.
    """
    height = np.abs(points[:, 2] - points[0, 2])
    if height.max() > _FLAT * np.ptp(points, axis=0).max():
        raise ValueError(
            f"{label} is not flat: point {height.argmax()} is {height.max():.4g} m away from the plane normal to z "
            "through point 0; turn it, with up_axis or in the file, so that it lies in one"
        )
    return points[:, :2]

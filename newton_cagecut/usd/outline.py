# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Plane cages as curves, each a loop of segments, or as flat meshes, whose border they are, in a plane normal to z."""

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


def border_of(
    label: str, points: np.ndarray, counts: np.ndarray, indices: np.ndarray
) -> tuple[np.ndarray, np.ndarray] | None:
    """Return the border of a flat mesh, as a plane cage: points, shape ``(n, 2)``, and segments, shape ``(n, 2)``.

    The inside is to the left of each segment.

    Args:
        label: What the errors call the mesh.
        points: The points, shape ``(k, 3)``.
        counts: Corners of each face, shape ``(F,)``.
        indices: Point ids of all corners, face after face.

    Returns:
        The border, or ``None`` where the mesh is not flat or has none.

    Raises:
        ValueError: The mesh lies in a plane that is not normal to z.
    """
    spread = points - points.mean(axis=0)
    if np.linalg.matrix_rank(spread.T @ spread, tol=_FLAT**2 * float((spread**2).sum())) > 2:
        return None
    ends = np.cumsum(counts)
    following = np.arange(1, len(indices) + 1)
    following[ends - 1] = ends - counts
    edges = np.stack([indices, indices[following]], axis=1)
    edges = edges[~np.isin(edges @ [len(points), 1], edges @ [1, len(points)])]
    if len(edges) == 0:
        return None
    flat = flat_points(label, points)
    (ax, ay), (bx, by) = np.moveaxis(flat[edges] - flat.mean(axis=0), 0, -1)
    edges = edges[:, ::-1] if (ax * by - ay * bx).sum() < 0.0 else edges
    used, segments = np.unique(edges, return_inverse=True)
    return flat[used], segments.reshape(-1, 2)

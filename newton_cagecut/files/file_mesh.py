# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A polygon mesh as it stands in a file, and how its points are split, joined and left out."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

_DIGITS = 6  # of attributes: corners of one point that agree to these have one value


@dataclass(frozen=True, eq=False)
class FileMesh:
    """A polygon mesh in the units of its file.

    Attributes:
        name: Its name in the file.
        points: Its points, shape ``(n, 3)``, float64.
        counts: Corners of each face, shape ``(F,)``.
        indices: Point ids of all corners, face after face, shape ``(C,)``.
        uvs: Texture coordinates of the points, shape ``(n, 2)``, or ``None``.
        normals: Normals of the points, shape ``(n, 3)``, or ``None``.
    """

    name: str
    points: np.ndarray
    counts: np.ndarray
    indices: np.ndarray
    uvs: np.ndarray | None = None
    normals: np.ndarray | None = None

    @property
    def loops(self) -> list[list[int]]:
        """The faces as lists of point ids."""
        corners, ends = self.indices.tolist(), np.cumsum(self.counts).tolist()
        return [corners[end - count : end] for end, count in zip(ends, self.counts.tolist())]

    def reversed(self) -> FileMesh:
        """The mesh with its faces turned over; its normals stay."""
        ends = np.cumsum(self.counts)
        back = np.repeat(2 * ends - self.counts - 1, self.counts) - np.arange(len(self.indices))
        return replace(self, indices=self.indices[back])


def split_at_seams(mesh: FileMesh, corner_uvs: np.ndarray | None, corner_normals: np.ndarray | None) -> FileMesh:
    """Give attributes of corners to points: a point whose corners differ gets copies, which follow all points.

    Args:
        mesh: The mesh, without attributes.
        corner_uvs: Texture coordinates of the corners, shape ``(C, 2)``, or ``None``.
        corner_normals: Normals of the corners, shape ``(C, 3)``, or ``None``.
    """
    given = [values for values in (corner_uvs, corner_normals) if values is not None]
    if not given or len(mesh.indices) == 0:
        return mesh
    key = np.round(np.concatenate(given, axis=1), _DIGITS) + 0.0
    first = np.zeros(len(mesh.points), dtype=np.int64)
    first[mesh.indices[::-1]] = np.arange(len(key))[::-1]
    other = (key != key[first[mesh.indices]]).any(axis=1)
    rows, copy = np.unique(np.column_stack([mesh.indices[other], key[other]]), axis=0, return_inverse=True)
    points = np.concatenate([mesh.points, mesh.points[rows[:, 0].astype(np.int64)]])
    indices = mesh.indices.copy()
    indices[other] = len(mesh.points) + copy.reshape(-1)
    spread = [_of_points(values, indices, len(points)) for values in (corner_uvs, corner_normals)]
    return FileMesh(mesh.name, points, mesh.counts, indices, *spread)


def joined(meshes: list[FileMesh]) -> FileMesh:
    """Meshes as one; those that share an array of points go on sharing it.

    Texture coordinates are zero where a mesh has none; normals are kept if all meshes have them.
    """
    if len(meshes) == 1:
        return meshes[0]
    counts = np.concatenate([mesh.counts for mesh in meshes])
    if all(mesh.points is meshes[0].points for mesh in meshes):
        return replace(meshes[0], counts=counts, indices=np.concatenate([mesh.indices for mesh in meshes]))
    start = np.cumsum([0, *(len(mesh.points) for mesh in meshes)])
    uvs = normals = None
    if any(mesh.uvs is not None for mesh in meshes):
        uvs = np.concatenate([np.zeros((len(m.points), 2)) if m.uvs is None else m.uvs for m in meshes])
    if all(mesh.normals is not None for mesh in meshes):
        normals = np.concatenate([mesh.normals for mesh in meshes])
    points = np.concatenate([mesh.points for mesh in meshes])
    indices = np.concatenate([mesh.indices + offset for mesh, offset in zip(meshes, start)])
    return FileMesh(meshes[0].name, points, counts, indices, uvs, normals)


def used_points(mesh: FileMesh) -> FileMesh:
    """The mesh without points that no face has."""
    used = np.zeros(len(mesh.points), dtype=bool)
    used[mesh.indices] = True
    number = np.cumsum(used) - 1
    kept = [None if values is None else values[used] for values in (mesh.uvs, mesh.normals)]
    return FileMesh(mesh.name, mesh.points[used], mesh.counts, number[mesh.indices], *kept)


def welded(mesh: FileMesh) -> FileMesh:
    """The mesh with points at one place joined to the first of them.

    Texture coordinates are left out if they differ somewhere between joined points; normals are summed.
    """
    _, first, group = np.unique(mesh.points + 0.0, axis=0, return_index=True, return_inverse=True)
    group = group.reshape(-1)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    number, kept = rank[group], first[order]
    uvs = normals = None
    if mesh.uvs is not None and np.abs(mesh.uvs - mesh.uvs[kept][number]).max() <= 0.1**_DIGITS:
        uvs = mesh.uvs[kept]
    if mesh.normals is not None:
        normals = np.zeros((len(kept), 3))
        np.add.at(normals, number, mesh.normals)
    return FileMesh(mesh.name, mesh.points[kept], mesh.counts, number[mesh.indices], uvs, normals)


def _of_points(values: np.ndarray | None, indices: np.ndarray, count: int) -> np.ndarray | None:
    """Values of corners as values of their points, zero for points without corners."""
    if values is None:
        return None
    spread = np.zeros((count, values.shape[1]))
    spread[indices] = values
    return spread

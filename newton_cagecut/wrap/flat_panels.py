# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Triangles of a shell that are nearly in a plane, joined into polygons that are.

The sides of a panel stay one loop through all of its vertices, and every vertex keeps three panels, so that a closed
mesh of polygons comes out. That k vertices are in a plane is k - 3 conditions: their heights over a plane are no
combination of 1, x and y. Newton's method of least moves on all of them, quadratic, ends it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..geometry import triangle_normals, units
from .shell import Shell, flatness

_ROUNDS = 12
_PLANAR = 1e-9  # of the shell's size of about 1; a cage asks for 1e-6


def flat_panels(shell: Shell, angle: float) -> list[np.ndarray]:
    """Return groups of triangles to make flat, those with a flat edge between them first.

    Args:
        shell: The shell.
        angle: Largest angle between the normals of a panel and a triangle that joins it [deg].

    Returns:
        Triangle ids of each panel of more than one.
    """
    least, normals = np.cos(np.radians(angle)), shell.normals
    areas = triangle_normals(shell.corners)
    panel = np.arange(len(normals))
    members = {k: [k] for k in range(len(normals))}
    edges, sides = _inner_edges(shell.triangles)
    cosine = np.einsum("ni,ni->n", normals[sides[:, 0]], normals[sides[:, 1]])
    fans = [set(np.flatnonzero((shell.triangles == v).any(axis=1)).tolist()) for v in range(len(shell.vertices))]
    for k in np.argsort(-cosine, kind="stable"):
        one, other = (int(panel[side]) for side in sides[k])
        if cosine[k] < least or one == other:
            continue
        vertices = [set(shell.triangles[members[p]].reshape(-1).tolist()) for p in (one, other)]
        both = members[one] + members[other]
        normal = units(areas[both].sum(axis=0))
        if len(vertices[0] & vertices[1]) > 2 or (normals[both] @ normal).min() < least:
            continue
        if any(len({int(panel[t]) for t in fans[v]} - {other}) < 3 for v in edges[k]):
            continue
        panel[members[other]] = one
        members[one] = both
        del members[other]
    return [np.array(triangles) for triangles in members.values() if len(triangles) > 1]


def flattened(shell: Shell, panels: Sequence[np.ndarray]) -> Shell:
    """Return a shell with the least moves that make panels flat.

    Args:
        shell: The shell, its panels nearly flat.
        panels: Triangle ids of each.

    Raises:
        ValueError: No flat panels are near.
    """
    for _ in range(_ROUNDS):
        rows, wanted = [], []
        for panel in panels:
            vertices, weights, normal, missing = flatness(shell, panel)
            row = np.zeros((len(weights), len(shell.vertices), 3))
            row[:, vertices] = weights[:, :, None] * normal
            rows.append(row.reshape(len(weights), -1))
            wanted.append(missing)
        if not panels or np.abs(np.concatenate(wanted)).max() < _PLANAR:
            return shell
        moves = np.linalg.lstsq(np.concatenate(rows), np.concatenate(wanted), rcond=None)[0]
        shell = shell.moved(moves.reshape(-1, 3))
    raise ValueError("the panels of the cage do not become flat")


def panel_loops(shell: Shell, panels: Sequence[np.ndarray]) -> list[tuple[int, ...]]:
    """Return the faces of a shell with its panels as polygons.

    Args:
        shell: The shell.
        panels: Triangle ids of each.
    """
    single = np.ones(len(shell.triangles), dtype=bool)
    loops = []
    for panel in panels:
        single[panel] = False
        loops.append(_loop(shell.triangles[panel]))
    return [tuple(triangle) for triangle in shell.triangles[single].tolist()] + loops


def _loop(triangles: np.ndarray) -> tuple[int, ...]:
    """The border of a disc of triangles."""
    sides = {(int(t[k]), int(t[(k + 1) % 3])) for t in triangles for k in range(3)}
    following = {a: b for a, b in sides if (b, a) not in sides}
    loop = [min(following)]
    while len(loop) < len(following):
        loop.append(following[loop[-1]])
    return tuple(loop)


def _inner_edges(triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vertices of the edges of a closed mesh, and the two triangles beside each."""
    sides = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    order = np.lexsort(sides.T)
    return sides[order[::2]], (order // 3).reshape(-1, 2)

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The cage of Newton's bunny: ``python -m assets.bunny`` writes bunny_cage.usda.

The bunny itself stays in the newton wheel (``newton.examples.get_asset("bunny.usd")``). Its skin is offset outward,
triangulated coarsely and coarsened to a hull of a few dozen triangles. Metres, +Z up.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from assets.hull import ProgressiveHull
from assets.implicit import order_along, repel, restricted_delaunay, scatter
from newton_cagecut.usd import read_mesh, write_mesh

FACE_COUNT = 56
OFFSET = 0.07  # of the first hull from the skin [m]


def bunny_mesh() -> tuple[np.ndarray, np.ndarray]:
    """Return the points ``(6102, 3)`` [m] and the triangles ``(12200, 3)`` of Newton's bunny, +Z up."""
    import newton.examples

    mesh = read_mesh(newton.examples.get_asset("bunny.usd"), up_axis="Z")
    return mesh.points, mesh.triangles


def bunny_cage() -> tuple[np.ndarray, list[tuple[int, ...]]]:
    """Return the vertices [m] and the triangles of the bunny's cage."""
    points, triangles = bunny_mesh()
    corners = points[triangles]
    centres, normals = corners.mean(axis=1), np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    tree = cKDTree(centres)

    def field(places: np.ndarray) -> np.ndarray:
        distance, nearest = tree.query(places)
        outside = np.einsum("ij,ij->i", places - centres[nearest], normals[nearest]) > 0.0
        return np.where(outside, distance, -distance) - OFFSET

    lower, upper = points.min(axis=0) - 1.2 * OFFSET, points.max(axis=0) + 1.2 * OFFSET
    shell = scatter(field, lower, upper, 700, step=1e-3, seed=1)
    shell = repel(field, shell, step=1e-3, iterations=40)
    shell, shell_triangles = order_along(shell, restricted_delaunay(field, shell))
    return ProgressiveHull(shell, shell_triangles).coarsen(FACE_COUNT)


def main(folder: Path = Path(__file__).parent) -> None:
    """Write bunny_cage.usda.

    Args:
        folder: Where to.
    """
    write_mesh(folder / "bunny_cage.usda", *bunny_cage(), name="bunny_cage", purpose="guide")


if __name__ == "__main__":
    main()

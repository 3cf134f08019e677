# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Weights and gradients by finite elements of scikit-fem, of degree 1 or 2."""

from __future__ import annotations

from collections.abc import Sequence
from time import perf_counter

import numpy as np
from scipy.spatial import cKDTree
from skfem import Basis, ElementTetP1, ElementTetP2, ElementTriP1, ElementTriP2, MeshTet, MeshTri
from skfem.models.poisson import laplace

from ...cage import Cage
from .boundary import boundary_values, solved
from .meshing import fill

_ELEMENTS = {(2, 1): ElementTriP1, (2, 2): ElementTriP2, (3, 1): ElementTetP1, (3, 2): ElementTetP2}
_CANDIDATES = 24  # simplices that are tried for a point before all of them are


def element_weights(
    cages: tuple[Cage, Cage],
    swept: Sequence[np.ndarray],
    front: np.ndarray,
    points: np.ndarray,
    has_gradient: np.ndarray,
    *,
    order: int,
    cells: int,
) -> tuple[np.ndarray, np.ndarray, dict]:
    """Find weights and gradients, from meshing to the last value.

    Args:
        cages: The cage before the cut and as it is.
        swept: What the blade has swept, polygons or in the plane segments [m].
        front: Ends of the front, in the plane the tip [m].
        points: Points [m], shape (n, dimension).
        has_gradient: Which of them have gradients, as a mask.
        order: Degree of the elements, 1 or 2.
        cells: Simplices that would fill the cage if they were regular.

    Returns:
        Weights, shape (n, v), gradients [1/m], shape (m, v, dimension), and the seconds, those without the mesher, and
        the number of unknowns.

    Raises:
        ValueError: The mesher failed.
    """
    start = perf_counter()
    before, cage = cages
    nodes, simplices = fill(before, swept, front, cells)
    meshed = perf_counter()
    kind = MeshTri if cage.dimension == 2 else MeshTet
    mesh = kind(np.ascontiguousarray(nodes.T), np.ascontiguousarray(simplices.T), validate=False)
    basis = Basis(mesh, _ELEMENTS[cage.dimension, order]())
    border = basis.get_dofs().flatten()
    solution = solved(laplace.assemble(basis), boundary_values(basis, cage, order=order), border)
    weights, gradients = _evaluated(basis, solution, points, has_gradient)
    end = perf_counter()
    values = {"seconds": end - start, "solve_seconds": end - meshed, "unknowns": int(basis.N - len(border))}
    return weights, gradients, values


def warm_up() -> None:
    """Load the mesher and the elements, so that this is not measured."""
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    cage = Cage(corners, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
    point = corners.mean(axis=0, keepdims=True)
    element_weights((cage, cage), [], corners[:0], point, np.array([True]), order=2, cells=1)


def _evaluated(
    basis: Basis, solution: np.ndarray, points: np.ndarray, has_gradient: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Weights of points, and gradients of some, from the values of the degrees of freedom."""
    mesh = basis.mesh
    cells, place = located(mesh.p.T, mesh.t.T, points)
    weights = np.zeros((len(points), solution.shape[1]))
    gradients = np.zeros((len(points), solution.shape[1], points.shape[1]))
    for k in range(basis.Nbfun):
        field = basis.elem.gbasis(basis.mapping, place.T[:, :, None], k, tind=cells)[0]
        value = solution[basis.element_dofs[k, cells]]
        weights += np.asarray(field).reshape(-1, 1) * value
        gradients += value[:, :, None] * np.asarray(field.grad)[:, :, 0].T[:, None]
    return weights, gradients[has_gradient]


def located(nodes: np.ndarray, simplices: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the simplex that each point is in, or nearly in, and its coordinates there.

    Args:
        nodes: Nodes, shape (k, dimension) [m].
        simplices: Simplices, shape (m, dimension + 1).
        points: Points, shape (n, dimension) [m].

    Returns:
        Simplices, shape (n,), and the barycentric coordinates of all corners but the first, shape (n, dimension).
    """
    corner = nodes[simplices]
    inverse = np.linalg.inv((corner[:, 1:] - corner[:, :1]).transpose(0, 2, 1))
    _, near = cKDTree(corner.mean(axis=1)).query(points, min(_CANDIDATES, len(simplices)))
    cells, inside = _best(corner[:, 0], inverse, points, near.reshape(len(points), -1))
    left = np.flatnonzero(~inside)
    if len(left):
        everything = np.broadcast_to(np.arange(len(simplices)), (len(left), len(simplices)))
        cells[left] = _best(corner[:, 0], inverse, points[left], everything)[0]
    return cells, np.einsum("nij,nj->ni", inverse[cells], points - corner[cells, 0])


def _best(
    origin: np.ndarray, inverse: np.ndarray, points: np.ndarray, candidates: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Of each point's candidates the one that it is deepest in, and whether it is in."""
    rest = np.einsum("ncij,ncj->nci", inverse[candidates], points[:, None] - origin[candidates])
    depth = np.minimum(rest.min(axis=2), 1.0 - rest.sum(axis=2))
    chosen = depth.argmax(axis=1)
    rows = np.arange(len(points))
    return candidates[rows, chosen], depth[rows, chosen] > -1e-9

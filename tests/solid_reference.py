# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Harmonic coordinates of a cage that is cut part of the way, by quadratic finite elements of scikit-fem.

The tetrahedra stand on a grid, in whose planes the cage's faces and the cut lie; nodes on the opened part of the cut
are there once for each side. The boundary values are the library's by definition, not by its code: harmonic on a face,
from ``plane_reference``, or mean value coordinates (paper, equation 4).
"""

from __future__ import annotations

from itertools import pairwise, permutations

import numpy as np
from scipy.sparse import csr_matrix
from skfem import Basis, ElementTetP2, MeshTet
from skfem.models.poisson import laplace

from harmonic_shapes import mean_value
from newton_cagecut.cage import Cage, Cut
from plane_reference import PlaneReference


def crowded(stops: list[float], crowds: list[float], count: int) -> np.ndarray:
    """Coordinates from stop to stop, some of which they crowd towards as the square of the distance.

    Args:
        stops: First, last and those in between, ascending.
        crowds: The stops where they are to be dense.
        count: Intervals from one stop to the next, even.
    """
    share = np.linspace(0.0, 1.0, count + 1)
    parts = [stops[:1]]
    for low, high in pairwise(stops):
        steps = share
        if low in crowds:
            steps = (
                np.where(share < 0.5, 2.0 * share**2, 1.0 - 2.0 * (1.0 - share) ** 2) if high in crowds else share**2
            )
        elif high in crowds:
            steps = 1.0 - (1.0 - share) ** 2
        parts.append(low + (high - low) * steps[1:])
    return np.concatenate(parts)


class SolidReference:
    """Finite elements on a cut cage.

    Args:
        cut: A cut whose plane is a plane of the grid and whose front is a line of it.
        ticks: Coordinates of the grid's planes, one array an axis; the cage's faces lie in them.
        points: Nodes of the grid inside the cage at which weights are wanted, shape (point_count, 3).
    """

    def __init__(self, cut: Cut, ticks: list[np.ndarray], points: np.ndarray) -> None:
        self.cage = cut.cage
        self._side_of = cut.plane.distance
        self._basis = Basis(_slit_mesh(cut, ticks), ElementTetP2(), intorder=2)
        self._border = self._basis.get_dofs().flatten()
        stiffness = laplace.assemble(self._basis).tocsr()
        inner = np.setdiff1d(np.arange(self._basis.N), self._border)
        offset = np.abs(self._basis.mesh.p.T[:, None] - points).max(axis=2)
        assert (offset.min(axis=0) < 1e-9).all(), "points must be nodes of the grid"
        load = (inner[:, None] == self._basis.nodal_dofs[0, offset.argmin(axis=0)]).astype(np.float64)
        # Solving for the points instead of the vertices: the weights are sums over the border by the same influence.
        response = conjugate_gradients(stiffness[inner][:, inner], load)
        self._influence = -(stiffness[self._border][:, inner] @ response).T

    def weights(self, *, quads: str) -> np.ndarray:
        """Weights of the points, shape (point_count, cage.vertex_count), for one rule of convex quads."""
        return self._influence @ self._hats(quads)[self._border]

    def _hats(self, quads: str) -> np.ndarray:
        """Every vertex's boundary function at the degrees of freedom, shape (N, cage.vertex_count)."""
        cage, mesh = self.cage, self._basis.mesh
        facets = mesh.boundary_facets()
        center = mesh.p[:, mesh.facets[:, facets]].mean(axis=1).T
        side = (self._side_of(mesh.p[:, mesh.t[:, mesh.f2t[0, facets]]].mean(axis=1).T) > 0.0).astype(int)
        values = np.zeros((self._basis.N, cage.vertex_count))
        # On the slit of a face its two sides are told apart by the sides of the cut, which overwrite it.
        for face in sorted(range(cage.face_count), key=lambda face: not _is_slit(cage, face)):
            wall = cage.walls[cage.face_wall[face]]
            corners, local = _in_plane(cage, face)
            own = np.abs((center - wall.origin) @ wall.normal) < 1e-9
            if wall.two_sided:
                own &= side == cage.face_side[face]
            own &= _inside(corners, local(center))
            used = self._basis.get_dofs(facets[own]).flatten()
            place = local(self._basis.doflocs[:, used].T)
            if quads == "mean_value" and len(corners) == 4:
                found = np.array([mean_value(corners, point) for point in place])
            else:
                found = PlaneReference(corners).weights(place)
            values[used] = 0.0
            values[np.ix_(used, cage.faces[face])] = found
        return values


def conjugate_gradients(matrix: csr_matrix, right: np.ndarray, rtol: float = 1e-9) -> np.ndarray:
    """Solve a symmetric positive system for several right-hand sides at once, shape (n, k)."""
    scale = 1.0 / matrix.diagonal()[:, None]
    solution, residual = np.zeros_like(right), right.copy()
    direction = scale * residual
    product = np.einsum("ij,ij->j", residual, direction)
    limit = rtol**2 * product
    while (product > limit).any():
        image = matrix @ direction
        step = product / np.einsum("ij,ij->j", direction, image)
        solution += step * direction
        residual -= step * image
        smoothed = scale * residual
        product, last = np.einsum("ij,ij->j", residual, smoothed), product
        direction = smoothed + product / last * direction
    return solution


def _slit_mesh(cut: Cut, ticks: list[np.ndarray]) -> MeshTet:
    """Six tetrahedra in each cell of the grid inside the cage, their nodes doubled where the cut is open."""
    shape = tuple(len(axis) for axis in ticks)
    node = np.arange(np.prod(shape)).reshape(shape)
    place = np.stack(np.meshgrid(*ticks, indexing="ij"), axis=-1).reshape(-1, 3)
    tetrahedra = np.concatenate([_corners_along(node, order) for order in permutations(range(3))])
    tetrahedra = tetrahedra[cut.base.contains(place[tetrahedra].mean(axis=1))]
    doubled = np.flatnonzero(
        (np.abs(cut.plane.distance(place)) < 1e-9) & (cut.plane.coordinates(place)[:, 1] < cut.front - 1e-9)
    )
    other = np.arange(len(place))
    other[doubled] = len(place) + np.arange(len(doubled))
    beyond = cut.plane.distance(place[tetrahedra].mean(axis=1)) > 0.0
    tetrahedra[beyond] = other[tetrahedra[beyond]]
    used, tetrahedra = np.unique(tetrahedra, return_inverse=True)
    place = np.concatenate([place, place[doubled]])[used]
    return MeshTet(np.ascontiguousarray(place.T), np.ascontiguousarray(tetrahedra.reshape(-1, 4).T))


def _corners_along(node: np.ndarray, order: tuple[int, ...]) -> np.ndarray:
    """In each cell, the tetrahedron around the path from its least to its greatest corner, axis after axis."""
    offset = np.cumsum([np.zeros(3, dtype=int), *np.eye(3, dtype=int)[list(order)]], axis=0)
    last = np.array(node.shape) - 1
    corners = [node[tuple(slice(o, o + n) for o, n in zip(row, last))] for row in offset]
    return np.stack([corner.ravel() for corner in corners], axis=1)


def _is_slit(cage: Cage, face: int) -> bool:
    """Whether a face's loop runs along the same line twice."""
    return len(np.unique(cage.vertices[list(cage.faces[face])], axis=0)) < len(cage.faces[face])


def _in_plane(cage: Cage, face: int):
    """A face's corners in its plane, counterclockwise, and the map that takes points there."""
    wall = cage.walls[cage.face_wall[face]]
    axes = wall.axes if cage.face_side[face] == 0 else wall.axes[::-1]

    def local(points: np.ndarray) -> np.ndarray:
        return (points - wall.origin) @ axes.T

    return local(cage.vertices[list(cage.faces[face])]), local


def _inside(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Whether points lie in a polygon, by the even-odd rule."""
    start, end = corners, np.roll(corners, -1, axis=0)
    crosses = (start[:, 1] > points[:, None, 1]) != (end[:, 1] > points[:, None, 1])
    with np.errstate(divide="ignore", invalid="ignore"):
        x = start[:, 0] + (points[:, None, 1] - start[:, 1]) * (end[:, 0] - start[:, 0]) / (end[:, 1] - start[:, 1])
    return np.count_nonzero(crosses & (points[:, None, 0] < x), axis=1) % 2 == 1

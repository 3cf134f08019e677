# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Every cage vertex's boundary function at the nodes of a mesh that fills the cage.

The rules are the library's by definition, not by its code: linear on segments and triangles, mean value coordinates on
convex quads (paper, equation 4), harmonic on all other faces, there by finite elements on the mesh's own facets.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse.linalg import splu
from skfem import Basis, ElementTriP1, ElementTriP2, MeshTri
from skfem.models.poisson import laplace

from ...cage import Cage

_TOLERANCE = 1e-5  # of the cage's diameter


def boundary_values(basis: Basis, cage: Cage, *, order: int) -> np.ndarray:
    """Return the boundary functions at the degrees of freedom, shape (N, cage.vertex_count).

    Args:
        basis: The elements.
        cage: The cage, cut as the mesh is.
        order: Degree of the elements, 1 or 2.
    """
    values = np.zeros((basis.N, cage.vertex_count))
    facets = basis.mesh.boundary_facets()
    face_of = _faces_of(basis.mesh, facets, cage)
    for face in range(cage.face_count):
        own = facets[face_of == face]
        if not len(own):
            continue
        corners = list(cage.faces[face])
        if cage.dimension == 2:
            used = basis.get_dofs(own).flatten()
            values[np.ix_(used, corners)] = _on_segment(cage.vertices[corners], basis.doflocs[:, used].T)
            continue
        loop, local = _in_plane(cage, face)
        if len(loop) == 3 or (len(loop) == 4 and _is_convex(loop)):
            used = basis.get_dofs(own).flatten()
            rule = _on_triangle if len(loop) == 3 else _mean_value
            found = rule(loop, local(basis.doflocs[:, used].T))
        else:
            used, found = _harmonic(basis, own, loop, local, order)
        values[np.ix_(used, corners)] = found
    return values


def _faces_of(mesh: object, facets: np.ndarray, cage: Cage) -> np.ndarray:
    """The cage's face that each boundary facet lies on, by plane, side and place."""
    corner = mesh.p[:, mesh.facets[:, facets]]  # (dimension, corners, facets)
    center = corner.mean(axis=1).T
    inside = mesh.p[:, mesh.t[:, mesh.f2t[0, facets]]].mean(axis=1).T
    simplices = cage.vertices[cage.simplices]
    owner = cage.simplex_face
    outward = _outward(simplices)
    best, found = np.full(len(facets), np.inf), np.full(len(facets), -1)
    for simplex, normal, face in zip(simplices, outward, owner.tolist()):
        flat = np.abs((center - simplex[0]) @ normal) < _TOLERANCE * cage.diameter
        near = np.flatnonzero(flat & ((inside - center) @ normal < 0.0))
        if not len(near):
            continue
        out = _outside_by(simplex, center[near])
        closer = out < best[near]
        best[near[closer]], found[near[closer]] = out[closer], face
    return found


def _outward(simplices: np.ndarray) -> np.ndarray:
    """Unit normals, outward."""
    edges = simplices[:, 1:] - simplices[:, :1]
    if simplices.shape[2] == 2:
        normal = np.stack([edges[:, 0, 1], -edges[:, 0, 0]], axis=1)
    else:
        normal = np.cross(edges[:, 0], edges[:, 1])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    return normal / np.where(length > 0.0, length, 1.0)


def _outside_by(simplex: np.ndarray, points: np.ndarray) -> np.ndarray:
    """How far barycentric coordinates of points in a simplex's plane are below 0."""
    edges = (simplex[1:] - simplex[0]).T
    rest = np.linalg.lstsq(edges, (points - simplex[0]).T, rcond=None)[0]
    return np.maximum(0.0, -np.minimum(rest.min(axis=0), 1.0 - rest.sum(axis=0)))


def _on_segment(ends: np.ndarray, points: np.ndarray) -> np.ndarray:
    along = ends[1] - ends[0]
    share = np.clip((points - ends[0]) @ along / (along @ along), 0.0, 1.0)
    return np.stack([1.0 - share, share], axis=1)


def _on_triangle(loop: np.ndarray, points: np.ndarray) -> np.ndarray:
    rest = np.linalg.solve((loop[1:] - loop[0]).T, (points - loop[0]).T).T
    return np.column_stack([1.0 - rest.sum(axis=1), rest])


def _in_plane(cage: Cage, face: int):
    """A face's corners in its plane, counterclockwise, and the map that takes points there."""
    wall = cage.walls[cage.face_wall[face]]
    axes = wall.axes * np.array([[1.0], [1.0 if cage.face_side[face] == 0 else -1.0]])

    def local(points: np.ndarray) -> np.ndarray:
        return (points - wall.origin) @ axes.T

    return local(cage.vertices[list(cage.faces[face])]), local


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _is_convex(loop: np.ndarray) -> bool:
    edges = np.roll(loop, -1, axis=0) - loop
    return bool((_cross(np.roll(edges, 1, axis=0), edges) > 1e-6 * (edges**2).sum(axis=1).max()).all())


def _mean_value(loop: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Mean value coordinates in a convex polygon; linear on its edges (Floater 2003)."""
    offset = loop - points[:, None]
    radius = np.linalg.norm(offset, axis=2)
    following = np.roll(offset, -1, axis=1)
    sine = _cross(offset, following)
    cosine = (offset * following).sum(axis=2)
    tangent = sine / np.maximum(radius * np.roll(radius, -1, axis=1) + cosine, 1e-300)  # of half of the angle
    weight = (np.roll(tangent, 1, axis=1) + tangent) / np.maximum(radius, 1e-300)
    values = weight / weight.sum(axis=1, keepdims=True)
    for k in range(len(loop)):
        end = (k + 1) % len(loop)
        along = loop[end] - loop[k]
        on_edge = np.abs(sine[:, k]) < 1e-5 * (along @ along)
        on_edge &= cosine[:, k] < 1e-9 * (along @ along)
        values[on_edge] = 0.0
        values[np.ix_(np.flatnonzero(on_edge), [k, end])] = _on_segment(loop[[k, end]], points[on_edge])
    return values


def _harmonic(basis: Basis, facets: np.ndarray, loop: np.ndarray, local, order: int) -> tuple[np.ndarray, np.ndarray]:
    """Degrees of freedom on a face and the harmonic coordinates of its polygon there."""
    mesh = basis.mesh
    nodes, triangles = np.unique(mesh.facets[:, facets], return_inverse=True)
    triangles = triangles.reshape(3, -1)
    place = local(mesh.p[:, nodes].T)
    edge = place[triangles[1]] - place[triangles[0]]
    back = _cross(edge, place[triangles[2]] - place[triangles[0]]) < 0.0
    triangles[1:, back] = triangles[:0:-1, back]
    plane = MeshTri(np.ascontiguousarray(place.T), np.ascontiguousarray(triangles))
    patch = Basis(plane, ElementTriP2() if order == 2 else ElementTriP1())
    values = _loop_values(patch, loop)
    values = solved(laplace.assemble(patch), values, patch.get_dofs().flatten())
    return _dofs_in_space(basis, patch, nodes, order), values


def _loop_values(patch: Basis, loop: np.ndarray) -> np.ndarray:
    """The polygon's hat functions on its boundary, a slit's sides told apart by their directions."""
    plane = patch.mesh
    border = plane.boundary_facets()
    ends = plane.p.T[plane.facets[:, border]]  # (2, count, 2)
    inward = plane.p[:, plane.t[:, plane.f2t[0, border]]].mean(axis=1).T - ends[0]
    along = ends[1] - ends[0]
    along *= np.where(_cross(along, inward) > 0.0, 1.0, -1.0)[:, None]
    start, side = loop, np.roll(loop, -1, axis=0) - loop
    length = (side**2).sum(axis=1)
    center = ends.mean(axis=0)[:, None] - start
    share = np.clip((center * side).sum(axis=2) / length, 0.0, 1.0)
    distance = np.linalg.norm(center - share[:, :, None] * side, axis=2)
    distance = np.where(along @ side.T > 0.0, distance, np.inf)
    values = np.zeros((patch.N, len(loop)))
    for k in np.unique(distance.argmin(axis=1)):
        used = patch.get_dofs(border[distance.argmin(axis=1) == k]).flatten()
        pair = [k, (k + 1) % len(loop)]
        values[used] = 0.0
        values[np.ix_(used, pair)] = _on_segment(loop[pair], patch.doflocs[:, used].T)
    return values


def _dofs_in_space(basis: Basis, patch: Basis, nodes: np.ndarray, order: int) -> np.ndarray:
    """Degrees of freedom of the elements that those of a face are."""
    found = np.empty(patch.N, dtype=np.int64)
    found[patch.nodal_dofs[0]] = basis.nodal_dofs[0, nodes]
    if order == 2:
        count = basis.mesh.p.shape[1]
        keys = np.sort(basis.mesh.edges, axis=0).T @ [count, 1]
        wanted = np.sort(nodes[patch.mesh.facets], axis=0).T @ [count, 1]
        rank = np.argsort(keys)
        found[patch.facet_dofs[0]] = basis.edge_dofs[0, rank[np.searchsorted(keys[rank], wanted)]]
    return found


def solved(stiffness: object, values: np.ndarray, border: np.ndarray) -> np.ndarray:
    """Return a solution of the Laplace equation for each column of values on the border, which it keeps.

    Args:
        stiffness: The stiffness, sparse, shape (N, N).
        values: Values, shape (N, count); only those on the border are read.
        border: Degrees of freedom on the border.
    """
    stiffness = stiffness.tocsr()
    inner = np.setdiff1d(np.arange(stiffness.shape[0]), border)
    values = values.copy()
    if len(inner):
        rows = stiffness[inner]
        load = -(rows[:, border] @ values[border])
        factor = splu(
            rows[:, inner].tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
        )
        values[inner] = factor.solve(load)
    return values

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Simplices that fill a cage, conforming to its faces and to a cut, by Netgen (LGPL).

The cage's polygons and those that the blade has swept are glued as a boundary representation, from which Netgen meshes
edges, faces and the inside. Elements are small along the front, where the gradients are singular. The nodes on the cut
are then doubled: corners of elements are one node where they are joined across facets that are not on the cut, which
leaves the front single and opens the rest.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ...cage import Cage

_FRONT_SHARE = {2: 0.01, 3: 0.2}  # of the longest edge, along the front, by the dimension
_GRADING = 0.4
_REGULAR = {2: 0.433, 3: 0.118}  # size of a regular triangle and tetrahedron of edge 1


def fill(cage: Cage, swept: Sequence[np.ndarray], front: np.ndarray, cells: int) -> tuple[np.ndarray, np.ndarray]:
    """Fill a cage with simplices, open along a cut.

    Args:
        cage: The cage before the cut.
        swept: What the blade has swept, polygons or in the plane segments, each of shape (corner_count, dimension) [m].
        front: Ends of the front, in the plane the tip, shape (end_count, dimension) [m]; none before the cut.
        cells: Simplices that would fill the cage if they were regular; small faces and the front bring more.

    Returns:
        Nodes, shape (n, dimension) [m], and simplices, shape (m, dimension + 1).

    Raises:
        ValueError: The mesher failed.
    """
    import netgen.meshing
    from netgen.occ import OCCGeometry

    netgen.meshing.SetMessageImportance(0)
    low = cage.vertices.min(axis=0)
    scale = float((cage.vertices.max(axis=0) - low).max())
    size = _edge(cage, cells) / scale
    shape = _shape(cage, [(polygon - low) / scale for polygon in swept], low, scale)
    _refine(shape, (front - low) / scale, _FRONT_SHARE[cage.dimension] * size)
    try:
        mesh = OCCGeometry(shape, dim=cage.dimension).GenerateMesh(maxh=size, grading=_GRADING)
    except Exception as error:  # Netgen has a class of its own for its failures, and OCC another
        raise ValueError(f"Netgen cannot mesh the cage: {error}") from None
    nodes = mesh.Coordinates()[:, : cage.dimension]
    cells, sheets = (
        (mesh.Elements2D(), mesh.Elements1D()) if cage.dimension == 2 else (mesh.Elements3D(), mesh.Elements2D())
    )
    simplices = _corners(cells, cage.dimension + 1)
    if not len(simplices):
        raise ValueError("Netgen cannot mesh the cage: it made no element inside")
    nodes, simplices = opened(nodes, simplices, _corners(sheets, cage.dimension))
    return low + scale * nodes, simplices


def _edge(cage: Cage, cells: int) -> float:
    """Edge of as many equal simplices as fill the cage [m]."""
    return float((cage.volume / (_REGULAR[cage.dimension] * cells)) ** (1.0 / cage.dimension))


def opened(nodes: np.ndarray, simplices: np.ndarray, sheets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Double the nodes where facets between two simplices are on a sheet.

    Args:
        nodes: Nodes, shape (n, dimension).
        simplices: Simplices, shape (m, dimension + 1).
        sheets: Facets on the boundary or on a cut, shape (k, dimension).

    Returns:
        Nodes and simplices.
    """
    count = simplices.shape[1]
    facets = np.concatenate([np.delete(simplices, k, axis=1) for k in range(count)])
    owner = np.tile(np.arange(len(simplices)), count)
    keys, sheet_keys = _keys(facets, len(nodes)), _keys(sheets, len(nodes))
    order = np.argsort(keys, kind="stable")
    joined = np.flatnonzero((keys[order][1:] == keys[order][:-1]) & ~np.isin(keys[order][1:], sheet_keys))
    one, other = order[joined], order[joined + 1]
    links = []
    for k in range(count - 1):
        vertex = facets[one, k]
        links.append([_corner_of(simplices, owner[side], vertex) for side in (one, other)])
    first, second = np.concatenate(links, axis=1)
    corner_count = simplices.size
    graph = coo_matrix((np.ones(len(first)), (first, second)), shape=(corner_count, corner_count))
    _, label = connected_components(graph, directed=False)
    _, example, corner_node = np.unique(label, return_index=True, return_inverse=True)
    return nodes[simplices.ravel()[example]], corner_node.reshape(simplices.shape)


def _corner_of(simplices: np.ndarray, simplex: np.ndarray, vertex: np.ndarray) -> np.ndarray:
    """Number, among all corners of all simplices, of a vertex in a simplex."""
    return simplex * simplices.shape[1] + (simplices[simplex] == vertex[:, None]).argmax(axis=1)


def _keys(facets: np.ndarray, node_count: int) -> np.ndarray:
    """One number for each set of nodes."""
    return np.sort(facets, axis=1) @ (node_count ** np.arange(facets.shape[1], dtype=np.int64))


def _corners(elements: object, count: int) -> np.ndarray:
    """Node numbers of Netgen's elements, which count from 1."""
    table = elements.NumPy()
    return np.asarray(table["nodes"][:, :count], dtype=np.int64) - 1


def _shape(cage: Cage, swept: Sequence[np.ndarray], low: np.ndarray, scale: float) -> object:
    """The cage in units of its longest side, with the cut glued in."""
    from netgen import occ

    place = (cage.vertices - low) / scale
    if cage.dimension == 2:
        faces = [_face(place[loop]) for loop in _loops(cage)]
        outer = max(faces, key=lambda face: face.mass)
        body = outer
        for face in faces:
            body = body if face is outer else body - face
        cuts = [occ.Segment(_point(a), _point(b)) for a, b in swept]
    else:
        body = occ.Solid(occ.Sew([_face(place[list(loop)]) for loop in cage.faces], tolerance=1e-5))
        cuts = [_face(polygon) for polygon in swept]
    return occ.Glue([body, *cuts]) if cuts else body


def _loops(cage: Cage) -> list[list[int]]:
    """The loops of a plane cage."""
    following = dict(cage.faces)
    loops = []
    while following:
        loop = [next(iter(following))]
        while following[loop[-1]] != loop[0]:
            loop.append(following[loop[-1]])
        loops.append(loop)
        for vertex in loop:
            del following[vertex]
    return loops


def _point(place: np.ndarray) -> object:
    from netgen import occ

    return occ.Pnt(*map(float, place), *[0.0] * (3 - len(place)))


def _face(corners: np.ndarray) -> object:
    from netgen import occ

    ends = [occ.Vertex(_point(corner)) for corner in corners]
    return occ.Face(occ.MakePolygon([*ends, ends[0]]))


def _refine(shape: object, front: np.ndarray, size: float) -> None:
    """Ask for small elements along the front, or at the tip."""
    if not len(front):
        return
    dimension = front.shape[1]
    for part in shape.edges if dimension == 3 else shape.vertices:
        center = part.center if dimension == 3 else part.p
        offset = np.array([center.x, center.y, center.z])[:dimension] - front[0]
        if dimension == 3:
            along = front[-1] - front[0]
            share = np.clip(offset @ along / (along @ along), 0.0, 1.0)
            offset = offset - share * along
        if np.abs(offset).max() < 1e-6:
            part.maxh = size

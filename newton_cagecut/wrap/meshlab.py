# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What PyMeshLab does for us: alpha wraps, decimation and reading mesh files.

Alpha wraps are those of CGAL (Portaneri, Rouxel-Labbé, Hemmer, Cohen-Steiner, Alliez, "Alpha wrapping with an offset",
2022): closed, manifold, oriented, and around every triangle of whatever they get. PyMeshLab is GPL, so nothing else
imports it and only this extra installs it.
"""

from __future__ import annotations

from types import ModuleType

import numpy as np

Triangles = tuple[np.ndarray, np.ndarray]


def alpha_wrap(points: np.ndarray, triangles: np.ndarray, *, alpha: float, offset: float) -> Triangles:
    """Wrap triangles, which may be open, cross each other and be in pieces.

    Args:
        points: Points, shape (point_count, 3).
        triangles: Point ids, shape (triangle_count, 3).
        alpha: Size of the openings that the wrap does not enter, and of its triangles.
        offset: Distance of the wrap's vertices from the triangles.

    Returns:
        Vertices, shape (vertex_count, 3), and triangles, shape (wrap_triangle_count, 3).
    """
    lengths = {"alpha": import_meshlab().PureValue(alpha), "offset": import_meshlab().PureValue(offset)}
    return _filtered(points, triangles, "generate_alpha_wrap", **lengths)


def decimate(points: np.ndarray, triangles: np.ndarray, face_count: int) -> Triangles:
    """Collapse edges by their quadric errors, without closing handles, until few triangles are left.

    Args:
        points: Vertices of a closed mesh, shape (point_count, 3).
        triangles: Vertex ids, shape (triangle_count, 3).
        face_count: Triangles to keep; more stay where no edge is left that can go.

    Returns:
        Vertices and triangles as in :func:`alpha_wrap`.
    """
    options = {"targetfacenum": face_count, "preservetopology": True, "preservenormal": True}
    return _filtered(points, triangles, "meshing_decimation_quadric_edge_collapse", **options)


def read_triangles(path: str) -> Triangles:
    """Read all meshes of a file in a format that PyMeshLab knows, as one.

    Args:
        path: The file.

    Returns:
        Points and triangles as in :func:`alpha_wrap`.

    Raises:
        ImportError: The extra is not installed.
        ValueError: The file cannot be read.
    """
    meshlab = import_meshlab()
    meshes = meshlab.MeshSet()
    try:
        meshes.load_new_mesh(path)
    except meshlab.PyMeshLabException as error:
        raise ValueError(f"{path} cannot be read as a mesh: {error}") from None
    meshes.generate_by_merging_visible_meshes()  # one mesh, with its transform applied
    return _arrays(meshes)


def import_meshlab() -> ModuleType:
    """Return the module ``pymeshlab``.

    Raises:
        ImportError: The extra is not installed; the text says how to.
    """
    try:
        import pymeshlab
    except ImportError as error:
        raise ImportError(
            f"cages are wrapped with PyMeshLab, which cannot be imported ({error}); "
            "install it with: pip install 'newton_cagecut[wrap]'"
        ) from error
    return pymeshlab


def _filtered(points: np.ndarray, triangles: np.ndarray, name: str, **options: object) -> Triangles:
    """Return what a filter of PyMeshLab makes of a mesh; its failure is a ``ValueError``."""
    meshlab = import_meshlab()
    meshes = meshlab.MeshSet()
    meshes.add_mesh(meshlab.Mesh(np.asarray(points, dtype=np.float64), np.asarray(triangles, dtype=np.int32)))
    try:
        meshes.apply_filter(name, **options)
    except meshlab.PyMeshLabException as error:
        raise ValueError(f"PyMeshLab's {name} failed: {error}") from None
    return _arrays(meshes)


def _arrays(meshes) -> Triangles:
    """Return vertices and triangles of the current mesh of a set."""
    mesh = meshes.current_mesh()
    return mesh.vertex_matrix(), mesh.face_matrix().astype(np.int64)

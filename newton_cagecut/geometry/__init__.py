# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Plain geometry in NumPy and float64, which knows of no cage: meshes, triangulation, winding numbers, distances."""

from .distances import edge_distances, nearest_on_edges, nearest_on_triangles
from .face_triangles import triangulate_faces
from .holes import bridge_holes, contains_point, signed_area
from .lift import lifted
from .polygon_mesh import PolygonMesh
from .triangulate import triangulate
from .winding import winding_numbers

__all__ = [
    "PolygonMesh",
    "bridge_holes",
    "contains_point",
    "edge_distances",
    "lifted",
    "nearest_on_edges",
    "nearest_on_triangles",
    "signed_area",
    "triangulate",
    "triangulate_faces",
    "winding_numbers",
]

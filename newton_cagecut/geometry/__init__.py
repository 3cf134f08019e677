# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Plain geometry in NumPy and float64, which knows of no cage.

Meshes, triangulation, winding numbers, distances, overlaps, vectors, and the checks of arguments that everything else
makes.
"""

from .arguments import (
    as_callback,
    as_choice,
    as_finite,
    as_flag,
    as_index,
    as_instance,
    as_length,
    as_number,
    as_path,
    as_sequence,
    is_number,
    shown,
)
from .array_arguments import (
    as_floats,
    as_indices,
    as_integers,
    as_loops,
    as_numbers,
    as_points,
    as_vector,
    check_finite,
)
from .distances import (
    edge_distances,
    nearest_on_edges,
    nearest_on_triangles,
    plane_gaps,
    simplex_distances,
    triangle_distances,
)
from .face_triangles import triangulate_faces
from .holes import bridge_holes, contains_point, signed_area
from .lift import lifted
from .moments import cone_moments, monomials
from .overlaps import edge_pierces, near_pairs, point_touches, segments_meet
from .polygon_mesh import PolygonMesh
from .polygon_triangles import polygon_triangles
from .triangulate import triangulate
from .vectors import dots, triangle_normals, units
from .winding import winding_numbers

__all__ = [
    "PolygonMesh",
    "as_callback",
    "as_choice",
    "as_finite",
    "as_flag",
    "as_floats",
    "as_index",
    "as_indices",
    "as_instance",
    "as_integers",
    "as_length",
    "as_loops",
    "as_number",
    "as_numbers",
    "as_path",
    "as_points",
    "as_sequence",
    "as_vector",
    "bridge_holes",
    "check_finite",
    "cone_moments",
    "contains_point",
    "dots",
    "edge_distances",
    "edge_pierces",
    "is_number",
    "lifted",
    "monomials",
    "near_pairs",
    "nearest_on_edges",
    "nearest_on_triangles",
    "plane_gaps",
    "point_touches",
    "polygon_triangles",
    "segments_meet",
    "shown",
    "signed_area",
    "simplex_distances",
    "triangle_distances",
    "triangle_normals",
    "triangulate",
    "triangulate_faces",
    "units",
    "winding_numbers",
]

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Writes a mesh or a cage that does not move to a USD file of its own."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike

import numpy as np
from pxr import Sdf, Usd, UsdGeom, Vt

from ..cage import Cage
from ..geometry import as_points, lifted
from .layers import (
    checked_name,
    checked_path,
    define_mesh,
    export_stage,
    extent,
    flat_faces,
    integers,
    new_stage,
    vectors,
    write_arrays,
)
from .mesh_data import check_mesh
from .outline import define_outline, outline_loops


def write_mesh(
    path: str | PathLike,
    points: np.ndarray,
    faces: np.ndarray | Sequence[Sequence[int]],
    *,
    name: str = "mesh",
    uvs: np.ndarray | None = None,
    purpose: str = "default",
    up_axis: str = "Z",
    meters_per_unit: float = 1.0,
) -> None:
    """Write one mesh as ``/World/<name>``.

    Args:
        path: A file that ends in .usd, .usda or .usdc; its folder exists.
        points: Vertices [m], shape ``(n, 3)``. USD keeps 32 bits of each coordinate.
        faces: Triangles, shape ``(m, 3)``, or polygons.
        name: Name of the prim.
        uvs: Texture coordinates of the vertices, shape ``(n, 2)``.
        purpose: USD's purpose: ``"default"``, ``"render"``, ``"proxy"`` or ``"guide"``.
        up_axis: ``"Y"`` or ``"Z"``; the points are written as they are.
        meters_per_unit: Unit of the stage [m].

    Raises:
        FileNotFoundError: The folder does not exist.
        OSError: The file cannot be written.
        ValueError: The mesh is empty or invalid, or an argument is none of those named above.
    """
    path = checked_path(path)
    points = as_points(points, "points", rows="n", widths=(3,))
    prim_path = f"/World/{checked_name(name)}"
    counts, indices = flat_faces(faces)
    check_mesh(f"mesh {name}", points, counts, indices)
    stage = new_stage(up_axis, meters_per_unit)
    mesh = define_mesh(stage, prim_path)
    mesh.CreatePurposeAttr(purpose)
    write_arrays(mesh, points / meters_per_unit, counts, indices)
    if uvs is not None:
        if np.shape(uvs) != (len(points), 2):
            raise ValueError(f"uvs must have shape ({len(points)}, 2), got {np.shape(uvs)}")
        primvars = UsdGeom.PrimvarsAPI(mesh)
        st = primvars.CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.vertex)
        st.Set(Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(uvs, dtype=np.float32)))
    export_stage(stage, path)


def write_cage(
    path: str | PathLike, cage: Cage, *, name: str = "cage", up_axis: str = "Z", meters_per_unit: float = 1.0
) -> None:
    """Write a cage as a guide mesh, a plane one as guide curves; :func:`read_cage` reads it back.

    Args:
        path: A file that ends in .usd, .usda or .usdc; its folder exists.
        cage: The cage [m].
        name: Name of the prim.
        up_axis: ``"Y"`` or ``"Z"``; the vertices are written as they are.
        meters_per_unit: Unit of the stage [m].

    Raises:
        FileNotFoundError: The folder does not exist.
        OSError: The file cannot be written.
        ValueError: An argument is none of those named above.
    """
    if cage.dimension == 2:
        _write_outline(checked_path(path), cage, name, new_stage(up_axis, meters_per_unit), meters_per_unit)
        return
    write_mesh(
        path,
        cage.vertices,
        cage.faces,
        name=name,
        purpose="guide",
        up_axis=up_axis,
        meters_per_unit=meters_per_unit,
    )


def _write_outline(path: str, cage: Cage, name: str, stage: Usd.Stage, meters_per_unit: float) -> None:
    """Write the loops of a plane cage."""
    prim_path = f"/World/{checked_name(name)}"
    loops = outline_loops("the cage", cage.faces, cage.vertex_count)
    points = lifted(cage.vertices)[np.concatenate(loops)] / meters_per_unit
    curves = define_outline(stage, prim_path)
    curves.CreatePointsAttr(vectors(points))
    curves.CreateCurveVertexCountsAttr(integers([len(loop) for loop in loops]))
    curves.CreateExtentAttr(extent(points))
    export_stage(stage, path)

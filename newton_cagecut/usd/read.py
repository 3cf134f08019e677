# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Reads meshes, cages and surfaces from USD, in metres and in world space."""

from __future__ import annotations

import os
import warnings
from os import PathLike, fspath

import numpy as np
from pxr import Sdf, Tf, Usd, UsdGeom

from ..cage import Cage
from ..surface import Surface
from .mesh_data import MeshData, check_mesh

_SEAM_TOLERANCE = 1e-5  # of texture space: corners of one vertex that agree to this are one texture coordinate


def read_mesh(
    source: str | PathLike | Usd.Stage, prim_path: str | None = None, *, up_axis: str | None = None
) -> MeshData:
    """Read one mesh, with its world transform and the stage's ``metersPerUnit`` applied.

    Subdivision schemes are ignored: the control mesh is read. Animated attributes are read at their first sample.
    Texture coordinates come from ``primvars:st``; those with seams cannot belong to vertices and are left out with
    a warning.

    Args:
        source: A USD file or an open stage.
        prim_path: The mesh, or a prim with one mesh below it. May be left out where the stage has one mesh.
        up_axis: ``"Y"`` or ``"Z"`` rotates the mesh from the stage's up axis to this one; ``None`` keeps the stage's.

    Returns:
        The mesh; its ``up_axis`` is the one that its points have now.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: The file is no USD, the mesh cannot be told, or it is empty or invalid.
    """
    if up_axis not in (None, "Y", "Z"):
        raise ValueError(f'up_axis must be "Y", "Z" or None, got {up_axis!r}')
    stage = source if isinstance(source, Usd.Stage) else _open_stage(fspath(source))
    mesh = _find_mesh(stage, prim_path)
    label = f"mesh {mesh.GetPath()} of {stage.GetRootLayer().identifier}"
    points, counts, indices = _arrays(mesh)
    check_mesh(label, points, counts, indices)
    transform = np.array(UsdGeom.Xformable(mesh).ComputeLocalToWorldTransform(Usd.TimeCode.EarliestTime()))
    starts = np.cumsum(counts)[:-1]
    faces = tuple(tuple(int(i) for i in face) for face in np.split(indices, starts))
    left_handed = mesh.GetOrientationAttr().Get() == UsdGeom.Tokens.leftHanded
    if left_handed != (np.linalg.det(transform[:3, :3]) < 0.0):
        faces = tuple(face[::-1] for face in faces)
    points = (points @ transform[:3, :3] + transform[3, :3]) * UsdGeom.GetStageMetersPerUnit(stage)
    stage_axis = str(UsdGeom.GetStageUpAxis(stage))
    uvs = _texture_coordinates(mesh, label, len(points), indices)
    return MeshData(points, faces, uvs, mesh.GetPrim().GetName(), stage_axis).turned(up_axis or stage_axis)


def read_cage(
    source: str | PathLike | Usd.Stage, prim_path: str | None = None, *, up_axis: str | None = None, **options
) -> Cage:
    """Read a mesh as a cage; its polygons become the cage's faces.

    Args:
        source: As in :func:`read_mesh`.
        prim_path: As in :func:`read_mesh`.
        up_axis: As in :func:`read_mesh`.
        options: Keyword arguments of :class:`~newton_cagecut.cage.Cage`.

    Returns:
        The validated cage [m].

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: As in :func:`read_mesh`, or the mesh is no valid cage.
    """
    mesh = read_mesh(source, prim_path, up_axis=up_axis)
    return Cage(mesh.points, mesh.faces, **options)


def read_surface(
    source: str | PathLike | Usd.Stage, prim_path: str | None = None, *, up_axis: str | None = None, **options
) -> Surface:
    """Read a mesh as a surface to embed; polygons are cut into triangles.

    Args:
        source: As in :func:`read_mesh`.
        prim_path: As in :func:`read_mesh`.
        up_axis: As in :func:`read_mesh`.
        options: Keyword arguments of :class:`~newton_cagecut.surface.Surface`.

    Returns:
        The surface [m], with its texture coordinates.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: As in :func:`read_mesh`, or the mesh is no valid surface.
    """
    mesh = read_mesh(source, prim_path, up_axis=up_axis)
    return Surface(mesh.points, mesh.triangles, uvs=mesh.uvs, **options)


def _open_stage(path: str) -> Usd.Stage:
    """Open a file, with errors of Python in the place of USD's."""
    if not os.path.exists(path):
        raise FileNotFoundError(f"no such USD file: {path}")
    try:
        return Usd.Stage.Open(path)
    except Tf.ErrorException as error:
        raise ValueError(f"{path} cannot be read as USD: {error}") from error


def _find_mesh(stage: Usd.Stage, prim_path: str | None) -> UsdGeom.Mesh:
    """Return the one mesh at or below ``prim_path``; tell which ones there are where it is not one."""
    every = [prim for prim in stage.Traverse(Usd.TraverseInstanceProxies()) if prim.IsA(UsdGeom.Mesh)]
    listed = ", ".join(str(prim.GetPath()) for prim in every) or "none"
    label = stage.GetRootLayer().identifier
    found = every
    if prim_path is not None:
        if not Sdf.Path.IsValidPathString(prim_path)[0] or not stage.GetPrimAtPath(prim_path):
            raise ValueError(f"{label} has no prim {prim_path}; its meshes: {listed}")
        found = [prim for prim in every if prim.GetPath().HasPrefix(prim_path)]
    if not found:
        place = f"no mesh at or below {prim_path}" if prim_path else "no mesh"
        raise ValueError(f"{label} has {place}; its meshes: {listed}")
    if len(found) > 1:
        names = ", ".join(str(prim.GetPath()) for prim in found)
        raise ValueError(f"{label} has {len(found)} meshes; choose one by its path (prim_path, --prim): {names}")
    return UsdGeom.Mesh(found[0])


def _arrays(mesh: UsdGeom.Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return points, vertices of each face and vertex indices at the first sample."""
    first = Usd.TimeCode.EarliestTime()
    points = np.array(mesh.GetPointsAttr().Get(first) or [], dtype=np.float64).reshape(-1, 3)
    counts = np.array(mesh.GetFaceVertexCountsAttr().Get(first) or [], dtype=np.int64)
    indices = np.array(mesh.GetFaceVertexIndicesAttr().Get(first) or [], dtype=np.int64)
    return points, counts, indices


def _texture_coordinates(mesh: UsdGeom.Mesh, label: str, point_count: int, indices: np.ndarray) -> np.ndarray | None:
    """Return ``primvars:st`` of the vertices, or ``None`` where there are none or they have seams."""
    primvar = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st")
    if not primvar or not primvar.HasValue():
        return None
    values = np.array(primvar.ComputeFlattened(Usd.TimeCode.EarliestTime()), dtype=np.float64).reshape(-1, 2)
    if primvar.GetInterpolation() in (UsdGeom.Tokens.vertex, UsdGeom.Tokens.varying) and len(values) == point_count:
        return values
    if primvar.GetInterpolation() == UsdGeom.Tokens.faceVarying and len(values) == len(indices):
        uvs = np.zeros((point_count, 2))
        uvs[indices] = values
        if np.abs(uvs[indices] - values).max() <= _SEAM_TOLERANCE:
            return uvs
    warnings.warn(f"{label}: its texture coordinates do not belong to vertices; they are left out", stacklevel=3)
    return None

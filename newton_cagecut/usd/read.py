# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Reads meshes, cages and surfaces from USD, in metres and in world space."""

from __future__ import annotations

import os
import warnings
from dataclasses import replace
from os import PathLike, fspath

import numpy as np
from pxr import Sdf, Tf, Usd, UsdGeom

from ..cage import Cage
from ..surface import Surface
from .layers import points_at
from .mesh_data import MeshData, check_mesh, turn_up
from .outline import border_of, flat_points, read_outline

_SEAM_TOLERANCE = 1e-5  # of texture space: corners of one vertex that agree to this are one texture coordinate
_FLAT = 1e-6  # of the size of a mesh: what is thinner has a dimension less
_LEFT_OUT = "do not belong to vertices; they are left out"


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
    stage = open_stage(source)
    prim = _find_prim(stage, prim_path, UsdGeom.Mesh)
    mesh = _read_prim(prim, up_axis)
    if mesh.corner_uvs is not None:
        warnings.warn(f"{_label(prim)}: its texture coordinates {_LEFT_OUT}", stacklevel=2)
        mesh = replace(mesh, corner_uvs=None)
    return mesh


def read_meshes(
    source: str | PathLike | Usd.Stage, prim_path: str | None = None, *, up_axis: str | None = None
) -> list[MeshData]:
    """Read all meshes at or below a prim, instanced ones included, each as :func:`read_mesh` does.

    Args:
        source: As in :func:`read_mesh`.
        prim_path: The prim; all the stage without it.
        up_axis: As in :func:`read_mesh`.

    Returns:
        The meshes, in the order of the stage; those whose texture coordinates have seams keep them at their corners.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: The file is no USD, it has no such prim, or a mesh is empty or invalid.
    """
    stage = open_stage(source)
    return [_read_prim(prim, up_axis) for prim in _prims(stage, prim_path, UsdGeom.Mesh)]


def read_cage(
    source: str | PathLike | Usd.Stage, prim_path: str | None = None, *, up_axis: str | None = None, **options
) -> Cage:
    """Read a mesh as a cage; its polygons become the cage's faces.

    A flat mesh that is open is read as the plane cage of its border. Where there is no mesh, linear and periodic
    ``BasisCurves`` are read as a plane cage: each curve is a loop of segments. They lie in a plane normal to z; with
    the outer loops clockwise, all are reversed.

    Args:
        source: As in :func:`read_mesh`.
        prim_path: As in :func:`read_mesh`, or the curves.
        up_axis: As in :func:`read_mesh`.
        options: Keyword arguments of :class:`~newton_cagecut.cage.Cage`.

    Returns:
        The validated cage [m].

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: As in :func:`read_mesh`, or the mesh or the curves are no valid cage.
    """
    stage = open_stage(source)
    if _prims(stage, prim_path, UsdGeom.Mesh) or not _prims(stage, prim_path, UsdGeom.BasisCurves):
        mesh = read_mesh(stage, prim_path, up_axis=up_axis)
        counts = np.array([len(face) for face in mesh.faces])
        border = border_of(f"mesh {mesh.name}", mesh.points, counts, np.concatenate(mesh.faces))
        return Cage(*(border or (mesh.points, mesh.faces)), **options)
    curves = UsdGeom.BasisCurves(_find_prim(stage, prim_path, UsdGeom.BasisCurves))
    label = f"curves {curves.GetPath()} of {stage.GetRootLayer().identifier}"
    points, segments = read_outline(label, curves)
    points = flat_points(label, _place(curves, points, up_axis)[0])
    return Cage(points, _counterclockwise(points, segments), **options)


def read_surface(
    source: str | PathLike | Usd.Stage,
    prim_path: str | None = None,
    *,
    up_axis: str | None = None,
    flat: bool = False,
    **options,
) -> Surface:
    """Read a mesh as a surface to embed; polygons are cut into triangles.

    Args:
        source: As in :func:`read_mesh`.
        prim_path: As in :func:`read_mesh`.
        up_axis: As in :func:`read_mesh`.
        flat: Whether to read a mesh that lies in a plane normal to z as the surface of a plane cage. If it faces -z,
            all its triangles are reversed.
        options: Keyword arguments of :class:`~newton_cagecut.surface.Surface`.

    Returns:
        The surface [m], with its texture coordinates; those with seams belong to the triangles' corners.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: As in :func:`read_mesh`, or the mesh is no valid surface, or not flat where it should be.
    """
    stage = open_stage(source)
    mesh = _read_prim(_find_prim(stage, prim_path, UsdGeom.Mesh), up_axis)
    points, uvs, triangles = mesh.points, mesh.uvs, mesh.triangles
    if mesh.corner_uvs is not None:
        corners = mesh.triangle_corners
        triangles, uvs = np.concatenate(mesh.faces)[corners], mesh.corner_uvs[corners]
    if flat:
        points = flat_points(f"mesh {mesh.name}", points)
        turned = _counterclockwise(points, triangles)
        uvs = uvs if uvs is None or uvs.ndim == 2 or turned is triangles else uvs[:, ::-1]
        triangles = turned
    return Surface(points, triangles, uvs=uvs, **options)


def _counterclockwise(points: np.ndarray, loops: np.ndarray) -> np.ndarray:
    """Return segments around, or triangles of, an area in the plane, all reversed where it is negative."""
    edges = loops if loops.shape[1] == 2 else loops[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    (ax, ay), (bx, by) = np.moveaxis(points[edges] - points.mean(axis=0), 0, -1)
    return loops[:, ::-1] if (ax * by - ay * bx).sum() < 0.0 else loops


def open_stage(source: str | PathLike | Usd.Stage) -> Usd.Stage:
    """Open a file, with errors of Python in the place of USD's."""
    if isinstance(source, Usd.Stage):
        return source
    path = fspath(source)
    if not os.path.exists(path):
        raise FileNotFoundError(f"no such USD file: {path}")
    try:
        return Usd.Stage.Open(path)
    except Tf.ErrorException:
        raise ValueError(f"{path} cannot be read as USD: it is damaged, cut short, or no USD file") from None


def _prims(stage: Usd.Stage, prim_path: str | None, kind: type) -> list[Usd.Prim]:
    """Return the prims of a kind at or below ``prim_path``, or of all the stage."""
    every = [prim for prim in stage.Traverse(Usd.TraverseInstanceProxies()) if prim.IsA(kind)]
    if prim_path is None:
        return every
    if not Sdf.Path.IsValidPathString(prim_path)[0] or not stage.GetPrimAtPath(prim_path):
        meshes = _listed(_prims(stage, None, UsdGeom.Mesh))
        raise ValueError(f"{stage.GetRootLayer().identifier} has no prim {prim_path}; its meshes: {meshes}")
    return [prim for prim in every if prim.GetPath().HasPrefix(prim_path)]


def _find_prim(stage: Usd.Stage, prim_path: str | None, kind: type) -> Usd.Prim:
    """Return the one prim of a kind at or below ``prim_path``; tell which ones there are where it is not one."""
    found, label = _prims(stage, prim_path, kind), stage.GetRootLayer().identifier
    if not found:
        place = f"no mesh at or below {prim_path}" if prim_path else "no mesh"
        raise ValueError(f"{label} has {place}; its meshes: {_listed(_prims(stage, None, UsdGeom.Mesh))}")
    if len(found) > 1:
        what = f"{len(found)} {'meshes' if kind is UsdGeom.Mesh else 'prims of curves'}"
        raise ValueError(f"{label} has {what}; choose one by its path (prim_path, --prim): {_listed(found)}")
    return found[0]


def _listed(prims: list[Usd.Prim]) -> str:
    return ", ".join(str(prim.GetPath()) for prim in prims) or "none"


def _place(prim: UsdGeom.PointBased, points: np.ndarray, up_axis: str | None) -> tuple[np.ndarray, bool]:
    """Return points of a prim in world space [m], turned to an up axis, and whether the world mirrors the prim."""
    if up_axis not in (None, "Y", "Z"):
        raise ValueError(f'up_axis must be "Y", "Z" or None, got {up_axis!r}')
    stage = prim.GetPrim().GetStage()
    transform = np.array(prim.ComputeLocalToWorldTransform(Usd.TimeCode.EarliestTime()))
    placed = (points @ transform[:3, :3] + transform[3, :3]) * UsdGeom.GetStageMetersPerUnit(stage)
    stage_axis = str(UsdGeom.GetStageUpAxis(stage))
    return turn_up(placed, stage_axis, up_axis or stage_axis), bool(np.linalg.det(transform[:3, :3]) < 0.0)


def _read_prim(prim: Usd.Prim, up_axis: str | None) -> MeshData:
    """Read a mesh; texture coordinates with seams stay at the corners."""
    mesh, label = UsdGeom.Mesh(prim), _label(prim)
    points, counts, indices = _arrays(mesh)
    check_mesh(label, points, counts, indices)
    placed, mirrored = _place(mesh, points, up_axis)
    if _rank(placed) < _rank(points):
        raise ValueError(f"{label} is flattened in the world: it, or a prim above it, has a scale of zero")
    uvs, corner_uvs = _texture_coordinates(mesh, len(points), indices)
    corner_normals = _corner_normals(mesh, len(points), indices, up_axis)
    ends = np.cumsum(counts)
    starts = ends - counts
    left_handed = mesh.GetOrientationAttr().Get() == UsdGeom.Tokens.leftHanded
    if left_handed != mirrored:
        back = np.repeat(starts + ends - 1, counts) - np.arange(len(indices))
        indices, corner_uvs = indices[back], None if corner_uvs is None else corner_uvs[back]
        corner_normals = None if corner_normals is None else corner_normals[back]
    corners = indices.tolist()
    faces = tuple(tuple(corners[start:end]) for start, end in zip(starts.tolist(), ends.tolist()))
    own_axis = str(UsdGeom.GetStageUpAxis(prim.GetStage()))
    return MeshData(placed, faces, uvs, prim.GetName(), up_axis or own_axis, corner_uvs, corner_normals)


def _arrays(mesh: UsdGeom.Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return points, vertices of each face and vertex indices at the first sample."""
    first = Usd.TimeCode.EarliestTime()
    counts = np.array(mesh.GetFaceVertexCountsAttr().Get(first) or [], dtype=np.int64)
    indices = np.array(mesh.GetFaceVertexIndicesAttr().Get(first) or [], dtype=np.int64)
    return points_at(mesh, first), counts, indices


def _texture_coordinates(
    mesh: UsdGeom.Mesh, point_count: int, indices: np.ndarray
) -> tuple[np.ndarray | None, np.ndarray | None]:
    """Return ``primvars:st`` of the vertices and, where it has seams, of the corners; ``None`` where there is none."""
    primvar = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st")
    if not primvar or not primvar.HasValue():
        return None, None
    values = np.array(primvar.ComputeFlattened(Usd.TimeCode.EarliestTime()), dtype=np.float64).reshape(-1, 2)
    if primvar.GetInterpolation() in (UsdGeom.Tokens.vertex, UsdGeom.Tokens.varying) and len(values) == point_count:
        return values, None
    if primvar.GetInterpolation() == UsdGeom.Tokens.faceVarying and len(values) == len(indices):
        uvs = np.zeros((point_count, 2))
        uvs[indices] = values
        seams = np.abs(uvs[indices] - values).max() > _SEAM_TOLERANCE
        return (None, values) if seams else (uvs, None)
    warnings.warn(f"{_label(mesh.GetPrim())}: its texture coordinates {_LEFT_OUT}", stacklevel=4)
    return None, None


def _corner_normals(
    mesh: UsdGeom.Mesh, point_count: int, indices: np.ndarray, up_axis: str | None
) -> np.ndarray | None:
    """Return the normals of the corners in world space, of any length; ``None`` where there are none or too few."""
    primvar = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("normals")
    first = Usd.TimeCode.EarliestTime()
    if primvar and primvar.HasValue():
        values, interpolation = primvar.ComputeFlattened(first), primvar.GetInterpolation()
    else:
        values, interpolation = mesh.GetNormalsAttr().Get(first), mesh.GetNormalsInterpolation()
    normals = np.array(values if values else [], dtype=np.float64).reshape(-1, 3)
    if interpolation in (UsdGeom.Tokens.vertex, UsdGeom.Tokens.varying) and len(normals) == point_count:
        normals = normals[indices]
    elif interpolation != UsdGeom.Tokens.faceVarying or len(normals) != len(indices):
        return None
    linear = np.array(mesh.ComputeLocalToWorldTransform(first))[:3, :3]
    if np.linalg.matrix_rank(linear) < 3:
        return None
    own_axis = str(UsdGeom.GetStageUpAxis(mesh.GetPrim().GetStage()))
    return turn_up(normals @ np.linalg.inv(linear).T, own_axis, up_axis or own_axis)


def _rank(points: np.ndarray) -> int:
    """Return the dimension of the space that points span."""
    spread = points - points.mean(axis=0)
    return int(np.linalg.matrix_rank(spread.T @ spread, tol=_FLAT**2 * float((spread**2).sum())))


def _label(prim: Usd.Prim) -> str:
    """Return what errors call a mesh."""
    return f"mesh {prim.GetPath()} of {prim.GetStage().GetRootLayer().identifier}"

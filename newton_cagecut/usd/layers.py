# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Stages in memory or in files, written so that a file is whole at any time, and the values that USD takes."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from os import PathLike

import numpy as np
from pxr import Gf, Sdf, Tf, Usd, UsdGeom, Vt

from ..geometry import as_finite, as_instance, as_loops, as_numbers, as_path, shown

_EXTENSIONS = (".usd", ".usda", ".usdc")


def checked_path(path: str | PathLike) -> str:
    """Return ``path`` as text.

    Raises:
        TypeError: It is no path.
        ValueError: The name does not end in .usd, .usda or .usdc.
        FileNotFoundError: The folder does not exist.
    """
    text = as_path(path)
    if os.path.splitext(text)[1] not in _EXTENSIONS:
        raise ValueError(f"{text}: the name of a USD file must end in {', '.join(_EXTENSIONS)}")
    folder = os.path.dirname(os.path.abspath(text))
    if not os.path.isdir(folder):
        raise FileNotFoundError(f"{text}: there is no folder {folder}")
    return text


def free_name(label: str, is_taken: Callable[[str], bool]) -> str:
    """A name that is not taken, as near to a label as USD takes it.

    Args:
        label: The label.
        is_taken: Whether a name is.
    """
    stem = Tf.MakeValidIdentifier(label)
    name, number = stem, 2
    while is_taken(name):
        name, number = f"{stem}_{number}", number + 1
    return name


def checked_name(name: str) -> str:
    """Return the name of a prim.

    Raises:
        ValueError: USD cannot take it.
    """
    as_instance(name, str, "the name of a prim")
    if not Tf.IsValidIdentifier(name):
        raise ValueError(f"{name!r} is no name for a USD prim; {Tf.MakeValidIdentifier(name)!r} would be")
    return name


def new_stage(up_axis: str, meters_per_unit: float) -> Usd.Stage:
    """Return an empty stage in memory with its metrics set and ``/World`` as its default prim.

    Raises:
        ValueError: The up axis is neither Y nor Z, or the unit is not a positive number.
    """
    _check_metrics(up_axis, meters_per_unit)
    return _with_metrics(Usd.Stage.CreateInMemory(), up_axis, meters_per_unit)


def new_file_stage(path: str, up_axis: str, meters_per_unit: float) -> Usd.Stage:
    """Return such a stage for a file, which stays as it is until :func:`save_stage`.

    A layer of this file that is open is emptied and used.

    Raises:
        ValueError: As in :func:`new_stage`.
    """
    _check_metrics(up_axis, meters_per_unit)
    layer = Sdf.Layer.Find(path)
    if layer is None:
        layer = Sdf.Layer.New(Sdf.FileFormat.FindByExtension(path), path)
    layer.Clear()
    return _with_metrics(Usd.Stage.Open(layer), up_axis, meters_per_unit)


def _check_metrics(up_axis: str, meters_per_unit: float) -> None:
    if not (isinstance(up_axis, str) and up_axis in ("Y", "Z")):
        raise ValueError(f'up_axis must be "Y" or "Z", got {shown(up_axis)}')
    if as_finite(meters_per_unit, "meters_per_unit") <= 0.0:
        raise ValueError(f"meters_per_unit must be positive, got {meters_per_unit}")


def _with_metrics(stage: Usd.Stage, up_axis: str, meters_per_unit: float) -> Usd.Stage:
    UsdGeom.SetStageUpAxis(stage, up_axis)
    UsdGeom.SetStageMetersPerUnit(stage, meters_per_unit)
    stage.SetDefaultPrim(UsdGeom.Xform.Define(stage, "/World").GetPrim())
    return stage


def save_stage(stage: Usd.Stage, path: str) -> None:
    """Write what is new in a stage to its file; binary ones only grow, and point to what is new at the very end.

    Raises:
        OSError: The file cannot be written.
    """
    try:
        saved = stage.GetRootLayer().Save()
    except Tf.ErrorException as error:
        raise OSError(f"{path} cannot be written: {error}") from error
    if not saved:
        raise OSError(f"{path} cannot be written")


def export_stage(stage: Usd.Stage, path: str) -> None:
    """Write the stage beside ``path`` and move it there, so that the file is whole at any time.

    Raises:
        OSError: The file cannot be written.
    """
    stem, extension = os.path.splitext(path)
    part = f"{stem}.part{os.getpid()}{extension}"
    try:
        if not stage.GetRootLayer().Export(part):
            raise OSError(f"{path} cannot be written")
        os.replace(part, path)
    except Tf.ErrorException as error:
        raise OSError(f"{path} cannot be written: {error}") from error
    finally:
        if os.path.exists(part):
            os.remove(part)
    opened = Sdf.Layer.Find(path)
    if opened:
        opened.Reload(force=True)


def define_mesh(stage: Usd.Stage, path: str) -> UsdGeom.Mesh:
    """Return a new mesh without subdivision."""
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    return mesh


def write_arrays(mesh: UsdGeom.Mesh, points: np.ndarray, counts: np.ndarray, indices: np.ndarray) -> None:
    """Write a mesh that does not move, in the units of the stage."""
    mesh.CreatePointsAttr(vectors(points))
    mesh.CreateFaceVertexCountsAttr(integers(counts))
    mesh.CreateFaceVertexIndicesAttr(integers(indices))
    mesh.CreateExtentAttr(extent(points))


def points_at(prim: UsdGeom.PointBased, time: Usd.TimeCode | float) -> np.ndarray:
    """Return the points of a prim at a time in its own units, shape ``(n, 3)``, float64; none where it has none."""
    return np.array(prim.GetPointsAttr().Get(time) or [], dtype=np.float64).reshape(-1, 3)


def vectors(values: np.ndarray) -> Vt.Vec3fArray:
    """Return an array of shape ``(n, 3)`` as USD's float3[]."""
    return Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(values, dtype=np.float32))


def integers(values: np.ndarray) -> Vt.IntArray:
    """Return an array of shape ``(n,)`` as USD's int[]."""
    return Vt.IntArray.FromNumpy(np.ascontiguousarray(values, dtype=np.int32))


def extent(points: np.ndarray) -> Vt.Vec3fArray:
    """Return the two corners of the box around ``points``."""
    return vectors(np.stack([points.min(axis=0), points.max(axis=0)]))


def color(value: tuple[float, float, float]) -> Gf.Vec3f:
    """Return a colour as USD's color3f."""
    return Gf.Vec3f(*checked_color(value, "the colour").tolist())


def checked_color(value: tuple[float, float, float], what: str) -> np.ndarray:
    """Return a colour, shape ``(3,)``.

    Args:
        value: What was passed.
        what: What it is, for the error.

    Raises:
        TypeError: It is not three numbers.
        ValueError: One is not finite, or negative.
    """
    channels = as_numbers(value, what, 3, kind="red, green and blue, three numbers from 0 to 1")
    if channels.min() < 0.0:
        raise ValueError(f"{what} is negative: {channels.tolist()}")
    return channels


def flat_faces(faces: np.ndarray | Sequence[Sequence[int]]) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices of each face and all vertex indices of ``faces``, an ``(m, 3)`` array or polygons.

    Args:
        faces: The faces.

    Raises:
        TypeError: They are no faces.
    """
    if isinstance(faces, np.ndarray) and faces.ndim == 2 and np.issubdtype(faces.dtype, np.integer):
        return np.full(len(faces), faces.shape[1], dtype=np.int32), faces.reshape(-1).astype(np.int32)
    start, vertex = as_loops(faces, "the mesh")
    return np.diff(start).astype(np.int32), vertex.astype(np.int32)

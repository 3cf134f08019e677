# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Checks an animation at every one of its samples."""

from __future__ import annotations

from os import PathLike, fspath

import numpy as np
from pxr import Usd, UsdGeom

from .layers import points_at


def validate_animation(source: str | PathLike | Usd.Stage) -> list[str]:
    """Return what is wrong with the meshes and curves of a file, at each of their samples and between them.

    Checked are the stage's metrics, topology, finite points, the lengths of normals and display colours, extents and
    subsets. ``usdchecker`` checks none of that.

    Args:
        source: A USD file or an open stage.

    Returns:
        One line a problem, with the prim and the time code; empty when the file is valid.
    """
    stage = source if isinstance(source, Usd.Stage) else Usd.Stage.Open(fspath(source))
    problems = _stage_problems(stage)
    for prim in stage.Traverse(Usd.TraverseInstanceProxies()):
        for kind, find_problems in ((UsdGeom.Mesh, _mesh_problems), (UsdGeom.BasisCurves, _curve_problems)):
            for time in _times(stage, prim) if prim.IsA(kind) else ():
                where = f"{prim.GetPath()} at {time}"
                problems += [f"{where}: {problem}" for problem in find_problems(kind(prim), time)]
    return problems


def _stage_problems(stage: Usd.Stage) -> list[str]:
    """Return what is wrong with the stage's metadata."""
    problems = []
    if not UsdGeom.StageHasAuthoredMetersPerUnit(stage):
        problems.append("metersPerUnit is not set")
    timed = ("timeCodesPerSecond", "startTimeCode", "endTimeCode") if _is_animated(stage) else ()
    problems += [f"{key} is not set" for key in ("upAxis", *timed) if not stage.HasAuthoredMetadata(key)]
    if not stage.GetDefaultPrim():
        problems.append("defaultPrim is not set")
    if stage.GetEndTimeCode() < stage.GetStartTimeCode():
        problems.append("endTimeCode is before startTimeCode")
    return problems


def _is_animated(stage: Usd.Stage) -> bool:
    """Return whether something has samples in time."""
    prims = stage.Traverse(Usd.TraverseInstanceProxies())
    return any(attribute.GetNumTimeSamples() for prim in prims for attribute in prim.GetAttributes())


def _times(stage: Usd.Stage, prim: Usd.Prim) -> list[float]:
    """Return the samples of a mesh and its subsets, the middles between them and the stage's two ends."""
    attributes = [a for p in (prim, *prim.GetChildren()) for a in p.GetAttributes()]
    samples = {time for attribute in attributes for time in attribute.GetTimeSamples()}
    ordered = sorted(samples | {stage.GetStartTimeCode(), stage.GetEndTimeCode()})
    return sorted([*ordered, *(0.5 * (a + b) for a, b in zip(ordered[:-1], ordered[1:]))])


def _mesh_problems(mesh: UsdGeom.Mesh, time: float) -> list[str]:
    """Return what is wrong with a mesh at one time."""
    points = points_at(mesh, time)
    counts = mesh.GetFaceVertexCountsAttr().Get(time) or []
    indices = mesh.GetFaceVertexIndicesAttr().Get(time) or []
    empty = len(points) == len(counts) == len(indices) == 0 and mesh.GetPointsAttr().GetNumTimeSamples() > 1
    if not empty and (len(points) == 0 or len(counts) == 0):
        return ["it has no points or no faces"]
    valid, reason = UsdGeom.Mesh.ValidateTopology(indices, counts, len(points))
    problems = [] if valid else [reason]
    sizes = {"constant": 1, "uniform": len(counts), "vertex": len(points), "faceVarying": len(indices)}
    sizes["varying"] = sizes["vertex"]
    problems += _length_problem("normals", mesh.GetNormalsAttr().Get(time), sizes, mesh.GetNormalsInterpolation())
    for primvar in UsdGeom.PrimvarsAPI(mesh).GetPrimvarsWithValues():
        values, interpolation = primvar.ComputeFlattened(time), primvar.GetInterpolation()
        if values is None:
            problems.append(f"the indices of {primvar.GetName()} are out of range")
        problems += _length_problem(primvar.GetName(), values, sizes, interpolation)
    if not np.isfinite(points).all():
        return [*problems, "points are not finite"]
    return problems + _extent_problem(mesh, points, time) + _subset_problems(mesh, len(counts), time)


def _curve_problems(curves: UsdGeom.BasisCurves, time: float) -> list[str]:
    """Return what is wrong with curves at one time."""
    points = points_at(curves, time)
    sizes = np.array(curves.GetCurveVertexCountsAttr().Get(time) or [], dtype=np.int64)
    least = 3 if curves.GetWrapAttr().Get() == UsdGeom.Tokens.periodic else 2
    if len(points) == 0 or sizes.sum() != len(points) or sizes.min() < least:
        return [f"curves of {sizes.tolist()} points do not go round {len(points)} points"]
    if not np.isfinite(points).all():
        return ["points are not finite"]
    return _extent_problem(curves, points, time)


def _length_problem(name: str, values, sizes: dict[str, int], interpolation: str) -> list[str]:
    """Return whether an attribute has another length than its interpolation asks for."""
    if values is None or len(values) == sizes[interpolation]:
        return []
    return [f"{name} has {len(values)} values, {interpolation} needs {sizes[interpolation]}"]


def _extent_problem(prim: UsdGeom.PointBased, points: np.ndarray, time: float) -> list[str]:
    """Return whether the extent is missing or leaves points out."""
    box = np.array(prim.GetExtentAttr().Get(time) or [])
    if box.shape != (2, 3):
        return ["it has no extent"]
    slack = 1e-5 * np.linalg.norm(box[1] - box[0])
    if (points < box[0] - slack).any() or (points > box[1] + slack).any():
        return [f"points leave the extent {box.tolist()}"]
    return []


def _subset_problems(mesh: UsdGeom.Mesh, face_count: int, time: float) -> list[str]:
    """Return which subsets name faces twice or that do not exist."""
    problems = []
    for subset in UsdGeom.Subset.GetAllGeomSubsets(mesh):
        faces = np.array(subset.GetIndicesAttr().Get(time) or [], dtype=np.int64)
        if ((faces < 0) | (faces >= face_count)).any():
            problems.append(f"subset {subset.GetPrim().GetName()} names face {faces.max()} of {face_count}")
        if len(np.unique(faces)) < len(faces):
            problems.append(f"subset {subset.GetPrim().GetName()} names a face twice")
    return problems

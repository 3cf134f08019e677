# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Cage bodies and blades from a USD stage.

A body is a prim with ``PhysicsDeformableBodyAPI``; below it stand the mesh that is rendered, untagged, and the cage, a
mesh with ``CageCutCageAPI``. Its physics material has ``PhysicsVolumeDeformableMaterialAPI``. A blade is any prim with
``CageCutBladeAPI``. The schemas are read as they are written: they are registered nowhere.
"""

from __future__ import annotations

from os import PathLike

import newton
import numpy as np
from pxr import Usd, UsdGeom, UsdPhysics, UsdShade

from ..elastic import Material
from ..section import Blade
from ..solver import Capacity, SolverCageCut, add_cage_body
from ..usd import open_stage, read_cage, read_surface, turn_up
from .stage_scene import StageBlade, StageScene

_OPTIONS = {"walks": int, "seed": int, "quadrature": int, "cuttable": bool}
_CAPACITY = ("vertices", "surface_points", "surface_triangles")


def add_usd(
    builder: newton.ModelBuilder, source: str | PathLike | Usd.Stage, *, walks: int | None = None
) -> StageScene:
    """Add the cage bodies of a stage to a builder, in metres and with the builder's up axis.

    Args:
        builder: The builder.
        source: A USD file or an open stage.
        walks: Walks a point in the place of those that cages name.

    Returns:
        The bodies, and the blades with their tracks.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: It is no USD, it has no cage bodies, or a prim lacks something or holds something wrong; the text
            names the prim. The builder may hold the bodies before that one then.
    """
    stage = open_stage(source)
    SolverCageCut.register_custom_attributes(builder)
    axis = newton.Axis.from_any(builder.up_axis).name
    if axis not in ("Y", "Z"):
        raise ValueError(f"the builder's up axis is {axis}; stages can be turned to Y or Z")
    bodies = {}
    for prim in stage.Traverse():
        if _has(prim, "PhysicsDeformableBodyAPI") and (cages := _tagged(prim, "CageCutCageAPI")):
            if len(cages) > 1:
                raise ValueError(f"{prim.GetPath()} has {len(cages)} cages, {_paths(cages)}; a body has one")
            bodies[str(prim.GetPath())] = _add_body(builder, prim, cages[0], axis, walks)
    strays = [p for p in _tagged(stage.GetPseudoRoot(), "CageCutCageAPI") if not _owner(p, bodies)]
    if strays:
        raise ValueError(f"{strays[0].GetPath()} is a cage, but no prim above it has PhysicsDeformableBodyAPI")
    if not bodies:
        raise ValueError(
            f"{stage.GetRootLayer().identifier} has no cage bodies: a prim with PhysicsDeformableBodyAPI that has a "
            "mesh with CageCutCageAPI and a mesh to render below it"
        )
    blades = tuple(_blade(prim, bodies, axis) for prim in _tagged(stage.GetPseudoRoot(), "CageCutBladeAPI"))
    frames = int(round(stage.GetEndTimeCode() - stage.GetStartTimeCode())) + 1
    rate = stage.GetTimeCodesPerSecond()
    return StageScene(bodies=bodies, blades=blades, fps=rate, frame_count=max(frames, 1))


def _add_body(builder: newton.ModelBuilder, prim: Usd.Prim, cage: Usd.Prim, axis: str, walks: int | None) -> int:
    """Add one body."""
    below = [p for p in Usd.PrimRange(prim) if p.IsA(UsdGeom.Mesh) and not _has(p, "CageCutCageAPI")]
    if len(below) != 1:
        raise ValueError(f"{prim.GetPath()} must have one mesh to render beside its cage, it has {_paths(below)}")
    options = {name: kind(value) for name, kind in _OPTIONS.items() if (value := _value(cage, name)) is not None}
    if walks is not None:
        options["walks"] = walks
    unit = UsdGeom.GetStageMetersPerUnit(prim.GetStage())
    if (fixed := _value(cage, "fixed")) is not None:
        options["fixed"] = np.array(fixed, dtype=np.int64)
    if (radius := _value(cage, "contactRadius")) is not None:
        options["contact_radius"] = radius * unit
    if (velocity := _value(cage, "velocity")) is not None:
        options["velocity"] = _turned(prim, np.array(velocity) * unit, axis)
    room = {name: _value(cage, "capacity:" + name) for name in _CAPACITY}
    if any(value is not None for value in room.values()):
        missing = [name for name, value in room.items() if value is None]
        if missing:
            raise ValueError(f"{cage.GetPath()} has a capacity without cagecut:capacity:{missing[0]}")
        options["capacity"] = Capacity(**room)
    stage, label = prim.GetStage(), str(prim.GetPath()).strip("/").replace("/", "_")
    try:
        return add_cage_body(
            builder,
            read_cage(stage, str(cage.GetPath()), up_axis=axis),
            read_surface(stage, str(below[0].GetPath()), up_axis=axis),
            material=_material(prim),
            label=label,
            **options,
        )
    except (TypeError, ValueError) as error:
        raise ValueError(f"{prim.GetPath()}: {error}") from error


def _material(prim: Usd.Prim) -> Material:
    """The material bound to a body for physics, in SI units; what it does not say is as of ``Material``."""
    bound = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial("physics")[0]
    if not bound:
        return Material()
    found = bound.GetPrim()
    if not _has(found, "PhysicsVolumeDeformableMaterialAPI"):
        raise ValueError(f"its material {found.GetPath()} has no PhysicsVolumeDeformableMaterialAPI")
    unit = UsdGeom.GetStageMetersPerUnit(prim.GetStage())
    kilogram = UsdPhysics.GetStageKilogramsPerUnit(prim.GetStage())
    scales = {
        "young": ("physics:youngsModulus", kilogram / unit),
        "poisson": ("physics:poissonsRatio", 1.0),
        "density": ("physics:density", kilogram / unit**3),
        "damping": ("cagecut:damping", 1.0),
    }
    options: dict[str, object] = {}
    for name, (attribute, scale) in scales.items():
        value = found.GetAttribute(attribute).Get() if found.HasAttribute(attribute) else None
        if value is not None and not (name in ("young", "density") and value == 0.0):
            options[name] = value * scale
    model = found.GetAttribute("cagecut:model").Get() if found.HasAttribute("cagecut:model") else None
    try:
        return Material(**options, **({} if model is None else {"model": str(model)}))
    except ValueError as error:
        raise ValueError(f"its material {found.GetPath()}: {error}") from error


def _blade(prim: Usd.Prim, bodies: dict[str, int], axis: str) -> StageBlade:
    """A blade, in the frame of its prim, with its track."""
    relation = prim.GetRelationship("cagecut:body")
    targets = [str(path) for path in relation.GetTargets()] if relation else []
    if not targets and len(bodies) == 1:
        targets = list(bodies)
    if len(targets) != 1 or targets[0] not in bodies:
        raise ValueError(
            f"{prim.GetPath()}: cagecut:body must name one of the cage bodies {', '.join(bodies)}, it names "
            f"{', '.join(targets) or 'none'}"
        )
    track = prim.GetAttribute("cagecut:depth")
    codes = track.GetTimeSamples() if track else []
    if not codes:
        raise ValueError(f"{prim.GetPath()} has no track: give cagecut:depth time samples")
    stage = prim.GetStage()
    unit = UsdGeom.GetStageMetersPerUnit(stage)
    matrix = np.array(UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(Usd.TimeCode.EarliestTime()))
    edge, direction = (
        _turned(prim, np.array(_value(prim, name) or default) @ matrix[:3, :3], axis)
        for name, default in (("edge", (1.0, 0.0, 0.0)), ("direction", (0.0, 0.0, -1.0)))
    )
    width = _value(prim, "width")
    options = {} if width is None else {"width": width * unit * np.linalg.norm(matrix[0, :3])}
    try:
        blade = Blade(_turned(prim, matrix[3, :3] * unit, axis), edge, direction, **options)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{prim.GetPath()}: {error}") from error
    times = (np.array(codes) - stage.GetStartTimeCode()) / stage.GetTimeCodesPerSecond()
    depths = np.array([track.Get(code) for code in codes], dtype=np.float64) * unit
    return StageBlade(path=str(prim.GetPath()), body=bodies[targets[0]], blade=blade, times=times, depths=depths)


def _has(prim: Usd.Prim, schema: str) -> bool:
    """Whether an API schema is applied to a prim, registered or not."""
    listed = prim.GetMetadata("apiSchemas")
    return listed is not None and schema in listed.GetAddedOrExplicitItems()


def _tagged(root: Usd.Prim, schema: str) -> list[Usd.Prim]:
    """The prims at or below another that have a schema."""
    return [prim for prim in Usd.PrimRange(root) if _has(prim, schema)]


def _owner(prim: Usd.Prim, bodies: dict[str, int]) -> bool:
    """Whether a body stands above a prim."""
    return any(str(path) in bodies for path in prim.GetPath().GetPrefixes())


def _value(prim: Usd.Prim, name: str) -> object:
    """The value of one of our attributes, or None."""
    attribute = prim.GetAttribute(f"cagecut:{name}")
    return attribute.Get() if attribute else None


def _turned(prim: Usd.Prim, vector: np.ndarray, axis: str) -> np.ndarray:
    """A vector of the stage with the builder's up axis."""
    own = str(UsdGeom.GetStageUpAxis(prim.GetStage()))
    return turn_up(np.asarray(vector, dtype=np.float64)[None], own, axis)[0]


def _paths(prims: list[Usd.Prim]) -> str:
    return ", ".join(str(prim.GetPath()) for prim in prims) or "none"

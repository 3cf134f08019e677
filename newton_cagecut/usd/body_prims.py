# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The prims of one animated body: its skin and its caps, as two meshes or one, and its cage."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np
from pxr import Sdf, Usd, UsdGeom, Vt

from .body_frame import BodyFrame
from .layers import color, flat_faces, integers, vectors
from .materials import bind_material
from .normals import direction_numbers, direction_table, split_caps, vertex_normals
from .outline import outline_loops
from .sampled_prims import SampledMesh, SampledOutline, SampledVelocities

_CAGE_COLOR = (0.25, 0.45, 0.85)


class BodyOptions(NamedTuple):
    """What is written of bodies; see :class:`~newton_cagecut.usd.AnimationWriter`."""

    normals: bool | Literal["compact"] = "compact"
    velocities: bool | Literal["changes"] = "changes"
    separate_caps: bool = True


class SurfacePart:
    """A mesh of some of a body's triangles, on the points that they use.

    Args:
        stage: The stage.
        path: Path of the mesh, which is made.
        options: What to write.
    """

    def __init__(self, stage: Usd.Stage, path: str, options: BodyOptions):
        self._sampled = SampledMesh(stage, path)
        self.mesh, self._options = self._sampled.mesh, options
        self._velocities = SampledVelocities(self.mesh, always=options.velocities is True)
        self._st: UsdGeom.Primvar | None = None
        self._source, self._triangles = np.zeros(0, dtype=np.int64), np.zeros((0, 3), dtype=np.int32)
        self._changed = False
        self._number_normals = self._make_normals()

    def set_topology(self, source: np.ndarray, triangles: np.ndarray) -> None:
        """Take over other triangles.

        Args:
            source: The body's point that each point is, shape ``(n,)``.
            triangles: Point ids, shape ``(m, 3)``.
        """
        self._source, self._triangles, self._changed = source, triangles, True

    def set_uvs(self, frame: float, uvs: np.ndarray) -> None:
        """Write the texture coordinates of the triangles' corners, shape ``(m, 3, 2)``, each pair of numbers once."""
        if self._st is None:
            primvars = UsdGeom.PrimvarsAPI(self.mesh)
            kind, token = Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.faceVarying
            self._st = primvars.CreatePrimvar("st", kind, token)
        pairs = np.ascontiguousarray(uvs.reshape(-1, 2), dtype=np.float32)
        _, first, number = np.unique(pairs.view(np.int64).reshape(-1), return_index=True, return_inverse=True)
        self._st.Set(Vt.Vec2fArray.FromNumpy(pairs[first]), frame)
        self._st.CreateIndicesAttr().Set(integers(number.reshape(-1)), frame)

    def write(self, frame: float, points: np.ndarray, velocities: np.ndarray | None) -> None:
        """Write one frame.

        Args:
            frame: Time code.
            points: The body's points, in units of the stage, shape ``(n, 3)``.
            velocities: Their velocities, in units of the stage a second, or ``None``.
        """
        place, points = points.mean(axis=0), points[self._source]
        self._sampled.write(frame, points, *flat_faces(self._triangles), place)
        if self._options.normals:
            normals = vertex_normals(points, self._triangles)
            if self._number_normals is None:
                self.mesh.GetNormalsAttr().Set(vectors(normals), frame)
            else:
                self._number_normals.Set(integers(direction_numbers(normals)), frame)
        if velocities is not None and self._options.velocities:
            self._velocities.write(frame, velocities[self._source], changed=self._changed)
        self._changed = False

    def write_nothing(self, frame: float, place: np.ndarray) -> None:
        """Write a frame without triangles.

        Args:
            frame: Time code.
            place: Where the body is, in units of the stage.
        """
        self.write(frame, place.reshape(1, 3), np.zeros((1, 3)))

    def _make_normals(self) -> Usd.Attribute | None:
        """Declare the normals; return the attribute of their numbers in the table of directions, if that is used."""
        if self._options.normals != "compact":
            if self._options.normals:
                self.mesh.SetNormalsInterpolation(UsdGeom.Tokens.vertex)
            return None
        primvars = UsdGeom.PrimvarsAPI(self.mesh)
        table = primvars.CreatePrimvar("normals", Sdf.ValueTypeNames.Normal3fArray, UsdGeom.Tokens.vertex)
        table.Set(vectors(direction_table()))
        return table.CreateIndicesAttr()


class BodyPrims:
    """Writes the frames of one body.

    Args:
        stage: The stage.
        path: Path of the body, which is made.
        body: The body in its first frame.
        frame: That frame.
        since: The frame from which it is visible, or ``None`` for all.
        options: What to write. With normals caps have points of their own for each side of a cut.
    """

    def __init__(
        self, stage: Usd.Stage, path: str, body: BodyFrame, *, frame: float, since: float | None, options: BodyOptions
    ):
        root = UsdGeom.Xform.Define(stage, path)
        if since is not None:
            root.GetVisibilityAttr().Set(UsdGeom.Tokens.invisible, stage.GetStartTimeCode())
            root.GetVisibilityAttr().Set(UsdGeom.Tokens.inherited, since)
        self._stage, self._path, self._options, self._first = stage, path, options, frame
        self._cage: SampledMesh | SampledOutline | None = None
        self._topology: tuple[np.ndarray, ...] | None = None
        self._caps: SurfacePart | None = None
        self._skin = SurfacePart(stage, f"{path}/{'skin' if options.separate_caps else 'surface'}", options)
        self._make_materials(body)

    def write(self, frame: float, body: BodyFrame, scale: float) -> None:
        """Write one frame.

        Args:
            frame: Time code.
            body: The body now, checked.
            scale: Units of the stage in a metre.
        """
        points = body.points * scale
        topology = (np.array(len(points)), body.triangles, body.triangle_cap)
        if self._topology is None or not all(map(np.array_equal, topology, self._topology)):
            self._topology = tuple(values.copy() for values in topology)
            if self._options.separate_caps:
                self._change_parts(frame, body, points)
            else:
                self._change_whole(frame, body)
        velocities = None if body.velocities is None else body.velocities * scale
        for part in (self._skin, self._caps):
            if part is not None:
                part.write(frame, points, velocities)
        if body.cage_points is not None:
            self._write_cage(frame, body, scale)

    def _make_materials(self, body: BodyFrame) -> None:
        """Bind the skin's material; in one mesh also that of the caps, to a subset."""
        mesh = self._skin.mesh
        bind_material(mesh.GetPrim(), body.skin_color, texture=body.skin_texture)
        if self._options.separate_caps:
            mesh.CreateDisplayColorAttr([color(body.skin_color)])
            return
        self._colors = mesh.CreateDisplayColorPrimvar(UsdGeom.Tokens.uniform)
        self._colors.Set(Vt.Vec3fArray([color(body.skin_color), color(body.cap_color)]))
        none = Vt.IntArray()
        self._subset = UsdGeom.Subset.CreateGeomSubset(mesh, "cap", UsdGeom.Tokens.face, none, "materialBind")
        self._subset.GetIndicesAttr().Clear()
        UsdGeom.Subset.SetFamilyType(mesh, "materialBind", UsdGeom.Tokens.nonOverlapping)
        bind_material(self._subset.GetPrim(), body.cap_color, texture=body.cap_texture)

    def _change_parts(self, frame: float, body: BodyFrame, points: np.ndarray) -> None:
        """Take over other triangles: those of the skin and those of the caps."""
        is_cap = body.triangle_cap >= 0
        source, triangles = self._split(body)
        self._skin.set_topology(*_used(source, triangles[~is_cap]))
        if body.uvs is not None and body.has_skin_uvs:
            self._skin.set_uvs(frame, body.uvs[~is_cap])
        if self._caps is None and is_cap.any():
            self._caps = SurfacePart(self._stage, f"{self._path}/caps", self._options)
            self._caps.mesh.CreateDisplayColorAttr([color(body.cap_color)])
            bind_material(self._caps.mesh.GetPrim(), body.cap_color, texture=body.cap_texture)
            if frame != self._first:
                self._caps.write_nothing(self._first, points.mean(axis=0))
                if body.uvs is not None:
                    self._caps.set_uvs(self._first, np.zeros((0, 3, 2)))
        if self._caps is not None:
            self._caps.set_topology(*_used(source, triangles[is_cap]))
            if body.uvs is not None:
                self._caps.set_uvs(frame, body.uvs[is_cap])

    def _change_whole(self, frame: float, body: BodyFrame) -> None:
        """Take over other triangles or caps, all in one mesh."""
        self._skin.set_topology(*self._split(body))
        if body.uvs is not None:
            self._skin.set_uvs(frame, body.uvs)
        is_cap = body.triangle_cap >= 0
        self._subset.GetIndicesAttr().Set(integers(np.flatnonzero(is_cap)), frame)
        self._colors.CreateIndicesAttr().Set(integers(is_cap), frame)

    def _split(self, body: BodyFrame) -> tuple[np.ndarray, np.ndarray]:
        """Return the points, and the triangles on them; with normals each side of a cut has its own."""
        if self._options.normals:
            return split_caps(body.rest_points, body.triangles, body.triangle_cap)
        return np.arange(len(body.points)), body.triangles.copy()

    def _write_cage(self, frame: float, body: BodyFrame, scale: float) -> None:
        """Write the cage: a mesh, or the outlines of a plane one."""
        points, path = body.cage_points * scale, f"{self._path}/cage"
        if body.has_plane_cage:
            if self._cage is None:
                self._cage = SampledOutline(self._stage, path)
                self._cage.curves.CreateDisplayColorAttr([color(_CAGE_COLOR)])
            self._cage.write(frame, points, outline_loops("the cage", body.cage_faces, len(points)))
            return
        if self._cage is None:
            self._cage = SampledMesh(self._stage, path)
            self._cage.mesh.CreatePurposeAttr(UsdGeom.Tokens.guide)
            self._cage.mesh.CreateDisplayColorAttr([color(_CAGE_COLOR)])
            self._cage.mesh.CreateDisplayOpacityPrimvar(UsdGeom.Tokens.constant).Set(Vt.FloatArray([0.25]))
        self._cage.write(frame, points, *flat_faces(body.cage_faces))


def _used(source: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the points that triangles use, and the triangles on those."""
    used, corner = np.unique(triangles, return_inverse=True)
    return source[used], corner.reshape(-1, 3).astype(np.int32)

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The prims of one animated body: its surface, the subset of its caps and its cage."""

from __future__ import annotations

import numpy as np
from pxr import Usd, UsdGeom, Vt

from .body_frame import BodyFrame
from .layers import color, define_mesh, extent, flat_faces, integers, vectors
from .materials import bind_material
from .normals import split_caps, vertex_normals
from .outline import define_outline, outline_loops

_CAGE_COLOR = (0.25, 0.45, 0.85)


class SampledPoints:
    """A prim whose points get a sample in every frame.

    Between two samples with different numbers of points USD holds the points of the first but interpolates the
    extent. So the extent of the second holds both.

    Args:
        prim: The prim.
    """

    def __init__(self, prim: UsdGeom.PointBased):
        self._prim = prim
        self._points = np.zeros((0, 3))

    def write_points(self, frame: float, points: np.ndarray) -> None:
        """Write a sample."""
        resized = len(points) != len(self._points)
        self._prim.GetPointsAttr().Set(vectors(points), frame)
        self._prim.GetExtentAttr().Set(extent(np.concatenate([self._points, points]) if resized else points), frame)
        self._points = points


class SampledMesh(SampledPoints):
    """A mesh prim, seen from both sides, whose topology gets a sample in the frames where it changes.

    Args:
        stage: The stage.
        path: Path of the prim, which is made.
    """

    def __init__(self, stage: Usd.Stage, path: str):
        self.mesh = define_mesh(stage, path)
        self.mesh.CreateDoubleSidedAttr(True)
        self._counts = self._indices = np.zeros(0, dtype=np.int32)
        super().__init__(self.mesh)

    def write(self, frame: float, points: np.ndarray, counts: np.ndarray, indices: np.ndarray) -> None:
        """Write a sample."""
        self.write_points(frame, points)
        if not (np.array_equal(counts, self._counts) and np.array_equal(indices, self._indices)):
            self.mesh.GetFaceVertexCountsAttr().Set(integers(counts), frame)
            self.mesh.GetFaceVertexIndicesAttr().Set(integers(indices), frame)
            self._counts, self._indices = counts, indices


class SampledOutline(SampledPoints):
    """The curves of a plane cage, whose counts get a sample in the frames where they change.

    Args:
        stage: The stage.
        path: Path of the prim, which is made.
    """

    def __init__(self, stage: Usd.Stage, path: str):
        self.curves = define_outline(stage, path)
        self._sizes: list[int] = []
        super().__init__(self.curves)

    def write(self, frame: float, points: np.ndarray, loops: tuple[np.ndarray, ...]) -> None:
        """Write a sample."""
        self.write_points(frame, points[np.concatenate(loops)])
        sizes = [len(loop) for loop in loops]
        if sizes != self._sizes:
            self.curves.GetCurveVertexCountsAttr().Set(integers(sizes), frame)
            self._sizes = sizes


class BodyPrims:
    """Writes the frames of one body.

    Args:
        stage: The stage.
        path: Path of the body, which is made.
        body: The body in its first frame.
        since: The frame from which it is visible, or ``None`` for all.
        normals: Whether to write normals. Caps get vertices of their own then, behind those of the skin.
    """

    def __init__(self, stage: Usd.Stage, path: str, body: BodyFrame, *, since: float | None, normals: bool):
        root = UsdGeom.Xform.Define(stage, path)
        if since is not None:
            root.GetVisibilityAttr().Set(UsdGeom.Tokens.invisible, stage.GetStartTimeCode())
            root.GetVisibilityAttr().Set(UsdGeom.Tokens.inherited, since)
        self._stage, self._path, self._normals = stage, path, normals
        self._cage: SampledMesh | SampledOutline | None = None
        self._surface = SampledMesh(stage, f"{path}/surface")
        mesh = self._surface.mesh
        if normals:
            mesh.SetNormalsInterpolation(UsdGeom.Tokens.vertex)
        bind_material(mesh.GetPrim(), body.skin_color)
        self._colors = mesh.CreateDisplayColorPrimvar(UsdGeom.Tokens.uniform)
        self._colors.Set(Vt.Vec3fArray([color(body.skin_color), color(body.cap_color)]))
        no_faces = Vt.IntArray()
        self._cap = UsdGeom.Subset.CreateGeomSubset(mesh, "cap", UsdGeom.Tokens.face, no_faces, "materialBind")
        self._cap.GetIndicesAttr().Clear()
        UsdGeom.Subset.SetFamilyType(mesh, "materialBind", UsdGeom.Tokens.nonOverlapping)
        bind_material(self._cap.GetPrim(), body.cap_color)
        self._topology: tuple[np.ndarray, ...] | None = None

    def write(self, frame: float, body: BodyFrame, scale: float) -> None:
        """Write one frame.

        Args:
            frame: Time code.
            body: The body now, checked.
            scale: Units of the stage in a metre.
        """
        topology = (np.array(len(body.points)), body.triangles, body.triangle_cap)
        if self._topology is None or not all(map(np.array_equal, topology, self._topology)):
            self._topology = tuple(values.copy() for values in topology)
            self._change_topology(frame, body)
        points = body.points[self._source] * scale
        self._surface.write(frame, points, *flat_faces(self._triangles))
        if self._normals:
            self._surface.mesh.GetNormalsAttr().Set(vectors(vertex_normals(points, self._triangles)), frame)
        if body.cage_points is not None:
            self._write_cage(frame, body, scale)

    def _change_topology(self, frame: float, body: BodyFrame) -> None:
        """Take over other triangles or caps."""
        self._source, self._triangles = np.arange(len(body.points)), body.triangles.copy()
        if self._normals:
            self._source, self._triangles = split_caps(body.rest_points, body.triangles, body.triangle_cap)
        is_cap = body.triangle_cap >= 0
        self._cap.GetIndicesAttr().Set(integers(np.flatnonzero(is_cap)), frame)
        self._colors.CreateIndicesAttr().Set(integers(is_cap), frame)

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

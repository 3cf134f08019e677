# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Prims whose arrays get a sample in every frame or where they change."""

from __future__ import annotations

import numpy as np
from pxr import Sdf, Usd, UsdGeom

from .layers import define_mesh, extent, integers, vectors
from .outline import define_outline


class SampledPoints:
    """A prim whose points get a sample in every frame.

    Between two samples with different numbers of points USD holds the points of the first but interpolates the
    extent. So the extent of the second holds both. Where there are no points, the extent is the place of the prim.

    Args:
        prim: The prim.
    """

    def __init__(self, prim: UsdGeom.PointBased):
        self._prim = prim
        self._points = np.zeros((0, 3))

    def write_points(self, frame: float, points: np.ndarray, place: np.ndarray | None = None) -> None:
        """Write a sample.

        Args:
            frame: Time code.
            points: The points, in units of the stage.
            place: Where the prim is without points.
        """
        held = np.concatenate([self._points, points]) if len(points) != len(self._points) else points
        self._prim.GetPointsAttr().Set(vectors(points), frame)
        self._prim.GetExtentAttr().Set(extent(held if len(held) else place.reshape(1, 3)), frame)
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
        self._counts = self._indices = None
        super().__init__(self.mesh)

    def write(
        self,
        frame: float,
        points: np.ndarray,
        counts: np.ndarray,
        indices: np.ndarray,
        place: np.ndarray | None = None,
    ) -> None:
        """Write a sample; see :meth:`write_points`."""
        self.write_points(frame, points, place)
        if self._counts is None or not (
            np.array_equal(counts, self._counts) and np.array_equal(indices, self._indices)
        ):
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


class SampledVelocities:
    """Velocities of a mesh, in all frames or in those beside a change of topology, and blocked in the others.

    A renderer takes motion blur from two samples of the points where they have the same topology, and from the
    velocities where they do not.

    Args:
        mesh: The mesh.
        always: Whether in all frames.
    """

    def __init__(self, mesh: UsdGeom.Mesh, *, always: bool):
        self._attribute, self._always = mesh.GetVelocitiesAttr(), always
        self._last: tuple[float, np.ndarray] | None = None
        self._first: float | None = None
        self._open = False

    def write(self, frame: float, velocities: np.ndarray, *, changed: bool) -> None:
        """Write a sample.

        Args:
            frame: Time code.
            velocities: The velocities, in units of the stage a second.
            changed: Whether the topology is another than in the last frame.
        """
        changed = changed and self._last is not None  # the first frame has none before it
        if self._first is None:
            self._first = frame
        if changed and not self._always and not self._open:
            if self._attribute.GetNumTimeSamples() == 0:
                self._attribute.Set(Sdf.ValueBlock(), self._first)  # a first sample would count before it too
            self._attribute.Set(vectors(self._last[1]), self._last[0])
        if changed or self._always:
            self._attribute.Set(vectors(velocities), frame)
        elif self._open:
            self._attribute.Set(Sdf.ValueBlock(), frame)
        self._open = changed or self._always
        self._last = (frame, velocities)

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What a whole scene looks like in one frame: cage bodies, shapes, and where rigid bodies are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from .body_frame import BodyFrame


@dataclass(frozen=True, eq=False, kw_only=True)
class SceneShape:
    """A shape that keeps its form.

    Attributes:
        name: Its name; one that is taken gets a number.
        points: Its vertices [m], shape ``(n, 3)``, in the frame of its body.
        triangles: Its triangles, shape ``(m, 3)``.
        normals: Unit normals of the vertices, shape ``(n, 3)``, or ``None`` for flat triangles.
        body: Number of the rigid body that carries it, -1 for the world.
        color: Linear RGB.
        endless: Whether it stands for a plane without an end: its points are then 1 m from its middle, along each axis,
            and moved out as far as the scene needs.
    """

    name: str
    points: np.ndarray
    triangles: np.ndarray
    normals: np.ndarray | None = None
    body: int = -1
    color: tuple[float, float, float] = (0.22, 0.24, 0.27)
    endless: bool = False


@dataclass(frozen=True, eq=False, kw_only=True)
class SceneFrame:
    """What a scene looks like in one frame.

    Attributes:
        bodies: The cage bodies.
        shapes: The shapes, the same in all frames.
        rigid_names: Names of the rigid bodies.
        rigid_poses: Position [m] and quaternion (x, y, z, w) of each, shape ``(k, 7)``.
        up_axis: The axis that points up, ``"Y"`` or ``"Z"``.
    """

    bodies: tuple[BodyFrame, ...]
    shapes: tuple[SceneShape, ...] = ()
    rigid_names: tuple[str, ...] = ()
    rigid_poses: np.ndarray | None = None
    up_axis: str = "Z"


class SceneSource(Protocol):
    """What can be written whole, such as a solver."""

    def scene_frame(self, state: Any) -> SceneFrame:
        """Return what the scene looks like in a state."""
        ...

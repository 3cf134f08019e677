# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Showing bodies in Newton's viewers."""

from __future__ import annotations

import newton
import numpy as np
import warp as wp

from .body.simulated_body import SimulatedBody

SKIN_COLOR = (0.91, 0.46, 0.33)
CAP_COLOR = (0.98, 0.84, 0.70)


class SurfaceViewer:
    """Logs the surfaces of bodies, and remembers their index buffers between changes of topology."""

    def __init__(self) -> None:
        self._indices: dict[str, tuple[object, wp.array, wp.array]] = {}

    def log(self, viewer: newton.viewer.ViewerBase, body: SimulatedBody, state: newton.State) -> None:
        """Log one body's skin and caps as two meshes over the same points; a plane body has no caps."""
        points = body.surface_points(state)
        skin, caps = self._index_buffers(body)
        name = f"/cagecut/{body.label}"
        viewer.log_mesh(f"{name}/skin", points, skin, color=SKIN_COLOR, backface_culling=False, dynamic=True)
        if body.is_plane:
            return
        # Before the first cut a hidden triangle stands for the caps, so that no frame shows them too early.
        hidden = caps.size == 0
        viewer.log_mesh(
            f"{name}/caps",
            points,
            skin[:3] if hidden else caps,
            color=CAP_COLOR,
            backface_culling=False,
            dynamic=True,
            hidden=hidden,
        )

    def _index_buffers(self, body: SimulatedBody) -> tuple[wp.array, wp.array]:
        kept = self._indices.get(body.label)
        if kept is None or kept[0] is not body.surface:
            is_cap = np.asarray(body.surface.triangle_cap) >= 0
            triangles = np.asarray(body.surface.triangles, dtype=np.int32)
            buffers = [
                wp.array(triangles[rows].reshape(-1), dtype=wp.int32, device=body.device) for rows in (~is_cap, is_cap)
            ]
            kept = (body.surface, *buffers)
            self._indices[body.label] = kept
        return kept[1], kept[2]

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Showing bodies in Newton's viewers, and keeping them in recordings, which have no meshes of their own."""

from __future__ import annotations

import newton
import numpy as np
import warp as wp

from .body.simulated_body import SimulatedBody

SKIN_COLOR = (0.91, 0.46, 0.33)
CAP_COLOR = (0.98, 0.84, 0.70)
_ROOT = "/cagecut/"
_RECORDED = ("points", "skin", "caps")


class SurfaceViewer:
    """Logs the surfaces of bodies, and remembers their index buffers between changes of topology."""

    def __init__(self) -> None:
        self._indices: dict[str, tuple[object, wp.array, wp.array]] = {}

    def log(self, viewer: newton.viewer.ViewerBase, body: SimulatedBody, state: newton.State) -> None:
        """Log one body's skin and caps as two meshes over the same points; a plane body has no caps."""
        points = body.surface_points(state)
        skin, caps = self._index_buffers(body)
        name = f"{_ROOT}{body.label}"
        if isinstance(viewer, newton.viewer.ViewerFile):
            _record(viewer, name, points, skin, caps)
        else:
            _show(viewer, name, points, skin, None if body.is_plane else caps)

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


def log_recorded(viewer: newton.viewer.ViewerBase, recording: newton.viewer.ViewerFile, frame: int) -> None:
    """Show the surfaces that ``SolverCageCut.log`` kept in a recording, with the topology of that frame.

    Args:
        viewer: Any of Newton's viewers that shows meshes.
        recording: A recording, with ``load_recording()`` called, or one that has just been made.
        frame: Number of the frame, from 0.

    Raises:
        ValueError: There is no such frame, or it has no surfaces.
    """
    count = len(recording.history)
    if not 0 <= frame < count:
        raise ValueError(f"there is no frame {frame}; the recording has {count}")
    kept = recording.history[frame]
    names = [key.removesuffix("/points") for key in kept if key.startswith(_ROOT) and key.endswith("/points")]
    if not names:
        raise ValueError(
            f"frame {frame} has no surfaces of cage bodies: call solver.log(viewer, state) after viewer.log_state"
        )
    for name in names:
        _show(viewer, name, *(kept[f"{name}/{part}"] for part in _RECORDED))


def _record(recording: newton.viewer.ViewerFile, name: str, *arrays: wp.array) -> None:
    """Keep a surface with the state that was recorded last."""
    if len(recording.history) == 0:
        raise ValueError("a recording keeps surfaces with a state: call viewer.log_state(state) before solver.log")
    recording.history[-1].update({f"{name}/{part}": wp.clone(array) for part, array in zip(_RECORDED, arrays)})


def _show(viewer: newton.viewer.ViewerBase, name: str, points: wp.array, skin: wp.array, caps: wp.array | None) -> None:
    """Log skin and caps; before the first cut a hidden triangle stands for the caps, which no frame has too early."""
    viewer.log_mesh(f"{name}/skin", points, skin, color=SKIN_COLOR, backface_culling=False, dynamic=True)
    if caps is not None:
        hidden = caps.size == 0
        shown = skin[:3] if hidden else caps
        options = {"color": CAP_COLOR, "backface_culling": False, "dynamic": True, "hidden": hidden}
        viewer.log_mesh(f"{name}/caps", points, shown, **options)

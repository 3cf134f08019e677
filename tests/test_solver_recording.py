# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Surfaces in the recordings of Newton's ViewerFile."""

from __future__ import annotations

import newton
import numpy as np
import pytest

from newton_cagecut.solver import log_recorded
from solver_scenes import make_solver, run, slanted_blade


class Seen(newton.viewer.ViewerNull):
    """Keeps what is logged of meshes."""

    def log_mesh(self, name, points, indices, *args, hidden=False, **options):
        """Keep one."""
        self.meshes = {**getattr(self, "meshes", {}), name: (points.numpy(), indices.numpy().reshape(-1, 3), hidden)}


def test_recording_plays_the_surface_back(tmp_path):
    """A file of four frames, with cuts from the second on, shows the surface of each with its own topology."""
    model, solver, *states = make_solver(gravity=-9.81, label="ball")
    viewer, cut, expected = newton.viewer.ViewerFile(str(tmp_path / "cut.json")), None, []
    viewer.set_model(model)
    with pytest.raises(ValueError, match="call viewer.log_state"):
        solver.log(viewer, states[0])
    for frame in range(4):
        if frame > 0:
            cut = cut or solver.begin_cut(0, slanted_blade())
            solver.advance_cut(cut, 0.3, states=states)
        states = run(solver, states, 1)
        viewer.begin_frame(frame / 60.0)
        viewer.log_state(states[0])
        solver.log(viewer, states[0])
        viewer.end_frame()
        expected.append((*solver.surface(states[0]), solver.bodies[0].surface.triangle_cap >= 0))
    viewer.close()
    again = newton.viewer.ViewerFile(str(tmp_path / "cut.json"))
    again.load_recording()
    for frame, (points, triangles, is_cap) in enumerate(expected):
        seen = Seen()
        log_recorded(seen, again, frame)
        skin, caps = seen.meshes["/cagecut/ball/skin"], seen.meshes["/cagecut/ball/caps"]
        np.testing.assert_array_equal(skin[0], points)
        np.testing.assert_array_equal(skin[1], triangles[~is_cap])
        assert caps[2] == (not is_cap.any())
        if is_cap.any():
            np.testing.assert_array_equal(caps[1], triangles[is_cap])
    assert expected[-1][2].any()
    with pytest.raises(ValueError, match="there is no frame 4; the recording has 4"):
        log_recorded(Seen(), again, 4)

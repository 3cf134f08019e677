# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Cut a starfish yourself: move the blade, press Cut; --viewer viser in a browser, --viewer gl in a window.

The translucent plate is the knife: it goes down from where it stands, as wide as it is drawn. Cuts can be undone.

Success criteria: the blade where it stands at first takes an arm off; undo brings it back, bit for bit.
"""

from __future__ import annotations

import time
from argparse import Namespace

import newton
import numpy as np
import warp as wp

from newton_cagecut import BodyCut, BodySnapshot, Material
from newton_cagecut.usd import AnimationWriter

from .base import Camera, PlannedCut, knife_at, require
from .paper import starfish

SIZE = (0.34, 0.24)  # width and height of the knife [m]


class Example(starfish.Example):
    name = "interactive"
    frame_count = 100_000
    substep_count = 1
    camera = Camera(eye=(0.42, -1.42, 0.98), target=(0.04, -0.1, 0.25))
    cut: BodyCut | None = None
    message = "move the blade, then press Cut"
    young, pace = 2e4, 0.012  # [Pa], [m] a frame

    def __init__(self, viewer: newton.viewer.ViewerBase, args: Namespace):
        self.undoable: list[BodySnapshot] = []
        self.seconds = {"cut": 0.0, "step": 0.0}
        turn = wp.quat_from_axis_angle(wp.vec3(0.0, 0.0, 1.0), float(np.radians(-36.0)))
        self.gizmo = wp.transform(wp.vec3(-0.22, -0.3, 0.42), turn)
        args.walks = args.walks or 64
        super().__init__(viewer, args)
        if hasattr(viewer, "set_reset_callback"):
            viewer.set_reset_callback(self.reset)

    def cuts(self) -> tuple[PlannedCut, ...]:
        return ()

    def begin(self) -> None:
        """Put the knife to the body, from where it can be undone."""
        try:
            snapshot = self.solver.snapshot(0, states=(self.state_0, self.state_1))
            self.cut = self.solver.begin_cut(
                0, knife_at(self.gizmo, self.points(), self.solver.body(0).surface.points, SIZE)
            )
            self.undoable.append(snapshot)
            self.message = "cutting"
        except ValueError as error:
            self.message = str(error).split(";")[0]

    def undo(self, *, count: int = 1) -> None:
        """Undo the last cuts."""
        self.cut = None
        for _ in range(min(count, len(self.undoable))):
            self.solver.restore(self.undoable.pop())

    def reset(self) -> None:
        """Undo all cuts, and start anew."""
        self.undo(count=len(self.undoable))
        for state in (self.state_0, self.state_1):
            self.solver.reset(state)

    def advance(self) -> None:
        start = time.perf_counter()
        if self.cut is not None:
            try:
                self.solver.advance_cut(self.cut, self.pace, states=(self.state_0, self.state_1))
            except ValueError as error:
                self.cut, self.message = None, str(error).split(";")[0]
            if self.cut is not None and self.cut.complete:
                self.cut, self.message = None, f"{len(self.solver.pieces(0))} pieces"
        cut = time.perf_counter() - start
        super().advance()
        self.seconds = {"cut": cut, "step": time.perf_counter() - start - cut}

    def show(self) -> None:
        super().show()
        self.viewer.log_gizmo("blade", self.gizmo)
        corners = [(x * SIZE[0], 0.0, z * SIZE[1]) for x, z in ((-0.5, 0), (0.5, 0), (0.5, 1), (-0.5, 1))]
        plate = wp.array([wp.transform_point(self.gizmo, wp.vec3(*corner)) for corner in corners], dtype=wp.vec3)
        triangles = wp.array([0, 1, 2, 0, 2, 3], dtype=wp.int32)
        self.viewer.log_mesh("/blade", plate, triangles, color=(0.6, 0.7, 0.9), opacity=0.5, backface_culling=False)

    def gui(self, ui: object) -> None:
        """Draw the panel, with what both ImGui and Viser have."""
        if ui.button("Cut") and self.cut is None:
            self.begin()
        if ui.button("Undo"):
            self.undo()
        if ui.button("Save USD"):
            with AnimationWriter("interactive.usd", fps=self.fps) as writer:
                writer.write_frame(0, self.recording, self)
            self.message = "wrote interactive.usd"
        changed, self.young = ui.slider_float("Stiffness [Pa]", self.young, 5e3, 2e5)
        if changed:
            self.solver.set_material(0, Material(young=self.young, poisson=0.4, density=1000.0, damping=0.01))
        _, self.pace = ui.slider_float("Pace [m/frame]", self.pace, 0.002, 0.05)
        ui.text(f"{self.message}, {len(self.solver.pieces(0))} pieces")
        ui.text(", ".join(f"{name} {1e3 * seconds:.0f} ms" for name, seconds in self.seconds.items()))

    def test_final(self) -> None:
        before = self.solver.body(0).surface_weights
        self.begin()
        while self.cut is not None:
            self.advance()
        require(len(self.solver.pieces(0)) == 2, f"the blade takes an arm off: {self.message}")
        self.undo()
        require(np.array_equal(before, self.solver.body(0).surface_weights), "undo brings every bit back")

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A ball in a cube falls in half: all that a scene of your own needs, without this folder's base class.

Success criteria: two pieces.
"""

import newton
import newton.examples
import warp as wp

import newton_cagecut as cagecut

CUBE = [(x, y, z) for x in (-0.3, 0.3) for y in (-0.3, 0.3) for z in (-0.3, 0.3)]
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


class Example:
    def __init__(self, viewer, args=None):
        builder = newton.ModelBuilder()
        cagecut.SolverCageCut.register_custom_attributes(builder)
        ball = newton.Mesh.create_sphere(0.28)
        pose, cube = wp.transform((0, 0, 0.3), wp.quat_identity()), cagecut.Cage(CUBE, FACES)
        cagecut.add_cage_body(builder, cube, ball, xform=pose, walks=64, contact_radius=0.004)
        builder.add_ground_plane()
        self.viewer, self.model, self.frame = viewer, builder.finalize(), 0
        self.solver, self.pipeline = cagecut.SolverCageCut(self.model), newton.CollisionPipeline(self.model)
        self.state_0, self.state_1, self.contacts = self.model.state(), self.model.state(), self.pipeline.contacts()
        self.cut = self.solver.begin_cut(0, cagecut.Blade((0.01, 0, 0), (0.3, 1, 0), (0, 0, -1)))
        viewer.set_model(self.model)

    def step(self):
        if not self.cut.complete:
            self.solver.advance_cut(self.cut, 0.015, states=(self.state_0, self.state_1))
        self.pipeline.collide(self.state_0, self.contacts)
        self.solver.step(self.state_0, self.state_1, None, self.contacts, 1.0 / 60.0)
        self.state_0, self.state_1, self.frame = self.state_1, self.state_0, self.frame + 1

    def render(self):
        self.viewer.begin_frame(self.frame / 60.0)
        self.solver.log(self.viewer, self.state_0)
        self.viewer.end_frame()

    def test_final(self):
        if self.cut.complete and len(self.solver.pieces(0)) != 2:
            raise ValueError(f"{len(self.solver.pieces(0))} pieces; there should be two")


if __name__ == "__main__":
    viewer, args = newton.examples.init()
    newton.examples.run(Example(viewer, args), args)

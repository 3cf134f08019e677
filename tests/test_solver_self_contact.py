# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Contact of a body with itself: pieces that lie on one another, slits that close, and what it costs when off."""

from __future__ import annotations

import newton
import numpy as np
import pytest
import warp as wp

import newton_cagecut as cagecut
from contact_scenes import MASS, SIDE, Scene, add_cube, cube_cage
from solver_scenes import make_solver, simulated

GRAVITY = 9.81


def _cut(scene: Scene, *, share: float = 1.0, height: float = 0.5) -> None:
    """Cut the cube along a level plane."""
    blade = cagecut.Blade((-0.01, 0.5 * SIDE, height * SIDE), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0))
    cut = scene.solver.begin_cut(0, blade)
    scene.solver.advance_cut(cut, to=share * cut.length, states=(scene.state, scene.after))


def _centres(scene: Scene) -> np.ndarray:
    """Mean surface points of the pieces, the lowest first [m]."""
    points, _ = scene.solver.surface(scene.state)
    found = np.array([points[piece.surface_points].mean(axis=0) for piece in scene.solver.pieces(0)])
    return found[np.argsort(found[:, 2])]


def _lying(*, touch: bool) -> Scene:
    """The cube on the ground, cut through on half its height."""
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -GRAVITY))
    material = cagecut.Material(young=1.0e5, density=1000.0, damping=0.01)
    add_cube(builder, 0.0, cuttable=True, pieces_touch=touch, material=material)
    builder.add_ground_plane()
    scene = Scene(builder)
    scene.model.soft_contact_ke = 1.0e4
    _cut(scene)
    return scene


@pytest.mark.parametrize("steps", [60, pytest.param(1000, marks=pytest.mark.slow)])
def test_a_body_cut_through_stays_where_it_lies(steps: int):
    """The upper half lies on the lower one: no drift beyond 1e-3 of the size, and hardly any overlap."""
    scene = _lying(touch=True)
    scene.step(40)
    start = _centres(scene)
    scene.step(steps)
    assert np.abs(_centres(scene) - start).max() < 1.0e-3 * SIDE
    gaps = simulated(scene.solver).contact._touching.touches
    listed = gaps.listed.numpy()[: int(gaps.count.numpy()[0])]
    assert len(listed) > 20
    assert gaps.gap.numpy()[listed].min() > -1.0e-3 * SIDE
    assert scene.solver.statistics()[0]["stalled"] == 0


def test_without_contact_the_upper_half_falls_through():
    """The same body without contact of its pieces: the upper half ends on the ground."""
    scene = _lying(touch=False)
    before = _centres(scene)[1, 2]
    scene.step(60)
    assert _centres(scene)[:, 2].max() < before - 0.2 * SIDE


def _shortening(*, cut: bool, touch: bool) -> float:
    """How far the top of a bar that stands on a fixed end comes down under a load on its top [m].

    Its cage is a refined one: the eight corners of a box alone are stiffer than the bar, whatever cuts add to them.
    """
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    material = cagecut.Material(young=1.0e5, density=1000.0, damping=0.05)
    held = np.flatnonzero(cube_cage(refined=True).vertices[:, 2] == 0.0)
    options = {"material": material, "quadrature": 300, "walks": 128}
    add_cube(builder, 1.0, refined=True, self_contact=touch, fixed=held, cuttable=True, **options)
    scene = Scene(builder)
    if cut:
        _cut(scene, share=0.6)
    body = scene.solver.bodies[0]
    top = np.flatnonzero(body.cage.vertices[:, 2] > 0.999 * SIDE)
    start = scene.vertices()[top, 2].mean()

    def press(state: newton.State) -> None:
        forces = np.zeros((scene.model.particle_count, 3), dtype=np.float32)
        forces[body.vertices.start + top] = [0.0, 0.0, -40.0 / len(top)]
        state.particle_f.assign(forces)

    scene.step(150, before=press)
    assert np.abs(scene.velocity()).max() < 1.0e-3
    return start - scene.vertices()[top, 2].mean()


def test_a_closed_slit_carries_the_load():
    """Pressed, a bar that is slit over half its width is as stiff as the uncut one, to 5 %; without contact softer."""
    whole = _shortening(cut=False, touch=False)
    assert _shortening(cut=True, touch=True) == pytest.approx(whole, rel=0.05)
    assert _shortening(cut=True, touch=False) > 1.3 * whole


def test_pieces_that_push_each_other_keep_their_momentum():
    """In free space, pieces that are thrown against each other part or stay together, of the same momentum."""
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    add_cube(builder, 1.0, cuttable=True, pieces_touch=True)
    scene = Scene(builder)
    _cut(scene)
    body = scene.solver.bodies[0]
    velocities = scene.state.particle_qd.numpy()
    rows = np.arange(body.cage.vertex_count) + body.vertices.start
    upper = body.cage.vertices[:, 2] > 0.75 * SIDE
    piece = body.cage.vertex_piece
    upper = np.isin(piece, piece[upper])
    velocities[rows] = np.where(upper, -1.0, 0.5)[:, None] * np.array([0.0, 0.0, 1.0])
    scene.state.particle_qd.assign(velocities)

    def momentum() -> tuple[np.ndarray, float]:
        mass = simulated(scene.solver).system.vertex_mass.numpy()[: len(rows)].astype(float)
        moving = scene.state.particle_qd.numpy()[rows].astype(float)
        return mass @ moving, float(mass[upper] @ moving[upper, 2])

    total, own = momentum()
    scene.step(20)
    total_after, own_after = momentum()
    assert abs(own_after - own) > 0.5
    # solves are exact to 1e-5 of the residual, most of which is that of the stiff contacts
    assert np.abs(total_after - total).max() < 3.0e-4 * abs(own_after - own)
    assert scene.solver.bodies[0].energy(scene.state).kinetic < 0.5 * MASS * 0.625


def test_captured_contacts_are_the_eager_ones():
    """A graph of two steps with touching pieces, replayed, gives the states of eager steps, bit for bit."""
    results = []
    for captured in (False, True):
        scene = _lying(touch=True)
        scene.step(2)
        if captured:
            with wp.ScopedCapture(device="cpu") as capture:
                scene.step(2)
            for _ in range(2):
                wp.capture_launch(capture.graph)
        else:
            scene.step(4)
        results.append(scene.state.particle_q.numpy())
    np.testing.assert_array_equal(*results)


def test_nothing_is_paid_when_off():
    """Without it there are no rows, samples or kernels of it; with it the plan counts their bytes as contact."""
    contact = {}
    for touch in (False, True):
        _, solver, *_ = make_solver(contact_radius=0.01, walks=16, self_contact=touch)
        term = simulated(solver).contact
        assert (term._touching is not None) == touch
        assert (term.points.pair_weights.shape[0] > 0) == touch
        contact[touch] = next(entry for entry in solver.plan() if entry.feature == "contact").byte_count
    assert contact[True] > 1.5 * contact[False]


def test_what_cannot_touch_itself_is_refused():
    """It needs a contact radius, and a solid body."""
    with pytest.raises(ValueError, match="pieces_touch needs contact_radius"):
        make_solver(pieces_touch=True)
    with pytest.raises(ValueError, match="self_contact is for solid bodies"):
        make_solver(dimension=2, contact_radius=0.01, self_contact=True)
    with pytest.raises(TypeError, match="self_contact"):
        make_solver(contact_radius=0.01, self_contact=1)

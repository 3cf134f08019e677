# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Contact with shapes and rigid bodies: momentum, friction, materials, fast bodies, forces on surface particles."""

from __future__ import annotations

import newton
import numpy as np
import pytest
import warp as wp

import newton_cagecut as cagecut
from contact_scenes import MASS, RADIUS, SIDE, Scene, add_cube
from solver_scenes import make_solver

GRAVITY = 9.81
FIRM = {"contact": "firm"}


def _box(builder: newton.ModelBuilder, place, mass: float, half=(0.15, 0.15, 0.05)) -> int:
    """Add a rigid box of some mass."""
    body = builder.add_body(xform=wp.transform(place))
    density = mass / (8.0 * float(np.prod(half)))
    cfg = newton.ModelBuilder.ShapeConfig(density=density, mu=0.5)
    builder.add_shape_box(body, hx=half[0], hy=half[1], hz=half[2], cfg=cfg)
    return body


def _momenta(scene: Scene, mass: float) -> tuple[np.ndarray, np.ndarray]:
    """Momentum of the cube, and of the pair."""
    own = MASS * scene.velocity()
    return own, own + mass * scene.state.body_qd.numpy()[0, :3].astype(float)


@pytest.mark.parametrize("aside", [0.0, 0.1])
@pytest.mark.parametrize(("integrator", "speed"), [("tr_bdf2", 1.0), ("tr_bdf2", 100.0), ("paper", 1.0)])
def test_a_pair_keeps_its_momentum(integrator: str, speed: float, aside: float):
    """What a cube that hits a free box loses the box gains, to 1e-5, on centre and aside."""
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    add_cube(builder, 0.06, velocity=(0.1, 0.0, -speed))
    _box(builder, (0.1 + aside, 0.1, 0.0), 5.0)
    options = {"integrator": integrator, "contact": "firm" if speed > 10.0 else "penalty"}
    scene = Scene(builder, gap=2.0, rigid=newton.solvers.SolverXPBD, options=options)
    own, total = _momenta(scene, 5.0)
    scene.step(20)
    own_after, total_after = _momenta(scene, 5.0)
    exchanged = np.linalg.norm(own_after - own)
    assert exchanged > 0.5 * speed
    largest = max(exchanged, np.linalg.norm(own))  # velocities are float32: those of 100 m/s have no more digits
    assert np.linalg.norm(total_after - total) < 1.0e-5 * largest


def test_reaction_is_about_the_centre_of_mass():
    """A cube that presses on one end of a box at rest turns it about the middle: force times arm."""
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    add_cube(builder, 0.05 + 0.5 * RADIUS)
    _box(builder, (0.1 + 0.3, 0.1, 0.0), 5000.0, half=(0.5, 0.15, 0.05))
    scene = Scene(builder)
    scene.step()
    force, torque = np.split(scene.after.body_f.numpy()[0], 2)
    assert force[2] < -0.1
    np.testing.assert_allclose(torque, np.cross([-0.3, 0.0, 0.05], force), atol=2.0e-3 * abs(force[2]))


@pytest.mark.parametrize("stiffness", [None, 2.0e3])
def test_a_body_sinks_in_by_its_weight(stiffness: float | None):
    """At rest the points carry the weight: depth times the mean stiffness of body and shape, the model's by default."""
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -GRAVITY))
    add_cube(builder, 0.0, contact_stiffness=stiffness)
    builder.add_ground_plane(cfg=newton.ModelBuilder.ShapeConfig(ke=4.0e3))
    scene = Scene(builder)
    scene.model.soft_contact_ke = 6.0e3
    scene.step(240)
    mean = 0.5 * ((stiffness or 6.0e3) + 4.0e3)
    assert scene.lowest() == pytest.approx(MASS * GRAVITY / (25 * mean), rel=0.02)


@pytest.mark.parametrize(("friction", "slides"), [(0.9, False), (0.3, True)])
def test_friction_on_a_slope(friction: float, slides: bool):
    """On a slope of 30 degrees a body stays if the mean friction is above its tangent; else Coulomb's law speeds it."""
    angle, shape = np.radians(30.0), 0.4
    mean, fall = 0.5 * (friction + shape), (GRAVITY * np.sin(angle), 0.0, -GRAVITY * np.cos(angle))
    builder = newton.ModelBuilder(gravity=fall)
    add_cube(builder, RADIUS, friction=friction)
    builder.add_ground_plane(cfg=newton.ModelBuilder.ShapeConfig(mu=shape))
    scene = Scene(builder, options=FIRM)
    scene.model.soft_contact_ke = 1.0e4
    scene.step(30)
    start, speed = scene.vertices()[:, 0].mean(), scene.velocity()[0]
    scene.step(60)
    if slides:
        acceleration = GRAVITY * (np.sin(angle) - mean * np.cos(angle))
        assert scene.velocity()[0] - speed == pytest.approx(acceleration, rel=0.04)
    else:
        assert scene.vertices()[:, 0].mean() - start < 1.0e-3 * SIDE


def test_friction_holds_and_lets_go_at_the_tangent():
    """Just below the tangent of a slope a body slides, just above it stays."""
    angle = np.radians(20.0)
    moved = []
    for mean in (0.95 * np.tan(angle), 1.05 * np.tan(angle)):
        builder = newton.ModelBuilder(gravity=(GRAVITY * np.sin(angle), 0.0, -GRAVITY * np.cos(angle)))
        add_cube(builder, RADIUS, friction=mean)
        builder.add_ground_plane(cfg=newton.ModelBuilder.ShapeConfig(mu=mean))
        scene = Scene(builder, options=FIRM)
        scene.step(150)
        start = scene.vertices()[:, 0].mean()
        scene.step(60)
        moved.append(scene.vertices()[:, 0].mean() - start)
    assert moved[0] > 0.05
    assert moved[1] < 1.0e-3


@pytest.mark.parametrize("ground", ["plane", "box", "mesh", "heightfield"])
def test_nothing_tunnels_at_a_hundred_metres_a_second(ground: str):
    """With firm contacts and a pipeline that looks a step ahead, a body at 100 m/s stays on its side of thin ground."""
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -GRAVITY))
    add_cube(builder, 1.0, velocity=(0.0, 0.0, -100.0))
    if ground == "plane":
        builder.add_ground_plane()
    elif ground == "box":
        builder.add_shape_box(-1, xform=wp.transform((0.1, 0.1, -0.05)), hx=1.0, hy=1.0, hz=0.05)
    elif ground == "mesh":
        builder.add_shape_mesh(-1, xform=wp.transform((0.1, 0.1, -0.1)), mesh=newton.Mesh.create_box(1.0, 1.0, 0.1))
    else:
        heights = newton.Heightfield(np.zeros((9, 9), dtype=np.float32), nrow=9, ncol=9, hx=1.0, hy=1.0)
        builder.add_shape_heightfield(heightfield=heights)
    scene = Scene(builder, gap=2.0, options=FIRM)
    deepest = 0.0
    for _ in range(90):
        scene.step()
        deepest = max(deepest, scene.lowest())
    assert deepest < 0.3 * SIDE
    assert abs(scene.lowest()) < RADIUS
    assert np.abs(scene.velocity()).max() < 0.05


def test_forces_on_surface_particles_reach_the_cage():
    """Wind on all surface particles speeds the body up by force over mass; a pull on one side turns it."""
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    add_cube(builder, 1.0)
    scene = Scene(builder)
    rows = scene.solver.bodies[0].surface_particles
    count = scene.solver.bodies[0].surface.site_count

    def blow(state: newton.State) -> None:
        forces = np.zeros((scene.model.particle_count, 3), dtype=np.float32)
        forces[rows.start : rows.start + count] = [MASS / count, 0.0, 0.0]
        state.particle_f.assign(forces)

    scene.step(30, before=blow)
    np.testing.assert_allclose(scene.velocity(), [30.0 / 60.0, 0.0, 0.0], atol=1.0e-4)

    def pull(state: newton.State) -> None:
        forces = np.zeros((scene.model.particle_count, 3), dtype=np.float32)
        top = np.flatnonzero(scene.solver.bodies[0].surface.site_points[:, 2] > 0.99 * SIDE)
        forces[rows.start + top] = [1.0 / len(top), 0.0, 0.0]
        state.particle_f.assign(forces)

    scene.step(6, before=pull)
    velocities = scene.vertices("particle_qd")
    assert velocities[:, 0].mean() == pytest.approx(0.5 + 0.1 / MASS, rel=1.0e-3)
    assert velocities[scene.solver.bodies[0].cage.vertices[:, 2] > 0.1][:, 0].mean() > velocities[:, 0].mean() + 0.01


def test_contact_that_nothing_would_feel_is_refused():
    """A contact radius without elasticity, and a contact material without a radius, are refused."""
    with pytest.raises(ValueError, match="contact_radius was given with quadrature=0.*leave out one of the two"):
        make_solver(contact_radius=0.01, quadrature=0)
    with pytest.raises(ValueError, match="friction is of no use without contact_radius"):
        make_solver(friction=0.4)
    with pytest.raises(ValueError, match="contact_damping must not be negative"):
        make_solver(contact_radius=0.01, contact_damping=-1.0)
    with pytest.raises(ValueError, match="contact_stiffness must be positive"):
        make_solver(contact_radius=0.01, contact_stiffness=0.0)


def test_slots_do_not_depend_on_the_order_of_contacts():
    """Contacts found in another order give the same step, bit for bit."""
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -GRAVITY))
    add_cube(builder, 0.0)
    builder.add_ground_plane()
    builder.add_shape_box(-1, xform=wp.transform((0.1, 0.1, -0.05)), hx=0.07, hy=1.0, hz=0.0505)
    scene = Scene(builder)
    scene.pipeline.collide(scene.state, scene.contacts)
    results = []
    count = int(scene.contacts.soft_contact_count.numpy()[0])
    assert count > 25
    order = np.random.default_rng(0).permutation(count)
    for turn in (np.arange(count), order):
        for name in ("particle", "shape", "body_pos", "body_vel", "normal"):
            array = getattr(scene.contacts, f"soft_contact_{name}")
            rows = array.numpy()
            rows[:count] = rows[:count][turn]
            array.assign(rows)
        scene.solver.step(scene.state, scene.after, None, scene.contacts, scene.dt)
        results.append(scene.after.particle_q.numpy())
    np.testing.assert_array_equal(*results)


def test_cage_body_argument_names():
    """The contact material is that of the body's definition."""
    builder = newton.ModelBuilder()
    add_cube(builder, 0.0, contact_stiffness=10.0, friction=0.0)
    material = builder.custom_attributes["cagecut:definition"].values[0].contact_material
    assert material == (10.0, None, 0.0)
    assert isinstance(cagecut.SolverCageCut(builder.finalize(device="cpu")), cagecut.SolverCageCut)

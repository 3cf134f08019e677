# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of the reduced system on rectangles and boxes, whose harmonic coordinates are exact."""

import numpy as np
import pytest
import warp as wp
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from elastic_bodies import DT, STILL, THICKNESS, Body, Spring, as_array, both_dimensions
from newton_cagecut.elastic import Material, ReducedSystem


def static_positions(body):
    """Static equilibrium under gravity: the energy minimised in float64 by other means (neo-Hookean)."""
    mu, lam = body.material.lame
    free = np.ix_(~body.fixed, np.arange(body.dimension))
    loads = body.material.density * (body.volumes @ body.weights)[:, None] * body.gravity

    def objective(flat):
        u = np.zeros((body.count, 3))
        u[free] = flat.reshape(-1, body.dimension)
        F = body.deformation(u)
        J = np.linalg.det(F)
        square, bulk = np.einsum("qcd,qcd->q", F, F), lam + 5.0 / 6.0 * mu
        density = 2.0 / 3.0 * mu * (square - 3.0 - np.log((square + 1.0) / 4.0))
        density += 0.5 * bulk * (J - 1.0) ** 2 - mu * (J - 1.0)
        cofactor = J[:, None, None] * np.linalg.inv(F).transpose(0, 2, 1)
        P = 4.0 / 3.0 * mu * (square / (square + 1.0))[:, None, None] * F
        P += (bulk * (J - 1.0) - mu)[:, None, None] * cofactor
        force = np.einsum("q,qcd,qjd->jc", body.volumes, P, body.gradients) - loads
        return body.volumes @ density - (loads * u).sum(), force[free].ravel()

    result = minimize(objective, np.zeros(body.rest[free].size), jac=True, method="BFGS", options={"gtol": 1e-6})
    positions = body.rest.copy()
    positions[free] += result.x.reshape(-1, body.dimension)
    return positions


def pointers(system):
    """Where the arrays of a system are, those that a step works on and solves with included."""
    integrator = system._integrator
    owners = (system, integrator, integrator.solver, system._energy)
    structs = (system.arrays, integrator.arrays, integrator.system, integrator.solver.search, system._energy.energies)
    fields = [(i, *item) for i, owner in enumerate((*owners, *structs)) for item in vars(owner).items()]
    return {(i, name): array.ptr for i, name, array in fields if isinstance(array, wp.array)}


@both_dimensions
@pytest.mark.parametrize("model", ["neo_hookean", "stvk"])
def test_rest_stays_at_rest_to_the_bit(dimension, model):
    """Without gravity a body at rest does not move by a bit in 60 steps, wherever it is and however it is turned."""
    turn = Rotation.from_rotvec([0.3, -0.5, 0.9]).as_matrix()
    body = Body(dimension, rotation=turn, offset=[3.0, 1.0, 7.0], young=1e6, model=model)
    start = body.x.numpy().copy()
    body.run(60)
    assert np.array_equal(body.x.numpy(), start)
    assert not body.v.numpy().any()


@both_dimensions
def test_free_fall_is_exact(dimension):
    """A free body falls rigidly along the parabola.

    A float32 position, 5 m down, is rounded by 2e-7 m: vertices then swing, undamped, at some hundred radians a second.
    """
    body = Body(dimension, cells=(1, 2, 2), points=3, young=1e5)
    body.run(60, body.gravity)
    np.testing.assert_allclose(body.velocities, np.broadcast_to(body.gravity * 60 * DT, (body.count, 3)), atol=1e-4)
    mass = 1000.0 * body.volume
    np.testing.assert_allclose(body.momentum() / mass, body.gravity * 60 * DT, atol=1e-5)
    expected = body.rest + body.gravity * (60 * DT) ** 2 / 2
    np.testing.assert_allclose(body.positions, expected, atol=1e-5)
    assert body.system.energy(body.x, body.v).elastic < 1e-7


@both_dimensions
@pytest.mark.parametrize("integrator", ["backward_euler", "paper"])
def test_free_fall_of_damped_steps(dimension, integrator):
    """Steps that damp what they do not resolve keep every vertex at the speed of free fall."""
    body = Body(dimension, cells=(1, 2, 2), points=3, young=1e5, integrator=integrator)
    body.run(60, body.gravity)
    np.testing.assert_allclose(body.velocities, np.broadcast_to(body.gravity * 60 * DT, (body.count, 3)), atol=2e-5)


@both_dimensions
@pytest.mark.parametrize("damping", [0.0, 0.02])
def test_linear_momentum_is_conserved(dimension, damping):
    """A free body with random velocities keeps its linear momentum over 60 steps, damped or not."""
    body = Body(dimension, cells=(1, 1, 2), points=3, young=2e4, damping=damping)
    velocities = body.random(0)
    before = body.place(velocities=velocities).momentum()
    body.run(60)
    scale = np.abs(velocities).mean() * body.material.density * body.volume
    np.testing.assert_allclose(body.momentum(), before, atol=1e-4 * scale)
    assert body.system.energy(body.x, body.v).kinetic > 0.0


@both_dimensions
def test_mass_is_the_body_mass(dimension):
    """The rows of the mass matrix sum to the vertices' masses, those to the body's, and it is positive definite."""
    body = Body(dimension, cells=(1, 2, 2), points=1, density=700.0)
    mass = body.system.mass.numpy()[: body.count, : body.count].astype(np.float64)
    assert mass.sum() == pytest.approx(700.0 * body.volume, rel=1e-5)
    np.testing.assert_allclose(mass.sum(axis=1), body.system.vertex_mass.numpy()[: body.count], rtol=1e-5)
    assert np.array_equal(mass, mass.T)
    assert np.linalg.eigvalsh(mass).min() > 0.0
    assert not body.system.mass.numpy()[body.count :].any()


@both_dimensions
def test_hung_box_settles_at_static_equilibrium(dimension):
    """A hung box comes to rest where the energy is least, found independently."""
    body = Body(dimension, cells=(1, 1, 2), points=3, fix_top=True, young=2e4, damping=0.02)
    expected = static_positions(body)
    body.run(240, body.gravity)
    sag = (expected @ body.up).min()
    assert sag < -0.02
    np.testing.assert_allclose(body.positions, expected, atol=2e-3 * abs(sag))
    assert np.abs(body.velocities).max() < 1e-3
    assert np.array_equal(body.positions[body.fixed], body.rest[body.fixed].astype(np.float32))


@both_dimensions
def test_sag_converges_with_refinement(dimension):
    """The sag of a hung bar approaches the slender bar's rho g L^2 / 2E from below as its cells are refined."""
    exact = 1000.0 * 9.81 * 0.5**2 / (2.0 * 1e6)
    sags = []
    for cells in ((1, 1, 1), (1, 1, 3), (2, 2, 6)):
        body = Body(dimension, cells=cells, points=2, fix_top=True, young=1e6, poisson=0.0, damping=0.02)
        sags.append(-body.run(60, body.gravity).heights.min())
    assert sags[0] == pytest.approx(exact, rel=0.03)
    assert abs(sags[2] - exact) <= abs(sags[0] - exact) + 1e-3 * exact


@both_dimensions
@pytest.mark.parametrize("model", ["neo_hookean", "stvk"])
def test_stiff_body_gains_no_energy(dimension, model):
    """At 1 GPa and 1/60 s a body that vibrates and drifts loses energy in every step."""
    body = Body(dimension, cells=(1, 1, 2), points=3, young=1e9, model=model)
    offset = body.vertices - body.vertices.mean(axis=0)
    waist = np.where(np.abs(offset[:, -1:]) < 1e-6, -1.5, 1.0)
    velocities = waist * offset * [3.0, -4.0, 2.0][-dimension:] + [0.1, 0.2, 0.3][-dimension:]
    body.place(velocities=body.to_world(velocities))
    energies = [body.energy()]
    for _ in range(60):
        energies.append(body.run(1).energy())
    assert np.isfinite(energies).all()
    assert np.all(np.diff(energies) <= 1e-3 * energies[0])


@both_dimensions
def test_tumbling_stiff_body_stays_whole(dimension):
    """At 1 GPa and 5 rad/s nothing blows up: the energy ends below its start and edges keep their lengths.

    In 300 steps what the integrator takes, 1e-4, is more than the rounding of float32 positions adds, up to 5e-5.
    """
    body = Body(dimension, cells=(1, 1, 2), points=3, young=1e9)
    offset = body.rest - body.rest.mean(axis=0)
    spin = {2: [0.0, 0.0, 5.0], 3: [3.0, 4.0, 0.0]}[dimension]
    body.place(velocities=np.cross(spin, offset))
    start = body.energy()
    body.run(300)
    assert body.energy() < start
    edges, rest_edges = (np.linalg.norm(p[1:] - p[0], axis=1) for p in (body.positions, body.rest))
    np.testing.assert_allclose(edges, rest_edges, rtol=1e-2)


@both_dimensions
@pytest.mark.parametrize("young", [5e4, 1e6])
@pytest.mark.parametrize("start", ["inverted", "flat", "random"])
def test_neo_hookean_recovers(dimension, start, young):
    """A neo-Hookean body comes back to its rest shape from inverted, flat and random starts."""
    body = Body(dimension, cells=(1, 1, 2), points=3, young=young, damping=0.01)
    positions = {
        "inverted": body.rest - 1.5 * np.outer(body.rest @ body.up, body.up),
        "flat": body.rest - np.outer(body.rest @ body.up, body.up),
        "random": body.random(2, 0.2),
    }[start]
    body.place(positions=positions + body.random(5, 1e-3))
    start_energy = body.energy()
    body.run(240)
    assert np.isfinite(body.positions).all()
    assert body.system.energy(body.x, body.v).elastic < 1e-3 * start_energy


@both_dimensions
def test_wild_velocities_add_no_energy(dimension):
    """Velocities that would turn the body inside out in one step add no energy; the linear momentum stays."""
    body = Body(dimension, cells=(1, 1, 2), points=3, young=1e4)
    before = body.place(velocities=body.random(6, 60.0)).momentum()
    start = body.energy()
    for _ in range(20):
        assert body.run(1).energy() < start
    np.testing.assert_allclose(body.momentum(), before, atol=1e-4 * np.abs(before).max())


@both_dimensions
def test_fixed_vertices_stay_whatever_their_velocity(dimension):
    """Fixed vertices do not travel, and have no velocity after a step; moved by hand they drag the rest along."""
    body = Body(dimension, fix_top=True, young=1e6, damping=0.05)
    body.place(velocities=np.where(body.fixed[:, None], [0.4, 0.0, 0.0], 0.0)).run(30)
    assert np.array_equal(body.positions, body.rest.astype(np.float32))
    assert not body.velocities.any()
    positions = body.rest + np.where(body.fixed[:, None], [0.01, 0.0, 0.0], 0.0)
    body.place(positions=positions).run(240)
    np.testing.assert_allclose(body.positions, body.rest + [0.01, 0.0, 0.0], atol=1e-4)


@both_dimensions
def test_rotation_turns_the_whole_motion(dimension):
    """A body whose rest positions are turned against its gradients moves like the unturned one, turned."""
    turn = Rotation.from_rotvec([0.4, 1.0, -0.6]).as_matrix()
    plain, turned = Body(dimension, young=1e5), Body(dimension, young=1e5, rotation=turn)
    for body in (plain, turned):
        body.place(velocities=body.random(3)).run(20)
    np.testing.assert_allclose(turned.positions, plain.positions @ turn.T, atol=2e-5)


@both_dimensions
def test_external_forces_accelerate_the_body(dimension):
    """Forces that are spread like the mass give the acceleration of the whole body."""
    body = Body(dimension, young=1e5)
    mass = body.system.vertex_mass.numpy()[:, None]
    acceleration = body.to_world([2.0, 0.0, -1.0][-dimension:])
    body.run(30, forces=as_array(mass * acceleration, wp.vec3))
    np.testing.assert_allclose(body.velocities, np.tile(0.5 * acceleration, (body.count, 1)), atol=1e-4)


@both_dimensions
def test_linear_term_takes_part_in_the_solve(dimension):
    """A very stiff implicit spring holds a vertex at its target and stays stable."""
    body = Body(dimension, young=1e5, damping=0.02)
    target = body.rest[0] + [0.05, 0.0, 0.0]
    body.run(200, body.gravity, spring=Spring(body, 1e8, target))
    np.testing.assert_allclose(body.positions[0], target, atol=1e-5)
    assert np.isfinite(body.positions).all()


@both_dimensions
def test_step_does_no_host_work(dimension, monkeypatch):
    """A step makes no array, reads none on the host, and its arrays stay where they are."""
    body = Body(dimension, fix_top=True).run(1)
    arrays = pointers(body.system)
    assert len(arrays) > 30
    gravity = as_array([body.gravity], wp.vec3)

    def refuse(*args, **kwargs):
        raise AssertionError("a step must not touch the host")

    with monkeypatch.context() as patch:
        for name in ("__init__", "numpy", "assign", "list"):
            patch.setattr(wp.array, name, refuse)
        for _ in range(20):
            body.system.step(body.x, body.v, body.x, body.v, DT, gravity=gravity)
    assert pointers(body.system) == arrays


@both_dimensions
def test_growing_in_place_equals_a_new_body(dimension):
    """Assigning new weights, gradients and count and refreshing gives the same motion as a system built that way."""
    big = Body(dimension, cells=(1, 1, 2), points=3, spare=0)
    small = Body(dimension, cells=(1, 1, 1), points=3, spare=big.count - 2**dimension)
    halves = {name: getattr(big.system, name).numpy()[::2] for name in ("weights", "gradients")}
    assert small.system.point_count == len(halves["weights"])
    for name, values in halves.items():
        getattr(small.system, name).assign(values)
    small.system.rest.assign(big.system.rest)
    small.system.volumes.assign(big.system.volumes.numpy()[::2] * 2.0)
    small.system.vertex_count.assign([big.count])
    small.system.refresh()
    fresh = ReducedSystem(
        wp.clone(small.system.rest),
        wp.clone(small.system.weights),
        wp.clone(small.system.gradients),
        wp.clone(small.system.volumes),
        small.material,
        wp.clone(small.system.vertex_count),
        thickness=small.thickness,
    )
    velocities = as_array(big.random(0), wp.vec3)
    results = []
    for system in (small.system, fresh):
        x, v = wp.clone(system.rest), wp.clone(velocities)
        for _ in range(5):
            system.step(x, v, x, v, DT, gravity=as_array([big.gravity], wp.vec3))
        results.append(x.numpy())
    assert np.array_equal(results[0], results[1])


@both_dimensions
def test_pieces_far_apart_stay_free_of_strain(dimension):
    """Two pieces of one body that have moved kilometres apart do not strain each other."""
    body = Body(dimension)
    count, points = body.count, len(body.points)
    weights, gradients = (np.zeros((2 * points, 2 * count, *a.shape[2:])) for a in (body.weights, body.gradients))
    weights[:points, :count] = weights[points:, count:] = body.weights
    gradients[:points, :count] = gradients[points:, count:] = body.gradients
    rest = np.concatenate([body.rest, body.rest + body.up])
    system = ReducedSystem(
        as_array(rest, wp.vec3),
        as_array(weights, float),
        as_array(gradients, wp.vec3),
        np.tile(body.volumes, 2),
        Material(young=1e9),
        as_array([2 * count], int),
        thickness=body.thickness,
    )
    moved = as_array(rest + np.repeat([[0.0, 0, 0], [3000.0, 0, 0]], count, axis=0), wp.vec3)
    start, v = moved.numpy().copy(), wp.zeros_like(moved)
    system.step(moved, v, moved, v, DT, gravity=as_array([STILL], wp.vec3))
    assert np.array_equal(moved.numpy(), start)


def test_material_edit_takes_effect():
    """A softer material sags more; another model is refused."""
    body = Body(fix_top=True, young=1e6, damping=0.05)
    stiff_sag = -body.run(60, body.gravity).heights.min()
    body.system.set_material(Material(young=1e5, damping=0.05))
    assert -body.run(120, body.gravity).heights.min() > 8.0 * stiff_sag
    with pytest.raises(ValueError, match="built for the model 'neo_hookean'"):
        body.system.set_material(Material(model="stvk"))


def test_wrong_arrays_are_refused():
    """Arrays of the wrong shape or type are refused by name."""
    body = Body()
    s = body.system
    good = [s.rest, s.weights, s.gradients, s.volumes, s.material, s.vertex_count]
    with pytest.raises(ValueError, match="gradients has the shape"):
        ReducedSystem(*good[:2], as_array(np.zeros((3, 10, 3)), wp.vec3), *good[3:])
    with pytest.raises(TypeError, match="fixed has the type float32"):
        ReducedSystem(*good, fixed=as_array(np.zeros(10), float))
    for thickness in (0.0, -THICKNESS, float("inf")):
        with pytest.raises(ValueError, match=f"thickness is {thickness} m"):
            ReducedSystem(*good, thickness=thickness)

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of plane strain: its energy, its moduli, and that nothing leaves the plane."""

import numpy as np
import pytest
import warp as wp
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy.spatial.transform import Rotation

from elastic_bodies import Body, Spring, as_array

MODELS = ("neo_hookean", "stvk", "corotational")
ROUNDING = 2.0**-22
UPRIGHT = Rotation.from_euler("x", 90, degrees=True).as_matrix()
TILTED = Rotation.from_rotvec([0.4, 1.0, -0.6]).as_matrix()


def plane_energy_density(material, F):
    """Energy density [J/m^3] in plane strain, written with the 2x2 deformation gradient."""
    mu, lam = material.lame
    if material.model == "stvk":
        E = 0.5 * (F.T @ F - np.eye(2))
        return mu * np.sum(E * E) + 0.5 * lam * np.trace(E) ** 2
    if material.model == "corotational":
        angle = np.arctan2(F[1, 0] - F[0, 1], F[0, 0] + F[1, 1])
        R = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        return mu * np.sum((F - R) ** 2) + 0.5 * lam * np.trace(R.T @ F - np.eye(2)) ** 2
    J, square = np.linalg.det(F), np.sum(F * F) + 1.0
    density = 2.0 / 3.0 * mu * (square - 3.0 - np.log((square + 1.0) / 4.0))
    return density - mu * (J - 1.0) + 0.5 * (lam + 5.0 / 6.0 * mu) * (J - 1.0) ** 2


def plane_stress(material, F):
    """First Piola-Kirchhoff stress in the plane [Pa]: the derivative of the energy density."""
    step, h = np.eye(4).reshape(4, 2, 2), 1e-6
    energies = [[plane_energy_density(material, F + sign * h * d) for d in step] for sign in (1.0, -1.0)]
    return ((np.array(energies[0]) - energies[1]) / (2.0 * h)).reshape(2, 2)


@pytest.mark.parametrize("model", MODELS)
@settings(max_examples=40, deadline=None)
@given(F=hnp.arrays(np.float64, (2, 2), elements=st.floats(-2.0, 2.0, width=32)))
def test_affine_motion_has_the_plane_strain_energy(model, F):
    """Any affine motion in the plane, inversions and collapses too, has the energy of plane strain times the volume."""
    body = Body(2, cells=(1, 2, 3), points=2, young=1e5, poisson=0.4, rotation=TILTED, model=model)
    body.place(positions=body.to_world(body.vertices @ F.T))
    expected = body.volume * plane_energy_density(body.material, F)
    scale = body.volume * body.material.young
    assert body.system.energy(body.x, body.v).elastic == pytest.approx(expected, rel=1e-5, abs=1e-6 * scale)


@pytest.mark.parametrize("model", MODELS)
def test_stretched_rectangle_has_the_analytic_energy(model):
    """Uniaxial stretches cost what plane strain says, in closed form: the width stays and the third stretch is one."""
    mu, lam = 1.0, 3.0
    young, poisson = mu * (3.0 * lam + 2.0 * mu) / (lam + mu), lam / (2.0 * (lam + mu))
    for stretch in (0.3, 0.9, 1.1, 2.0):
        body = Body(2, young=young, poisson=poisson, model=model)
        body.place(positions=body.to_world(body.vertices * [1.0, stretch]))
        strain = 0.5 * (stretch**2 - 1.0)
        density = {
            "neo_hookean": 2.0 / 3.0 * mu * (2.0 * strain - np.log1p(0.5 * strain))
            - mu * (stretch - 1.0)
            + 0.5 * (lam + 5.0 / 6.0 * mu) * (stretch - 1.0) ** 2,
            "stvk": (mu + 0.5 * lam) * strain**2,
            "corotational": (mu + 0.5 * lam) * (stretch - 1.0) ** 2,
        }[model]
        assert body.system.energy(body.x, body.v).elastic == pytest.approx(body.volume * density, rel=1e-5)


@pytest.mark.parametrize("model", MODELS)
def test_forces_are_those_of_the_plane_stress(model):
    """Vertices of a stretched rectangle are accelerated by the stress in the plane; that across it pulls on nothing."""
    F = np.array([[1.2, 0.3], [-0.1, 0.8]])
    body = Body(2, cells=(1, 2, 2), points=3, young=1e5, poisson=0.4, rotation=TILTED, model=model)
    body.place(positions=body.to_world(body.vertices @ F.T)).run(1, dt=1e-6)
    forces = -np.einsum("q,cd,qjd->jc", body.volumes, plane_stress(body.material, F), body.gradients[:, :, :2])
    mass = body.system.mass.numpy()[: body.count, : body.count].astype(np.float64)
    accelerations = body.to_world(np.linalg.solve(mass, forces))
    np.testing.assert_allclose(body.velocities / 1e-6, accelerations, atol=1e-4 * np.abs(accelerations).max())


@pytest.mark.parametrize("model", MODELS)
def test_rigid_motion_is_free_of_stress(model):
    """A rectangle that was turned and moved in its plane has no energy and stays where it is."""
    turn = Rotation.from_euler("z", 130, degrees=True).as_matrix()[:2, :2]
    body = Body(2, cells=(1, 2, 2), young=1e6, rotation=TILTED, model=model)
    positions = body.to_world(body.vertices @ turn.T + [0.4, -0.3])
    body.place(positions=positions)
    assert body.system.energy(body.x, body.v).elastic < 1e-12 * body.material.young * body.volume
    body.run(30)
    np.testing.assert_allclose(body.positions, positions, atol=1e-6)


def test_pulled_strip_has_the_plane_strain_moduli():
    """Under a uniform pull a strip stretches by (1 - nu^2) / E and narrows by nu (1 + nu) / E times the traction."""
    young, poisson, traction = 1e6, 0.3, 500.0
    body = Body(2, cells=(1, 2, 3), points=2, young=young, poisson=poisson, damping=0.02)
    width, height = body.vertices.max(axis=0)
    share = np.where(np.isin(body.vertices[:, 0], (0.0, width)), 0.5, 1.0) * width / 2.0
    pull = np.where(body.vertices[:, 1] == 0.0, -1.0, np.where(body.vertices[:, 1] == height, 1.0, 0.0))
    forces = np.zeros((body.x.shape[0], 3))
    forces[: body.count, 1] = traction * body.thickness * share * pull
    body.run(300, forces=as_array(forces, wp.vec3))
    size = np.ptp(body.positions[:, :2], axis=0)
    assert size[1] / height - 1.0 == pytest.approx(traction * (1.0 - poisson**2) / young, rel=5e-3)
    assert size[0] / width - 1.0 == pytest.approx(-traction * poisson * (1.0 + poisson) / young, rel=5e-3)


@pytest.mark.parametrize("rotation", [np.eye(3), UPRIGHT, TILTED], ids=["flat", "upright", "tilted"])
@pytest.mark.parametrize("young", [1e4, 1e9])
def test_nothing_leaves_the_plane(rotation, young):
    """Gravity, forces, velocities and springs that pull out of the plane move nothing out of it, in 200 steps.

    In planes normal to an axis of the world not a bit; in a tilted one by a rounding of velocity and position.
    """
    body = Body(2, cells=(1, 2, 2), points=2, young=young, rotation=rotation, offset=[0.7, -0.4, 1.3])
    normal = rotation[:, 2]
    rng = np.random.default_rng(4)
    body.place(velocities=rng.normal(size=(body.count, 3)) + 5.0 * normal)
    forces = as_array(rng.normal(size=(body.x.shape[0], 3)) + 3.0 * normal, wp.vec3)
    spring = Spring(body, 1e4, body.rest[0] + normal + rotation[:, 0])
    rest = body.positions
    for _ in range(200):
        body.run(1, [1.0, -5.0, 7.0], forces=forces, spring=spring)
        out_of_plane = (body.positions - rest) @ normal
        drift = body.velocities @ normal
        assert np.abs(out_of_plane).max() <= ROUNDING * np.abs(body.positions).max()
        assert np.abs(drift).max() <= ROUNDING * np.abs(body.velocities).max()
    assert np.abs(body.positions - rest).max() > 0.5
    if rotation is not TILTED:
        axis = int(np.argmax(np.abs(normal)))
        assert np.array_equal(body.positions[:, axis], rest[:, axis])
        assert not body.velocities[:, axis].any()


def test_displaced_body_returns_to_its_plane():
    """A state that lies beside the plane is put back into it by the first step."""
    body = Body(2, young=1e5)
    body.place(positions=body.rest + [0.2, 0.0, 0.3]).run(1)
    np.testing.assert_allclose(body.positions, body.rest + [0.2, 0.0, 0.0], atol=1e-6)
    assert np.array_equal(body.positions[:, 2], body.rest[:, 2])


def test_thickness_scales_mass_and_stiffness_alike():
    """A body twice as thick has twice the mass and energy, and moves in the same way."""
    bodies = [Body(2, cells=(1, 2, 2), young=1e5, thickness=thickness) for thickness in (0.1, 0.2)]
    for body in bodies:
        body.place(velocities=body.random(2)).run(20)
    thin, thick = bodies
    np.testing.assert_allclose(thick.positions, thin.positions, atol=1e-5)
    assert thick.energy() == pytest.approx(2.0 * thin.energy(), rel=1e-4)
    assert thick.system.vertex_mass.numpy().sum() == pytest.approx(2.0 * thin.system.vertex_mass.numpy().sum())


def test_spin_is_kept():
    """A soft plane body keeps its angular momentum about the normal within a thousandth over 40 steps."""
    body = Body(2, cells=(1, 2, 2), points=2, young=2e4, rotation=TILTED)
    normal = TILTED[:, 2]
    body.place(velocities=np.cross(2.0 * normal, body.rest - body.rest.mean(axis=0)))
    start = body.angular_momentum() @ normal
    spin = body.run(40).angular_momentum()
    np.testing.assert_allclose(spin, start * normal, atol=1e-3 * start)


def test_solid_bodies_carry_nothing_for_the_plane():
    """A solid body has no normal, a plane one has."""
    body = Body(3)
    assert not body.system.is_plane
    assert body.system.arrays.normal is None
    assert Body(2).system.is_plane

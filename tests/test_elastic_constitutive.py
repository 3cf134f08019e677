# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of the constitutive models against finite differences and their invariants."""

import functools
import itertools

import hypothesis.extra.numpy as hnp
import numpy as np
import pytest
import warp as wp
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from elastic_bodies import Body
from newton_cagecut.elastic import ConstitutiveModel, Material
from newton_cagecut.elastic.constitutive import CONSTITUTIVE_MODELS
from newton_cagecut.elastic.constitutive.model import cofactor
from newton_cagecut.elastic.solve.expansion import Matrix9, expanded
from newton_cagecut.elastic.stiffness import Stiffness, apply_stiffness, make_stiffness_function

MU, LAM = 2.0, 3.0
MODELS = tuple(CONSTITUTIVE_MODELS)
PLANE = np.pad(np.ones((2, 2)), (0, 1))
"""One where a plane F may change."""

solid_and_plane = pytest.mark.parametrize("plane", [False, True], ids=["solid", "plane"])


@functools.cache
def make_probe(model, plane):
    """A kernel that evaluates a model at many deformation gradients."""
    energy, stress = CONSTITUTIVE_MODELS[model].energy, CONSTITUTIVE_MODELS[model].stress
    stiffness_function = make_stiffness_function(model, plane)

    @wp.kernel(enable_backward=False, module="unique")
    def probe(
        mu: wp.float64,
        lam: wp.float64,
        F: wp.array[wp.mat33d],
        directions: wp.array[wp.mat33],
        energies: wp.array[wp.float64],
        stresses: wp.array[wp.mat33d],
        products: wp.array2d[wp.mat33],
        matrices: wp.array[Matrix9],
    ):
        i = wp.tid()
        energies[i] = energy(F[i], mu, lam)
        stresses[i] = stress(F[i], mu, lam)
        stiffness = stiffness_function(F[i], wp.vec2d(mu, lam), wp.vec2d(mu, lam), wp.float64(1.0))
        for k in range(directions.shape[0]):
            products[i, k] = apply_stiffness(stiffness, directions[k])
        matrices[i] = expanded(stiffness)

    return probe


def evaluate(model, F, plane=False, mu=MU, lam=LAM):
    """Energies (n,), stresses (n, 3, 3), projected Hessians (n, 9, 9), by products and written out."""
    F = np.asarray(F, dtype=np.float64).reshape(-1, 3, 3)
    n = len(F)
    outputs = (wp.zeros(n, dtype=wp.float64, device="cpu"), wp.zeros(n, dtype=wp.mat33d, device="cpu"))
    outputs += (wp.zeros((n, 9), dtype=wp.mat33, device="cpu"), wp.zeros(n, dtype=Matrix9, device="cpu"))
    inputs = [wp.float64(mu), wp.float64(lam), wp.array(F, dtype=wp.mat33d, device="cpu")]
    inputs += [wp.array(np.eye(9).reshape(9, 3, 3), dtype=wp.mat33, device="cpu")]
    wp.launch(make_probe(model, plane), dim=n, inputs=inputs, outputs=outputs, device="cpu")
    energies, stresses, products, matrices = (a.numpy() for a in outputs)
    return energies, stresses, products.reshape(n, 9, 9), matrices


def true_hessians(model, F):
    """Central differences of the stress, shape (n, 9, 9), symmetric to their accuracy."""
    return difference(lambda shifted: evaluate(model, shifted)[1], F)


def difference(function, F):
    """Derivative by F of a function from matrices to matrices, shape (n, 9, 9)."""
    h = 1e-6
    steps = h * np.eye(9).reshape(9, 3, 3)
    values = [function((F[:, None] + step).reshape(-1, 3, 3)).reshape(len(F), 9, 9) for step in (steps, -steps)]
    return (values[0] - values[1]) / (2.0 * h)


def cofactors(F):
    """Cofactor matrices: the derivative of the determinant."""
    columns = [F[:, :, k] for k in range(3)]
    return np.stack([np.cross(columns[k - 2], columns[k - 1]) for k in range(3)], axis=2)


def kept_hessians(model, F):
    """The Hessians that the stiffness is made from: without what tension adds to them in the neo-Hookean model."""
    hessians = true_hessians(model, F)
    if model == "neo_hookean":
        tension = np.maximum((LAM + 5.0 / 6.0 * MU) * (np.linalg.det(F) - 1.0) - MU, 0.0)
        hessians -= tension[:, None, None] * difference(cofactors, F)
    return hessians


def random_gradients(count=60):
    """Deformation gradients: near the identity, large, inverted, flat and with equal stretches."""
    rng = np.random.default_rng(3)
    F = rng.normal(size=(count, 3, 3))
    F[:20] = np.eye(3) + 0.1 * F[:20]
    F[20] = np.diag([1.0, 1.0, 0.0])
    F[21] = np.diag([1.0, 0.0, 0.0])
    F[22] = -np.eye(3)
    F[23] = 2.0 * Rotation.random(rng=rng).as_matrix()
    F[24] = np.zeros((3, 3))
    return F


def smooth(model, F):
    """Those at which the model is smooth: the rotation nearest to F, of the corotational one, is not always unique."""
    if model != "corotational":
        return F
    values = np.linalg.svd(F, compute_uv=False) * [1.0, 1.0, 1.0]
    values[:, 2] *= np.sign(np.linalg.det(F))
    return F[values[:, 1] + values[:, 2] > 1e-3]


def as_plane(F):
    """Deformation gradients whose third row and column are the identity's."""
    return np.eye(3) + PLANE * (F - np.eye(3))


@pytest.mark.parametrize("model", MODELS)
def test_stress_is_derivative_of_energy(model):
    """The stress is the finite difference of the energy density, inverted and flat states included."""
    F, h = smooth(model, random_gradients()), 1e-5
    steps = h * np.eye(9).reshape(9, 3, 3)
    energy = evaluate(model, np.stack([F[:, None] + steps, F[:, None] - steps]))[0].reshape(2, len(F), 9)
    expected = (energy[0] - energy[1]) / (2.0 * h)
    np.testing.assert_allclose(evaluate(model, F)[1].reshape(-1, 9), expected, rtol=1e-6, atol=1e-6)


@solid_and_plane
@pytest.mark.parametrize("model", MODELS)
def test_projected_hessian_is_nearest_positive_semidefinite(model, plane):
    """The projected Hessian is the kept one, or its part in the plane, with negative eigenvalues set to zero."""
    F = as_plane(random_gradients()) if plane else smooth(model, random_gradients())
    true, projected = kept_hessians(model, F), evaluate(model, F, plane)[2]
    if plane:
        true *= np.outer(PLANE, PLANE)
    values, vectors = np.linalg.eigh(0.5 * (true + true.transpose(0, 2, 1)))
    expected = np.einsum("nij,nj,nkj->nik", vectors, np.maximum(values, 0.0), vectors)
    scale = np.maximum(np.abs(true).max(axis=(1, 2), keepdims=True), 1e-3 * MU)
    assert np.all(np.abs(projected - expected) < 2e-5 * scale)
    definite = values[:, 5 if plane else 0] > 1e-6
    assert 3 < definite.sum() < len(F) - 10
    assert np.all((np.abs(projected - true) < 2e-5 * scale)[definite])


@solid_and_plane
@pytest.mark.parametrize("model", MODELS)
@settings(max_examples=60, deadline=None)
@given(
    F=hnp.arrays(np.float64, (3, 3), elements=st.floats(-4.0, 4.0, width=32)),
    flat=st.integers(0, 2),
)
@example(F=np.zeros((3, 3)), flat=0)
@example(F=-np.eye(3), flat=0)
@example(F=np.full((3, 3), 1e-30), flat=0)
def test_projected_hessian_is_positive_semidefinite(model, plane, F, flat):
    """The projected Hessian is finite, symmetric and has no negative eigenvalue, whatever F is."""
    F = F.copy()
    F[:, :flat] = F[:, 2:]
    hessian = evaluate(model, as_plane(F) if plane else F, plane)[2][0]
    scale = max(1.0, np.abs(hessian).max())
    assert np.isfinite(hessian).all()
    assert np.abs(hessian - hessian.T).max() < 1e-5 * scale
    assert np.linalg.eigvalsh(hessian.astype(np.float64)).min() > -1e-5 * scale


@solid_and_plane
@pytest.mark.parametrize("model", MODELS)
def test_written_out_stiffness_is_the_hessian(model, plane):
    """The 9x9 matrix of a point is what its factors make of all changes."""
    F = as_plane(random_gradients()) if plane else random_gradients()
    *_, hessians, matrices = evaluate(model, F, plane)
    scale = np.abs(hessians).max(axis=(1, 2), keepdims=True) + 1e-6
    assert np.all(np.abs(matrices - hessians) < 1e-5 * scale)


@pytest.mark.parametrize("model", MODELS)
def test_rest_is_free_of_stress(model):
    """Stress and energy vanish exactly at the identity."""
    energy, stress, *_ = evaluate(model, np.eye(3))
    assert energy[0] == 0.0
    assert np.array_equal(stress[0], np.zeros((3, 3)))


@pytest.mark.parametrize("model", MODELS)
def test_small_strain_is_linear_elasticity(model):
    """At rest the Hessian is that of linear elasticity with the given constants."""
    delta = np.eye(3)
    expected = LAM * np.einsum("ij,kl->ijkl", delta, delta)
    expected += MU * (np.einsum("ik,jl->ijkl", delta, delta) + np.einsum("il,jk->ijkl", delta, delta))
    np.testing.assert_allclose(evaluate(model, np.eye(3))[2][0], expected.reshape(9, 9), atol=1e-5)


@pytest.mark.parametrize("model", MODELS)
def test_objectivity_and_isotropy(model):
    """Rotating the world rotates the stress, rotating the material too; the energy does not change."""
    F = smooth(model, random_gradients())
    R = Rotation.random(len(F), rng=np.random.default_rng(1)).as_matrix()
    energy, stress, *_ = evaluate(model, F)
    turned, turned_stress, *_ = evaluate(model, R @ F)
    np.testing.assert_allclose(turned, energy, atol=1e-10, rtol=1e-10)
    np.testing.assert_allclose(turned_stress, R @ stress, atol=1e-9, rtol=1e-9)
    np.testing.assert_allclose(evaluate(model, F @ R)[1], stress @ R, atol=1e-9, rtol=1e-9)


def test_stiffness_is_compact():
    """A quadrature point's stiffness is kept in 33 floats, not in 81 of the full matrix."""
    assert wp.types.type_size_in_bytes(Stiffness) == 33 * 4


def test_small_strains_have_the_given_moduli():
    """A small pull gives back Young's modulus and Poisson's ratio, from -0.8 to 0.499, with every model."""
    for model, poisson in itertools.product(MODELS, (-0.8, -0.3, 0.0, 0.3, 0.499)):
        mu, lam = Material(young=1.0, poisson=poisson).lame
        strain = 1e-6 * np.diag([1.0, -poisson, -poisson])
        stress = evaluate(model, np.eye(3) + strain, mu=mu, lam=lam)[1][0]
        np.testing.assert_allclose(stress, 1e-6 * np.diag([1.0, 0.0, 0.0]), atol=1e-10 * max(1.0, lam))


@pytest.mark.parametrize("poisson", [-0.85, -0.3, 0.0, 0.1, 0.3, 0.4, 0.49])
def test_crushed_neo_hookean_state_is_no_place_to_stay(poisson):
    """A point has more energy than rest, and a uniform squeeze is driven back from any size, in the plane too."""
    mu, lam = Material(young=1.0, poisson=poisson).lame
    sizes = np.concatenate([np.geomspace(1e-4, 0.99, 60), np.geomspace(1.01, 30.0, 20)])
    for dimension in (2, 3):
        direction = np.diag([1.0, 1.0, float(dimension == 3)])
        F = np.eye(3) + (sizes[:, None, None] - 1.0) * direction
        pull = np.einsum("nij,ij->n", evaluate("neo_hookean", F, mu=mu, lam=lam)[1], direction)
        assert np.all(pull * (sizes - 1.0) > 0.0)
        assert evaluate("neo_hookean", np.eye(3) - direction, mu=mu, lam=lam)[0][0] > 0.0


@pytest.mark.parametrize("poisson", [-0.5, 0.0, 0.4])
def test_neo_hookean_is_free_of_stress_at_rest_only(poisson):
    """From random F a descent of the energy ends at a rotation; no other F is free of stress."""
    mu, lam = Material(young=1.0, poisson=poisson).lame
    starts = np.random.default_rng(0).normal(size=(25, 9))

    def objective(flat):
        energy, stress, *_ = evaluate("neo_hookean", flat, mu=mu, lam=lam)
        return energy[0], stress[0].ravel()

    for start in starts:
        F = minimize(objective, start, jac=True, method="BFGS", options={"gtol": 1e-9}).x.reshape(3, 3)
        np.testing.assert_allclose(F.T @ F, np.eye(3), atol=1e-5)
        assert np.linalg.det(F) > 0.0


@wp.func
def plain_energy(F: wp.mat33d, mu: wp.float64, lam: wp.float64) -> wp.float64:
    """A user's own energy: the stable neo-Hookean one without the logarithm."""
    change = wp.determinant(F) - wp.float64(1.0)
    half = wp.float64(0.5)
    return half * mu * (wp.ddot(F, F) - wp.float64(3.0)) - mu * change + half * (lam + mu) * change * change


@wp.func
def plain_stress(F: wp.mat33d, mu: wp.float64, lam: wp.float64) -> wp.mat33d:
    """Its derivative."""
    return mu * F + ((lam + mu) * (wp.determinant(F) - wp.float64(1.0)) - mu) * cofactor(F)


@wp.func
def soft_stress(F: wp.mat33d, mu: wp.float64, lam: wp.float64) -> wp.mat33d:
    """Not its derivative."""
    return mu * F + ((lam + wp.float64(0.5) * mu) * (wp.determinant(F) - wp.float64(1.0)) - mu) * cofactor(F)


@wp.func
def plain_block(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.mat33d:
    """Its second derivatives by the stretches."""
    area = wp.vec3d(s[1] * s[2], s[2] * s[0], s[0] * s[1])
    shear = ((lam + mu) * (s[0] * s[1] * s[2] - wp.float64(1.0)) - mu) * s
    zero = wp.float64(0.0)
    block = mu * wp.identity(3, dtype=wp.float64) + (lam + mu) * wp.outer(area, area)
    return block + wp.mat33d(zero, shear[2], shear[1], shear[2], zero, shear[0], shear[1], shear[0], zero)


@wp.func
def constant_block(s: wp.vec3d, mu: wp.float64, lam: wp.float64) -> wp.mat33d:
    """Right at rest only."""
    ones = wp.vec3d(wp.float64(1.0), wp.float64(1.0), wp.float64(1.0))
    return wp.float64(2.0) * mu * wp.identity(3, dtype=wp.float64) + lam * wp.outer(ones, ones)


def test_own_model_moves_a_body():
    """A user's model of energy, stress and block is checked, kept by name, and moves a body as it says."""
    model = ConstitutiveModel(name="plain", energy=plain_energy, stress=plain_stress, stretch_block=plain_block)
    assert Material(model=model).model == Material(model=model).model == Material(model="plain").model == "plain"
    body = Body(3, cells=(1, 1, 2), points=2, fix_top=True, young=2e4, damping=0.02, model="plain")
    other = Body(3, cells=(1, 1, 2), points=2, fix_top=True, young=2e4, damping=0.02)
    for hung in (body, other):
        hung.run(100, 0.1 * hung.gravity)
    assert body.heights.min() == pytest.approx(other.heights.min(), rel=0.02)
    assert body.heights.min() < -1e-3


def test_wrong_models_are_refused():
    """A stress or a block that is not the derivative, and a name that is taken, are refused with the place."""
    parts = {"energy": plain_energy, "stress": plain_stress, "stretch_block": plain_block}
    with pytest.raises(ValueError, match="'soft' has a wrong stress: it must be the derivative of energy"):
        Material(model=ConstitutiveModel(name="soft", **{**parts, "stress": soft_stress}))
    with pytest.raises(ValueError, match="wrong stretch_block: it must be the derivative of stress. At F = "):
        Material(model=ConstitutiveModel(name="flat", **{**parts, "stretch_block": constant_block}))
    with pytest.raises(ValueError, match="another constitutive model named 'stvk'"):
        Material(model=ConstitutiveModel(name="stvk", **parts))
    with pytest.raises(TypeError, match="must be a name or a ConstitutiveModel"):
        Material(model=plain_energy)
    assert "soft" not in CONSTITUTIVE_MODELS

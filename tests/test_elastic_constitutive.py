# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of the constitutive models against finite differences and their invariants."""

import functools

import hypothesis.extra.numpy as hnp
import numpy as np
import pytest
import warp as wp
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from newton_cagecut.elastic.constitutive import CONSTITUTIVE_MODELS
from newton_cagecut.elastic.stiffness import Stiffness, apply_stiffness, make_stiffness_function, vertex_block

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
        F: wp.array[wp.mat33d],
        directions: wp.array[wp.mat33],
        gradient: wp.vec3,
        energies: wp.array[wp.float64],
        stresses: wp.array[wp.mat33d],
        products: wp.array2d[wp.mat33],
        blocks: wp.array[wp.mat33],
    ):
        i = wp.tid()
        mu, lam = wp.float64(MU), wp.float64(LAM)
        energies[i] = energy(F[i], mu, lam)
        stresses[i] = stress(F[i], mu, lam)
        stiffness = stiffness_function(F[i], mu, lam, wp.float64(1.0))
        for k in range(directions.shape[0]):
            products[i, k] = apply_stiffness(stiffness, directions[k])
        blocks[i] = vertex_block(stiffness, gradient)

    return probe


GRADIENT = np.array([0.3, -0.7, 0.5])


def evaluate(model, F, plane=False):
    """Energies (n,), stresses (n, 3, 3), projected Hessians (n, 9, 9) and vertex blocks (n, 3, 3)."""
    F = np.asarray(F, dtype=np.float64).reshape(-1, 3, 3)
    n = len(F)
    outputs = (wp.zeros(n, dtype=wp.float64, device="cpu"), wp.zeros(n, dtype=wp.mat33d, device="cpu"))
    outputs += (wp.zeros((n, 9), dtype=wp.mat33, device="cpu"), wp.zeros(n, dtype=wp.mat33, device="cpu"))
    inputs = [wp.array(F, dtype=wp.mat33d, device="cpu")]
    inputs += [wp.array(np.eye(9).reshape(9, 3, 3), dtype=wp.mat33, device="cpu"), wp.vec3(*GRADIENT)]
    wp.launch(make_probe(model, plane), dim=n, inputs=inputs, outputs=outputs, device="cpu")
    energies, stresses, products, blocks = (a.numpy() for a in outputs)
    return energies, stresses, products.reshape(n, 9, 9), blocks


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
        tension = np.maximum((LAM + MU) * (np.linalg.det(F) - 1.0) - MU, 0.0)
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


def as_plane(F):
    """Deformation gradients whose third row and column are the identity's."""
    return np.eye(3) + PLANE * (F - np.eye(3))


@pytest.mark.parametrize("model", MODELS)
def test_stress_is_derivative_of_energy(model):
    """The stress is the finite difference of the energy density, inverted and flat states included."""
    F, h = random_gradients(), 1e-5
    steps = h * np.eye(9).reshape(9, 3, 3)
    energy = evaluate(model, np.stack([F[:, None] + steps, F[:, None] - steps]))[0].reshape(2, len(F), 9)
    expected = (energy[0] - energy[1]) / (2.0 * h)
    np.testing.assert_allclose(evaluate(model, F)[1].reshape(-1, 9), expected, rtol=1e-6, atol=1e-6)


@solid_and_plane
@pytest.mark.parametrize("model", MODELS)
def test_projected_hessian_is_nearest_positive_semidefinite(model, plane):
    """The projected Hessian is the kept one, or its part in the plane, with negative eigenvalues set to zero."""
    F = as_plane(random_gradients()) if plane else random_gradients()
    true, projected = kept_hessians(model, F), evaluate(model, F, plane)[2]
    if plane:
        true *= np.outer(PLANE, PLANE)
    values, vectors = np.linalg.eigh(0.5 * (true + true.transpose(0, 2, 1)))
    expected = np.einsum("nij,nj,nkj->nik", vectors, np.maximum(values, 0.0), vectors)
    scale = np.abs(true).max(axis=(1, 2), keepdims=True)
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
def test_vertex_block_belongs_to_hessian(model, plane):
    """The 3x3 block of a vertex is the Hessian between its three directions."""
    F = as_plane(random_gradients()) if plane else random_gradients()
    *_, hessians, blocks = evaluate(model, F, plane)
    full = hessians.reshape(-1, 3, 3, 3, 3)
    expected = np.einsum("naibj,i,j->nab", full, GRADIENT, GRADIENT)
    scale = np.abs(expected).max(axis=(1, 2), keepdims=True) + 1e-6
    assert np.all(np.abs(blocks - expected) < 1e-5 * scale)


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
    F = random_gradients()
    R = Rotation.random(len(F), rng=np.random.default_rng(1)).as_matrix()
    energy, stress, *_ = evaluate(model, F)
    turned, turned_stress, *_ = evaluate(model, R @ F)
    np.testing.assert_allclose(turned, energy, atol=1e-10, rtol=1e-10)
    np.testing.assert_allclose(turned_stress, R @ stress, atol=1e-9, rtol=1e-9)
    np.testing.assert_allclose(evaluate(model, F @ R)[1], stress @ R, atol=1e-9, rtol=1e-9)


def test_stiffness_is_compact():
    """A quadrature point's stiffness is kept in 33 floats, not in 81 of the full matrix."""
    assert wp.types.type_size_in_bytes(Stiffness) == 33 * 4

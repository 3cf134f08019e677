# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Checks of a user's constitutive model by finite differences, on the CPU."""

from __future__ import annotations

import numpy as np
import warp as wp

from .model import ConstitutiveModel

_MU, _LAM = 2.0, 3.0
_STEP = 1.0e-5
_TOLERANCE = 1.0e-4
_AXES = np.eye(9).reshape(9, 3, 3)
_PAIRS = ((1, 2), (2, 0), (0, 1))


def check_model(model: ConstitutiveModel) -> None:
    """Compare a model's stress and stiffness with differences of its energy and stress, at rest and far from it.

    Raises:
        ValueError: If something is wrong; the text says what and where.
    """
    probe = _Probe(model)
    stretches = np.array([[1.0, 1.0, 1.0], [0.8, 1.1, 1.3], [0.4, 0.7, 1.6], [1.2, 0.9, -0.3], [0.1, 0.2, 0.3]])
    rng = np.random.default_rng(0)
    turns = np.linalg.qr(rng.normal(size=(2, len(stretches), 3, 3)))[0]
    turns *= np.sign(np.linalg.det(turns))[..., None, None]
    F = np.einsum("nij,nj,nkj->nik", turns[0], stretches, turns[1])
    steps = _STEP * _AXES
    energies, stresses = probe.at(F)
    shifted = [probe.at((F[:, None] + sign * steps).reshape(-1, 3, 3)) for sign in (1.0, -1.0)]
    slope = (shifted[0][0] - shifted[1][0]).reshape(-1, 3, 3) / (2.0 * _STEP)
    _compare(model, "stress", "the derivative of energy", stresses, slope, F)
    diagonal = np.einsum("nj,jk->njk", stretches, np.eye(3))
    plain = probe.at(diagonal)
    _compare(model, "energy", "the same for all turned F", energies, plain[0], F)
    turned = np.einsum("nij,njk,nlk->nil", turns[0], plain[1], turns[1])
    _compare(model, "stress", "turned with F", stresses, turned, F)
    _compare(model, "stress", "zero at rest", plain[1][:1], np.zeros((1, 3, 3)), diagonal)
    shifted = [probe.at((diagonal[:, None] + sign * steps).reshape(-1, 3, 3))[1] for sign in (1.0, -1.0)]
    hessian = ((shifted[0] - shifted[1]) / (2.0 * _STEP)).reshape(-1, 3, 3, 3, 3)
    block, *modes = probe.stiffness(stretches)
    _compare(model, "stretch_block", "the derivative of stress", block, np.einsum("niijj->nij", hessian), diagonal)
    for name, values, sign in zip(("symmetric_modes", "antisymmetric_modes"), modes, (1.0, -1.0)):
        expected = [hessian[:, i, j, i, j] + sign * hessian[:, i, j, j, i] for i, j in _PAIRS]
        _compare(model, name, "the derivative of stress", values, np.stack(expected, axis=1), diagonal)
    small = 2.0 * _MU * np.eye(3) + _LAM
    _compare(model, "stretch_block", "2 mu I + lam at rest, for small strains", block[:1], small[None], diagonal)


class _Probe:
    """Evaluates a model."""

    def __init__(self, model: ConstitutiveModel):
        energy, stress, stretch_block = model.energy, model.stress, model.stretch_block
        symmetric_modes, antisymmetric_modes = model.symmetric_modes, model.antisymmetric_modes

        @wp.kernel(enable_backward=False, module="unique")
        def probe_stress(F: wp.array[wp.mat33d], energies: wp.array[wp.float64], stresses: wp.array[wp.mat33d]):
            i = wp.tid()
            mu, lam = wp.float64(wp.static(_MU)), wp.float64(wp.static(_LAM))
            energies[i] = energy(F[i], mu, lam)
            stresses[i] = stress(F[i], mu, lam)

        @wp.kernel(enable_backward=False, module="unique")
        def probe_stiffness(
            s: wp.array[wp.vec3d],
            blocks: wp.array[wp.mat33d],
            symmetric: wp.array[wp.vec3d],
            antisymmetric: wp.array[wp.vec3d],
        ):
            i = wp.tid()
            mu, lam = wp.float64(wp.static(_MU)), wp.float64(wp.static(_LAM))
            blocks[i] = stretch_block(s[i], mu, lam)
            symmetric[i] = symmetric_modes(s[i], mu, lam)
            antisymmetric[i] = antisymmetric_modes(s[i], mu, lam)

        self._stress, self._stiffness = probe_stress, probe_stiffness

    def at(self, F: np.ndarray) -> list[np.ndarray]:
        """Energies and stresses."""
        return _evaluate(self._stress, wp.array(F, dtype=wp.mat33d, device="cpu"), (wp.float64, wp.mat33d))

    def stiffness(self, stretches: np.ndarray) -> list[np.ndarray]:
        """Blocks of the stretches, symmetric and antisymmetric modes."""
        inputs = wp.array(stretches, dtype=wp.vec3d, device="cpu")
        return _evaluate(self._stiffness, inputs, (wp.mat33d, wp.vec3d, wp.vec3d))


def _evaluate(kernel: wp.Kernel, inputs: wp.array, dtypes: tuple[type, ...]) -> list[np.ndarray]:
    outputs = [wp.zeros(inputs.shape[0], dtype=dtype, device="cpu") for dtype in dtypes]
    wp.launch(kernel, dim=inputs.shape[0], inputs=[inputs], outputs=outputs, device="cpu")
    return [output.numpy() for output in outputs]


def _compare(
    model: ConstitutiveModel, part: str, claim: str, found: np.ndarray, expected: np.ndarray, F: np.ndarray
) -> None:
    """Refuse a model whose values differ from what they must be; the first axis runs over the F."""
    difference = np.abs(found - expected).reshape(len(found), -1).max(axis=1)
    scale = _MU + np.abs(expected).reshape(len(found), -1).max(axis=1)
    wrong = np.flatnonzero(~(difference <= _TOLERANCE * scale))
    if len(wrong):
        first = wrong[0]
        raise ValueError(
            f"The constitutive model {model.name!r} has a wrong {part}: it must be {claim}. At "
            f"F = {np.round(F[first], 4).tolist()}, mu = {_MU} and lam = {_LAM} it is "
            f"{np.round(found[first], 6).tolist()}, not {np.round(expected[first], 6).tolist()}."
        )

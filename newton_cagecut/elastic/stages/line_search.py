# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""How much of a solution is taken: no more than lets the incremental potential of its piece not rise.

The potential of a stage is |x - target|_M^2 / 2 - impulse . x + k^2 Psi(x), with damping, ties and further terms, which
are quadratic. The solution goes downhill, since its matrix is positive definite; the largest of a row of halvings is
taken at which the potential is no higher than at the start, up to rounding. Each piece of a body chooses alone.
"""

from __future__ import annotations

import functools

import warp as wp

from ..arrays import BodyArrays, LinearSystem, StepArrays
from ..constitutive import CONSTITUTIVE_MODELS
from ..launching import record
from ..step_kernels import gather, make_deformation_function
from ..stiffness import apply_stiffness
from .stage_arrays import PieceArrays, StageArrays
from .step_record import StepRecord

wp.set_module_options({"enable_backward": False})

HALVINGS = 12
"""How many parts of a solution are tried: 1, 1/2, 1/4 and so on."""

_ROUNDING = wp.constant(wp.float64(1.0e-6))
"""Share of the potential's terms, and of a strain, that is rounding."""


@functools.cache
def make_energy_kernel(model: str, plane: bool) -> wp.Kernel:
    """The kernel that finds how each quadrature point's energy changes along the solution, for one model."""
    energy = CONSTITUTIVE_MODELS[model].energy
    deformation = make_deformation_function(plane)

    @wp.kernel(enable_backward=False, module="unique")
    def find_energies(body: BodyArrays, step: StepArrays, system: LinearSystem, energies: wp.array2d[wp.float64]):
        q = wp.tid()
        mu, lam = body.material[0][0], body.material[0][1]
        scale = step.scales[0] * wp.float64(body.volumes[q])
        F = deformation(q, step.displacement, body)
        dF = deformation(q, system.solution, body) - wp.identity(3, dtype=wp.float64)
        start = energy(F, mu, lam)
        slope, curvature = wp.float64(0.0), wp.float64(0.0)
        if step.scales[2] > wp.float64(0.0):
            change = gather(q, system.solution, body)
            before = apply_stiffness(step.stiffnesses[q], gather(q, step.predicted, body))
            slope = wp.float64(wp.ddot(change, before))
            after = apply_stiffness(step.stiffnesses[q], change)
            curvature = step.scales[2] * wp.float64(wp.ddot(change, after))
        part = wp.float64(1.0)
        for m in range(wp.static(HALVINGS)):
            rise = scale * (energy(F + part * dF, mu, lam) - start)
            energies[q, m] = rise + part * slope + wp.float64(0.5) * part * part * curvature
            part *= wp.float64(0.5)
        energies[q, wp.static(HALVINGS)] = scale * (lam + wp.float64(2.0) * mu) * wp.sqrt(wp.ddot(dF, dF))

    return find_energies


@wp.kernel(enable_backward=False)
def choose_factors(
    body: BodyArrays,
    stage: StageArrays,
    pieces: PieceArrays,
    system: LinearSystem,
    energies: wp.array2d[wp.float64],
    record: StepRecord,
):
    """The part of the solution that each piece takes."""
    p = wp.tid()
    if p >= body.piece_count[0]:
        return
    slope, curvature, size = wp.float64(0.0), wp.float64(0.0), wp.float64(0.0)
    for i in range(body.vertex_count[0]):
        if body.piece[i] == p and body.fixed[i] == 0:
            change = wp.vec3d(system.solution[i])
            slope -= wp.dot(change, wp.vec3d(stage.force[i]))
            curvature += wp.dot(change, wp.vec3d(stage.product[i]))
            size += wp.abs(wp.dot(change, wp.vec3d(stage.force[i])))
    for q in range(energies.shape[0]):
        if body.piece[body.anchors[q]] == p:
            size += energies[q, wp.static(HALVINGS)]
    factor, part = wp.float64(0.0), wp.float64(1.0)
    for m in range(wp.static(HALVINGS)):
        if factor == wp.float64(0.0):
            rise = part * slope + wp.float64(0.5) * part * part * curvature
            for q in range(energies.shape[0]):
                if body.piece[body.anchors[q]] == p:
                    rise += energies[q, m]
            # the comparison is false where something is not a number
            if rise <= part * _ROUNDING * size:
                factor = part
        part *= wp.float64(0.5)
    pieces.factor[p] = factor
    if factor == wp.float64(0.0):
        wp.atomic_max(record.limited, 0, 2)
    elif factor < wp.float64(1.0):
        wp.atomic_max(record.limited, 0, 1)


class LineSearch:
    """Chooses how much of a solution each piece takes; only launches kernels."""

    def __init__(
        self,
        model: str,
        body: BodyArrays,
        step: StepArrays,
        stage: StageArrays,
        pieces: PieceArrays,
        system: LinearSystem,
        step_record: StepRecord,
    ) -> None:
        points, device = body.volumes.shape[0], body.rest.device
        self.energies = wp.zeros((points, HALVINGS + 1), dtype=wp.float64, device=device)
        kernel = make_energy_kernel(model, body.normal is not None)
        self._find_energies = record(kernel, points, [body, step, system, self.energies], device)
        inputs = [body, stage, pieces, system, self.energies, step_record]
        self._choose = record(choose_factors, body.rest.shape[0], inputs, device)

    def launch(self) -> None:
        """Choose, given the solution and the product of the matrix without the quadrature's part with it."""
        self._find_energies.launch()
        self._choose.launch()

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""How much of a solution is taken: no more than lets the incremental potential of its piece not rise.

The potential of a stage is |x - target|_M^2 / 2 - impulse . x + k^2 Psi(x), with damping, ties and further terms, which
are quadratic. The solution goes downhill, since its matrix is positive definite; the largest of a row of halvings is
taken at which the potential is no higher than at the start, up to rounding. Each piece of a body chooses alone, unless
pieces push each other: then all take the same part.
"""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

import warp as wp

from ..arrays import DAMPING_SHARE, ELASTIC_FORCE, JOINED, BodyArrays, LinearSystem, StepArrays, matrix_of
from ..averaging.row_functions import make_row_energy
from ..launching import launch_later
from ..step_kernels import make_deformation_function
from ..stiffness import apply_stiffness
from .stage_arrays import PieceArrays, StageArrays
from .step_record import StepRecord

if TYPE_CHECKING:
    from ..implicit_integrator import ImplicitIntegrator

wp.set_module_options({"enable_backward": False})

HALVINGS = 12
"""How many parts of a solution are tried: 1, 1/2, 1/4 and so on."""

_ROUNDING = wp.constant(wp.float64(1.0e-6))
"""Share of the potential's terms, and of a strain, that is rounding."""


@wp.struct
class LineSearchArrays:
    """What the choice is made from."""

    energies: wp.array2d[wp.float64]
    """How each point's energy changes with each part of the solution, and the size of its terms [J s^2]."""
    terms: wp.array[wp.vec3d]
    """Slope and curvature of the rest of the potential, and the size of all terms, one a piece."""
    halving: wp.array[int]
    """Whether some piece does not take the whole solution, shape (1,)."""


@functools.cache
def make_energy_kernel(model: str, plane: bool, whole: bool) -> wp.Kernel:
    """The kernel that finds how each quadrature point's energy changes along the solution, for one model.

    Args:
        model: The model.
        plane: Whether the body is plane.
        whole: Whether for the whole solution; otherwise for its parts, where a piece does not take the whole.
    """
    energy = make_row_energy(model)
    deformation = make_deformation_function(plane)
    first, end = (0, 1) if whole else (1, HALVINGS)

    @wp.kernel(enable_backward=False, module="unique")
    def find_energies(body: BodyArrays, step: StepArrays, search: LineSearchArrays):
        q = wp.tid()
        volume = wp.float64(body.volumes[q])
        if wp.static(whole):
            if q == 0:
                search.halving[0] = 0
        elif search.halving[0] == 0:
            return
        if volume == wp.float64(0.0):
            for m in range(wp.static(first), wp.static(end)):
                search.energies[q, m] = wp.float64(0.0)
            search.energies[q, wp.static(HALVINGS)] = wp.float64(0.0)
            return
        mu, lam = body.material[0][0], body.material[0][1]
        scale = step.scales[ELASTIC_FORCE] * volume
        F = deformation(matrix_of(step.strain, q), body)
        change = matrix_of(step.change, q)
        dF = deformation(change, body) - wp.identity(3, dtype=wp.float64)
        start = energy(q, F, body)
        slope, curvature = wp.float64(0.0), wp.float64(0.0)
        if step.scales[DAMPING_SHARE] > wp.float64(0.0):
            before = apply_stiffness(step.stiffnesses[q], matrix_of(step.drift, q))
            slope = wp.float64(wp.ddot(change, before))
            after = apply_stiffness(step.stiffnesses[q], change)
            curvature = step.scales[DAMPING_SHARE] * wp.float64(wp.ddot(change, after))
        part = wp.float64(wp.static(0.5**first))
        for m in range(wp.static(first), wp.static(end)):
            rise = scale * (energy(q, F + part * dF, body) - start)
            search.energies[q, m] = rise + part * slope + wp.float64(0.5) * part * part * curvature
            part *= wp.float64(0.5)
        search.energies[q, wp.static(HALVINGS)] = scale * (lam + wp.float64(2.0) * mu) * wp.sqrt(wp.ddot(dF, dF))

    return find_energies


@wp.kernel(enable_backward=False)
def choose_whole(
    body: BodyArrays,
    step: StepArrays,
    stage: StageArrays,
    pieces: PieceArrays,
    system: LinearSystem,
    search: LineSearchArrays,
):
    """Take the whole solution of the pieces whose potential it does not raise."""
    p = wp.tid()
    if p >= body.piece_count[0]:
        return
    slope, curvature, size = wp.float64(0.0), wp.float64(0.0), wp.float64(0.0)
    joined = step.scales[JOINED] > wp.float64(0.0)
    for i in range(body.vertex_count[0]):
        if (joined or body.piece[i] == p) and body.fixed[i] == 0:
            change = wp.vec3d(system.solution[i])
            slope -= wp.dot(change, wp.vec3d(system.kept[i]))
            curvature += wp.dot(change, wp.vec3d(stage.product[i]))
            size += wp.abs(wp.dot(change, wp.vec3d(system.kept[i])))
    rise = slope + wp.float64(0.5) * curvature
    for q in range(search.energies.shape[0]):
        if joined or body.piece[body.anchors[q]] == p:
            size += search.energies[q, wp.static(HALVINGS)]
            rise += search.energies[q, 0]
    search.terms[p] = wp.vec3d(slope, curvature, size)
    pieces.factor[p] = wp.float64(1.0)
    # the comparison is false where something is not a number
    if not (rise <= _ROUNDING * size):
        pieces.factor[p] = wp.float64(0.0)
        wp.atomic_max(search.halving, 0, 1)


@wp.kernel(enable_backward=False)
def choose_part(body: BodyArrays, step: StepArrays, pieces: PieceArrays, search: LineSearchArrays, record: StepRecord):
    """Choose the part of the solution that the other pieces take."""
    p = wp.tid()
    if search.halving[0] == 0 or p >= body.piece_count[0] or pieces.factor[p] > wp.float64(0.0):
        return
    terms = search.terms[p]
    factor, part = wp.float64(0.0), wp.float64(0.5)
    for m in range(1, wp.static(HALVINGS)):
        if factor == wp.float64(0.0):
            rise = part * terms[0] + wp.float64(0.5) * part * part * terms[1]
            for q in range(search.energies.shape[0]):
                if step.scales[JOINED] > wp.float64(0.0) or body.piece[body.anchors[q]] == p:
                    rise += search.energies[q, m]
            if rise <= part * _ROUNDING * terms[2]:
                factor = part
        part *= wp.float64(0.5)
    pieces.factor[p] = factor
    wp.atomic_max(record.limited, 0, wp.where(factor == wp.float64(0.0), 2, 1))


class LineSearch:
    """Chooses how much of a solution each piece takes; only launches kernels.

    Args:
        integrator: Whose solutions.
        model: Constitutive model of its body.
        stage: What its stages work on.
        pieces: The pieces of its body.
    """

    def __init__(self, integrator: ImplicitIntegrator, model: str, stage: StageArrays, pieces: PieceArrays) -> None:
        body, step, system = integrator.body, integrator.arrays, integrator.system
        points, capacity, device = body.volumes.shape[0], body.rest.shape[0], integrator.device
        self.arrays = search = LineSearchArrays()
        search.energies = wp.zeros((points, HALVINGS + 1), dtype=wp.float64, device=device)
        search.terms = wp.zeros(capacity, dtype=wp.vec3d, device=device)
        search.halving = wp.zeros(1, dtype=int, device=device)
        whole, parts = (make_energy_kernel(model, integrator.is_plane, flag) for flag in (True, False))
        choosing = [body, step, stage, pieces, system, search]
        self._launches = (
            integrator.solver.gathering(step.displacement, step.strain),
            integrator.solver.gathering(step.predicted, step.drift),
            integrator.solver.gathering(system.solution, step.change),
            launch_later(whole, points, [body, step, search], device),
            launch_later(choose_whole, capacity, choosing, device),
            launch_later(parts, points, [body, step, search], device),
            launch_later(choose_part, capacity, [body, step, pieces, search, integrator.record], device),
        )

    def launch(self) -> None:
        """Choose, given the solution and the product of the matrix without the quadrature's part with it."""
        for launch in self._launches:
            launch.launch()

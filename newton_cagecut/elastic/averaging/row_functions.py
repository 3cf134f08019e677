# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Energy, stress and stiffness of a row: of a point, or of a cluster's mean.

A point has the softer material; a mean has the material, less the softer one. Bodies without clusters have no softer
material: their points have the material itself.
"""

from __future__ import annotations

import functools

import warp as wp

from ..arrays import BodyArrays
from ..constitutive import CONSTITUTIVE_MODELS
from ..stiffness import Stiffness, make_stiffness_function

wp.set_module_options({"enable_backward": False})


@wp.func
def point_constants(q: int, body: BodyArrays) -> wp.vec2d:
    """Lame's constants of the material at the points of a row's cluster."""
    constants = wp.vec2d(body.material[0][0], body.material[0][1])
    if body.clusters.shape[0] > 0:
        constants = body.softened[body.clusters[q]]
    return constants


@functools.cache
def make_row_energy(model: str) -> wp.Function:
    """The function (row, F, body) -> energy density."""
    energy = CONSTITUTIVE_MODELS[model].energy

    @wp.func
    def row_energy(q: int, F: wp.mat33d, body: BodyArrays) -> wp.float64:
        soft = point_constants(q, body)
        result = energy(F, soft[0], soft[1])
        if q >= body.point_volumes.shape[0]:
            result = energy(F, body.material[0][0], body.material[0][1]) - result
        return result

    return row_energy


@functools.cache
def make_row_stress(model: str) -> wp.Function:
    """The function (row, F, body) -> first Piola-Kirchhoff stress."""
    stress = CONSTITUTIVE_MODELS[model].stress

    @wp.func
    def row_stress(q: int, F: wp.mat33d, body: BodyArrays) -> wp.mat33d:
        soft = point_constants(q, body)
        result = stress(F, soft[0], soft[1])
        if q >= body.point_volumes.shape[0]:
            result = stress(F, body.material[0][0], body.material[0][1]) - result
        return result

    return row_stress


@functools.cache
def make_row_stiffness(model: str, plane: bool) -> wp.Function:
    """The function (row, F, body, scale) -> projected stiffness times scale."""
    point_stiffness = make_stiffness_function(model, plane)
    mean_stiffness = make_stiffness_function(model, plane, difference=True)

    @wp.func
    def row_stiffness(q: int, F: wp.mat33d, body: BodyArrays, scale: wp.float64) -> Stiffness:
        soft = point_constants(q, body)
        if q >= body.point_volumes.shape[0]:
            full = body.material[0]
            return mean_stiffness(F, wp.vec2d(full[0], full[1]), soft, scale)
        return point_stiffness(F, soft, soft, scale)

    return row_stiffness

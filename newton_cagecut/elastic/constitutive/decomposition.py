# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Singular values with signs: F = U diag(s) V^T with rotations U and V."""

from __future__ import annotations

import warp as wp

wp.set_module_options({"enable_backward": False})


@wp.func
def decompose(F: wp.mat33d):
    """Rotations U and V and signed stretches s with F = U diag(s) V^T; in float64 exact to 1e-13."""
    left, stretches, right = wp.svd3(F)
    return left, stretches, right


@wp.func
def turn(angle: wp.float64) -> wp.mat33d:
    """Rotation about the third axis."""
    c, s, zero = wp.cos(angle), wp.sin(angle), wp.float64(0.0)
    return wp.mat33d(c, -s, zero, s, c, zero, zero, zero, wp.float64(1.0))


@wp.func
def decompose_plane(F: wp.mat33d):
    """Rotations U and V about the third axis and signed stretches s with F = U diag(s) V^T, of a plane F.

    In closed form: Warp's ``svd2`` (1.19) returns the identity's for F = -I.
    """
    half = wp.float64(0.5)
    turned = wp.vec2d(half * (F[0, 0] + F[1, 1]), half * (F[1, 0] - F[0, 1]))
    mirrored = wp.vec2d(half * (F[0, 0] - F[1, 1]), half * (F[1, 0] + F[0, 1]))
    difference, total = wp.atan2(turned[1], turned[0]), wp.atan2(mirrored[1], mirrored[0])
    mean, half_gap = wp.length(turned), wp.length(mirrored)
    stretches = wp.vec3d(mean + half_gap, mean - half_gap, wp.float64(1.0))
    return turn(half * (total + difference)), stretches, turn(half * (total - difference))

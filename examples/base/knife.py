# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A knife that is held in the world, as the rest frame of a bent body sees it."""

from __future__ import annotations

import numpy as np
import warp as wp

from newton_cagecut import Blade

REACH = 0.25  # how near to the knife points tell how the body is bent there [m]
LEAST = 20  # of such points


def knife_at(pose: wp.transform, points: np.ndarray, rest: np.ndarray, size: tuple[float, float]) -> Blade:
    """Return a knife whose edge is the x axis of a pose, going down along its z axis.

    The body near it is taken to be bent as an affine map of it says; a body that is bent more sharply is cut beside.

    Args:
        pose: Of the middle of the knife's edge, in the world.
        points: Where the body's points are now [m], shape (n, 3).
        rest: Where they are at rest [m], shape (n, 3).
        size: Width and height of the knife [m].

    Raises:
        ValueError: There is too little of the body near the knife.
    """
    axes = np.array(wp.quat_to_matrix(wp.transform_get_rotation(pose))).reshape(3, 3)
    place, (width, height) = np.array(wp.transform_get_translation(pose)), size
    own = (points - place) @ axes
    near = (np.abs(own[:, 1]) < REACH) & (np.abs(own[:, 0]) < 0.5 * width) & (own[:, 2] < height)
    if near.sum() < LEAST:
        raise ValueError("the knife does not reach the body from there")
    middle, rest_middle = points[near].mean(axis=0), rest[near].mean(axis=0)
    affine = np.linalg.lstsq(points[near] - middle, rest[near] - rest_middle, rcond=None)[0]
    edge, down = axes[:, 0] @ affine, -axes[:, 2] @ affine
    half = 0.5 * width * float(np.linalg.norm(edge))
    return Blade((place - middle) @ affine + rest_middle, edge, down, width=(-half, half))

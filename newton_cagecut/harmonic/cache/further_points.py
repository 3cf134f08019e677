# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Weights of further points, which are not kept."""

from __future__ import annotations

import numpy as np

from ..options import WalkOptions
from ..resolve.point_weights import PointWeights
from ..stats import UpdateStats
from ..walks.query_points import empty_points, place_points
from .domain_state import DomainState
from .placement import Placement
from .stages import Stages


def weights_of(state: DomainState, placement: Placement, options: WalkOptions) -> np.ndarray:
    """Walk for points and forget them.

    Args:
        state: Walls and faces.
        placement: The points, numbered from 0.
        options: Options of the walks.

    Returns:
        Weights, shape (n, cage.vertex_count), float32.
    """
    count, device = len(placement.indices), state.device
    points = empty_points(count, np.zeros(count, dtype=bool), device)
    place_points(points, placement.indices, placement.positions, placement.keys, placement.pieces)
    errors = options.correction == "fitted" and options.walks > 0
    weights = PointWeights(count, 0, state.cage.vertex_count, device=device, errors=errors)
    Stages(state, options, points, count, weights, None, UpdateStats(count * options.walks)).run_all()
    return weights.weights.numpy()

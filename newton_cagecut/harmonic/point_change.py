# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Points that an edit of the cage brings with it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class PointChange:
    """Points to set once the cage is edited: to move, or to add.

    Args:
        indices: Their numbers, shape (n,); those beyond the count continue it without gaps.
        points: Rest positions in the edited cage [m], shape (n, dimension).
        keys: Key 2 * wall + side for points on a wall, else -1, shape (n,); none lies on one by default.
    """

    indices: np.ndarray
    points: np.ndarray
    keys: np.ndarray | None = None

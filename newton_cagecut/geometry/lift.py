# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The plane in space.

Section 4 of the paper cuts in the plane, section 5 in space. What serves both takes the plane for the one at z = 0.
"""

from __future__ import annotations

import numpy as np


def lifted(vectors: np.ndarray) -> np.ndarray:
    """Vectors with a third component, 0 for those of the plane; shape (..., 3).

    Args:
        vectors: Vectors, shape (..., dimension).
    """
    missing = 3 - vectors.shape[-1]
    return np.concatenate([vectors, np.zeros((*vectors.shape[:-1], missing))], axis=-1) if missing else vectors

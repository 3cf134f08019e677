# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Powers fitted to what grows or falls."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def power_of(amounts: Sequence[float], values: Sequence[float]) -> float:
    """Return the exponent p of the power law values ~ amounts^p, by least squares of the logarithms.

    Args:
        amounts: Positive amounts, two or more.
        values: Positive values.
    """
    return float(np.polyfit(np.log(amounts), np.log(values), 1)[0])


def linear_of(amounts: Sequence[float], values: Sequence[float]) -> tuple[float, float]:
    """Return a and b, neither below 0, of values ~ a + b * amounts, each value weighted by its inverse.

    Args:
        amounts: Amounts, not all 0.
        values: Positive values.
    """
    amounts, values = np.asarray(amounts, dtype=np.float64), np.asarray(values, dtype=np.float64)
    if len(amounts) > 1:
        slope, start = np.polyfit(amounts, values, 1, w=1.0 / values)
        if slope > 0.0 and start >= 0.0:
            return float(start), float(slope)
    some = amounts > 0.0
    return 0.0, float(np.exp(np.mean(np.log(values[some] / amounts[some]))))

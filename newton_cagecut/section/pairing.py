# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Matching of entries and exits along a line.

A line meets the region between weakly simple loops in intervals. Where the loops coincide, as the two sides of an
earlier cut do (section 5.2 of the paper), rounding cannot tell the order of entries and exits; alternation can.
"""

from __future__ import annotations

import numpy as np


def alternate(coordinate: np.ndarray, enters: np.ndarray) -> list[tuple[int, int]]:
    """Match each entry with the exit that ends its interval.

    Args:
        coordinate: Positions along the line, shape (count,).
        enters: Whether the line enters the region there, shape (count,); as many entries as exits.

    Returns:
        Pairs of indices (entry, exit) in the order of the line.
    """
    order = np.lexsort((~np.asarray(enters), coordinate)).tolist()
    entries = [i for i in order if enters[i]]
    exits = [i for i in order if not enters[i]]
    return list(zip(entries, exits, strict=True))

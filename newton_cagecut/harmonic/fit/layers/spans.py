# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Points in spans of sixteen, whose layers are computed side by side in single precision.

What is done to a span is done to each of its numbers alone: what a point gets does not depend on those beside it.
Points that only fill the last span repeat the last one.
"""

from __future__ import annotations

import numpy as np
import warp as wp

SPAN = 16
"""Points of a span."""
Span = wp.types.vector(length=SPAN, dtype=wp.float32)
"""A number for each point of a span."""
WideSpan = wp.types.vector(length=SPAN, dtype=wp.float64)


@wp.func
def offset_from(place: WideSpan, origin: wp.float64) -> Span:
    """Coordinates of a span's points from an origin, along an axis: rounded only once they are small."""
    out = Span()
    for c in range(SPAN):
        out[c] = wp.float32(place[c] - origin)
    return out


@wp.func
def inverse_root(values: Span) -> Span:
    """One over the square roots."""
    out = Span()
    for c in range(SPAN):
        out[c] = wp.float32(1.0) / wp.sqrt(values[c])
    return out


@wp.func
def inverse(values: Span) -> Span:
    """One over the values."""
    out = Span()
    for c in range(SPAN):
        out[c] = wp.float32(1.0) / values[c]
    return out


@wp.func
def logarithm(values: Span) -> Span:
    """Logarithms."""
    out = Span()
    for c in range(SPAN):
        out[c] = wp.log(values[c])
    return out


def span_count(points: int) -> int:
    """Spans that so many points take."""
    return -(-points // SPAN)


def in_spans(points: np.ndarray) -> np.ndarray:
    """Points as spans, filled up with the last one.

    Args:
        points: Positions, shape (point_count, dimension).

    Returns:
        Positions, shape (span_count * 16, dimension).
    """
    fill = span_count(len(points)) * SPAN - len(points)
    return np.concatenate([points, np.repeat(points[-1:], fill, axis=0)])

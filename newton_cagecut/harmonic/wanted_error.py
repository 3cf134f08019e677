# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""How many walks a wanted error takes: two short runs tell, as squared errors fall as the walks."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from ..geometry import as_number, shown

AUTO = "auto"
USUAL_ERROR = 1.0e-2
"""Error of ``walks="auto"`` where no other is asked for."""
MOST_WALKS = 1 << 24
_FIRST, _SECOND = 64, 512  # walks of the short runs: control variates of few walks are still of low degree
_POINTS = 128
_SEEDS = (0x5EED0, 0x5EED1)


def walks_for_error(variance: float, error: float) -> int:
    """Walks a point for a wanted error.

    Args:
        variance: Squared error of the weights times the walks that had it.
        error: Wanted root mean square, over the points, of the Euclidean norm of the errors of a point's weights.

    Returns:
        Walks, at least 1; more than ``MOST_WALKS`` if those do not reach it.
    """
    return max(1, math.ceil(variance / error**2 * (1.0 - 1.0e-12)))


def chosen_walks(
    walks: int | str | None,
    error: float | None,
    make: Callable[..., object],
    domain: object,
    points: np.ndarray,
    options: Mapping[str, object],
) -> int | str | None:
    """The walks that were passed, or those for a wanted error.

    Args:
        walks: What was passed; "auto" chooses. A number stands beside no error.
        error: Wanted error; None for that of "auto", or for the walks as they are.
        make: Makes coordinates: ``HarmonicCoordinates``.
        domain: The cage, or the domain that they share.
        points: The points, of which some are walked from.
        options: Options of the coordinates. With control variates there are never fewer walks than those of the short
            runs, as fewer leave lower degrees.

    Raises:
        TypeError: The error is no number.
        ValueError: It is not positive, or too small for the most walks there can be.
    """
    if error is None and not (isinstance(walks, str) and walks == AUTO):
        return walks
    wanted = USUAL_ERROR if error is None else as_number(error, "error")
    if not wanted > 0.0:
        raise ValueError(f"error must be positive, the wanted error of a point's weights, not {shown(error)}")
    some = points[:: max(1, len(points) // _POINTS)]
    found = 1
    for count in (_FIRST, _SECOND):
        runs = [make(domain, some, count, seed, cuttable=False, **options).weights for seed in _SEEDS]
        one, other = (weights.astype(np.float64) for weights in runs)
        squared = 0.5 * ((one - other) ** 2).sum(axis=1).mean() if len(some) else 0.0
        found = walks_for_error(float(squared) * count, wanted)
        if found <= count:
            break
    if found > MOST_WALKS:
        raise ValueError(
            f"an error of {wanted:g} takes {found} walks a point, and {MOST_WALKS} is the most; ask for "
            f'{math.sqrt(float(squared) * count / MOST_WALKS):.1g} or more, or take correction="fitted"'
        )
    return max(found, _FIRST) if options.get("correction") == "harmonic" else found

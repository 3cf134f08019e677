# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Arguments of the edits of cages, checked before anything changes."""

from __future__ import annotations

import numpy as np


def as_number(value: float, what: str) -> float:
    """A number, which may be infinite.

    Args:
        value: What was passed.
        what: What it is, for the error.

    Raises:
        TypeError: If it is not a number.
        ValueError: If it is nan.
    """
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{what} must be a number, got {value!r}") from None
    if np.isnan(number):
        raise ValueError(f"{what} must be a number, got nan")
    return number

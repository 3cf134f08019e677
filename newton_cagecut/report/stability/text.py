# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Numbers as text."""

from __future__ import annotations

import math


def share(value: float | None) -> str:
    """A share in percent, in few characters."""
    if value is None:
        return "n/a"
    if not math.isfinite(value):
        return "not finite" if math.isnan(value) else "infinite"
    percent = 100.0 * value
    if abs(percent) < 5.0e-3:
        return "0 %"
    return (
        f"{percent:.2g} %" if abs(percent) < 10.0 else f"{percent:.0f} %" if abs(percent) < 1e4 else f"{percent:.0e} %"
    )


def number(value: float | None) -> str:
    """A number in few characters."""
    if value is None:
        return "n/a"
    return f"{value:.2g}" if math.isfinite(value) else "infinite"


def step_text(dt: float) -> str:
    """A time step: a fraction of a second, or a power of ten."""
    return f"{dt:.0e}" if dt < 2.0e-3 else f"1/{round(1.0 / dt)}"

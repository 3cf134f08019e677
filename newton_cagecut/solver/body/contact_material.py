# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""How the surface of a body resists what touches it."""

from __future__ import annotations

from typing import NamedTuple


class ContactMaterial(NamedTuple):
    """The contact material of a body; None for what the model has."""

    stiffness: float | None = None
    """Stiffness of each surface point [N/m]."""
    damping: float | None = None
    """Damping of each surface point [N s/m]."""
    friction: float | None = None
    """Coefficient of friction."""

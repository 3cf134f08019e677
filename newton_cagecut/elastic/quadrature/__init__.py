# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Quadrature points inside a cage: where they are, and what volume each stands for."""

from .sample import sample_quadrature
from .volumes import exact_volumes

__all__ = ["exact_volumes", "sample_quadrature"]

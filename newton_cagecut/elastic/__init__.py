# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The elastic body inside a cage: materials, quadrature and the reduced system (paper, section 6.1)."""

from .backward_euler import LinearTerm, TermScales
from .energy import Energy
from .material import Material
from .quadrature import sample_quadrature
from .stages.step_record import COUNT_NAMES as STEP_COUNTS
from .system import INTEGRATORS, ReducedSystem

__all__ = [
    "STEP_COUNTS",
    "INTEGRATORS",
    "Energy",
    "LinearTerm",
    "Material",
    "ReducedSystem",
    "TermScales",
    "sample_quadrature",
]

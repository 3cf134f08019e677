# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The elastic body inside a cage: materials, quadrature and the reduced system (paper, section 6.1)."""

from .backward_euler import LinearTerm, TermScales
from .energy import Energy
from .material import Material
from .quadrature import sample_quadrature
from .system import INTEGRATORS, ReducedSystem

__all__ = ["INTEGRATORS", "Energy", "LinearTerm", "Material", "ReducedSystem", "TermScales", "sample_quadrature"]

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The elastic body inside a cage: materials, quadrature and the reduced system (paper, section 6.1)."""

from .backward_euler import LinearTerm
from .constitutive import ConstitutiveModel
from .energy import Energy
from .material import Material
from .quadrature import exact_volumes, sample_quadrature
from .system import ReducedSystem

__all__ = [
    "ConstitutiveModel",
    "Energy",
    "LinearTerm",
    "Material",
    "ReducedSystem",
    "exact_volumes",
    "sample_quadrature",
]

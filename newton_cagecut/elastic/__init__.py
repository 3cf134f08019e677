# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The elastic body inside a cage: materials, quadrature and the reduced system (paper, section 6.1)."""

from .arrays import DRIVEN, HELD
from .constitutive import ConstitutiveModel
from .energy import Energy
from .material import Material
from .quadrature import exact_volumes, sample_quadrature
from .solve.linear_solver import SolveLimits
from .solve.point_forces import PointForces, make_point_forces
from .stages.step_record import COUNT_NAMES as STEP_COUNTS
from .system import INTEGRATORS, ReducedSystem

__all__ = [
    "DRIVEN",
    "HELD",
    "INTEGRATORS",
    "STEP_COUNTS",
    "ConstitutiveModel",
    "Energy",
    "Material",
    "PointForces",
    "ReducedSystem",
    "SolveLimits",
    "exact_volumes",
    "make_point_forces",
    "sample_quadrature",
]

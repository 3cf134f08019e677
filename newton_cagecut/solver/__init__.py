# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The Newton solver for cage bodies: builder functions, contacts, model edits."""

import newton

from .body.body_pieces import BodyPiece
from .body.cage_body import CageBody
from .body.capacity import Capacity
from .builder import add_cage_body
from .cut.body_cut import BodyCut
from .cut.body_snapshot import BodySnapshot
from .cut.cut_report import CutReport
from .newton_version import warn_if_untested
from .plan import PlanEntry
from .solver import SolverCageCut
from .viewing import log_recorded

__all__ = [
    "BodyCut",
    "BodyPiece",
    "BodySnapshot",
    "CageBody",
    "Capacity",
    "CutReport",
    "PlanEntry",
    "SolverCageCut",
    "add_cage_body",
    "log_recorded",
]

warn_if_untested(newton.__version__)

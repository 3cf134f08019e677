# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The Newton solver for cage bodies: builder functions, contacts, model edits."""

import newton

from .body_pieces import BodyPiece
from .builder import add_cage_body
from .cut.cut_report import CutReport
from .definition import Capacity
from .newton_version import warn_if_untested
from .solver import SolverCageCut

__all__ = ["BodyPiece", "Capacity", "CutReport", "SolverCageCut", "add_cage_body"]

warn_if_untested(newton.__version__)

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The Newton solver for cage bodies: builder functions, contacts, model edits."""

from .builder import add_cage_body
from .definition import Capacity
from .pieces import BodyPiece
from .report import CutReport
from .solver import SolverCageCut

__all__ = ["BodyPiece", "Capacity", "CutReport", "SolverCageCut", "add_cage_body"]

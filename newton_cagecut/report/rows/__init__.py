# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What the report measures and writes: one class a subject, in the order of the page."""

from __future__ import annotations

from ..cuts.bounds_row import BoundsRow
from ..cuts.course import CourseRow
from ..cuts.locality import LocalityRow
from ..cuts.replay import ReplayRow
from ..measurement import Row
from .bias import BiasRow
from .elements_row import ElementsRow
from .epsilon import EpsilonRow
from .error_row import ErrorRow
from .exact import ExactRow
from .growth import GrowthRow
from .paper_table import PaperTableRow
from .quads import QuadsRow
from .recommendation import RecommendationRow

ROWS: tuple[Row, ...] = (
    RecommendationRow(),
    ErrorRow(),
    ElementsRow(),
    ExactRow(),
    BiasRow(),
    EpsilonRow(),
    QuadsRow(),
    PaperTableRow(),
    ReplayRow(),
    LocalityRow(),
    BoundsRow(),
    CourseRow(),
    GrowthRow(),
)

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Harmonic coordinates by Walk on Spheres: walls, walks, bounds, cache, resolve."""

from .cache.domain import Domain
from .cache.snapshot import CoordinatesSnapshot
from .closed_form_weights import ClosedFormWeights, closed_form_weights
from .coordinates import HarmonicCoordinates
from .coordinates_warm_up import warm_up_coordinates
from .correction_choice import choose_correction, chosen_correction
from .journal import Journal
from .options import check_options
from .point_change import PointChange
from .stats import UpdateStats
from .wanted_error import MOST_WALKS, chosen_walks, walks_for_error

__all__ = [
    "MOST_WALKS",
    "chosen_walks",
    "walks_for_error",
    "ClosedFormWeights",
    "CoordinatesSnapshot",
    "Domain",
    "HarmonicCoordinates",
    "Journal",
    "PointChange",
    "UpdateStats",
    "check_options",
    "choose_correction",
    "chosen_correction",
    "closed_form_weights",
    "warm_up_coordinates",
]

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Which correction suits a cage: a boundary fit, unless the cage has too many faces for one."""

from __future__ import annotations

from dataclasses import dataclass

from ..cage import Cage

AUTO = "auto"
_MOST_UNKNOWNS = 2000
"""Fewest unknowns of a fit from which on walks with control variates are taken: the time of a fit grows with their
square to their cube, that of a step of walks hardly (``docs/accuracy``)."""
_NODES_OF_SEGMENT = 17


@dataclass(frozen=True)
class CorrectionChoice:
    """A correction, and why.

    Args:
        correction: "fitted" or "harmonic".
        reason: Why, in a few words.
    """

    correction: str
    reason: str


def choose_correction(cage: Cage) -> CorrectionChoice:
    """Choose by the size of a cage, as it is before its cuts.

    Args:
        cage: The cage.
    """
    unknowns = len(cage.faces) * _NODES_OF_SEGMENT if cage.dimension == 2 else sum(map(len, cage.faces))
    size = f"{cage.face_count} faces take a fit {unknowns} unknowns at least"
    if unknowns > _MOST_UNKNOWNS:
        return CorrectionChoice("harmonic", f"{size}, more than {_MOST_UNKNOWNS}")
    return CorrectionChoice("fitted", f"{size}, of {_MOST_UNKNOWNS} that are quick")


def chosen_correction(correction: str, cage: Cage) -> str:
    """The correction that was asked for; in the place of "auto" the one that suits the cage.

    Args:
        correction: A correction, or "auto".
        cage: The cage.
    """
    return choose_correction(cage).correction if isinstance(correction, str) and correction == AUTO else correction

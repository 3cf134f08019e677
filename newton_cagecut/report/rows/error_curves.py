# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Curves of error against time, from records: of each correction, and of the finite elements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..measurement import Record, chosen, values_of
from .error import CORRECTIONS
from .error import NAME as ERROR

LABELS = {
    "none": "walks, plain",
    "affine": "walks, affine (the paper)",
    "harmonic": "walks, harmonic controls",
    "fitted": "boundary fit, and walks",
}


@dataclass(frozen=True)
class Curve:
    """Root mean square errors and times, a value for each number of walks or elements.

    Attributes:
        label: What it is of.
        amount: Walks a point, or unknowns.
        seconds: Time of each [s].
        errors: Error of each.
        own: Squared error of the reference that they are measured against.
    """

    label: str
    amount: np.ndarray
    seconds: np.ndarray
    errors: np.ndarray
    own: float = 0.0

    @property
    def net(self) -> np.ndarray:
        """The errors without the part that is the reference's; where little is left, an upper bound of them."""
        return np.sqrt(np.maximum(self.errors**2 - self.own, 0.5 * self.own))

    @property
    def bounded(self) -> np.ndarray:
        """Whether the net errors are such bounds."""
        return self.errors**2 < 1.5 * self.own

    @property
    def empty(self) -> bool:
        """Whether nothing was measured."""
        return not len(self.errors)

    def seconds_at(self, error: float) -> float:
        """Time in which an error is reached [s], between its values; infinite beyond the least error measured."""
        if self.empty or error < self.errors.min():
            return np.inf
        order = np.argsort(self.errors)
        return float(np.exp(np.interp(np.log(error), np.log(self.errors[order]), np.log(self.seconds[order]))))


def walk_curve(
    records: Sequence[Record], scene: str, correction: str, stage: str, kind: str, *, seconds: str = "seconds"
) -> Curve:
    """Return the curve of a correction: errors are means over the seeds, times medians.

    Args:
        records: All records.
        scene: The scene.
        correction: The correction.
        stage: "before" or "during".
        kind: "weights", "gradients" or "surface".
        seconds: "seconds", those of the update by one step during a cut, or "whole_seconds".
    """
    own = chosen(records, ERROR, scene, correction=correction)
    found = []
    for walks in values_of(own, "walks"):
        stages = [record.values[stage] for record in own if record.parameters["walks"] == walks]
        error = np.sqrt(np.mean([values["squared"][kind] for values in stages]))
        found.append((walks, np.median([values[seconds] for values in stages]), error))
    owns = [record.values["own"][kind] for record in chosen(records, "reference", scene, stage=stage)]
    return Curve(LABELS[correction], *np.array(found).reshape(-1, 3).T, own=owns[0] if owns else 0.0)


def element_curve(
    records: Sequence[Record], scene: str, order: int, stage: str, kind: str, *, seconds: str = "seconds"
) -> Curve:
    """Return the curve of the elements of one degree, where they were measured and did not fail.

    Args:
        records: All records.
        scene: The scene.
        order: Their degree.
        stage: "before" or "during".
        kind: "weights", "gradients" or "surface".
        seconds: "seconds", or "solve_seconds", those without the mesher.
    """
    own = chosen(records, "elements", scene, order=order)
    found = []
    for cells in values_of(own, "cells"):
        (record,) = (record for record in own if record.parameters["cells"] == cells)
        values = record.values[stage]
        if "failed" not in values:
            found.append((values["unknowns"], values[seconds], np.sqrt(values["squared"][kind])))
    return Curve(f"finite elements, P{order}", *np.array(found).reshape(-1, 3).T)


def all_curves(records: Sequence[Record], scene: str, stage: str, kind: str) -> list[Curve]:
    """Return the curves that are drawn together, without empty ones; during a cut those of updates.

    Args:
        records: All records.
        scene: The scene.
        stage: "before" or "during".
        kind: "weights", "gradients" or "surface".
    """
    found = [walk_curve(records, scene, correction, stage, kind) for correction in CORRECTIONS]
    found += [element_curve(records, scene, order, stage, kind) for order in (1, 2)]
    return [curve for curve in found if not curve.empty]

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The sequences of a fingerprint, by name."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from benchmarks import fingerprint_bodies as bodies
from benchmarks import fingerprint_cages as cages
from benchmarks import fingerprint_points as points
from benchmarks.fingerprint_record import Record

_DIMENSIONS = (2, 3)

_BOTH = {
    "plain cut": cages.plain_cut,
    "polygons": cages.polygons,
    "crossing cuts": cages.crossing,
    "turning blade": cages.turning,
    "one leg of a U": cages.one_leg,
    "extension": cages.extension,
    "obstacle": cages.obstacle,
    "random cuts": cages.random_cuts,
    "undo": points.undo,
    "hanging body": bodies.hanging,
    "keyframed body": bodies.keyframed,
}

_SPACE = {"knife": cages.knife, "inner knife": cages.inner_knife, "body and knives": bodies.knives}

_OPTIONS = {
    "none": {"correction": "none"},
    "affine": {"correction": "affine", "bounds": "aabb"},
    "quads harmonic": {"quads": "harmonic", "bounds": "sphere"},
    "dop26": {"bounds": "dop26", "distance": "all"},
    "degree 2": {"degree": 2, "epsilon": 1e-3, "max_steps": 24},
}

_WEIGHTS = {
    "dropped body": bodies.dropped,
    "files": points.files,
    "points": points.points,
    **{f"option {name}": partial(cages.variant, **options) for name, options in _OPTIONS.items()},
}


def _of_both(functions: dict[str, Callable]) -> dict[str, Callable[[Record], None]]:
    """Return sequences of both dimensions."""
    return {
        f"{name}, {dimension}D": partial(function, dimension=dimension)
        for name, function in functions.items()
        for dimension in _DIMENSIONS
    }


_WEIGHT_SEQUENCES = _of_both(_WEIGHTS)

SEQUENCES: dict[str, Callable[[Record], None]] = _of_both(_BOTH) | _SPACE | _WEIGHT_SEQUENCES
"""What records each sequence."""
WEIGHTS_ONLY = frozenset(_WEIGHT_SEQUENCES)
"""Sequences whose integers other sequences have too."""

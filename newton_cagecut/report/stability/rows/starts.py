# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Rows on impossible starts: flat, inverted, squeezed, random, stretched; and time steps that are no time steps."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from ....elastic import Material
from ..outcome import Outcome
from ..text import share
from ..trial import Trial
from ..workbench import CUBE, Workbench

FRAME = 1.0 / 60.0
MODELS = {"neo_hookean": "neo-Hookean", "stvk": "StVK"}
_STILL = "state before"
_NOISE = 1.0e-4
"""Noise on each start, of the size of the body: no symmetry holds it in an equilibrium."""


def scaled(bench: Workbench, model: str, scale: tuple[float, float, float], *, young: float = 1.0e5) -> Outcome:
    """Start with the body scaled about its middle."""
    trial = bench.subject(Material(young=young, damping=0.01, model=model))
    start = trial.positions
    middle, size = start.mean(axis=0), np.ptp(start, axis=0).max()
    noise = _NOISE * size * np.random.default_rng(0).normal(size=start.shape)
    return _let_go(bench, trial, middle + (start - middle) * scale + noise)


def flat_and_undamped(bench: Workbench, model: str) -> Outcome:
    """Start from a plane, exactly, with nothing that takes energy out but the integrator; a cube unless in a scene."""
    material = Material(young=1.0e8, model=model)
    trial = bench.subject(material) if bench.scene else bench.bar(material, segments=1, size=CUBE)
    start = trial.positions
    middle = start.mean(axis=0)
    return _let_go(bench, trial, middle + (start - middle) * (0.0, 1.0, 1.0))


def random(bench: Workbench, model: str) -> Outcome:
    """Start with every vertex anywhere in the body's box."""
    trial = bench.subject(Material(young=1.0e5, damping=0.01, model=model))
    low, high = trial.positions.min(axis=0), trial.positions.max(axis=0)
    return _let_go(bench, trial, np.random.default_rng(0).uniform(low, high, size=trial.positions.shape))


def bad_time_step(bench: Workbench, dt: float) -> Outcome:
    """A step of a length that is none: it is refused, or leaves the body where it was."""
    trial = bench.subject(Material(young=1.0e5))
    start = trial.positions
    middle, size = start.mean(axis=0), np.ptp(start, axis=0).max()
    trial.place(middle + 1.1 * (start - middle), np.cross((0.0, 0.0, 1.0), start - middle))
    start, velocities = trial.positions, trial.velocities
    try:
        trial.step(dt)
    except ValueError:
        return trial.outcome(energy_gain=None, error=0.0, against=_STILL, note="refused with an error")
    changes = np.stack([(trial.positions - start) / size, (trial.velocities - velocities) / size])
    finite = bool(np.isfinite(changes).all())
    change = float(np.abs(changes).max()) if finite else math.inf
    note = "accepted" if finite else "accepted: the state is not finite"
    return trial.outcome(finite=finite, energy_gain=None, error=change, against=_STILL, note=note)


def _let_go(bench: Workbench, trial: Trial, positions: np.ndarray) -> Outcome:
    """Two seconds from rest in these positions; held vertices stay where they are."""
    trial.place(np.where(trial.held[:, None], trial.positions, positions), np.zeros_like(positions))
    trial.run(120, FRAME)
    left = trial.elastic_left()
    note = f"{share(left)} of the elastic energy left" if math.isfinite(left) else ""
    free = not trial.held.any() and bench.scene is None
    return trial.outcome(free=free, recovers=trial.recovered(), note=note)


_STARTS: tuple[tuple[str, Callable[..., Outcome], bool], ...] = (
    ("flat along x", partial(scaled, scale=(0.0, 1.0, 1.0)), True),
    ("flat along x, 1e+08 Pa", partial(scaled, scale=(0.0, 1.0, 1.0), young=1.0e8), True),
    ("flat cube without damping, 1e+08 Pa", flat_and_undamped, True),
    ("flat along z", partial(scaled, scale=(1.0, 1.0, 0.0)), True),
    ("inverted along x", partial(scaled, scale=(-1.0, 1.0, 1.0)), True),
    ("inverted all over", partial(scaled, scale=(-1.0, -1.0, -1.0)), True),
    ("squeezed to a half", partial(scaled, scale=(0.5, 0.5, 0.5)), True),
    ("squeezed to a tenth", partial(scaled, scale=(0.1, 0.1, 0.1)), True),
    ("random", random, True),
    ("stretched tenfold along x", partial(scaled, scale=(10.0, 1.0, 1.0)), True),
    ("stretched tenfold, 1e+08 Pa", partial(scaled, scale=(10.0, 1.0, 1.0), young=1.0e8), False),
)

ROWS: tuple[tuple[str, Callable[[Workbench], Outcome], bool], ...] = (
    *(
        (f"{text}, {name}", partial(run, model=model), quick)
        for name, run, quick in _STARTS
        for model, text in MODELS.items()
    ),
    *(
        (f"time step {text}", partial(bad_time_step, dt=dt), True)
        for text, dt in (("NaN", math.nan), ("infinite", math.inf), ("negative", -FRAME), ("0", 0.0))
    ),
)

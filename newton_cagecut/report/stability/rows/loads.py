# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Rows on extreme loads: drops, gravity, densities, held vertices that are thrown, a long rest."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
import warp as wp

from ....elastic import Material
from ..outcome import Outcome
from ..trial import Trial
from ..workbench import CUBE, Workbench
from .starts import FRAME, MODELS

_HEIGHT = 0.3
"""Height of the lowest vertices above the ground before a drop [m]."""


def drop(bench: Workbench, model: str, speed: float) -> Outcome:
    """A cube thrown onto the ground: it bounces no higher than it came, and is a cube again."""
    material = Material(young=1.0e5, damping=0.01, model=model)
    trial = _above_ground(bench, material, _HEIGHT, speed)
    lowest = [0.0]

    def watch() -> None:
        lowest.append(float(trial.positions[:, 2].min()))

    trial.run(180, FRAME, watch=watch)
    ends = np.linalg.norm(np.ptp(trial.positions, axis=0))
    whole = trial.finite and trial.upright() and abs(ends / np.linalg.norm(CUBE) - 1.0) < 0.1
    return trial.outcome(recovers=bool(whole), note=f"lowest cage vertex at {min(lowest):.3g} m")


def heavy(bench: Workbench, gravity: float, density: float, young: float = 1.0e5) -> Outcome:
    """A clamped bar under its weight, 3 s: finite, and no energy beyond what gravity gives."""
    material = Material(young=young, density=density, damping=0.02)
    trial = bench.bar(material, gravity=(0.0, 0.0, -gravity), fixed=_clamped, key="clamped")
    trial.run(180, FRAME)
    tip = float((trial.positions - trial.rest)[-4:, 2].mean())
    note = f"tip {tip:.3g} m{'' if trial.upright() else ', inside out somewhere'}" if trial.finite else ""
    return trial.outcome(note=note)


def thrown_while_held(bench: Workbench) -> Outcome:
    """A clamped bar is added with a velocity: its clamped end does not move."""
    trial = bench.bar(Material(young=1.0e5), fixed=_clamped, key="thrown", velocity=(0.0, 0.0, 1.0))
    trial.run(60, FRAME)
    moved = float(np.abs(trial.positions - trial.rest)[:4].max())
    note = f"clamped vertices moved by {moved:.3g} m in 1 s at 1 m/s"
    return trial.outcome(energy_gain=None, error=moved, against="no motion", note=note)


def rest(bench: Workbench, steps: int) -> Outcome:
    """A bar lies on the ground, for many steps: it stays there, and at rest."""
    material = Material(young=1.0e5, damping=0.01)
    trial = _above_ground(bench, material, 0.0, 0.0)
    for _ in range(steps // 2):
        trial.step(FRAME)
    settled = trial.positions
    trial.begin()
    trial.run(steps // 2, FRAME)
    moved = float(np.abs(trial.positions - settled).max()) / CUBE[0]
    speed = float(np.abs(trial.velocities).max())
    note = f"fastest vertex {speed:.2g} m/s at the end"
    return trial.outcome(energy_gain=None, error=moved, against="no motion", step_count=steps, note=note)


def _above_ground(bench: Workbench, material: Material, height: float, speed: float) -> Trial:
    """A cube above the ground that is thrown at it."""
    pose = wp.transform((0.0, 0.0, height + 0.5 * CUBE[2]), wp.quat_identity())
    placed = {"key": f"{height} m, {speed} m/s", "xform": pose, "velocity": (0.0, 0.0, -speed)}
    return bench.bar(material, segments=1, size=CUBE, gravity=(0.0, 0.0, -9.81), ground=True, **placed)


def _clamped(vertices: np.ndarray) -> np.ndarray:
    return np.flatnonzero(vertices[:, 0] < 1.0e-6)


ROWS: tuple[tuple[str, Callable[[Workbench], Outcome], bool], ...] = (
    *(
        (f"drop at {speed:g} m/s, {text}", partial(drop, model=model, speed=speed), True)
        for speed in (1.0, 10.0, 100.0)
        for model, text in MODELS.items()
    ),
    ("gravity 1e3 m/s^2", partial(heavy, gravity=1.0e3, density=1.0e3), True),
    ("density 1 kg/m^3", partial(heavy, gravity=9.81, density=1.0), True),
    ("density 1e4 kg/m^3", partial(heavy, gravity=9.81, density=1.0e4), True),
    ("held vertices with a velocity", thrown_while_held, True),
    ("10 000 steps of rest", partial(rest, steps=10_000), False),
)

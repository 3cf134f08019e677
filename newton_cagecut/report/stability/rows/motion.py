# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Rows on bodies that move freely: spinning, tumbling, swinging, falling, against the rigid body's motion."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from ....elastic import Material
from ....section import Blade
from ..answers.book_answers import flip_time, swing
from ..outcome import Outcome
from ..trial import Trial
from ..workbench import CUBE, Workbench

FRAME = 1.0 / 60.0
_TURN = 2.0 * math.pi
_KEPT = "angular momentum at the start"


def spin(bench: Workbench, young: float, rate: float = _TURN, dt: float = FRAME) -> Outcome:
    """A free cube spins for a second; the error is the share of its angular momentum that is lost or won."""
    trial = bench.bar(Material(young=young), segments=1, size=CUBE)
    _spin(trial, (0.0, 0.0, rate))
    return _kept(trial, dt)


def spin_apart(bench: Workbench) -> Outcome:
    """A bar in two pieces, of which one spins fast and the other slowly; the error is the worse one's."""
    trial = bench.bar(Material(young=1.0e6), cuttable=True, quadrature=120)
    cut = trial.solver.begin_cut(0, Blade((0.5, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0)))
    trial.solver.advance_cut(cut, to=cut.length, states=trial.states)
    pieces = [piece.vertices for piece in trial.solver.pieces()]
    rest, velocities = trial.rest, np.zeros_like(trial.rest)
    for vertices, rate in zip(pieces, (_TURN, 1.0), strict=True):
        velocities[vertices] = np.cross((0.0, rate, 0.0), rest[vertices] - rest[vertices].mean(axis=0))
    trial.place(rest, velocities)
    start = [trial.angular_momentum(vertices) for vertices in pieces]
    trial.run(60, FRAME)
    kept = [trial.angular_momentum(v) @ s / (s @ s) for v, s in zip(pieces, start)]
    note = ", ".join(f"{100 * share:.1f} %" for share in kept) + " kept"
    error = max(abs(share - 1.0) for share in kept)
    return trial.outcome(free=True, error=error, against=_KEPT, note=note)


def draw_in(bench: Workbench) -> Outcome:
    """A spinning bar that was stretched by half draws in and turns faster: its angular momentum stays."""
    trial = bench.bar(Material(young=1.0e5), segments=2)
    center = trial.center()
    stretched = center + (trial.rest - center) * (1.5, 1.0, 1.0)
    trial.place(stretched, np.cross((0.0, 0.0, _TURN), stretched - center))
    return _kept(trial, FRAME)


def tumble(bench: Workbench) -> Outcome:
    """A box that spins about its middle axis flips over when the rigid box does."""
    trial = bench.bar(Material(young=1.0e7), segments=1, size=(0.5, 0.3, 0.2))
    rate = np.array([0.05, 5.0, 0.0])
    _spin(trial, rate)
    rest, center, masses = trial.rest, trial.center(), trial.masses()[0]
    arms = rest - center
    tensor = np.einsum("ij,ia,ja->", masses, arms, arms) * np.eye(3) - np.einsum("ij,ia,jb->ab", masses, arms, arms)
    expected = flip_time(np.diagonal(tensor), rate)
    times, middle = [0.0], [rate[1]]

    def watch() -> bool:
        times.append(times[-1] + FRAME)
        middle.append((_rotation(arms, trial.positions).T @ trial.angular_momentum())[1] / tensor[1, 1])
        return middle[-1] < 0.0

    trial.run(math.ceil(1.5 * expected / FRAME), FRAME, watch=watch)
    found = _crossing(times, middle)
    note = f"{found:.3f} s, rigid {expected:.3f} s" if math.isfinite(found) else f"no flip, rigid {expected:.3f} s"
    return trial.outcome(free=True, error=abs(found / expected - 1.0), against="rigid flip time", note=note)


def pendulum(bench: Workbench, young: float) -> Outcome:
    """A bar hinged along an edge at its end swings down; the error is the worse one of time and speed at the bottom."""
    material = Material(young=young)
    trial = bench.bar(material, segments=1, gravity=(0.0, 0.0, -9.81), fixed=_upper_edge, key="hinge")
    masses, hinge = trial.vertex_masses(), trial.rest[_upper_edge(trial.rest)].mean(axis=0)
    expected, expected_speed = swing(np.array([0.5, -0.1]), (1.0 + 0.04) / 12.0, 9.81)
    times, across, speeds = [0.0], [0.5], [0.0]

    def watch() -> bool:
        times.append(times[-1] + FRAME)
        across.append((masses @ trial.positions / masses.sum() - hinge)[0])
        speeds.append(np.linalg.norm(masses @ trial.velocities) / masses.sum())
        return across[-1] < 0.0

    trial.run(240, FRAME, watch=watch)
    found = _crossing(times, across)
    speed = np.interp(found, times, speeds) if math.isfinite(found) else 0.0
    error = max(abs(found / expected - 1.0), abs(speed / expected_speed - 1.0))
    note = f"{found:.3f} s and {speed:.2f} m/s, rigid {expected:.3f} s and {expected_speed:.2f} m/s"
    return trial.outcome(error=float(error), against="rigid pendulum", note=note)


def fall(bench: Workbench) -> Outcome:
    """A bar falls for a second, against g t^2 / 2."""
    trial = bench.bar(Material(young=1.0e6), gravity=(0.0, 0.0, -9.81))
    start = trial.center()
    trial.run(60, FRAME)
    depth = (start - trial.center())[2]
    expected = 0.5 * 9.81
    note = f"{depth:.4f} m; backward Euler falls {expected * (1.0 + FRAME):.4f} m"
    return trial.outcome(free=True, error=abs(depth / expected - 1.0), against="g t^2 / 2", note=note)


def _upper_edge(vertices: np.ndarray) -> np.ndarray:
    """Vertices of the upper edge at the bar's start."""
    return np.flatnonzero((vertices[:, 0] < 1.0e-6) & (vertices[:, 2] > 0.0))


def _spin(trial: Trial, rate: np.ndarray) -> None:
    trial.place(velocities=np.cross(rate, trial.positions - trial.center()))


def _kept(trial: Trial, dt: float) -> Outcome:
    """A second of a spinning body."""
    start = trial.angular_momentum()
    trial.run(round(1.0 / dt), dt)
    kept = float(trial.angular_momentum() @ start / (start @ start))
    return trial.outcome(free=True, error=abs(kept - 1.0), against=_KEPT, note=f"{100.0 * kept:.1f} % kept")


def _rotation(arms: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """The rotation that brings arms nearest to positions about their middle."""
    u, _, vt = np.linalg.svd((positions - positions.mean(axis=0)).T @ arms)
    return u @ np.diag((1.0, 1.0, np.linalg.det(u @ vt))) @ vt


def _crossing(times: list[float], values: list[float]) -> float:
    """When values first fall below zero, infinity if never."""
    if values[-1] >= 0.0:
        return math.inf
    share = values[-2] / (values[-2] - values[-1])
    return times[-2] + share * (times[-1] - times[-2])


ROWS: tuple[tuple[str, Callable[[Workbench], Outcome], bool], ...] = (
    *((f"spin, {young:.0e} Pa", partial(spin, young=young), young < 1.0e9) for young in (1.0e4, 1.0e6, 1.0e8, 1.0e9)),
    ("spin, 1 rad/s, 1e+08 Pa", partial(spin, young=1.0e8, rate=1.0), False),
    ("spin, 10 rad/s, 1e+08 Pa", partial(spin, young=1.0e8, rate=10.0), False),
    ("spin of two pieces", spin_apart, True),
    ("spin while it draws in", draw_in, True),
    ("tumbling about the middle axis", tumble, False),
    ("pendulum, 1e+08 Pa", partial(pendulum, young=1.0e8), True),
    ("pendulum, 1e+09 Pa", partial(pendulum, young=1.0e9), False),
    ("free fall", fall, True),
)

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Time integrators as lists of implicit stages.

A stage of scale k minimises |x - target|_M^2 / 2 - impulse . x + k^2 Psi(x). With s the displacement since the start of
the step, r that which the stage before has reached, v the velocity at the start, and a the acceleration there:

- backward Euler: one stage, k = dt, target dt v, velocity s / k at the end;
- TR-BDF2 (Bank et al. 1985), with k = (1 - 1 / sqrt 2) dt: the trapezoidal rule over 2 k, target 2 k v + k^2 a and
  velocity s / k - v at its end; then the two-step backward formula to dt, target 2 w r - sqrt(2) k v and velocity
  (s - w r) / k, where w = (1 + sqrt 2) / 2.

TR-BDF2 takes one step's state and no history, so that a state can be set, swapped and cut at any time; it is of second
order, and damps what it cannot resolve. Of the L-stable one-step methods that were measured it alone keeps the spin
of a stiff body: two- and three-stage SDIRK lose 40 % of it in a second at 10 rad/s, since their first stage is of first
order; the two-step formula alone loses 5 %, and needs history.

Damping and further terms act at the end of a stage alone: they take the trapezoidal rule's whole impulse there.

A step in which something touches the body is made of two halves of backward Euler. Contact is found late, up to a step
deep, and its stiffness is seldom resolved: out of that depth TR-BDF2 makes up to six times the energy of the blow: its
two-step formula goes on with the velocity from before it. Backward Euler drives a point out no faster than it takes
the depth in half a step, and damps the rest.
"""

from __future__ import annotations

import math
from typing import NamedTuple


class Stage(NamedTuple):
    """The factors of one stage, for a time step of 1 s."""

    scale: float
    """k [s]."""
    target_velocity: float
    """Factor of v in the target [s]."""
    target_reached: float
    """Factor of r in the target."""
    velocity_kept: float
    """Factor of v in what the end velocity lacks of s / k."""
    velocity_reached: float
    """Factor of r in that [1/s]."""
    force_share: float
    """Constant forces and further terms, in k^2."""
    damping_share: float
    """Damping, in k, over that of the mean rate of strain in the stage."""
    start_share: float
    """Factor of the forces at the start."""


_SCALE = 1.0 - math.sqrt(0.5)
_WEIGHT = 0.5 * (1.0 + math.sqrt(2.0))

BACKWARD_EULER_STEP = (Stage(1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0),)
"""Backward Euler."""

BACKWARD_EULER_HALVES = (
    Stage(0.5, 0.5, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0),
    Stage(0.5, 0.0, 2.0, 0.0, 2.0, 1.0, 1.0, 0.0),
)
"""Two steps of backward Euler, each over half of the time."""

TR_BDF2 = (
    Stage(_SCALE, 2.0 * _SCALE, 0.0, 1.0, 0.0, 2.0, 1.0, 1.0),
    Stage(_SCALE, -math.sqrt(2.0) * _SCALE, 2.0 * _WEIGHT, 0.0, _WEIGHT / _SCALE, 1.0, math.sqrt(0.5), 0.0),
)
"""The trapezoidal rule, then the two-step backward formula."""


class Scheme(NamedTuple):
    """The stages of a step, as many of either kind."""

    free: tuple[Stage, ...]
    """Where nothing touches the body."""
    touched: tuple[Stage, ...]
    """Where something does."""


SCHEMES = {
    "tr_bdf2": Scheme(TR_BDF2, BACKWARD_EULER_HALVES),
    "backward_euler": Scheme(BACKWARD_EULER_STEP, BACKWARD_EULER_STEP),
}
"""The stages by the integrator's name."""


class StageCourse(NamedTuple):
    """What follows for a stage from all of its scheme, for a time step of 1 s."""

    end_time: float
    """When it ends, counted from the start of the step [s]."""
    impulse_share: float
    """How long a force at its end acts in the step: its share in the velocity at the end of the step [s]."""


def courses_of(scheme: tuple[Stage, ...]) -> tuple[StageCourse, ...]:
    """The courses of a scheme's stages: where free flight at 1 m/s is, and what a force in one stage does to a mass."""
    courses = []
    for stage in range(len(scheme)):
        _, flown = _displacement(scheme[: stage + 1], velocity=1.0, forced=None)
        velocity, _ = _displacement(scheme, velocity=0.0, forced=stage)
        courses.append(StageCourse(flown, velocity))
    return tuple(courses)


def _displacement(scheme: tuple[Stage, ...], *, velocity: float, forced: int | None) -> tuple[float, float]:
    """Velocity and displacement of a mass of 1 kg at the end, which a force of 1 N acts on in one stage."""
    reached, speed = 0.0, velocity
    for number, stage in enumerate(scheme):
        moved = stage.target_velocity * velocity + stage.target_reached * reached
        if number == forced:
            moved += stage.force_share * stage.scale**2
        speed = moved / stage.scale - stage.velocity_kept * velocity - stage.velocity_reached * reached
        reached = moved
    return speed, reached

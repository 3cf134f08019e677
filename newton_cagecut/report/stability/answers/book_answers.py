# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The answers that rows are measured against: rigid bodies and Timoshenko's beams."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.linalg

SHEAR_FACTOR = 5.0 / 6.0
"""Timoshenko's factor for a rectangle."""


def swing(arm: np.ndarray, inertia: float, gravity: float) -> tuple[float, float]:
    """Time [s] that a rigid pendulum takes from rest to the bottom, and the speed of its centre there [m/s].

    Args:
        arm: From the hinge to the centre of mass, across and up [m].
        inertia: Moment of inertia about the centre, over the mass [m^2].
        gravity: Gravity [m/s^2].
    """
    length = float(np.linalg.norm(arm))
    rate = gravity * length / (inertia + length**2)
    state, time, dt = np.array([np.arctan2(arm[1], arm[0]), 0.0]), 0.0, 1.0e-3
    while True:
        new = _advanced(lambda s: np.array([s[1], -rate * np.cos(s[0])]), state, dt)
        if new[0] < -0.5 * np.pi:
            share = (state[0] + 0.5 * np.pi) / (state[0] - new[0])
            return time + share * dt, length * abs(state[1] + share * (new[1] - state[1]))
        state, time = new, time + dt


def flip_time(inertia: np.ndarray, rate: np.ndarray) -> float:
    """Time after which a free rigid body turns about its second axis the other way round [s].

    Args:
        inertia: Principal moments of inertia, shape (3,).
        rate: Angular velocity in the body's frame [rad/s], shape (3,).
    """
    state, time, dt = np.asarray(rate, dtype=float), 0.0, 1.0e-3
    while state[1] > 0.0 and time < 1.0e3:
        state = _advanced(lambda w: -np.cross(w, inertia * w) / inertia, state, dt)
        time += dt
    return time


def tip_deflection(force: float, *, size: tuple[float, float, float], young: float, poisson: float) -> float:
    """How far a force at the free end bends a clamped bar along its height [m], by Timoshenko."""
    length, width, height = size
    inertia, shear = width * height**3 / 12.0, young / (2.0 * (1.0 + poisson))
    return force * length**3 / (3.0 * young * inertia) + force * length / (SHEAR_FACTOR * shear * width * height)


def bending_mode(
    size: tuple[float, float, float], young: float, poisson: float, density: float, *, elements: int = 200
) -> tuple[float, np.ndarray, np.ndarray]:
    """The first bending mode of a free bar, by Timoshenko: frequency [Hz], deflection and turn at the nodes."""
    length, width, height = size
    area, inertia, h = width * height, width * height**3 / 12.0, length / elements
    shear = SHEAR_FACTOR * area * young / (2.0 * (1.0 + poisson))
    stiffness, mass = (np.zeros((2 * elements + 2, 2 * elements + 2)) for _ in range(2))
    bend = np.array([0.0, -1.0, 0.0, 1.0]) / h
    slide = np.array([-1.0 / h, -0.5, 1.0 / h, -0.5])  # one point: no locking
    local = h * (young * inertia * np.outer(bend, bend) + shear * np.outer(slide, slide))
    weights = np.kron(h / 6.0 * np.array([[2.0, 1.0], [1.0, 2.0]]), density * np.diag([area, inertia]))
    for first in range(0, 2 * elements, 2):
        stiffness[first : first + 4, first : first + 4] += local
        mass[first : first + 4, first : first + 4] += weights
    squares, modes = scipy.linalg.eigh(stiffness, mass, subset_by_index=(2, 2))
    return float(np.sqrt(squares[0])) / (2.0 * np.pi), modes[0::2, 0], modes[1::2, 0]


def _advanced(slope: Callable[[np.ndarray], np.ndarray], state: np.ndarray, dt: float) -> np.ndarray:
    """One step of the classical Runge-Kutta method."""
    first = slope(state)
    second = slope(state + 0.5 * dt * first)
    third = slope(state + 0.5 * dt * second)
    fourth = slope(state + dt * third)
    return state + dt / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The limits of every row: those of the longest key that its name begins with."""

from __future__ import annotations

from .outcome import Limits

_GAIN, _DRIFT = 1.0e-3, 1.0e-3

LIMITS: dict[str, Limits | None] = {
    "map": Limits(energy_gain=_GAIN),
    # Motion, against rigid bodies.
    "spin": Limits(energy_gain=_GAIN, momentum_drift=_DRIFT, error=0.02),
    "tumbling": Limits(energy_gain=_GAIN, momentum_drift=_DRIFT, error=0.02),
    "pendulum": Limits(energy_gain=_GAIN, error=0.02),
    "free fall": Limits(energy_gain=_GAIN, momentum_drift=_DRIFT, error=0.02),
    # Starts. StVK has other stationary points than rest, so it need not come back.
    "neo-Hookean": Limits(energy_gain=_GAIN, momentum_drift=_DRIFT, recovers=True),
    "StVK": Limits(energy_gain=_GAIN, momentum_drift=_DRIFT),
    "time step": Limits(error=0.0),
    # Loads.
    "drop": Limits(energy_gain=_GAIN, recovers=True),
    "gravity": Limits(energy_gain=_GAIN),
    "density": Limits(energy_gain=_GAIN),
    "held vertices": Limits(error=1.0e-6),
    "10 000 steps of rest": Limits(error=1.0e-5),
    # Cuts.
    "cut, stretched 3 times": Limits(energy_gain=0.01, error=0.01),
    "cut, stretched 3 times, 2 segments": Limits(energy_gain=0.05, error=0.05),
    "cut while spinning": Limits(energy_gain=_GAIN, momentum_drift=_DRIFT, error=1.0e-4),
    "cut while falling": Limits(momentum_drift=_DRIFT, error=1.0e-4),
    "sliver": Limits(energy_gain=_GAIN, momentum_drift=_DRIFT, error=0.01),
    "mass ratio": Limits(energy_gain=_GAIN, momentum_drift=_DRIFT, error=0.01),
    "tip": Limits(energy_gain=_GAIN, momentum_drift=_DRIFT),
    # Small deformations, against beams and finite elements.
    "cantilever": Limits(error=0.10),
    "cantilever, 16 segments": Limits(error=0.05),
    "torsion": Limits(error=0.10),
    "bracket": Limits(error=0.10),
    "axial frequency": Limits(error=0.05),
    "bending frequency": Limits(error=0.05),
    "edge crack": Limits(error=0.10),
    "edge crack, 16 segments": Limits(error=0.05),
    # Other solvers, and error against time, are measured, not judged.
    "SolverVBD": None,
    "SolverXPBD": None,
    "SolverCageCut": None,
}


def limits_of(name: str) -> Limits | None:
    """The limits of a row.

    Args:
        name: The row's name.

    Raises:
        KeyError: The table has none for it.
    """
    keys = [key for key in LIMITS if name.startswith(key)]
    if not keys:
        raise KeyError(f"no limits for the row {name!r}: add a line to LIMITS")
    return LIMITS[max(keys, key=len)]

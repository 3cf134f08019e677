# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The options of harmonic coordinates, checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace

import numpy as np
import warp as wp

from ..cage import Cage
from ..geometry import as_choice, as_instance, is_number, shown
from .correction_choice import chosen_correction

BOUNDS = ("dop18", "dop26", "aabb", "sphere")
CORRECTIONS = ("harmonic", "affine", "none", "fitted", "auto")
"""What can be asked for; in the place of "auto" stands one of the others before anything is walked."""
DISTANCES = ("grid", "all")
QUADS = ("mean_value", "harmonic")


@dataclass(frozen=True)
class WalkOptions:
    """Options of the walks and of the resolve; see ``HarmonicCoordinates``. Those of the domain are its own.

    Raises:
        ValueError: A value is out of its range; the message names the range.
    """

    walks: int
    seed: int
    correction: str = "harmonic"
    bounds: str = "dop18"
    epsilon: float = 1.0e-4
    max_steps: int = 256
    degree: int = 3

    def __post_init__(self) -> None:
        as_choice(self.correction, CORRECTIONS, "correction")
        as_choice(self.bounds, BOUNDS, "bounds")
        for name, low, high in (
            ("walks", 0 if self.correction in ("fitted", "auto") else 1, 1 << 24),
            ("seed", 0, (1 << 32) - 1),
            ("max_steps", 1, 1 << 16),
            ("degree", 1, 3),
        ):
            value = getattr(self, name)
            whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
            if not whole or not low <= value <= high:
                raise ValueError(f"{name} must be a whole number from {low} to {high}, not {shown(value)}")
        if not is_number(self.epsilon) or not 1.0e-6 <= float(self.epsilon) <= 0.1:
            raise ValueError(f"epsilon must lie between 1e-6 and 0.1 (relative to the cage), not {shown(self.epsilon)}")

    def chosen_for(self, cage: Cage) -> WalkOptions:
        """These options with a correction that suits a cage in the place of "auto".

        Args:
            cage: The cage.
        """
        return replace(self, correction=chosen_correction(self.correction, cage))


def as_device(device: wp.context.Devicelike) -> wp.Device:
    """The device that was named; Warp's current one for None.

    Args:
        device: What was passed.

    Raises:
        TypeError: It names none.
        ValueError: There is no such device.
    """
    if device is not None:
        as_instance(device, (str, wp.Device), "device", hint='"cpu" or "cuda:0" names one')
    try:
        return wp.get_device(device)
    except (ValueError, RuntimeError):
        there = ", ".join(one.alias for one in wp.get_devices())
        raise ValueError(f"device {device!r} is not there; Warp has {there}") from None


def check_options(options: Mapping[str, object], owner: str) -> None:
    """Refuse what coordinates would refuse, before there are any.

    Args:
        options: Keyword options of ``HarmonicCoordinates`` that say how it walks and resolves, walks and seed included.
        owner: What takes the options, for the error.

    Raises:
        TypeError: There is no such option.
        ValueError: A value is out of its range.
    """
    choices = {"distance": DISTANCES, "quads": QUADS}
    known = [field.name for field in fields(WalkOptions)] + list(choices)
    unknown = [name for name in options if name not in known]
    if unknown:
        raise TypeError(f"{owner} has no option {', '.join(unknown)}; options of the weights are {', '.join(known)}")
    for name, values in choices.items():
        if options.get(name) is not None:
            as_choice(options[name], values, name)
    WalkOptions(**{name: value for name, value in options.items() if name not in choices})

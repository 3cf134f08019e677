# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The options of harmonic coordinates, checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np

BOUNDS = ("dop18", "dop26", "aabb", "sphere")
CORRECTIONS = ("harmonic", "affine", "none", "fitted")
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
        require_choice("correction", self.correction, CORRECTIONS)
        require_choice("bounds", self.bounds, BOUNDS)
        for name, low, high in (
            ("walks", 0 if self.correction == "fitted" else 1, 1 << 24),
            ("seed", 0, (1 << 32) - 1),
            ("max_steps", 1, 1 << 16),
            ("degree", 1, 3),
        ):
            value = getattr(self, name)
            if not isinstance(value, (int, np.integer)) or not low <= value <= high:
                raise ValueError(f"{name} must be a whole number from {low} to {high}, not {value!r}")
        if not isinstance(self.epsilon, (int, float, np.number)) or not 1.0e-6 <= self.epsilon <= 0.1:
            raise ValueError(f"epsilon must lie between 1e-6 and 0.1 (relative to the cage), not {self.epsilon!r}")


def require_choice(name: str, value: str, choices: tuple[str, ...]) -> None:
    """Refuse a value that is none of the choices.

    Args:
        name: Name of the option.
        value: Its value.
        choices: The values that there are.

    Raises:
        ValueError: The value is another one.
    """
    if value not in choices:
        raise ValueError(f"{name} must be one of {', '.join(choices)}, not {value!r}")


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
            require_choice(name, options[name], values)
    WalkOptions(**{name: value for name, value in options.items() if name not in choices})

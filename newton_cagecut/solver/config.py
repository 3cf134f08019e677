# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""``SolverCageCut.Config``: how exactly the solver solves."""

from __future__ import annotations

import math
import operator
from dataclasses import dataclass, fields, replace


@dataclass(frozen=True, kw_only=True)
class Config:
    """Configuration of :class:`SolverCageCut`, the same for all its bodies.

    Raises:
        TypeError: If a value is not a number, or a count not a whole one.
        ValueError: If a value is out of its range.
    """

    max_iterations: int = 150
    """Most iterations of a step's linear solve; at least 1."""

    tolerance: float = 1.0e-5
    """Factor by which a step's linear solve shrinks the preconditioned residual, in (0, 1)."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "max_iterations", _as_count("max_iterations", self.max_iterations))
        object.__setattr__(self, "tolerance", _as_number("tolerance", self.tolerance))
        if self.max_iterations < 1:
            raise ValueError(f"SolverCageCut max_iterations is {self.max_iterations}; it must be at least 1.")
        if not 0.0 < self.tolerance < 1.0:
            raise ValueError(
                f"SolverCageCut tolerance is {self.tolerance}; it must lie in (0, 1): 1e-5 is the default, larger is "
                "faster."
            )

    @classmethod
    def of(cls, config: Config | None, options: dict[str, object]) -> Config:
        """The configuration that a solver's arguments ask for; options override the fields of ``config``.

        Raises:
            TypeError: If ``config`` is not a configuration, or there is no such option.
            ValueError: If a value is out of its range.
        """
        if config is None:
            config = cls()
        if not isinstance(config, cls):
            raise TypeError(
                f"SolverCageCut config is a {type(config).__name__}; it must be a SolverCageCut.Config, or be left out."
            )
        known = [field.name for field in fields(cls)]
        unknown = [name for name in options if name not in known]
        if unknown:
            raise TypeError(f"SolverCageCut has no option {', '.join(unknown)}; there are {', '.join(known)}.")
        return replace(config, **options)


def _as_count(name: str, value: int) -> int:
    """One value as an integer."""
    try:
        if isinstance(value, bool):
            raise TypeError("a truth value is no count")
        return operator.index(value)
    except TypeError as error:
        raise TypeError(f"SolverCageCut {name} is {value!r}; it must be an integer.") from error


def _as_number(name: str, value: float) -> float:
    """One value as a finite float."""
    try:
        if isinstance(value, bool | str):
            raise TypeError("neither truth values nor text are numbers")
        number = float(value)
    except (TypeError, ValueError) as error:
        raise TypeError(f"SolverCageCut {name} is {value!r}; it must be a number.") from error
    if not math.isfinite(number):
        raise ValueError(f"SolverCageCut {name} is {number}; it must be finite.")
    return number

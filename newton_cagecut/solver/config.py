# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""``SolverCageCut.Config``: how exactly the solver solves."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

from ..elastic import INTEGRATORS, SolveLimits
from ..geometry import as_choice, as_index, as_number
from .live.foreign_rows import FOREIGN_ROWS

_MOST_ITERATIONS = 1 << 30
_CONTACTS = ("penalty", "firm")

STRAINS = ("points", "averaged")
"""Where strain can be taken."""


@dataclass(frozen=True, kw_only=True)
class Config:
    """Configuration of :class:`SolverCageCut`, the same for all its bodies.

    Raises:
        TypeError: If a value is not a number, or a count not a whole one.
        ValueError: If a value is out of its range.
    """

    integrator: str = "tr_bdf2"
    """How time goes on: ``"tr_bdf2"``, of second order, which keeps spin and vibrations; ``"backward_euler"``, of first
    order, which damps both; or ``"paper"``, a single Newton step of it from the start positions (paper, section 6.1),
    which damps rotation the more, the stiffer the body."""

    newton_iterations: int = 1
    """Linear solves in each implicit stage (``"tr_bdf2"`` has two of these); at least 1, and 1 with ``"paper"``."""

    max_iterations: int = 150
    """Most iterations of a step's linear solve; at least 1."""

    tolerance: float = 1.0e-5
    """Factor by which a step's linear solve shrinks the preconditioned residual, in (0, 1)."""

    foreign: str = "copy"
    """What a step does with rows of ``state_out`` that are not of cage bodies, such as rigid bodies and particles:
    ``"copy"`` them from ``state_in``, or ``"keep"`` those that another solver has written before."""

    contact: str = "penalty"
    """How shapes push: ``"penalty"``, with the stiffness that body and shape have; or ``"firm"``, as much stiffer in an
    impact as stops it within the contact radius, from when the gap is closed by the end of the step; give the pipeline
    ``soft_contact_gap=speed * dt`` to look as far ahead. Firm contacts rub as Coulomb says and hold what rests."""

    dense_vertices: int | None = None
    """Most vertices of a cage, when the solver is made, whose solves have a dense factor of the matrix, at least 0;
    larger ones have the inverses of its diagonal blocks. None for what was measured to pay: 110, or 300 for Poisson's
    ratios from 0.45 on, whose solves without a factor miss the tolerance."""

    strain: str = "points"
    """Where strain is taken: at the ``"points"`` of the quadrature, or ``"averaged"`` over clusters of them, which
    locks far less in bending and near incompressibility; see ``docs/locking.md``."""

    def __post_init__(self) -> None:
        as_choice(self.foreign, tuple(FOREIGN_ROWS), "SolverCageCut foreign")
        as_choice(self.contact, _CONTACTS, "SolverCageCut contact")
        as_choice(self.integrator, tuple(INTEGRATORS), "SolverCageCut integrator")
        as_choice(self.strain, STRAINS, "SolverCageCut strain")
        iterations = as_index(self.newton_iterations, "SolverCageCut newton_iterations")
        object.__setattr__(self, "newton_iterations", iterations)
        if iterations < 1:
            raise ValueError(f"SolverCageCut newton_iterations must be at least 1, got {iterations}")
        if iterations > 1 and self.integrator == "paper":
            raise ValueError(f"SolverCageCut newton_iterations must be 1 with integrator='paper', got {iterations}")
        object.__setattr__(self, "max_iterations", as_index(self.max_iterations, "SolverCageCut max_iterations"))
        object.__setattr__(self, "tolerance", as_number(self.tolerance, "SolverCageCut tolerance"))
        if self.max_iterations < 1:
            raise ValueError(f"SolverCageCut max_iterations must be at least 1, got {self.max_iterations}")
        if max(iterations, self.max_iterations) > _MOST_ITERATIONS:
            name = "max_iterations" if self.max_iterations > _MOST_ITERATIONS else "newton_iterations"
            raise ValueError(f"SolverCageCut {name} must be at most {_MOST_ITERATIONS}, got {getattr(self, name)}")
        if self.dense_vertices is not None:
            object.__setattr__(self, "dense_vertices", as_index(self.dense_vertices, "SolverCageCut dense_vertices"))
            if self.dense_vertices < 0:
                raise ValueError(f"SolverCageCut dense_vertices must be at least 0, got {self.dense_vertices}")
        if not 0.0 < self.tolerance < 1.0:
            raise ValueError(f"SolverCageCut tolerance must lie in (0, 1), got {self.tolerance}: larger is faster")

    @property
    def limits(self) -> SolveLimits:
        """How exactly linear systems are solved."""
        return SolveLimits(self.max_iterations, self.tolerance, self.dense_vertices)

    @property
    def system_options(self) -> dict[str, object]:
        """What the elastic system of a body is made with."""
        return {
            "averaged": self.strain == "averaged",
            "integrator": self.integrator,
            "newton_iterations": self.newton_iterations,
            "limits": self.limits,
        }

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
                f"SolverCageCut config must be a SolverCageCut.Config, or be left out, got a {type(config).__name__}"
            )
        known = [field.name for field in fields(cls)]
        unknown = [name for name in options if name not in known]
        if unknown:
            raise TypeError(f"SolverCageCut has no option {', '.join(unknown)}; there are {', '.join(known)}")
        return replace(config, **options)

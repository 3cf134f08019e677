# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Materials: the constants of an isotropic hyperelastic solid (paper, section 6.1; Smith et al. 2018)."""

from __future__ import annotations

from dataclasses import dataclass, fields

from ..geometry import as_finite
from .constitutive import CONSTITUTIVE_MODELS, ConstitutiveModel, register

_LEAST_POISSON = -0.85
"""Below this the neo-Hookean model has a place between rest and a point where a uniform squeeze stays."""


@dataclass(frozen=True, kw_only=True)
class Material:
    """An isotropic hyperelastic material.

    Args:
        young: Young's modulus [Pa].
        poisson: Poisson's ratio, in (-1, 0.5), of the neo-Hookean model at least -0.85; negative for a material that
            widens when it is pulled.
        density: Rest density [kg/m^3].
        damping: Rayleigh damping proportional to the stiffness [s].
        model: ``"neo_hookean"`` (recovers from being inverted or crushed), ``"stvk"`` (Saint Venant-Kirchhoff, the
            paper's, which inverts under strong compression), ``"corotational"`` (linear in the stretches), or a
            :class:`ConstitutiveModel`, whose derivatives are checked, and of which the name is kept. Of all of them
            small strains are exactly those of Young's modulus and Poisson's ratio.

    Raises:
        TypeError: If a constant is not a number, or the model neither a name nor a model.
        ValueError: If a constant is out of its range, the model is unknown, or its derivatives are wrong.
    """

    young: float = 1.0e5
    poisson: float = 0.4
    density: float = 1000.0
    damping: float = 0.0
    model: str | ConstitutiveModel = "neo_hookean"

    def __post_init__(self) -> None:
        for field in fields(self):
            if field.name != "model":
                object.__setattr__(self, field.name, as_finite(getattr(self, field.name), f"Material {field.name}"))
        if self.young <= 0.0:
            raise ValueError(f"Material young is {self.young} Pa; it must be positive.")
        if not -1.0 < self.poisson < 0.5:
            raise ValueError(
                f"Material poisson is {self.poisson}; it must lie in (-1, 0.5). Use 0.49 for a nearly "
                "incompressible material."
            )
        if isinstance(self.model, str) and self.model == "neo_hookean" and self.poisson < _LEAST_POISSON:
            raise ValueError(
                f"Material poisson is {self.poisson}; with the model 'neo_hookean' it must be at least "
                f"{_LEAST_POISSON}, below which a squeezed body can stay squeezed. Use 'corotational'."
            )
        if self.density <= 0.0:
            raise ValueError(f"Material density is {self.density} kg/m^3; it must be positive.")
        if self.damping < 0.0:
            raise ValueError(f"Material damping is {self.damping} s; it must not be negative.")
        if isinstance(self.model, ConstitutiveModel):
            register(self.model)
            object.__setattr__(self, "model", self.model.name)
        if not isinstance(self.model, str):
            raise TypeError(f"Material model is {self.model!r}; it must be a name or a ConstitutiveModel.")
        if self.model not in CONSTITUTIVE_MODELS:
            names = ", ".join(map(repr, CONSTITUTIVE_MODELS))
            raise ValueError(f"Material model is {self.model!r}; choose one of {names}, or give a ConstitutiveModel.")

    @property
    def lame(self) -> tuple[float, float]:
        """Lame's constants (mu, lambda) [Pa]; mu is the shear modulus."""
        mu = self.young / (2.0 * (1.0 + self.poisson))
        return mu, self.young * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson))

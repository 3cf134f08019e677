# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The constitutive models by name."""

from __future__ import annotations

from .check import check_model
from .corotational import COROTATIONAL
from .model import ConstitutiveModel
from .neo_hookean import NEO_HOOKEAN
from .stvk import STVK

CONSTITUTIVE_MODELS = {model.name: model for model in (NEO_HOOKEAN, STVK, COROTATIONAL)}
"""The models by name, those registered later included."""


def register(model: ConstitutiveModel) -> None:
    """Make a model known by its name, once its derivatives were checked by finite differences.

    Args:
        model: The model; nothing happens if it is known already.

    Raises:
        ValueError: If a derivative is wrong, rest is not free of stress, the model is not isotropic, its small strains
            are not those of Lame's constants, or another model has its name.
    """
    known = CONSTITUTIVE_MODELS.get(model.name)
    if known is model:
        return
    if known is not None:
        raise ValueError(f"There is another constitutive model named {model.name!r}. Choose another name.")
    check_model(model)
    CONSTITUTIVE_MODELS[model.name] = model

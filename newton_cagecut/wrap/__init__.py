# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Coarse cages around meshes; needs the extra ``wrap``."""

from .wrap import wrap_cage

__all__ = ["wrap_cage"]

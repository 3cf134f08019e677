# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Surfaces that a cage carries, and their cuts."""

from .cut import SurfaceCut, SurfaceEdit
from .surface import Surface

__all__ = ["Surface", "SurfaceCut", "SurfaceEdit"]

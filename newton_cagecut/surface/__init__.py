# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Surfaces that a cage carries, and their cuts."""

from .surface import Surface
from .surface_cut import SurfaceCut, SurfaceEdit

__all__ = ["Surface", "SurfaceCut", "SurfaceEdit"]

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Layers of charges and dipoles on panels, and the densities with which they meet given values."""

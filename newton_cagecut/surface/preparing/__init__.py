# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Meshes as users bring them, made fit to be cut: seams, sheets, open edges."""

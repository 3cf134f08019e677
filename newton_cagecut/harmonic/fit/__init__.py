# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A boundary fit of all harmonic coordinates at once: layers of panels, and the densities that meet the boundary."""

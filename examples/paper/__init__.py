# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Scenes after those of the paper: its figures 11, 12 and 16 to 19."""

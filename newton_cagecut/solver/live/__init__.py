# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What a Newton user does to a running solver: resets, live edits, prescribed motion, mixed scenes."""

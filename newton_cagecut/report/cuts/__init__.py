# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What cuts do to walks: the figures of section 7 of the paper, of any scene."""

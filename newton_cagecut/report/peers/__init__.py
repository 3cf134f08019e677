# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What a user would take instead: finite elements, meshed and solved anew at each step of a cut."""

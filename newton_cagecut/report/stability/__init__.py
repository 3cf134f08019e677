# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The command ``stability``: extreme cases, exact answers and a map of stiffness against time step."""

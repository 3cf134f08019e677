# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What the method does on a scene, measured: the commands that write pages, and `run`. No other room knows this one."""

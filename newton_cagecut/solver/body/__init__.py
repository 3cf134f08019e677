# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""A body in a solver: what it is made of, what it holds on the device, and how users see it."""

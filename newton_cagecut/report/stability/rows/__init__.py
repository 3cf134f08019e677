# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The rows, by subject: each file has a table of names, measurements and whether the quick run has them."""

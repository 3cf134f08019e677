# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Moving pictures of the scenes: ``python -m examples.gallery`` renders them."""

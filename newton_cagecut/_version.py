# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The package's version, the one place that says it: ``pyproject.toml`` reads it from here."""

__version__ = "0.1.0"

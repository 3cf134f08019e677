# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Which versions of Newton the solver was tested with."""

from __future__ import annotations

import warnings

TESTED = ("1.8",)
"""Minor versions of Newton that the tests have run with, the oldest first."""


def warn_if_untested(version: str) -> None:
    """Warn where the solver was not tested with a version of Newton: it brings out a minor one about monthly.

    Args:
        version: The version, ``newton.__version__``.
    """
    if ".".join(version.split(".")[:2]) not in TESTED:
        warnings.warn(
            f"newton_cagecut was tested with Newton {', '.join(TESTED)}, this is {version}; if something goes wrong, "
            f"install newton=={TESTED[-1]}.* and tell us",
            RuntimeWarning,
            stacklevel=2,
        )

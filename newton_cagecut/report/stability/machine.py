# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What the figures are of."""

from __future__ import annotations

import os
import platform
from importlib.metadata import PackageNotFoundError, version

import warp as wp

_PACKAGES = ("newton_cagecut", "newton", "warp-lang", "numpy")


def machine() -> dict[str, str]:
    """Versions, the device and the number of cores."""
    device = wp.get_device()
    found = {"device": device.name if device.is_cuda else "cpu", "cores": str(len(os.sched_getaffinity(0)))}
    for name in _PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return {**found, "python": platform.python_version()}

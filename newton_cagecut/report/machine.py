# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What the figures are of: versions, device and processor."""

from __future__ import annotations

import importlib.metadata
import os
import platform
from pathlib import Path

import warp as wp

_PACKAGES = ("newton_cagecut", "newton", "warp-lang", "numpy", "scipy", "scikit-fem", "netgen-mesher")


def machine_of(device: wp.context.Device) -> dict:
    """Return versions, device and processor, as JSON can hold them.

    Args:
        device: The device that is measured.
    """
    return {
        "device": device.name if device.is_cuda else "cpu",
        "processor": _processor(),
        "cores": len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count(),
        "system": platform.system(),
        "python": platform.python_version(),
        **{name: _version(name) for name in _PACKAGES},
    }


def chosen_device(name: str | None) -> wp.Device:
    """The device of a name given on the command line, Warp's own choice without one.

    Args:
        name: The name.

    Raises:
        ValueError: There is no such device.
    """
    try:
        return wp.get_device(name)
    except (RuntimeError, ValueError):
        known = ", ".join(device.alias for device in wp.get_devices())
        raise ValueError(f"there is no device {name!r}; there are {known}") from None


def _version(package: str) -> str | None:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


def _processor() -> str:
    """The processor's name, where the system tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        return next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()

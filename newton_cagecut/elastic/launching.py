# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Launches whose arguments never change, ready to be repeated."""

from __future__ import annotations

import warp as wp

_BLOCK_SIZE = 256
"""Threads of a launch of one thread block on CUDA; on the CPU it has one."""


def launch_later(kernel: wp.Kernel, dim: int | tuple[int, int], inputs: list, device: wp.context.Device) -> wp.Launch:
    """A launch that is not made yet."""
    return wp.launch(kernel, dim=dim, inputs=inputs, device=device, record_cmd=True)


def block_later(kernel: wp.Kernel, inputs: list, device: wp.context.Device) -> wp.Launch:
    """A launch of one thread block that is not made yet."""
    size = _BLOCK_SIZE if device.is_cuda else 1
    return wp.launch(kernel, dim=size, inputs=inputs, block_dim=size, device=device, record_cmd=True)

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Kernel launches that use every core.

A Warp launch on the CPU is serial but releases the interpreter lock, so there a launch is cut into chunks that the
calling thread and a thread pool take in turn. On CUDA it is one launch. Kernels take the chunk's first index as their
first argument.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor, wait

import warp as wp

_CHUNKS_PER_CORE = 8
_SMALLEST_CHUNK = 512
_BLOCK = 1024
"""Elements that one thread of a CPU takes where starting a thread costs more than an element."""
_pool: ThreadPoolExecutor | None = None


def launch(
    kernel: wp.Kernel,
    count: int,
    inputs: list,
    *,
    device: wp.context.Device,
    smallest_chunk: int = _SMALLEST_CHUNK,
    progress: Callable[[float], None] | None = None,
) -> None:
    """Run ``kernel`` for the indices 0 to ``count`` - 1 and wait for it on the CPU.

    Whatever is raised, by a chunk or by an interrupt, is raised when no chunk runs any more.

    Args:
        kernel: Kernel whose first argument is the index of the chunk's first element.
        count: Number of elements.
        inputs: The kernel's other arguments.
        device: Where to run.
        smallest_chunk: Elements below which a chunk is not worth a thread.
        progress: Called with the finished fraction, between 0 and 1.
    """
    if count <= 0:
        return
    if device.is_cuda:
        wp.launch(kernel, dim=count, inputs=[0, *inputs], device=device)
        if progress is not None:
            wp.synchronize_device(device)
            progress(1.0)
        return
    # Loaded first, for the block size of CPU launches, so that it is compiled once and not by every thread.
    kernel.module.load(device, block_dim=1)
    core_count = _core_count()
    size = max(smallest_chunk, -(-count // (core_count * _CHUNKS_PER_CORE)))

    def run(start: int) -> None:
        wp.launch(kernel, dim=min(size, count - start), inputs=[start, *inputs], device=device)

    starts = range(0, count, size)
    chunks = _Chunks(run, starts)
    helpers = []
    try:
        for _ in range(min(core_count, len(starts)) - 1):
            helpers.append(_thread_pool(core_count - 1).submit(chunks.help))
        for start in chunks.take():
            if progress is not None and start + size < count:
                progress((start + size) / count)
    finally:
        chunks.settle(helpers)
    for helper in helpers:
        if not helper.cancelled():
            helper.result()
    if progress is not None:
        progress(1.0)


def launch_blocks(kernel: wp.Kernel, count: int, inputs: list, *, device: wp.Device) -> None:
    """Run a kernel for many cheap elements: on a CPU each of its threads loops over a block of them.

    Args:
        kernel: Kernel whose first arguments are the index of the chunk's first block, the elements of a block, and
            ``count``; a thread takes the elements from its block's first to the next block's, or to ``count``.
        count: Number of elements.
        inputs: The kernel's other arguments.
        device: Where to run.
    """
    block = 1 if device.is_cuda else _BLOCK
    launch(kernel, -(-count // block), [block, count, *inputs], device=device, smallest_chunk=8)


class _Chunks:
    """Chunks of one launch, which several threads take in turn until none is left or one has failed.

    Args:
        launch: Runs the chunk that starts at an index.
        starts: First indices of the chunks.
    """

    def __init__(self, launch: Callable[[int], None], starts: range) -> None:
        self._launch = launch
        self._starts = iter(starts)
        self._stopped = False

    def take(self) -> Iterator[int]:
        """Run chunks, and give the start of each when it has ended."""
        while not self._stopped and (start := next(self._starts, None)) is not None:
            self._launch(start)
            yield start

    def help(self) -> None:
        """Run chunks in another thread."""
        try:
            for _ in self.take():
                pass
        finally:
            self._stopped = True

    def settle(self, helpers: list[Future]) -> None:
        """Wait until no chunk is run; what interrupts that is raised afterwards.

        Args:
            helpers: Those that were sent for.
        """
        self._stopped = True
        interrupt = None
        while helpers := [helper for helper in helpers if not (helper.cancel() or helper.done())]:
            try:
                wait(helpers)
            except BaseException as error:
                interrupt = error
        if interrupt is not None:
            raise interrupt


def _core_count() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else (os.cpu_count() or 1)


def _thread_pool(thread_count: int) -> ThreadPoolExecutor:
    global _pool
    if _pool is None:
        _pool = ThreadPoolExecutor(thread_count, thread_name_prefix="cagecut")
    return _pool

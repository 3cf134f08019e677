# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Progress bars over what takes longer than a moment."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from tqdm import tqdm


@contextmanager
def fraction_bar(label: str) -> Iterator[Callable[[float], None]]:
    """Show a bar while a block runs; it yields a function that takes the finished fraction.

    Args:
        label: What is being done.
    """
    with tqdm(total=100, desc=label, unit="%", bar_format="{desc} {percentage:3.0f}% {bar} {elapsed}") as bar:
        yield lambda fraction: bar.update(round(100 * fraction) - bar.n)
        bar.update(100 - bar.n)


def frame_bar(frame_count: int) -> tqdm:
    """Return a bar over the frames of a scene that nobody watches.

    Args:
        frame_count: Frames of the scene.
    """
    return tqdm(total=frame_count, desc="frames ", unit="frame")

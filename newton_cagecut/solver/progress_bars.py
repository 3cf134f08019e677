# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Progress bars over what takes longer than a moment: in a terminal, unless told otherwise."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from tqdm import tqdm


def run_parts(parts: Sequence[tuple[str, Callable[[], None]]], label: str, *, shown: bool | None = None) -> None:
    """Run parts of a whole, with a bar that says which one runs.

    Args:
        parts: Name of each part, and what to run.
        label: What the whole is.
        shown: Whether to show the bar; None for in a terminal.
    """
    with tqdm(parts, desc=label, unit="part", disable=_disable(shown), leave=False) as bar:
        for name, part in bar:
            bar.set_postfix_str(name)
            part()


@contextmanager
def fraction_bar(label: str, *, shown: bool | None = None) -> Iterator[Callable[[float], None]]:
    """Show a bar while a block runs; it yields a function that takes the finished fraction.

    Args:
        label: What is being done.
        shown: Whether to show the bar; None for in a terminal.
    """
    form = "{desc} {percentage:3.0f}% {bar} {elapsed}"
    with tqdm(total=100, desc=label, bar_format=form, disable=_disable(shown), leave=False) as bar:
        yield lambda fraction: bar.update(round(100 * fraction) - bar.n)


def _disable(shown: bool | None) -> bool | None:
    """What tqdm calls the opposite, which has None for in a terminal too."""
    return None if shown is None else not shown

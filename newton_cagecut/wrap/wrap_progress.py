# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A bar that shows how far a wrap is."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from tqdm import tqdm

_DELAY = 1.0  # seconds after which a bar is worth it


@contextmanager
def wrap_progress(shown: bool | None) -> Iterator[Callable[[str], None]]:
    """Show a bar, and yield what moves it on, given what is done next.

    Args:
        shown: Whether; ``None`` shows it in terminals.
    """
    with tqdm(desc="cage", unit="step", disable=None if shown is None else not shown, delay=_DELAY, leave=False) as bar:

        def tick(stage: str) -> None:
            bar.set_postfix_str(stage, refresh=False)
            bar.update()

        yield tick

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""A progress bar, or lines where tqdm is not installed."""

from __future__ import annotations

import sys
import time
from types import TracebackType


class Progress:
    """Shows how much is done; a context manager.

    Args:
        total: Parts in all.
        label: What is being done.
    """

    def __init__(self, total: int, label: str) -> None:
        self._total, self._label, self._done, self._next = total, label, 0, 0.0
        try:
            from tqdm import tqdm
        except ImportError:
            self._bar = None
        else:
            self._bar = tqdm(total=total, desc=label)

    def __enter__(self) -> Progress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.close()

    def advance(self, name: str = "") -> None:
        """One more part is done.

        Args:
            name: The part's name.
        """
        self._done += 1
        if self._bar is not None:
            self._bar.set_postfix_str(name, refresh=False)
            self._bar.update()
        elif time.monotonic() >= self._next:
            self._next = time.monotonic() + 5.0
            print(f"{self._label}: {self._done} of {self._total} {name}", file=sys.stderr, flush=True)

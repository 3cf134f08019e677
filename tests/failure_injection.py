# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Warp calls that fail on request, so that tests can stop an edit at every one of them."""

from __future__ import annotations

import functools
import threading
from collections.abc import Callable
from types import TracebackType

import warp as wp

_CALLS = [
    *((wp, name) for name in ("launch", "copy", "clone", "zeros", "empty", "full", "zeros_like", "empty_like")),
    (wp.Launch, "launch"),
    (wp.utils, "array_scan"),
    *((wp.array, name) for name in ("__init__", "assign", "fill_", "zero_", "numpy")),
    *((wp.indexedarray, name) for name in ("__init__", "fill_", "zero_")),
]
"""Allocations, launches and copies: where they stand, and their names there."""


class InjectedFailure(Exception):
    """What a call raises that was made to fail."""


class FailingCalls:
    """While the ``with`` block lasts, Warp's allocations, launches and copies are counted, and one of them fails.

    Only one does: what takes an edit back is neither stopped nor counted. Nor is what counted calls make inside.

    Args:
        n: The call that raises ``InjectedFailure`` instead of being made, from 0 on; None for none.
    """

    def __init__(self, n: int | None = None) -> None:
        self.n = n
        self.count = 0
        self.raised = False
        self._kept: list[tuple[object, str, bool, object]] = []
        self._lock = threading.Lock()
        self._thread = threading.local()

    def __enter__(self) -> FailingCalls:
        for owner, name in _CALLS:
            function = getattr(owner, name)
            self._kept.append((owner, name, name in vars(owner), function))
            setattr(owner, name, self._counted(function))
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        while self._kept:
            owner, name, own, function = self._kept.pop()
            if own:
                setattr(owner, name, function)
            else:
                delattr(owner, name)

    def _counted(self, function: Callable) -> Callable:
        @functools.wraps(function)
        def counted(*args: object, **options: object) -> object:
            if getattr(self._thread, "inside", False):
                return function(*args, **options)
            self._count(function)
            self._thread.inside = True
            try:
                return function(*args, **options)
            finally:
                self._thread.inside = False

        return counted

    def _count(self, function: Callable) -> None:
        with self._lock:
            if self.raised:
                return
            if self.count == self.n:
                self.raised = True
                raise InjectedFailure(f"call {self.n}, of {function.__qualname__}, was made to fail")
            self.count += 1

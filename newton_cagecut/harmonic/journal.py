# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Edits that are all or nothing.

An edit first prepares what it can without changing anything. What it then overwrites in place, because pointers must
not change, is kept in a journal before, and taken back if anything fails: a launch, an allocation, an interrupt.
"""

from __future__ import annotations

from collections.abc import Callable
from types import TracebackType

import warp as wp


class Journal:
    """Old values of what an edit overwrites; a ``with`` block that ends with an exception takes all of it back.

    Nothing is taken back where the block ends well. A block inside another one, for an edit that is a part of a larger
    one, is that of the outer journal: ``with Journal.within(outer) as journal``.
    """

    def __init__(self) -> None:
        self._undo: list[Callable[[], None]] = []
        self._depth = 0

    @classmethod
    def within(cls, outer: Journal | None) -> Journal:
        """The outer journal, or a new one where there is none.

        Args:
            outer: Journal of the edit that this one is a part of.
        """
        return outer or cls()

    def __enter__(self) -> Journal:
        self._depth += 1
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None) -> None:
        self._depth -= 1
        if self._depth == 0:
            undo, self._undo = self._undo, []
            if kind is not None:
                for step in reversed(undo):
                    step()

    def keep(self, *arrays: wp.array) -> None:
        """Keep the values of arrays, each to be overwritten anywhere.

        Args:
            arrays: Contiguous arrays.
        """
        for array in arrays:
            kept = wp.clone(array)
            self._undo.append(lambda array=array, kept=kept: wp.copy(array, kept))

    def keep_rows(self, array: wp.array, rows: wp.array, *, axis: int = 0) -> None:
        """Keep some rows of an array.

        Args:
            array: The array.
            rows: Indices of the rows to be overwritten, int32, on the array's device.
            axis: Axis that the indices run along.
        """
        if rows.size == 0:
            return
        indices = [rows if axis == number else None for number in range(array.ndim)]
        view = wp.indexedarray(array, indices)
        kept = wp.clone(view)
        self._undo.append(lambda: wp.copy(view, kept))

    def keep_attributes(self, owner: object, *names: str) -> None:
        """Keep what attributes of an object refer to, to be replaced by other objects.

        Args:
            owner: The object.
            names: Names of its attributes.
        """
        kept = [(name, getattr(owner, name)) for name in names]

        def undo() -> None:
            for name, value in kept:
                setattr(owner, name, value)

        self._undo.append(undo)

    def when_taken_back(self, step: Callable[[], None]) -> None:
        """Run a step when edits are taken back, once everything that is kept after this call is as it was.

        Args:
            step: What to do, such as making anew what follows from kept values.
        """
        self._undo.append(step)

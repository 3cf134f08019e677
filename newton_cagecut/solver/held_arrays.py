# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Every Warp array that an object holds, found by walking its attributes, so that no new one is forgotten."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import warp as wp

_PACKAGE = __package__.split(".")[0]


class HeldArray(NamedTuple):
    """An array and where it is held.

    Args:
        path: Names of the attributes that lead to it.
        array: The array, which owns its memory.
    """

    path: tuple[str, ...]
    array: wp.array

    @property
    def byte_count(self) -> int:
        """Bytes of its memory."""
        return int(self.array.capacity)


def held_arrays(owner: object, *, without: tuple[object, ...] = ()) -> list[HeldArray]:
    """The arrays that an object of this package holds, directly or by others; each memory once, and whole.

    Where several paths lead to an array, it is the first, attributes in the order in which they were set.

    Args:
        owner: The object.
        without: Objects that are not looked into; views of their own arrays are not counted.
    """
    seen, found = {id(other) for other in without}, []
    memories = {array.ptr for other in without for array in vars(other).values() if isinstance(array, wp.array)}
    waiting: list[tuple[tuple[str, ...], object]] = [((), owner)]
    while waiting:
        path, value = waiting.pop()
        if id(value) in seen:
            continue
        seen.add(id(value))
        if isinstance(value, wp.array):
            while getattr(value, "_ref", None) is not None:  # a view
                value = value._ref
            if value.capacity and value.deleter is not None and value.ptr not in memories:
                memories.add(value.ptr)
                found.append(HeldArray(path, value))
        else:
            waiting.extend(reversed([((*path, name), part) for name, part in _parts(value)]))
    return found


def _parts(value: object) -> Iterator[tuple[str, object]]:
    """What may lead to arrays: attributes of the package's own objects and of Warp's structs, and containers."""
    if isinstance(value, dict):
        yield from ((str(key), part) for key, part in value.items() if not isinstance(part, int | float | str))
    elif isinstance(value, list | tuple):
        yield from ((str(index), part) for index, part in enumerate(value) if not isinstance(part, int | float | str))
    elif isinstance(value, wp.indexedarray):
        yield from (("data", value.data), *((str(axis), part) for axis, part in enumerate(value.indices)))
    elif _is_struct(value) or type(value).__module__.split(".")[0] == _PACKAGE:
        yield from getattr(value, "__dict__", {}).items()
        for kind in type(value).__mro__:
            slots = kind.__dict__.get("__slots__", ())
            for name in (slots,) if isinstance(slots, str) else slots:
                if name != "__dict__" and hasattr(value, name):
                    yield name, getattr(value, name)


def _is_struct(value: object) -> bool:
    """Whether a value is an instance of a Warp struct."""
    kinds = type(value).__mro__
    return any(kind.__name__ == "StructInstance" and kind.__module__.split(".")[0] == "warp" for kind in kinds)

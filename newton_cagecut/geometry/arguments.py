# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Arguments as numbers and objects of their kind, or an error that says what is wrong, where, and what it must be.

Arrays have a file of their own, ``array_arguments``. Text, truth values and None are no numbers here, though Python and
NumPy can make numbers of them.
"""

from __future__ import annotations

import operator
import os
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np

_Kind = TypeVar("_Kind")
_LONGEST = 60


def shown(value: object) -> str:
    """What was passed, in few words, for an error.

    Args:
        value: What was passed.
    """
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape}"
    text = " ".join(repr(value).split())
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."


def is_number(value: object) -> bool:
    """Whether something is a number and nothing that Python would only make one of.

    Args:
        value: What was passed.
    """
    if isinstance(value, bool | np.bool_ | str | bytes | bytearray) or getattr(value, "ndim", 0):
        return False
    return hasattr(value, "__float__") or hasattr(value, "__index__")


def as_number(value: float, what: str, *, limits: tuple[float, float] | None = None) -> float:
    """A number, which may be infinite where there are no limits.

    Args:
        value: What was passed.
        what: What it is, for the error.
        limits: The least and the greatest number that it may be.

    Raises:
        TypeError: If it is not a number.
        ValueError: If it is nan or not within the limits.
    """
    number = _as_float(value, f"{what} must be a number")
    _check_within(number, what, limits)
    if np.isnan(number):
        raise ValueError(f"{what} must be a number, got nan")
    return number


def as_finite(value: float, what: str) -> float:
    """A finite number.

    Args:
        value: What was passed.
        what: What it is, for the error.

    Raises:
        TypeError: If it is not a number.
        ValueError: If it is nan or infinite.
    """
    number = as_number(value, what)
    if np.isinf(number):
        raise ValueError(f"{what} must be finite, got {number}")
    return number


def as_length(value: float, what: str) -> float:
    """A positive, finite length [m].

    Args:
        value: What was passed.
        what: What it is, for the error.

    Raises:
        TypeError: If it is not a number.
        ValueError: If it is not positive or not finite.
    """
    number = _as_float(value, f"{what} must be a length [m]")
    if not (np.isfinite(number) and number > 0.0):
        raise ValueError(f"{what} must be positive, got {number} m")
    return number


def as_index(value: int, what: str, *, limits: tuple[int, int] | None = None) -> int:
    """An integer.

    Args:
        value: What was passed.
        what: What it is, for the error.
        limits: The least and the greatest integer that it may be.

    Raises:
        TypeError: If it is not an integer.
        ValueError: If it is not within the limits.
    """
    try:
        index = operator.index(value)
    except TypeError:
        index = None
    if index is None or not is_number(value):
        raise TypeError(f"{what} must be an integer, got {shown(value)}")
    _check_within(index, what, limits)
    return index


def as_flag(value: bool, what: str) -> bool:
    """Yes or no.

    Args:
        value: What was passed.
        what: What it is, for the error.

    Raises:
        TypeError: If it is neither.
    """
    if not isinstance(value, bool | np.bool_):
        raise TypeError(f"{what} must be True or False, got {shown(value)}")
    return bool(value)


def as_instance(value: _Kind, kind: type[_Kind] | tuple[type, ...], what: str, *, hint: str = "") -> _Kind:
    """An object of a kind, as it is.

    Args:
        value: What was passed.
        kind: Its class, or several of which one will do.
        what: What it is, for the error.
        hint: Where to get one, for the error.

    Raises:
        TypeError: If it is of another kind.
    """
    if isinstance(value, kind):
        return value
    kinds = kind if isinstance(kind, tuple) else (kind,)
    names = " or ".join(_article(_name(one)) for one in kinds)
    raise TypeError(f"{what} must be {names}, got {type(value).__name__}{'; ' if hint else ''}{hint}")


def as_sequence(values: Sequence[_Kind], kind: type[_Kind], what: str) -> tuple[_Kind, ...]:
    """Objects of a kind.

    Args:
        values: What was passed.
        kind: Their class.
        what: What they are, for the error.

    Raises:
        TypeError: If it is no sequence, or one of them is of another kind.
    """
    one = _name(kind)
    if not isinstance(values, Sequence) or isinstance(values, str | bytes):
        got = f"one {one}; pass {what}=({kind.__name__.lower()},)" if isinstance(values, kind) else shown(values)
        raise TypeError(f"{what} must be a sequence of {one}, got {got}")
    return tuple(as_instance(value, kind, f"{what}[{number}]") for number, value in enumerate(values))


def as_callback(value: Callable | None, what: str) -> Callable | None:
    """A function, or None.

    Args:
        value: What was passed.
        what: What it is, for the error.

    Raises:
        TypeError: If it is neither.
    """
    if value is not None and not callable(value):
        raise TypeError(f"{what} must be a function or None, got {shown(value)}")
    return value


def as_choice(value: str, choices: Sequence[str], what: str) -> str:
    """One of some words.

    Args:
        value: What was passed.
        choices: The words.
        what: What it is, for the error.

    Raises:
        ValueError: If it is none of them.
    """
    if not (isinstance(value, str) and value in choices):
        raise ValueError(f"{what} must be one of {', '.join(choices)}, not {shown(value)}")
    return value


def as_path(value: str | os.PathLike, what: str = "path") -> str:
    """A path as text.

    Args:
        value: What was passed.
        what: What it is, for the error.

    Raises:
        TypeError: If it is none.
        ValueError: If it is empty.
    """
    path = os.fspath(value) if isinstance(value, str | os.PathLike) else None
    if not isinstance(path, str):
        raise TypeError(f"{what} must be the path of a file, got {shown(value)}")
    if not path:
        raise ValueError(f"{what} is empty; give the path of a file")
    return path


def _as_float(value: object, wanted: str) -> float:
    try:
        if is_number(value):
            return float(value)
    except (TypeError, ValueError, OverflowError):
        pass
    raise TypeError(f"{wanted}, got {shown(value)}")


def _check_within(number: float, what: str, limits: tuple[float, float] | None) -> None:
    if limits is not None and not limits[0] <= number <= limits[1]:
        raise ValueError(f"{what} must lie between {limits[0]} and {limits[1]}, got {number}")


def _name(kind: type) -> str:
    """The name of a class as users know it."""
    room = kind.__module__.split(".")[0]
    return kind.__name__ if room in ("builtins", __package__.split(".")[0]) else f"{room}.{kind.__name__}"


def _article(name: str) -> str:
    return f"{'an' if name[0] in 'aeiouAEIOU' else 'a'} {name}"

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Values of every kind that no argument, or only some, may have, and what an error of the library's looks like."""

from __future__ import annotations

import dis
from pathlib import Path
from types import TracebackType

import numpy as np

import newton_cagecut

NAN, INF = float("nan"), float("inf")
VALUES: dict[str, object] = {
    "None": None,
    "a word": "sideways",
    "no text": "",
    "a number as text": "1",
    "bytes": b"1",
    "True": True,
    "nan": NAN,
    "inf": INF,
    "-inf": -INF,
    "-1": -1,
    "-1.5": -1.5,
    "0": 0,
    "1": 1,
    "0.5": 0.5,
    "1e9": 10**9,
    "1e30": 10**30,
    "imaginary": 1j,
    "an object": object(),
    "a class": dict,
    "a dict": {"x": 1.0},
    "no list": [],
    "one number": [1.0],
    "one index": [1],
    "a negative index": [-1],
    "an index beyond": [10**6],
    "the same twice": [1, 1],
    "three numbers": [1.0, 0.0, 0.0],
    "four numbers": [0.1, 0.2, 0.3, 0.4],
    "three nans": [NAN, NAN, NAN],
    "three zeros": [0.0, 0.0, 0.0],
    "words": ["a", "b", "c"],
    "a None in a row": [None, 0.0, 0.0],
    "ragged": [[0, 1, 2], [0, 1]],
    "a number": np.float64(0.25),
    "a table of 2": np.full((2, 2), 0.4),
    "a table of 3": np.full((2, 3), 0.4),
    "a table of 4": np.full((2, 4), 0.4),
    "a table of nan": np.full((2, 3), NAN),
    "an empty table": np.zeros((0, 3)),
    "a block": np.zeros((2, 3, 3)),
    "truths": np.array([True, False, True]),
    "objects": [object(), object()],
}
"""Each value by what it is called in ``Argument.good``."""

NOT_NEGATIVE = ("0", "1", "0.5", "1e9", "a number")
POSITIVE = ("1", "0.5", "1e9", "a number")
FINITE = ("-1", "-1.5", *NOT_NEGATIVE)

_ROOM = Path(newton_cagecut.__file__).parent


def complaint(error: BaseException, names: tuple[str, ...]) -> str | None:
    """What is wrong with an error of a wrong argument; None where nothing is.

    Args:
        error: The error.
        names: Words of which its text must have one.
    """
    if not isinstance(error, ValueError | TypeError | RuntimeError | OSError):
        return f"is a {type(error).__name__}"
    if not _raised_here(error.__traceback__):
        return "was not raised by the library"
    text = str(error)
    if not any(name.lower() in text.lower() for name in names):
        return f"names none of {', '.join(names)}"
    return None


def _raised_here(traceback: TracebackType) -> bool:
    """Whether an error comes from a ``raise`` in the library, not from what it called."""
    while traceback.tb_next is not None:
        traceback = traceback.tb_next
    code = traceback.tb_frame.f_code
    raised = code.co_code[traceback.tb_lasti] == dis.opmap["RAISE_VARARGS"]
    return raised and _ROOM in Path(code.co_filename).parents

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The page of bad input says what the library says."""

from __future__ import annotations

from docs import errors


def test_the_page_is_what_is_said():
    """Made anew it is the committed one, of at least thirty cases; what differs is in the test's output."""
    assert sum(map(len, errors.CASES.values())) >= 30
    assert errors.page() == errors.PAGE.read_text()


def test_each_is_one_sentence_of_ours():
    """None is of another library: those of NumPy, USD and trimesh have words that ours have not."""
    said = errors.PAGE.read_text()
    for foreign in ("Traceback", "numpy", "Tf.", "trimesh", "pxr", "object has no attribute", "index out of"):
        assert foreign not in said

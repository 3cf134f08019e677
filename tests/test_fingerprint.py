# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Edits of cages and surfaces have the results that they have always had, as far as these are integers."""

from __future__ import annotations

import json
from pathlib import Path

from benchmarks import fingerprint

RECORDED = Path(fingerprint.__file__).with_suffix(".json")


def test_integer_results_are_those_recorded():
    """Topology, numbers of what edits touch, triangles and caps of surfaces; none depends on the machine."""
    assert list(fingerprint.differences(json.loads(RECORDED.read_text()), fingerprint.compute(integers=True))) == []


def test_differences_are_named():
    """A digest that differs, is gone or is new has a line with its sequence, step and name."""
    one = {"cut": {"start": {"faces": "a", "keys": "b"}}}
    two = {"cut": {"start": {"faces": "c"}, "end": {"keys": "b"}}}
    expected = ["cut / start / faces differs", "cut / start / keys is gone", "cut / end / keys is new"]
    assert list(fingerprint.differences(one, two)) == expected

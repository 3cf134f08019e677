# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The quick run of the table of extreme cases, against the committed table."""

from __future__ import annotations

import json
from pathlib import Path

from newton_cagecut.report.stability.stability_run import measure_all

COMMITTED = Path(__file__).parents[1] / "docs" / "stability" / "stability.json"


def test_no_row_is_out_of_limits_that_it_kept(tmp_path):
    """What the committed table has within its limits is within them now."""
    kept = {name for name, record in _records(COMMITTED).items() if record["values"].get("failures") == []}
    status = measure_all(None, tmp_path, quick=True)
    failed = {
        name for name, record in _records(tmp_path / "stability.json").items() if record["values"].get("failures")
    }
    assert bool(failed) <= bool(status)
    assert not failed & kept


def _records(path: Path) -> dict[str, dict]:
    return json.loads(path.read_text(encoding="utf-8"))["records"]

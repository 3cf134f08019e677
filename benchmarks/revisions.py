# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Benchmarks run at another commit, to compare with."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).parent.parent
_OPTION = "--compare"


def with_kept(name: str, options: Sequence[str], folder: Path) -> list[str]:
    """Return a benchmark's options, with a file of kept figures in the place of the revision they are compared with.

    Args:
        name: The benchmark.
        options: Its command line. What stands after ``--compare`` and is no file is a revision: the benchmark is run
            as it was there, with the other options, before it is run here.
        folder: Where the revision is checked out to, and the figures are written to.

    Raises:
        ValueError: There is no such file or revision, or the benchmark failed there.
    """
    options = list(options)
    place = options.index(_OPTION) + 1 if _OPTION in options else len(options)
    if place >= len(options) or Path(options[place]).exists():
        return options
    revision, kept = options[place], folder / "kept.json"
    others = options[: place - 1] + options[place + 1 :]
    if "--json" in others:
        at = others.index("--json")
        del others[at : at + 2]
    tree = folder / "tree"
    commit = _git("rev-parse", "--verify", "--quiet", f"{revision}^{{commit}}")
    if not commit:
        raise ValueError(f"--compare {revision}: there is neither such a file nor such a revision")
    _git("worktree", "add", "--detach", "--quiet", str(tree), commit)
    try:
        command = [sys.executable, "-m", "benchmarks", name, *others, "--json", str(kept)]
        paths = os.pathsep.join(filter(None, [str(tree), os.environ.get("PYTHONPATH")]))
        done = subprocess.run(command, cwd=tree, env={**os.environ, "PYTHONPATH": paths}, stdout=subprocess.DEVNULL)
    finally:
        _git("worktree", "remove", "--force", str(tree))
    if done.returncode or not kept.exists():
        raise ValueError(f"--compare {revision}: {name} failed there, or keeps no figures")
    options[place] = str(kept)
    return options


def _git(*arguments: str) -> str:
    """What git prints; nothing if it fails."""
    done = subprocess.run(["git", "-C", str(ROOT), *arguments], capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else ""

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Digests of the library's results: whether a change of the code has changed any bit of them.

``python -m benchmarks.fingerprint --write FILE`` cuts cages, surfaces and bodies and writes a digest of each result
after each step; ``--compare FILE`` does it again and prints what differs. Both must run on one machine, on a CPU. What
``--integers`` keeps depends on no machine: the topology of cages and surfaces and the numbers of what edits touch, all
of a step in one digest.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

Digests = dict[str, dict[str, dict[str, str]]]
"""Digest of each result, by sequence, step and name."""


def compute(names: Sequence[str] | None = None, *, integers: bool = False) -> Digests:
    """Run sequences and return the digests of their results.

    Args:
        names: The sequences; all by default.
        integers: Whether to keep the results that are integers only, all of a step in one digest.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # sums of products do not depend on the number of threads
    import warp as wp

    from benchmarks.fingerprint_record import Record
    from benchmarks.fingerprint_sequences import SEQUENCES, WEIGHTS_ONLY

    wp.config.quiet = True
    found: Digests = {}
    for name in names or SEQUENCES:
        if integers and name in WEIGHTS_ONLY:
            continue
        start, record = time.process_time(), Record(integers=integers)
        SEQUENCES[name](record)
        found[name] = record.summary if integers else record.steps
        count = sum(len(digests) for digests in record.steps.values())
        print(f"{name}: {count} digests in {time.process_time() - start:.1f} s", file=sys.stderr)
    return found


def differences(expected: Digests, found: Digests) -> Iterator[str]:
    """Yield a line for each digest that differs, or that only one of two fingerprints has.

    Args:
        expected: The older fingerprint.
        found: The newer one.
    """
    one, two = dict(_flat(expected)), dict(_flat(found))
    for key in one | two:
        if one.get(key) != two.get(key):
            what = "differs" if key in one and key in two else "is gone" if key in one else "is new"
            yield f"{' / '.join(key)} {what}"


def _flat(digests: Digests) -> Iterator[tuple[tuple[str, str, str], str]]:
    """Yield each digest with its sequence, step and name."""
    for sequence, steps in digests.items():
        for step, values in steps.items():
            for name, digest in values.items():
                yield (sequence, step, name), digest


def main(arguments: Sequence[str] | None = None) -> int:
    """Write or compare a fingerprint; return 1 if something differs.

    Args:
        arguments: The command line; that of the program by default.
    """
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    action = parser.add_mutually_exclusive_group(required=True)
    action.add_argument("--write", metavar="FILE", type=Path, help="write the fingerprint to a file")
    action.add_argument("--compare", metavar="FILE", type=Path, help="print what differs from a file")
    parser.add_argument("--integers", action="store_true", help="keep results that are integers only")
    parser.add_argument("--sequence", metavar="NAME", nargs="+", help="which sequences (default: all)")
    options = parser.parse_args(arguments)
    found = compute(options.sequence, integers=options.integers)
    if options.write:
        options.write.write_text(json.dumps(found, indent=1) + "\n")
        return 0
    expected = json.loads(options.compare.read_text())
    if options.sequence:
        expected = {name: steps for name, steps in expected.items() if name in options.sequence}
    lines = list(differences(expected, found))
    print("\n".join([*lines, f"{len(lines)} differences in {len(found)} sequences"]))
    return int(bool(lines))


if __name__ == "__main__":
    sys.exit(main())

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""How local cuts are, and how well bounding volumes tell: figures 12 and 13 of the paper.

``python -m benchmarks.locality`` cuts OCTOPUS at three places and counts, for each vertex of the mesh, the walks that
the cut changes (figure 12); and it cuts STARFISH in three directions and compares the walks that each kind of bounding
volume flags, in steps of 3 %, with those that really change (figure 13). A third table cuts a star in the plane and the
prism on it alike (section 7: locality is "more pronounced in 3D"). The report does the same with any scene.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np
from tqdm import tqdm

from assets.starfish import ARM_ANGLES
from benchmarks.progressive import parsed, parser_of, show
from benchmarks.scenes import DOWN, SCENES, across_octopus_arm
from newton_cagecut import Blade
from newton_cagecut.report.cuts.following import Followed, follow
from newton_cagecut.report.cuts.locality import dimension_counts
from newton_cagecut.report.page.markdown import Table
from newton_cagecut.report.paper.cutting import step_count

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BOUNDS = ("dop26", "dop18", "aabb", "sphere")
SHARES = (0.0, 0.01, 0.03, 0.1, 0.3, 1.0)  # edges of the histogram's bins
_BINS = ["none", *(f"{100.0 * a:g} to {100.0 * b:g}" for a, b in zip(SHARES, SHARES[1:]))]
_HEAD = ["cut at the", "mean %", *_BINS]

PLACES = {
    "tip of an arm": across_octopus_arm(4, 0.84),
    "root of an arm": across_octopus_arm(4, 0.1, width=0.25),
    "middle": Blade((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), DOWN),
}
"""Cuts of OCTOPUS."""


def across_starfish_arm(arm: int, tilt: float) -> Blade:
    """Return a blade that goes down through an arm of the starfish, 0.36 m from its middle.

    Args:
        arm: Which arm.
        tilt: Angle of the blade's plane against the upright plane square to the arm, both ways about [rad].
    """
    along = np.array([np.cos(ARM_ANGLES[arm]), np.sin(ARM_ANGLES[arm]), 0.0])
    across, up = np.array([-along[1], along[0], 0.0]), np.array([0.0, 0.0, 1.0])
    edge = np.cos(tilt) * across + np.sin(tilt) * along
    return Blade(0.36 * along, edge, np.sin(tilt) * along - np.cos(tilt) * up)


DIRECTIONS = {
    "square to an axis": across_starfish_arm(0, 0.0),
    "oblique to two axes": across_starfish_arm(1, 0.0),
    "oblique to three axes": across_starfish_arm(2, 0.5),
}
"""Cuts of STARFISH."""


def _bar(label: str) -> Callable[[], object]:
    """A bar on standard error, as what is called after each step."""
    return tqdm(desc=label, total=step_count(), unit="step").update


def place_shares(walks: int, **options) -> dict[str, np.ndarray]:
    """Return, for each place of a cut through OCTOPUS, the share of each vertex's walks that the cut changes."""
    scene = SCENES["octopus"]
    found = {
        place: follow(scene.cage, scene.points, blade, walks, on_step=_bar(place), **options)
        for place, blade in PLACES.items()
    }
    return {place: flagged.touched.reshape(-1, walks).mean(axis=1) for place, flagged in found.items()}


def bounds_counts(walks: int, **options) -> dict[tuple[str, str], Followed]:
    """Return, for each direction of a cut through STARFISH and kind of bounds, the walks flagged and changed."""
    found, scene = {}, SCENES["starfish"]
    for direction, blade in DIRECTIONS.items():
        for bounds in BOUNDS:
            try:
                label = f"{direction}, {bounds}"
                found[direction, bounds] = follow(
                    scene.cage, scene.points, blade, walks, on_step=_bar(label), bounds=bounds, **options
                )
            except ValueError as error:
                print(f"{bounds} left out: {error}")
    return found


def histogram(share: np.ndarray) -> np.ndarray:
    """Return the percentage of vertices with no walk changed, then of those in each bin of ``SHARES``."""
    counts = [np.count_nonzero(share == 0.0), *np.histogram(share[share > 0.0], SHARES)[0]]
    return 100.0 * np.array(counts) / len(share)


def place_table(shares: dict[str, np.ndarray]) -> Table:
    """Return figure 12 as a table."""
    rows = [
        [place, f"{100.0 * share.mean():.2f}", *(f"{part:.1f}" for part in histogram(share))]
        for place, share in shares.items()
    ]
    return Table("OCTOPUS: vertices [%] by the share of their walks that a whole cut changes", _HEAD, rows)


def bounds_table(found: dict[tuple[str, str], Followed]) -> Table:
    """Return figure 13 as a table."""
    rows = []
    for key, counts in found.items():
        shares = [100.0 * np.mean(share) for share in (counts.flagged, counts.changed)]
        rows.append([*key, *(f"{share:.2f}" for share in shares), f"{counts.in_vain:.2f}"])
    head = ["cut", "bounds", "flagged %", "changed %", "in vain for each changed"]
    return Table("STARFISH: walks flagged and changed, means over the steps of a cut", head, rows)


def dimension_table(found: dict[str, Followed]) -> Table:
    """Return locality in both dimensions as a table."""
    rows = [
        [name, *(f"{100.0 * np.mean(share):.2f}" for share in (counts.flagged, counts.changed))]
        for name, counts in found.items()
    ]
    return Table("A cut across an arm, means over its steps", ["body", "flagged %", "changed %"], rows)


def plot(shares: dict[str, np.ndarray], found: dict[tuple[str, str], Followed], path: Path) -> None:
    """Draw both figures.

    Args:
        shares: Of figure 12.
        found: Of figure 13.
        path: The file.
    """
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 3.8), layout="constrained")
    _bars(left, _BINS, {place: histogram(share) for place, share in shares.items()})
    left.set(xlabel="walks that the cut changes [%]", ylabel="vertices [%]", title="OCTOPUS, cut at the")
    kinds = dict.fromkeys(bounds for _, bounds in found)
    _bars(right, list(DIRECTIONS), {kind: [found[cut, kind].in_vain for cut in DIRECTIONS] for kind in kinds})
    right.set(ylabel="walks flagged in vain for each changed", title="STARFISH")
    figure.savefig(path, dpi=150)


def _bars(axes: Axes, groups: Sequence[str], heights: dict[str, Sequence[float]]) -> None:
    """Draw bars, one of each series in each group."""
    width = 0.8 / len(heights)
    for k, (label, series) in enumerate(heights.items()):
        axes.bar(np.arange(len(groups)) + k * width, series, width, align="edge", label=label)
    axes.set_xticks(np.arange(len(groups)) + 0.4, [fill(group, 12) for group in groups])
    axes.legend()


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure, print the tables and plot if asked to.

    Args:
        arguments: The command line; that of the program by default.
    """
    parser = parser_of(__doc__.split("\n")[0])
    parser.add_argument("--plot", metavar="FILE", type=Path, help="write a plot of both figures")
    options = parsed(parser, arguments)
    shares = place_shares(options.walks, device=options.device)
    found = bounds_counts(options.walks, device=options.device)
    dimensions = dimension_counts(options.walks, device=options.device)
    show([place_table(shares), bounds_table(found), dimension_table(dimensions)], options)
    if options.plot:
        plot(shares, found, options.plot)


if __name__ == "__main__":
    main()

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""How local cuts are (paper, figure 12), and the plane beside space."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from ...cage import Cage
from ...section import Blade
from ..bench import Bench, spread
from ..measurement import Measurement, Record, chosen, scenes_of
from ..page.chart import Chart, Line, Panel
from ..page.markdown import Section, Table
from ..scenes.scene import blade_across
from .following import Followed, follow

NAME, PLANE_NAME = "locality", "dimensions"
PLACES = (0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9)
"""Where blades go through a cage, as shares of its longest side."""
POINTS, WALKS = 256, 64
_STEP = 0.25  # of a cut: the walks that a whole cut changes are the same in any steps
_STAR_STEP = 0.03


class LocalityRow:
    """Walks that a whole cut changes, against where it is."""

    name = NAME

    def measurements(self, benches: Sequence[Bench]) -> Iterator[Measurement]:
        """See ``Row``."""
        for bench in benches:
            yield Measurement(NAME, bench.scene.name, {}, partial(measure_locality, bench))
        for bench in benches[:1]:
            yield Measurement(PLANE_NAME, "", {}, partial(measure_dimensions, bench))

    def sections(self, records: Sequence[Record]) -> Iterator[Section]:
        """See ``Row``."""
        lines, rows = [], []
        for scene in scenes_of(chosen(records, NAME)):
            (record,) = chosen(records, NAME, scene)
            shares = 100.0 * np.array(record.values["touched"])
            lines.append(Line(scene, [100.0 * place for place in PLACES], shares.tolist()))
            rows.append([scene, *(f"{share:.1f}" for share in shares)])
        if not rows:
            return
        text = (
            "Walks whose landing changes when the cage is cut right through, square to its longest side, against the "
            f"place of the cut along that side; {WALKS} walks a point. Cuts at the ends change few walks, those "
            "through the middle many (figure 12 of the paper)."
        )
        panel = Panel("", "place along the longest side [%]", "walks that the cut changes [%]", lines, logarithmic="")
        tables = [Table("Walks changed [%] by a cut at:", ["scene", *(f"{place:.0%}" for place in PLACES)], rows)]
        for record in chosen(records, PLANE_NAME):
            tables.append(_plane_table(record))
        yield Section("Locality of cuts", [text], tables, [Chart("locality", "Locality of cuts", [[panel]])])


def measure_locality(bench: Bench) -> dict:
    """Measure the share of the walks that a cut changes, for blades at several places.

    Args:
        bench: The scene.
    """
    cage, points = bench.scene.cage, spread(np.asarray(bench.scene.points), POINTS)
    touched = []
    for place in PLACES:
        found = follow(cage, points, blade_across(cage, place), WALKS, step=_STEP, device=bench.device)
        touched.append(float(found.touched.mean()))
    return {"touched": touched}


def measure_dimensions(bench: Bench) -> dict:
    """Measure the walks that a cut across an arm of a star changes, and those of the prism on the star.

    Args:
        bench: For the device.
    """
    found = dimension_counts(WALKS, device=bench.device)
    return {
        name: {"flagged": float(np.mean(counts.flagged)), "changed": float(np.mean(counts.changed))}
        for name, counts in found.items()
    }


def dimension_counts(walks: int, **options) -> dict[str, Followed]:
    """Return the walks that a cut across an arm of a star changes, in the plane and in the prism on the star.

    The points in the prism are those of the plane at half of its height, which is as wide as the arm is at the cut.

    Args:
        walks: Walks a point.
        options: Further options of the coordinates.
    """
    angle = np.pi / 5.0 * np.arange(10)
    outline = np.where(np.arange(10) % 2 == 0, 1.0, 0.4)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    plane = Cage(outline, [(i, (i + 1) % 10) for i in range(10)])
    points = np.random.default_rng(1).uniform(-1.0, 1.0, (4000, 2))
    points, height = spread(points[plane.contains(points)], 2 * POINTS), 0.3
    sides = [(i, (i + 1) % 10, 10 + (i + 1) % 10, 10 + i) for i in range(10)]
    corners = np.concatenate([np.c_[outline, np.full(10, z)] for z in (0.0, height)])
    prism = Cage(corners, [tuple(range(10))[::-1], tuple(range(10, 20)), *sides])
    inside = np.c_[points, np.full(len(points), 0.5 * height)]
    upright = Blade((0.6, 1.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0))
    return {
        "star in 2D": follow(plane, points, Blade((0.6, 1.0), (0.0, -1.0)), walks, step=_STAR_STEP, **options),
        "prism in 3D": follow(prism, inside, upright, walks, step=_STAR_STEP, **options),
    }


def _plane_table(record: Record) -> Table:
    rows = [
        [name, *(f"{100.0 * counts[share]:.2f}" for share in ("flagged", "changed"))]
        for name, counts in record.values.items()
    ]
    title = (
        "The plane beside space: a cut across an arm of a star in the plane, and of the prism on that star, in steps "
        "of 3 %; the paper finds cuts in space more local."
    )
    return Table(title, ["body", "walked again a step [%]", "changed [%]"], rows)

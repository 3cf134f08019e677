# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Sequences of edits of cages, with the coordinates of some points."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from benchmarks.fingerprint_record import Record
from benchmarks.fingerprint_shapes import SQUARE, U_OUTLINE, across, cage_on, down, points_in, star
from newton_cagecut import Blade, Cage, CageEdit, Cut, HarmonicCoordinates

Edits = Iterator[tuple[str, CageEdit]]
"""Steps, each with its name."""
WALKS = 64
DEPTHS = (0.2, 0.55, 1.1)
"""Shares of a cut's length."""


def steps(cut: Cut, name: str = "cut", shares: tuple[float, ...] = DEPTHS) -> Edits:
    """Yield the advances of a cut.

    Args:
        cut: The cut.
        name: What the steps are called.
        shares: Depths, as shares of the cut's length as it is now.
    """
    length = cut.length
    for share in shares:
        yield f"{name} to {share:g}", cut.advance(to=share * length)


def bake(cage: Cage, points: np.ndarray, **options) -> HarmonicCoordinates:
    """Return coordinates of points, every other one with gradients.

    Args:
        cage: The cage.
        points: The points [m].
        options: Options of the coordinates.
    """
    defaults = {"walks": WALKS, "seed": 7, "gradients": np.arange(len(points)) % 2 == 0, "device": "cpu"}
    return HarmonicCoordinates(cage, points, **{**defaults, **options})


def follow(record: Record, cage: Cage, edits: Edits, points: np.ndarray | None = None, **options) -> None:
    """Record a cage and its edits, with coordinates unless integers are all that is wanted.

    Args:
        record: The record.
        cage: The cage before the edits.
        edits: The edits.
        points: Points to keep coordinates of [m]; random ones by default.
        options: Options of the coordinates.
    """
    record.begin("start")
    record.add_cage(cage)
    coordinates = None
    if not record.integers:
        coordinates = bake(cage, points_in(cage) if points is None else points, **options)
        record.add_coordinates(coordinates)
    for name, edit in edits:
        record.begin(name)
        record.add_edit(edit)
        if coordinates is not None:
            record.add_stats(coordinates.update(edit))
            record.add_coordinates(coordinates)


def plain_cut(record: Record, dimension: int) -> None:
    """Cut a square or a cube in two."""
    cage = cage_on(SQUARE, dimension)
    follow(record, cage, steps(Cut(cage, down(dimension)), shares=(0.1, 0.3, 0.6, 0.9, 1.1)))


def polygons(record: Record, dimension: int) -> None:
    """Cut a star, in space a prism with faces of ten corners, into several pieces."""
    cage = cage_on(star(), dimension)
    blade = Blade([0.1, 0.55], [-1.0, 0.1]) if dimension == 2 else Blade([0.1, 0.55, 0.5], [0, 0.1, 1], [-1, 0.1, 0])
    follow(record, cage, steps(Cut(cage, blade)))


def crossing(record: Record, dimension: int) -> None:
    """Cut half through, cut across that, and go on with the first cut."""
    cage = cage_on(SQUARE, dimension)

    def edits() -> Edits:
        first = Cut(cage, down(dimension))
        yield from steps(first, "first", (0.3, 0.6))
        second = Cut(first.cage, across(dimension))
        yield from steps(second, "second", (0.4, 1.1))
        first.resume(second.cage)
        yield from steps(first, "first again", (0.8, 1.2))

    follow(record, cage, edits())


def turning(record: Record, dimension: int) -> None:
    """Turn the blade about its front, twice."""
    cage = cage_on(SQUARE, dimension)

    def edits() -> Edits:
        cut = Cut(cage, down(dimension))
        yield from steps(cut, "straight", (0.3,))
        for name, sign in (("left", 1.0), ("right", -1.5)):
            cut.turn(cut.plane.across + 0.5 * sign * cut.plane.normal)
            yield from steps(cut, name, (0.5, 0.7) if sign > 0.0 else (0.9, 1.1))

    follow(record, cage, edits())


def knife(record: Record) -> None:
    """Cut with a knife of finite width from above, then with one that starts inside, across the first."""
    cage = cage_on(SQUARE, 3)

    def edits() -> Edits:
        above = Cut(cage, Blade([0.5, 0.5, 0.5], [0, 1, 0.1], [0.1, 0, -1], width=(-0.2, 0.15)))
        yield from steps(above, "from above")
        inside = Cut(above.cage, Blade([0.5, 0.5, 0.3], [1, 0.05, 0], [0, 0.1, -1], width=(-0.3, 0.25), start=-0.2))
        yield from steps(inside, "inside", (0.3, 0.7))

    follow(record, cage, edits())


def inner_knife(record: Record) -> None:
    """Cut with a knife that is wholly inside, then from the middle through a part of the body."""
    cage = cage_on(SQUARE, 3)

    def edits() -> Edits:
        inside = Cut(cage, Blade([0.5, 0.5, 0.65], [1, 0.1, 0], [0, 0.1, -1], width=0.3, start=0.0))
        yield from steps(inside, "inside", (0.3, 0.6))
        ahead = Cut(inside.cage, Blade([0.3, 0.5, 0.55], [0, 1, 0.1], [0.1, 0, -1], start=0.0))
        yield from steps(ahead, "ahead")

    follow(record, cage, edits())


def one_leg(record: Record, dimension: int) -> None:
    """Start between the legs of a U and cut off one of them."""
    cage = cage_on(U_OUTLINE, dimension, 0.8)
    blade = Blade([1.5, 2.05], [1.0, 0.05], start=0.0)
    if dimension == 3:
        blade = Blade([1.5, 2.05, 0.4], [0.05, 0.1, 1.0], [1.0, 0.05, 0.0], start=0.0)
    follow(record, cage, steps(Cut(cage, blade)))


def extension(record: Record, dimension: int) -> None:
    """Move a face, extrude two, and cut through what has grown."""
    cage = cage_on(SQUARE, dimension)

    def edits() -> Edits:
        edit = cage.move_face(1, 0.2)
        yield "moved", edit
        edit = edit.cage.extrude(1, 0.3)
        yield "extruded", edit
        edit = edit.cage.extrude(2, 0.25)
        yield "extruded again", edit
        yield from steps(Cut(edit.cage, down(dimension)))

    follow(record, cage, edits())


def obstacle(record: Record, dimension: int) -> None:
    """Insert an obstacle, cut into it and on, and insert another one."""
    cage, unit = cage_on(SQUARE, dimension), cage_on(SQUARE, dimension)

    def small(middle: float) -> Cage:
        return Cage(0.15 * (unit.vertices - 0.5) + middle, unit.faces)

    first = cage.insert(small(0.42))

    def edits() -> Edits:
        yield "inserted", first
        cut = Cut(first.cage, down(dimension))
        yield from steps(cut)
        yield "inserted again", cut.cage.insert(small(0.8))

    points = points_in(first.cage)
    follow(record, cage, edits(), points[(np.abs(points - 0.8) > 0.08).any(axis=1)])


def random_cuts(record: Record, dimension: int) -> None:
    """Cut cages again and again, at random and with turns, each sequence of cuts as one step."""
    for seed in range(9):
        rng, inner = np.random.default_rng(seed), Record(integers=record.integers)
        cage = cage_on((SQUARE, U_OUTLINE, star())[seed % 3], dimension)
        follow(inner, cage, _random_edits(cage, rng), points_in(cage, 10), walks=16)
        record.begin(f"seed {seed}")
        record.add_steps(inner)


def _random_edits(cage: Cage, rng: np.random.Generator) -> Edits:
    """Yield the steps of some cuts, one after the other."""
    low, high = cage.vertices.min(axis=0), cage.vertices.max(axis=0)
    for number in range(3):
        middle = low + (high - low) * rng.uniform(0.3, 0.7, cage.dimension)
        cut = Cut(cage, Blade(middle, *rng.normal(size=(cage.dimension - 1, cage.dimension))))
        for part in range(4):
            if cut.complete:
                break
            rest = max(0.1, cut.length - cut.depth)
            yield f"cut {number} part {part}", cut.advance(to=cut.depth + rng.uniform(0.1, 0.6) * rest)
            if rng.random() < 0.4 and not cut.complete:
                cut.turn(cut.plane.across + rng.uniform(-1.5, 1.5) * cut.plane.normal)
        cage = cut.cage


def variant(record: Record, dimension: int, **options) -> None:
    """Cut a square or a cube with other options of the coordinates."""
    cage = cage_on(SQUARE, dimension)
    follow(record, cage, steps(Cut(cage, down(dimension)), shares=(0.5, 1.1)), **options)

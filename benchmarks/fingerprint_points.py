# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Sequences in which the points change, cuts are undone and coordinates are kept in files."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.fingerprint_cages import bake
from benchmarks.fingerprint_record import Record
from benchmarks.fingerprint_shapes import SQUARE, across, cage_on, down, points_in, star
from newton_cagecut import CageEdit, Cut, HarmonicCoordinates
from newton_cagecut.usd import read_cage, write_cage


def undo(record: Record, dimension: int) -> None:
    """Go back to a snapshot, and by depth, and cut on from there."""
    cage = cage_on(SQUARE, dimension)
    cut = Cut(cage, down(dimension))
    coordinates = None if record.integers else bake(cage, points_in(cage), vertex_capacity=40, point_capacity=40)

    def note(step: str, edit: CageEdit | None = None) -> None:
        record.begin(step)
        if edit is None:
            record.add_cage(cut.cage)
        else:
            record.add_edit(edit)
        if coordinates is not None:
            if edit is not None:
                record.add_stats(coordinates.update(edit))
            record.add_coordinates(coordinates)

    note("cut to 0.3", cut.advance(to=0.3))
    known, kept = cut.snapshot(), coordinates and coordinates.snapshot()
    note("cut to 0.6", cut.advance(to=0.6))
    note("cut to 1.5", cut.advance(to=1.5))
    cut.rewind(known)
    if coordinates is not None:
        coordinates.restore(kept)
    note("restored")
    note("cut again", cut.advance(to=0.9))
    record.begin("rewound")
    record.add_cage(cut.rewind(0.4))
    if coordinates is not None:
        coordinates.recompute()
        record.begin("recomputed")
        record.add_coordinates(coordinates)


def files(record: Record, dimension: int) -> None:
    """Keep coordinates and a cage in files, and go on with those read."""
    cage = cage_on(star(), dimension)
    points, cut = points_in(cage), Cut(cage, down(dimension, 0.1))
    coordinates = bake(cage, points)
    coordinates.update(cut.advance(to=0.4))
    with TemporaryDirectory() as folder:
        coordinates.save(Path(folder) / "coordinates")
        loaded = HarmonicCoordinates.load(Path(folder) / "coordinates", cut.cage, points, device="cpu")
        write_cage(Path(folder) / "cage.usda", cut.cage)
        text = (Path(folder) / "cage.usda").read_text()
        write_cage(Path(folder) / "whole.usda", cage)
        again = read_cage(Path(folder) / "whole.usda")
    record.begin("read")
    record.add_coordinates(loaded)
    record.add_cage(again)
    record.add(usd=text)
    record.begin("cut on")
    record.add_stats(loaded.update(cut.advance(to=2.5)))
    record.add_coordinates(loaded)


def points(record: Record, dimension: int) -> None:
    """Set and remove points, on the boundary and on a cut too, and ask for the weights of others."""
    cage, some = cage_on(SQUARE, dimension), points_in(cage_on(SQUARE, dimension))
    low, middle = np.zeros(dimension), np.full(dimension, 0.5)
    edge, face = np.append(0.5, low[1:]), np.append(middle[:-1], 0.0)
    coordinates = bake(cage, np.concatenate([some, [low, edge, face]]), point_capacity=60)
    cut = Cut(cage, down(dimension))
    coordinates.update(cut.advance(to=0.7))
    record.begin("cut")
    record.add_coordinates(coordinates)
    coordinates.remove_points(np.array([3, 5, 8]))
    record.begin("removed")
    record.add_coordinates(coordinates)
    count = coordinates.point_count
    tip, keys = cut.plane.origin + (cut.front - 0.1) * cut.plane.direction, 2 * cut.wall + np.array([0, 1, 0])
    where = np.stack([tip, tip, some[5] * 0.5])
    record.begin("set")
    indices, on_wall = np.array([5, count, count + 1]), np.where([True, True, False], keys, -1)
    record.add_stats(coordinates.set_points(indices, where, on_wall))
    record.add_coordinates(coordinates)
    record.begin("others")
    record.add(
        weights_at=coordinates.weights_at(some * 0.9 + 0.05, walks=64),
        boundary_weights=coordinates.boundary_weights(where[:2], keys[:2], walks=64),
    )
    crossing = Cut(coordinates.cage, across(dimension))
    for depth in (0.3, 0.8, 1.6):
        record.begin(f"across to {depth:g}")
        record.add_stats(coordinates.update(crossing.advance(to=depth)))
        record.add_coordinates(coordinates)

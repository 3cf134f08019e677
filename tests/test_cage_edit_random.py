# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Random sequences of every kind of edit: faces extruded and moved, obstacles put in, cuts begun and gone on with."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cage_shapes import SHAPES, box, check_manifold, opened_characteristic, prism, random_blade, tetrahedron
from cut_sequences import crossings
from extension_checks import check_edit
from newton_cagecut.cage import Cage, CageEdit, Cut
from plane_shapes import PLANES, outline, ring, square

EVERY = SHAPES | PLANES
OBSTACLES = {
    2: (square(), outline(ring(7)), outline(ring(5, inner=0.5))),
    3: (box(), tetrahedron(), prism(ring(5, inner=0.5))),
}


class _Player:
    """A cage and the cuts that are in progress in it."""

    def __init__(self, cage: Cage, rng: np.random.Generator):
        self.cage = cage
        self.rng = rng
        self.cuts: list[Cut] = []
        self.done: list[str] = []

    def step(self) -> None:
        """One edit, unless it is refused; then the cage is what it was."""
        name = str(self.rng.choice(["extrude", "move_face", "insert", "cut", "cut", "resume"]))
        if getattr(self, f"_{name}")():
            self.done.append(name)

    def _extrude(self) -> bool:
        return self._extend("extrude")

    def _move_face(self) -> bool:
        return self._extend("move_face")

    def _extend(self, method: str) -> bool:
        face = int(self.rng.integers(self.cage.face_count))
        distance = float(self.rng.choice([0.02, 0.1, 0.5]) * self.cage.diameter)
        added = distance * float(np.linalg.norm(self.cage.mesh.face_area_vector[face]))
        return self._carry_out(lambda: getattr(self.cage, method)(face, distance), added)

    def _carry_out(self, edit: Callable[[], CageEdit], added: float) -> bool:
        try:
            done = edit()
        except ValueError:
            return False
        check_edit(done, added)
        self.cage = done.cage
        return True

    def _insert(self) -> bool:
        low, high = self.cage.vertices.min(axis=0), self.cage.vertices.max(axis=0)
        shape = OBSTACLES[self.cage.dimension][self.rng.integers(3)]
        size = self.rng.choice([0.03, 0.1, 0.3]) * self.cage.diameter / shape.diameter
        turn = np.linalg.qr(self.rng.normal(size=(self.cage.dimension, self.cage.dimension)))[0]
        turn[0] *= np.linalg.det(turn)
        points = size * (shape.vertices - shape.vertices.mean(axis=0)) @ turn
        obstacle = Cage(points + self.rng.uniform(low, high), shape.faces)
        return self._carry_out(lambda: self.cage.insert(obstacle), -obstacle.volume)

    def _cut(self) -> bool:
        self.cuts.append(Cut(self.cage, random_blade(self.rng, self.cage)))
        return self._advance(self.cuts[-1])

    def _resume(self) -> bool:
        if not self.cuts:
            return False
        cut = self.cuts[self.rng.integers(len(self.cuts))]
        if cut.cage is not self.cage:
            try:
                cut.resume(self.cage)
            except ValueError as error:
                if "cage has grown across the" in str(error) and {"extrude", "move_face"} & set(self.done):
                    return False
                raise
        return self._advance(cut)

    def _advance(self, cut: Cut) -> bool:
        volume, base = self.cage.volume, cut._strips[-1][0].base
        edit = cut.advance(to=cut.depth + self.rng.choice([0.3, 0.7, 1.1]) * max(0.0, cut.length - cut.depth))
        self.cage = edit.cage
        if edit.is_empty:
            return False
        check_manifold(self.cage, volume, rtol=1e-7, hollow=True)
        assert self.cage.euler_characteristic == opened_characteristic(base, self.cage, cut.wall)
        assert crossings(self.cage) == 0
        return True


@pytest.mark.parametrize("name", EVERY)
@settings(max_examples=8, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.integers(0, 2**32 - 1))
def test_edits_of_every_kind(name, seed):
    """Extended, obstructed and cut in any order, a cage stays a closed manifold of the right volume."""
    player = _Player(EVERY[name](), np.random.default_rng(seed))
    for _ in range(8):
        player.step()
    assert crossings(player.cage) == 0

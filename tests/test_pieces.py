# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Pieces: what of a cage, a surface and a mass belongs to which."""

from __future__ import annotations

import newton
import numpy as np
import pytest

import newton_cagecut as cagecut
from cage_shapes import box, u_shape, voxels
from newton_cagecut.cage import Cut
from newton_cagecut.section import Blade
from surface_shapes import sphere


def test_components_of_an_edit():
    """Legs of a U come off one by one; every vertex and face belongs to one piece and the volumes add up."""
    base = u_shape()
    cut = Cut(base, Blade([1.5, 2.0, 0.4], [0, 0, 1], [1, 0, 0]))
    seen = []
    for depth in (0.5, 1.2, 1.8, 2.5, 3.2):
        edit = cut.advance(to=depth)
        pieces = edit.pieces
        seen.append((len(pieces), edit.separated))
        assert sorted(np.concatenate([piece.vertices for piece in pieces])) == list(range(edit.cage.vertex_count))
        assert sorted(np.concatenate([piece.faces for piece in pieces])) == list(range(edit.cage.face_count))
        assert sum(piece.volume for piece in pieces) == pytest.approx(base.volume, rel=1e-12)
        for piece in pieces:
            assert {v for f in piece.faces for v in edit.cage.faces[f]} == set(piece.vertices.tolist())
    assert seen == [(1, False), (2, True), (2, False), (2, False), (3, True)]
    assert sorted(piece.volume for piece in pieces) == pytest.approx([0.8, 0.8, 4.0])


def test_cavity_belongs_to_the_piece_around_it():
    """A hollow body is one piece, and two after a cut through the cavity."""
    cells = [(i, j, k) for i in range(3) for j in range(3) for k in range(3) if (i, j, k) != (1, 1, 1)]
    base = voxels(cells, np.ones(3))
    assert base.component_count == 2
    cut = Cut(base, Blade([1.5, 1.5, 1.4], [1, 0.1, 0.02], [0, 1, 0.1]))
    first = cut.advance(to=0.2)
    assert [piece.volume for piece in first.pieces] == pytest.approx([26.0])
    assert len(first.pieces[0].vertices) == first.cage.vertex_count
    assert not first.separated
    last = cut.advance(to=5.0)
    assert last.separated
    assert sum(piece.volume for piece in last.pieces) == pytest.approx(26.0)


def test_pieces_of_a_body():
    """A ball in a box cut in two: points, triangles, volume and mass fall to the piece on their side."""
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    cagecut.SolverCageCut.register_custom_attributes(builder)
    material = cagecut.Material(young=1e4, density=500.0)
    cagecut.add_cage_body(builder, box(), sphere(2, 0.4), walks=32, quadrature=60, material=material)
    solver = cagecut.SolverCageCut(builder.finalize(device="cpu"))
    (whole,) = solver.pieces(0)
    assert whole.mass == pytest.approx(500.0)
    assert len(whole.surface_triangles) == solver.bodies[0].surface.triangle_count
    cut = solver.begin_cut(0, Blade([0.37, 0.5, 0.5], [0, 1, 0], [0, 0, -1]))
    assert not solver.advance_cut(cut, 0.5).separated
    assert len(solver.pieces(0)) == 1
    assert solver.advance_cut(cut, 1.0).separated
    pieces, surface = solver.pieces(0), solver.bodies[0].surface
    assert [piece.mass for piece in pieces] == pytest.approx([185.0, 315.0])
    used = np.concatenate([piece.surface_triangles for piece in pieces])
    assert sorted(used) == list(range(surface.triangle_count))
    for piece, sign in zip(pieces, (-1.0, 1.0), strict=True):
        side = (surface.points[surface.triangles[piece.surface_triangles]].mean(axis=1)[:, 0] - 0.37) * sign
        assert side.min() > -1e-9
        assert set(surface.triangles[piece.surface_triangles].ravel()) <= set(piece.surface_points.tolist())

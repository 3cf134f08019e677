# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The tools that the assets are made with."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from assets import fields
from assets.implicit import mesh_field
from assets.planar_tube import planar_tube, tube_faces
from assets.prism import prism_faces, split_quads
from newton_cagecut.cage import Cage

RING = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
SHAPES = {
    "ball": (lambda p: fields.ball(p, (0.1, 0.0, 0.0), 0.5), (0.6, 0.0, 0.0)),
    "ellipsoid": (lambda p: fields.ellipsoid(p, (0.0, 0.0, 0.0), (0.3, 0.6, 0.9)), (0.0, 0.0, -0.9)),
    "cone": (lambda p: fields.cone(p, (0, 0, 0), (0, 0, 1), 0.2, 0.4), (0.3, 0.0, 0.5)),
    "box": (lambda p: fields.box(p, (0, 0, 0), (0.5, 0.6, 0.7), 0.1), (0.2, -0.6, 0.3)),
    "slab": (lambda p: fields.slab(np.hypot(p[:, 0], p[:, 1]), p[:, 2], 0.6, 0.2, 0.1), (0.3, 0.0, 0.2)),
}


@pytest.mark.parametrize("name", SHAPES)
def test_field_measures_the_distance_near_its_skin(name):
    """It is zero at a point of the skin, negative inside, and grows by 1 a metre straight out of the skin."""
    field, place = SHAPES[name]
    place, step = np.array([place]), 1e-5
    slope = np.array([(field(place + step * axis) - field(place - step * axis))[0] for axis in np.eye(3)]) / (2 * step)
    assert abs(field(place)[0]) < 1e-9
    assert field(place - 0.01 * slope)[0] < 0.0
    assert np.linalg.norm(slope) == pytest.approx(1.0, abs=0.02)


def test_union_is_the_least_of_its_parts_away_from_where_they_meet():
    """Where one part is nearer by much more than the blend it decides alone; where two are equal, they gain."""
    near, far = np.array([0.1, 0.2]), np.array([3.0, 0.2])
    value = fields.union([near, far], 0.04)
    assert value[0] == pytest.approx(0.1, abs=1e-12)
    assert value[1] == pytest.approx(0.2 - 0.01 * np.log(2.0))


def test_field_is_meshed_with_a_wanted_spacing():
    """A ball whose points may lie farther apart on its upper half has fewer of them there, and is closed."""
    points, triangles = mesh_field(
        lambda p: fields.ball(p, (0, 0, 0), 1.0),
        (-1.1, -1.1, -1.1),
        (1.1, 1.1, 1.1),
        400,
        seed=0,
        iterations=0,
        spacing=lambda p: 1.5 + 0.5 * np.tanh(4.0 * p[:, 2]),
    )
    assert len(triangles) == 2 * 400 - 4
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 1.0, atol=1e-6)
    assert 2.0 < np.count_nonzero(points[:, 2] < 0) / np.count_nonzero(points[:, 2] > 0) < 4.5


BEND, TWIST = st.floats(-0.25, 0.25), st.floats(-0.03, 0.03)  # planar sides cannot follow much of a twist


@settings(max_examples=25, deadline=None)
@given(st.lists(st.tuples(BEND, BEND, TWIST, BEND), min_size=1, max_size=8))
def test_tube_along_any_gentle_curve_is_of_planar_quads(turns):
    """Rings that turn and grow at random leave a tube whose sides are planar, in rings near the wanted ones."""
    place, frame, wanted = np.zeros(3), np.eye(3), []
    for a, b, c, growth in turns:
        spin = np.array([[1, -c, b], [c, 1, -a], [-b, a, 1]])
        frame, triangle = np.linalg.qr(spin @ frame)
        frame = frame * np.sign(np.diag(triangle))
        place = place + 2.0 * frame[:, 2]
        wanted.append((1.0 + growth) * RING @ frame.T + place)
    rings = [RING, *planar_tube(RING, wanted)]
    count = 4 * len(rings)
    faces = [(3, 2, 1, 0), *tube_faces(np.arange(count).reshape(-1, 4).tolist()), tuple(range(count - 4, count))]
    cage = Cage(np.concatenate(rings), faces)  # refuses faces that are not planar
    assert cage.euler_characteristic == 2
    assert max(np.linalg.norm(ring - aim, axis=1).max() for ring, aim in zip(rings[1:], wanted)) < 1.0


def test_prism_over_a_frame_has_walls_around_it_and_in_its_hole():
    """Four pieces around a square hole make a closed cage with a handle."""
    square = RING[:, :2]
    pieces = [(k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k) for k in range(4)]
    outline = np.concatenate([square, 0.5 * square])
    corners = np.concatenate([np.column_stack([outline, np.full(8, z)]) for z in (0.3, -0.3)])
    cage = Cage(corners, prism_faces(pieces, 8))
    assert (cage.face_count, cage.euler_characteristic) == (16, 0)
    assert cage.volume == pytest.approx((4.0 - 1.0) * 0.6)
    assert Cage(corners, split_quads(prism_faces(pieces, 8))).face_count == 32

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Bridges from holes to the loops around them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from newton_cagecut.geometry import bridge_holes, contains_point, signed_area, triangulate


def _join(loops):
    """Bridge holes given by coordinates; the loop and its corners."""
    points = np.concatenate([np.array(loop, dtype=float) for loop in loops])
    ends = np.cumsum([len(loop) for loop in loops])
    labels = [list(range(end - len(loop), end)) for loop, end in zip(loops, ends, strict=True)]
    joined = bridge_holes(labels[0], labels[1:], points)
    return joined, points[joined]


def _check(loops):
    """The joined loop is a disc without its holes: triangles of positive area that add up and avoid the holes."""
    joined, corners = _join(loops)
    count = sum(len(loop) for loop in loops)
    assert len(joined) == count + 2 * (len(loops) - 1)
    assert len(set(joined)) == count
    area = sum(signed_area(np.array(loop, dtype=float)) for loop in loops)
    triangles = corners[triangulate(corners)]
    u, v = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    parts = 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    assert parts.min() >= -1e-12
    assert parts.sum() == pytest.approx(area, rel=1e-12)
    return joined


SQUARE = [[0, 0], [10, 0], [10, 10], [0, 10]]


def test_hole_in_a_square():
    """The nearest corners are joined, and the bridge is walked both ways."""
    joined = _check([SQUARE, [[4, 4], [4, 5], [8, 9], [5, 4]]])
    edges = set(zip(joined, joined[1:] + joined[:1], strict=True))
    assert (2, 6) in edges
    assert (6, 2) in edges


def test_edge_in_the_way():
    """A bridge does not cross the long edge of another hole, though the corners behind it are nearest."""
    wall = [[1, 2.4], [1, 2.5], [9, 2.5], [9, 2.4]]
    outer = [[0, 0], [5, 2], [10, 0], [10, 10], [0, 10]]
    joined = _check([outer, [[4.9, 3], [4.9, 3.5], [5.1, 3.5], [5.1, 3]], wall])
    first_hole = {5, 6, 7, 8}
    edges = set(zip(joined, joined[1:] + joined[:1], strict=True))
    assert all((1, corner) not in edges for corner in first_hole)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_both_sides_of_a_slit(side):
    """A hole beside a slit is joined to the corner on its own side, of two that coincide."""
    outer = [[0, 0], [5, 0], [5, 5], [5, 8], [5, 5], [5, 0], [10, 0], [10, 10], [0, 10]]
    x = 5.0 + side
    hole = [[x, 5], [x - 0.3, 5.2], [x, 5.4], [x + 0.3, 5.2]]
    joined = _check([outer, hole])
    edges = set(zip(joined, joined[1:] + joined[:1], strict=True))
    own = 4 if side > 0 else 2
    assert any((own, corner) in edges for corner in range(9, 13))


def test_corners_in_line():
    """A bridge does not run along other corners or edges."""
    outer = [[0, 0], [10, 0], [10, 10], [0, 10], [0, 6], [2, 5], [0, 4]]
    holes = [[[4, 5], [5, 6], [6, 5], [5, 4]], [[7, 5], [8, 6], [9, 5], [8, 4]]]
    _check([outer, *holes])


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_random_holes(seed):
    """Random holes in random star-shaped polygons are joined to one disc."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(4, 30))
    angle = (np.arange(count) + rng.uniform(0.1, 0.9, count)) * 2.0 * np.pi / count
    outer = np.c_[np.cos(angle), np.sin(angle)] * rng.uniform(14.0, 20.0, count)[:, None]
    loops = [outer]
    for cell in rng.permutation(16)[: rng.integers(1, 7)]:
        n = int(rng.integers(3, 9))
        turn = -(np.arange(n) + rng.uniform(0.0, 0.9, n)) * 2.0 * np.pi / n
        radius = rng.uniform(0.2, 0.99, n)[:, None]
        loops.append(np.c_[np.cos(turn), np.sin(turn)] * radius + 2.2 * np.array([cell % 4 - 1.5, cell // 4 - 1.5]))
    if count >= 6:
        _check([loop.tolist() for loop in loops])


def test_contains_point():
    """Counting crossings tells inside from outside, in the notch of a U as well."""
    polygon = np.array([[0, 0], [3, 0], [3, 3], [2, 3], [2, 1], [1, 1], [1, 3], [0, 3]], dtype=float)
    assert contains_point(polygon, np.array([0.5, 2.0]))
    assert contains_point(polygon, np.array([1.5, 0.5]))
    assert not contains_point(polygon, np.array([1.5, 2.0]))
    assert not contains_point(polygon, np.array([-1.0, 1.0]))

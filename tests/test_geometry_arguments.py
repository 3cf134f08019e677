# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Arguments as numbers and arrays, unit vectors, and the errors of what is neither."""

from __future__ import annotations

import numpy as np
import pytest

from newton_cagecut.geometry import (
    PolygonMesh,
    as_callback,
    as_flag,
    as_index,
    as_indices,
    as_instance,
    as_integers,
    as_loops,
    as_number,
    as_points,
    as_sequence,
    as_vector,
    check_finite,
    dots,
    units,
)


@pytest.mark.parametrize(
    ("call", "error", "text"),
    [
        (lambda: as_number("x", "the depth"), TypeError, "the depth must be a number, got 'x'"),
        (lambda: as_number("3", "the depth"), TypeError, "the depth must be a number, got '3'"),
        (lambda: as_number(True, "the depth"), TypeError, "the depth must be a number, got True"),
        (lambda: as_vector(None, "the way", dimension=3), TypeError, "the way must be three numbers, got None"),
        (lambda: as_vector(["1", "2"], "the way"), TypeError, "the way must be three numbers, or two in the plane"),
        (lambda: as_indices([0, 5], "rows", of="point", limit=5), ValueError, "rows: 5 is no point; there are 5"),
        (lambda: as_indices(None, "rows", of="point"), TypeError, "rows must be integers, got None"),
        (lambda: as_instance(3, PolygonMesh, "the mesh"), TypeError, "the mesh must be a PolygonMesh, got int"),
        (
            lambda: as_sequence(3, int, "the counts"),
            TypeError,
            r"must be a sequence of int, got one int; pass the counts=",
        ),
        (lambda: as_sequence([3, "x"], int, "the counts"), TypeError, r"the counts\[1\] must be an int, got str"),
        (lambda: as_callback(3, "progress"), TypeError, "progress must be a function or None, got 3"),
        (lambda: as_flag(1, "closed"), TypeError, "closed must be True or False, got 1"),
        (lambda: as_number(np.nan, "the depth"), ValueError, "the depth must be a number, got nan"),
        (lambda: as_index(1.0, "the face"), TypeError, "the face must be an integer, got 1.0"),
        (lambda: as_vector("up", "the way", dimension=2), TypeError, "the way must be two numbers, got 'up'"),
        (
            lambda: as_vector([1, 2, 3, 4], "the origin"),
            ValueError,
            r"shape \(3,\), or \(2,\) in the plane, got \(4,\)",
        ),
        (lambda: as_vector([1, np.inf], "the way", dimension=2), ValueError, r"the way is not finite: \[1.0, inf\]"),
        (
            lambda: as_points([[1], [2]], "the uvs", rows="point_count", widths=(2,)),
            ValueError,
            r"the uvs must have shape \(point_count, 2\), got \(2, 1\)",
        ),
        (lambda: check_finite(np.array([[0.0], [np.nan]]), "the uvs"), ValueError, "the uvs: row 1 is not finite"),
        (lambda: as_integers([0.5], "the labels", shape=(1,)), TypeError, "the labels must be integers, got float64"),
        (lambda: as_integers([1, 2], "the labels", shape=(3,)), ValueError, r"the labels must have shape \(3,\), got"),
        (
            lambda: as_integers(np.zeros((0, 3), dtype=int), "the triangles", shape=("triangle_count", 3)),
            ValueError,
            r"the triangles must have shape \(triangle_count, 3\), got \(0, 3\)",
        ),
        (lambda: as_loops([(0, 1), "ab"], "the cage"), TypeError, "face 1 of the cage must be a sequence of integers"),
    ],
)
def test_wrong_arguments_are_named(call, error, text):
    """The error says what is wrong and what it must be."""
    with pytest.raises(error, match=text):
        call()


def test_arguments_are_copies():
    """Numbers come back as an array of their own in float64; loops come back flat."""
    points = np.zeros((2, 3))
    assert as_number(np.inf, "the depth") == np.inf
    assert not np.shares_memory(as_points(points, "the points", rows="n", widths=(3, 2)), points)
    assert not np.shares_memory(as_vector(points[0], "the origin"), points)
    start, vertex = as_loops([(0, 1, 2), [2, 1]], "the cage")
    assert start.tolist() == [0, 3, 5]
    assert vertex.tolist() == [0, 1, 2, 2, 1]


def test_unit_vectors_and_dot_products():
    """Vectors without length stay as they are; a dot product does not depend on the vector's place."""
    vectors = np.random.default_rng(0).normal(size=(50, 3))
    np.testing.assert_allclose(np.linalg.norm(units(vectors), axis=1), 1.0)
    assert units(np.array([[0.0, 0.0], [3.0, 4.0]])).tolist() == [[0.0, 0.0], [0.6, 0.8]]
    assert units(np.array([[1e-31, 0.0]]), least=1e-30).tolist() == [[1e-31, 0.0]]
    axis = vectors[7]
    np.testing.assert_array_equal(dots(vectors, axis)[13:20], dots(vectors[13:20], axis))
    np.testing.assert_allclose(dots(vectors[:, :2], axis[:2]), vectors[:, :2] @ axis[:2])

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The report's finite elements against weights that are known, and its references."""

from __future__ import annotations

import numpy as np
import pytest
import warp as wp

from newton_cagecut import Blade, Cage, Cut
from newton_cagecut.report.fit import linear_of, power_of
from newton_cagecut.report.peers.elements import element_weights, located
from newton_cagecut.report.peers.meshing import fill, opened
from newton_cagecut.report.reference.exact_cases import box, tetrahedron
from newton_cagecut.report.reference.long_walks import Reference, long_walks
from plane_shapes import square

# At (0.25, 0.5) in the unit square slit from (0.5, 1) to (0.5, 0.5), by a spectral method: the corners
# counterclockwise from the origin, then the tip.
SLIT = {
    (0, 0): 0.3133712067,
    (1, 0): 0.0633712067,
    (1, 1): 0.0108204283,
    (0, 1): 0.2608204283,
    (0.5, 0.5): 0.2465151734,
}
NOTHING = np.zeros((0, 3))


@pytest.mark.parametrize("order", [1, 2])
def test_tetrahedron_is_exact(order):
    """Linear weights are found to rounding by elements of any degree, and so are their gradients."""
    case = tetrahedron(20)
    has_gradient = np.arange(20) < 5
    weights, gradients, values = element_weights(
        (case.cage, case.cage), [], NOTHING, case.points, has_gradient, order=order, cells=20
    )
    np.testing.assert_allclose(weights, case.weights, atol=1e-9)
    np.testing.assert_allclose(np.einsum("nvi,vj->nij", gradients, case.cage.vertices), [np.eye(3)] * 5, atol=1e-8)
    assert 0.0 < values["solve_seconds"] < values["seconds"]


def test_slit_square_comes_near_the_known_weights():
    """In the plane, on both sides of a slit; finer elements come nearer."""
    cage = square()
    cut = Cut(cage, Blade((0.5, 2.0), (0.0, -1.0)))
    edit = cut.advance(to=0.5)
    point = np.array([[0.25, 0.5]])
    errors = []
    for cells in (40, 400):
        weights, _, _ = element_weights(
            (cage, edit.cage),
            edit.swept,
            np.array([[0.5, 0.5]]),
            point,
            np.array([False]),
            order=2,
            cells=cells,
        )
        known = [np.abs(edit.cage.vertices - place).max(axis=1).argmin() for place in SLIT]
        errors.append(np.abs(weights[0, known] - list(SLIT.values())).max())
    assert errors[1] < errors[0]
    assert errors[1] < 1e-3


def test_cut_box_agrees_with_walks():
    """In space, with slit faces; the weights reproduce the points and are those of long walks but for their noise."""
    case = box(24)
    cut = Cut(case.cage, Blade((0.43, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0)))
    edit = cut.advance(to=0.3)
    front = np.array([[0.43, 0.0, 0.2], [0.43, 0.7, 0.2]])
    has_gradient = np.zeros(24, dtype=bool)
    weights, _, _ = element_weights(
        (case.cage, edit.cage), edit.swept, front, case.points, has_gradient, order=2, cells=300
    )
    np.testing.assert_allclose(weights @ edit.cage.vertices, case.points, atol=1e-6)
    reference = long_walks(edit.cage, case.points, has_gradient | True, runs=2, walks=2048, device=wp.get_device("cpu"))
    difference = np.sqrt(((weights - reference.weights) ** 2).sum(axis=1).mean())
    assert difference < 0.02
    assert difference < 3.0 * np.sqrt(reference.own["weights"]) + 0.005
    np.testing.assert_array_less(reference.check, 2.0)


def test_mesh_is_open_along_the_cut():
    """The mesh keeps the volume; its boundary has both sides of the cut."""
    case = box(1)
    cut = Cut(case.cage, Blade((0.43, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0)))
    edit = cut.advance(to=0.3)
    nodes, simplices = fill(case.cage, edit.swept, np.array([[0.43, 0.0, 0.2], [0.43, 0.7, 0.2]]), 60)
    corner = nodes[simplices]
    volumes = np.abs(np.linalg.det(corner[:, 1:] - corner[:, :1])) / 6.0
    assert volumes.sum() == pytest.approx(case.cage.volume, rel=1e-6)
    facets = np.sort(np.concatenate([np.delete(simplices, k, axis=1) for k in range(4)]), axis=1)
    border, count = np.unique(facets, axis=0, return_counts=True)
    border = nodes[border[count == 1]]
    area = np.linalg.norm(np.cross(border[:, 1] - border[:, 0], border[:, 2] - border[:, 0]), axis=1).sum() / 2.0
    outside = 2.0 * (1.0 * 0.7 + 1.0 * 0.5 + 0.7 * 0.5)
    assert area == pytest.approx(outside + 2.0 * 0.3 * 0.7, rel=1e-6)


def test_sheet_between_triangles_doubles_its_nodes_but_its_end():
    """Of four triangles around a point, a sheet from the border to the point opens; the point stays single."""
    nodes = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    triangles = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])
    found, simplices = opened(nodes, triangles, np.array([[0, 1], [1, 2], [2, 3], [3, 4], [4, 1]]))
    assert len(found) == 6
    assert len(np.unique(simplices[:, 0])) == 1
    np.testing.assert_array_equal(found[simplices], nodes[triangles])


def test_points_are_located():
    """Each point is in the simplex that is returned, with its coordinates there."""
    nodes = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    simplices = np.array([[0, 1, 2], [0, 2, 3]])
    cells, place = located(nodes, simplices, np.array([[0.9, 0.2], [0.1, 0.7]]))
    assert cells.tolist() == [0, 1]
    np.testing.assert_allclose(place, [[0.7, 0.2], [0.1, 0.6]])


def test_reference_is_kept(tmp_path):
    """A reference is read as it was written; a damaged file counts as none."""
    case = tetrahedron(4)
    found = long_walks(case.cage, case.points, np.arange(4) < 2, runs=2, walks=16, device=wp.get_device("cpu"))
    found.save(tmp_path / "some.npz")
    again = Reference.load(tmp_path / "some.npz")
    np.testing.assert_array_equal(again.weights, found.weights)
    assert again.own == found.own
    (tmp_path / "some.npz").write_bytes(b"PK")
    assert Reference.load(tmp_path / "some.npz") is None


def test_powers_and_lines_are_fitted():
    """Exact laws are found; a time that seems to fall with the walks counts as proportional."""
    assert power_of([1, 2, 4], [3.0, 12.0, 48.0]) == pytest.approx(2.0)
    np.testing.assert_allclose(linear_of([1, 2, 4], [3.0, 5.0, 9.0]), (1.0, 2.0))
    start, slope = linear_of([1, 2], [3.0, 2.0])
    assert start == 0.0
    assert slope == pytest.approx(np.sqrt(3.0))


def test_plane_cage_with_a_hole_is_filled():
    """A loop around a hole is left out of the mesh."""
    outer = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    hole = [(0.3, 0.3), (0.3, 0.6), (0.6, 0.6), (0.6, 0.3)]
    cage = Cage(
        np.array(outer + hole), [(k, (k + 1) % 4) for k in range(4)] + [(4 + k, 4 + (k + 1) % 4) for k in range(4)]
    )
    nodes, simplices = fill(cage, [], np.zeros((0, 2)), 20)
    edges = nodes[simplices][:, 1:] - nodes[simplices][:, :1]
    assert np.abs(np.linalg.det(edges)).sum() / 2.0 == pytest.approx(0.91, rel=1e-9)

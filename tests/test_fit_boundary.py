# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The fit of all coordinates: panels, boundary functions, pieces, exactness, and that it is a pure function."""

from __future__ import annotations

import numpy as np
import pytest
import warp as wp

from cage_shapes import box, prism
from harmonic_shapes import (
    MAKERS,
    copies,
    crossing_blade,
    interior_points,
    mean_value,
    multilinear,
    points_inside,
    random_blade,
)
from newton_cagecut.cage import Cage, Cut
from newton_cagecut.harmonic import launch as launching
from newton_cagecut.harmonic.fit.boundary_fit import BoundaryFit
from newton_cagecut.harmonic.fit.face_values import FaceFunctions
from newton_cagecut.harmonic.fit.fit_memory import FitMemory
from newton_cagecut.harmonic.fit.panels import face_panels as panelling
from newton_cagecut.harmonic.fit.panels.face_panels import FacePlanes, affordable_panels, face_panels
from newton_cagecut.harmonic.fit.plane_fit import PlaneFit, polygon_edges
from newton_cagecut.harmonic.walls.frame import UnitFrame
from newton_cagecut.section import Blade
from plane_reference import PlaneReference, plane_reference
from plane_shapes import ring

CPU = wp.get_device("cpu")


def fit(cage: Cage, *, panel_size: float = 1.0, quads: str = "harmonic") -> BoundaryFit:
    """The fit of a cage on the CPU."""
    return BoundaryFit(cage, quads=quads, panel_size=panel_size, device=CPU)


def cut_twice(name: str) -> Cage:
    """A cage cut part of the way, and across that again."""
    cage, rng, edits = MAKERS[name](), np.random.default_rng(5), []
    for share in (0.5, 0.7):
        cut = Cut(cage, crossing_blade(rng, edits) if edits else random_blade(rng, cage))
        edits.append(cut.advance(to=share * cut.length))
        cage = edits[-1].cage
    return cage


def rms(values: np.ndarray) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(values**2)))


@pytest.mark.parametrize("name", ["l_shape", "star", "square"])
def test_polygons(name):
    """In the plane values and gradients converge to those of rational functions."""
    cage = MAKERS[name]()
    points = points_inside(cage, 60, 0)
    exact, slopes = plane_reference(cage, points)
    edges = cage.vertices[np.array(cage.faces)]
    off = []
    for panels in (6, 12, 24):
        plane = PlaneFit(edges, np.array(cage.faces), cage.vertex_count, CPU, panels=panels)
        off.append((rms(plane.values(points) - exact), rms(plane.gradients(points) - slopes)))
    off = np.array(off)
    assert (off[0] < [1e-3, 1e-2]).all()
    assert (off[2] < [2e-5, 3e-4]).all()
    assert (off[2] < np.maximum(off[0] / 8.0, 1e-6)).all()


def test_slit_polygon_on_its_outline():
    """Next to a slit its two sides are told apart; on edges the functions are linear."""
    corners = np.array([[0, 0], [1, 0], [1, 1], [0.5, 1], [0.5, 0.5], [0.5, 1], [0, 1]], dtype=float)
    plane = PlaneFit(*polygon_edges(corners), len(corners), CPU)
    near = plane.values(np.array([[0.5 + 1e-5, 0.8], [0.5 - 1e-5, 0.8]]))
    np.testing.assert_allclose(near[0, 3:6], [0.6, 0.4, 0.0], atol=2e-3)
    np.testing.assert_allclose(near[1, 3:6], [0.0, 0.4, 0.6], atol=2e-3)
    on = plane.values(np.array([[0.25, 0.0], [1.0, 1.0], [0.0, 0.1]]))
    np.testing.assert_allclose(on @ corners, [[0.25, 0.0], [1.0, 1.0], [0.0, 0.1]], atol=1e-12)
    assert np.count_nonzero(on) <= 6


def face_values(corners: np.ndarray, points: np.ndarray, *, quads: str) -> np.ndarray:
    """What corners of a face count at points of its plane."""
    functions = FaceFunctions(corners, quads=quads)
    FaceFunctions.make_fits([functions], CPU)
    return FaceFunctions.values([functions], [points])[0]


def test_face_values():
    """Triangles are linear, quads mean value or harmonic; rectangles are bilinear, as a fit would have them."""
    rng = np.random.default_rng(0)
    triangle = np.array([[0.0, 0.0], [1.0, 0.2], [0.3, 0.9]])
    hats = rng.dirichlet(np.ones(3), 5)
    np.testing.assert_allclose(face_values(triangle, hats @ triangle, quads="harmonic"), hats, atol=1e-14)
    quad = np.array([[0.0, 0.0], [1.0, 0.1], [0.8, 1.1], [0.1, 0.7]])
    points = rng.dirichlet(np.full(4, 2.0), 9) @ quad
    found = face_values(quad, points, quads="mean_value")
    np.testing.assert_allclose(found, [mean_value(quad, point) for point in points], atol=1e-9)
    edge = face_values(quad, 0.25 * quad[:1] + 0.75 * quad[1:2], quads="mean_value")
    np.testing.assert_allclose(edge, [[0.25, 0.75, 0.0, 0.0]], atol=1e-12)
    found = face_values(quad, points, quads="harmonic")
    np.testing.assert_allclose(found, PlaneReference(quad).weights(points), atol=1e-5)
    square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]])
    points = rng.uniform(0.1, 0.9, (9, 2)) * [2.0, 1.0]
    fitted = PlaneFit(*polygon_edges(square), 4, CPU).values(points)
    np.testing.assert_allclose(face_values(square, points, quads="harmonic"), fitted, atol=1e-6)


@pytest.mark.parametrize("name", ["box", "star_prism", "merged_cube", "u_shape"])
def test_panels_tile_the_faces(name):
    """Panels of a cut cage cover every face once, face outward, and charge one side of each cut."""
    cage = cut_twice(name)
    frame = UnitFrame.of(cage.vertices)
    panels = face_panels(cage, frame, FacePlanes(cage, frame), 1.0)
    vector = 0.5 * np.cross(panels.corners[:, 1] - panels.corners[:, 0], panels.corners[:, 2] - panels.corners[:, 0])
    sign = 1.0 - 2.0 * cage.face_side
    outward = np.array([wall.normal for wall in cage.walls])[cage.face_wall] * sign[:, None]
    area = np.einsum("pi,pi->p", vector, outward[panels.face])
    assert (area > 0.0).all()
    np.testing.assert_allclose(area, np.linalg.norm(vector, axis=1), rtol=1e-9)
    tiled = np.bincount(panels.face[panels.valued], weights=area[panels.valued], minlength=cage.face_count)
    expected = np.linalg.norm(cage.mesh.face_area_vector, axis=1) / frame.half_side**2
    np.testing.assert_allclose(tiled, expected, rtol=1e-9, atol=1e-12)
    charged = np.bincount(panels.face[panels.charged], weights=area[panels.charged], minlength=cage.face_count)
    for wall, sheet in enumerate(cage.walls):
        faces = cage.face_wall == wall
        once = expected[faces & ((cage.face_side == 0) | (not sheet.two_sided))].sum()
        several = cage.piece_count > 1 and sheet.two_sided
        assert charged[faces].sum() >= once * (1.0 - 1e-9)
        assert charged[faces].sum() <= (expected[faces].sum() if several else once) * (1.0 + 1e-9)


def test_box_is_trilinear():
    """With harmonic quads a box has trilinear coordinates and their gradients; finer panels are closer to them."""
    cage = box((1.0, 0.7, 1.3))
    points = points_inside(cage, 100, 0)
    piece = np.zeros(len(points), dtype=int)
    exact, slopes = multilinear(cage, points)
    off = []
    for size in (1.0, 0.5, 0.25):
        found = fit(cage, panel_size=size)
        off.append((rms(found.values(points, piece) - exact), rms(found.gradients(points, piece) - slopes)))
    assert off[0][0] < 2e-3
    assert off[0][1] < 2e-2
    assert off[2][0] < off[0][0] / 20.0
    assert off[2][1] < off[0][1] / 20.0


@pytest.mark.parametrize(
    ("name", "quads"),
    [("box", "mean_value"), ("hexagonal_prism", "harmonic"), ("annulus", "harmonic"), ("comb", "harmonic")],
)
def test_cut_cages(name, quads):
    """Cut and cut across, weights sum to 1 and reproduce points by themselves, and to rounding once corrected.

    Those of other pieces are 0, and none is far out of bounds.
    """
    cage = cut_twice(name)
    points = interior_points(cage, 150, np.random.default_rng(1))
    piece = cage.piece_of(points)
    found = fit(cage, quads=quads)
    weights, corrected = found.values(points, piece), found.weights(points, piece)
    np.testing.assert_allclose(weights.sum(axis=1), 1.0, atol=1e-5)  # layers are in single precision
    np.testing.assert_allclose(weights @ cage.vertices, points, atol=1e-5 * cage.diameter)
    assert np.abs(corrected - weights).max() < 1e-5
    np.testing.assert_allclose(corrected.sum(axis=1), 1.0, atol=1e-14)
    np.testing.assert_allclose(corrected @ cage.vertices, points, atol=1e-14 * cage.diameter)
    gradients, slopes = found.gradients(points, piece), found.slopes(points, piece)
    assert np.abs(slopes - gradients).max() < 1e-4 * np.abs(gradients).max()
    limit = 1e-13 * np.abs(slopes).max()
    np.testing.assert_allclose(slopes.sum(axis=1), 0.0, atol=limit)
    identity = np.einsum("vi,pvj->pij", cage.vertices, slopes)
    np.testing.assert_allclose(identity, np.broadcast_to(np.eye(cage.dimension), identity.shape), atol=10.0 * limit)
    assert not corrected[piece[:, None] != cage.vertex_piece].any()
    assert corrected.min() > -0.05
    assert corrected.max() < 1.02


def kinds_of_cuts() -> dict[str, Cut]:
    """Cuts by a knife of finite width, from a place inside, and along a bend."""
    origin, down = [0.5, 0.5, 0.5], [0.0, 0.0, -1.0]
    cuts = {
        "knife": Cut(box(), Blade(origin, [0, 1, 0], down, width=0.4)),
        "inside": Cut(box(), Blade(origin, [0, 1, 0], down, width=0.4, start=-0.2)),
        "bend": Cut(box(), Blade(origin, [0, 1, 0], down)),
    }
    cuts["bend"].advance(to=0.4)
    cuts["bend"].turn([0.5, 0.0, -1.0])
    for name, depth in (("knife", 0.5), ("inside", 0.35), ("bend", 0.7)):
        cuts[name].advance(to=depth)
    return cuts


@pytest.mark.parametrize("name", ["knife", "inside", "bend"])
def test_kinds_of_cuts(name):
    """With several fronts, fronts all around and walls that meet at an angle, fits and walks agree."""
    cage = kinds_of_cuts()[name].cage
    points = points_inside(cage, 10, 1)
    weights = fit(cage).weights(points, np.zeros(len(points), dtype=int))
    walked = copies(cage, points, 512, 10, quads="harmonic")[0]
    error = rms(walked.std(axis=0, ddof=1)) / np.sqrt(10)
    assert rms(weights - walked.mean(axis=0)) < 1.6 * error
    assert weights.min() > -0.01


def test_pieces_that_came_apart():
    """The halves of a box that was cut in two are boxes, whose trilinear coordinates both have."""
    cage = box()
    cut = Cut(cage, Blade([0.5, 0.5, 0.5], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]))
    halves = cut.advance(to=2.0).cage
    assert halves.piece_count == 2
    points = interior_points(halves, 80, np.random.default_rng(3))
    points = points[np.abs(points[:, 0] - 0.5) > 0.05]
    piece = halves.piece_of(points)
    weights = fit(halves).values(points, piece)
    for number in range(2):
        own, columns = piece == number, np.flatnonzero(halves.vertex_piece == number)
        low, high = halves.vertices[columns].min(axis=0), halves.vertices[columns].max(axis=0)
        share = (points[own] - low) / (high - low)
        upper = halves.vertices[columns] > (low + high) / 2.0
        exact = np.where(upper, share[:, None], 1.0 - share[:, None]).prod(axis=2)
        assert rms(weights[np.ix_(own, columns)] - exact) < 2e-3


def test_front_that_only_one_piece_keeps():
    """Where a second cut takes a corner off the one side of a first cut, both pieces have charges there."""
    cage = prism(np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]), 1.0)
    first = Cut(cage, Blade([1.0, 1.0, 0.5], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0])).advance(to=1.5).cage
    cut = Cut(first, Blade([1.4, 1.2, 0.5], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]))
    cage = cut.advance(to=1.2).cage
    assert cage.piece_count == 2
    points = interior_points(cage, 60, np.random.default_rng(3))
    piece = cage.piece_of(points)
    weights = fit(cage).values(points, piece)
    np.testing.assert_allclose(weights @ cage.vertices, points, atol=1e-5)
    assert weights.min() > -0.02
    small = int(cage.piece_volumes.argmin())
    columns = np.flatnonzero(cage.vertex_piece == small)
    low, high = cage.vertices[columns].min(axis=0), cage.vertices[columns].max(axis=0)
    share = (points[piece == small] - low) / (high - low)
    upper = cage.vertices[columns] > (low + high) / 2.0
    exact = np.where(upper, share[:, None], 1.0 - share[:, None]).prod(axis=2)
    single = np.isclose(cage.vertices[columns][:, :2], [1.0, 1.2]).all(axis=1)  # corners that end no other edge
    assert rms((weights[np.ix_(piece == small, columns)] - exact)[:, single]) < 3e-3


@pytest.mark.parametrize("name", ["box", "annulus"])
def test_fit_is_a_pure_function(name, monkeypatch):
    """Reached in one step or in many, by one thread or by several, with kept faces or new ones: the same bits."""
    cage = MAKERS[name]()
    blade = random_blade(np.random.default_rng(5), cage)
    points = interior_points(cage, 40, np.random.default_rng(1))
    slow, fast = Cut(cage, blade), Cut(cage, blade)
    memory = FitMemory(3, CPU)
    for share in (0.2, 0.35, 0.5):
        stepped = slow.advance(to=share * slow.length).cage
        kept = BoundaryFit(stepped, quads="harmonic", panel_size=1.0, device=CPU, memory=memory)
    at_once = fast.advance(to=0.5 * fast.length).cage
    monkeypatch.setattr(launching, "_core_count", lambda: 3)
    monkeypatch.setattr(launching, "_pool", None)
    fresh = fit(at_once)
    piece = stepped.piece_of(points)
    assert np.array_equal(kept.weights(points, piece), fresh.weights(points, piece))
    assert np.array_equal(kept.slopes(points, piece), fresh.slopes(points, piece))
    assert np.array_equal(kept.weights(points[7:9], piece[7:9]), fresh.weights(points, piece)[7:9])
    assert np.array_equal(kept.slopes(points[7:9], piece[7:9]), fresh.slopes(points, piece)[7:9])


def test_scale_and_place_do_not_matter():
    """A cage of a millimetre, far from the origin, has the weights of one of a metre."""
    cage = prism(ring(5, inner=0.45), 0.4)
    points = points_inside(cage, 30, 0)
    piece = np.zeros(len(points), dtype=int)
    small = Cage(cage.vertices * 1e-3 + 7.0, cage.faces)
    first = fit(cage).values(points, piece)
    np.testing.assert_allclose(fit(small).values(points * 1e-3 + 7.0, piece), first, atol=1e-8)


def test_gradings_follow_what_is_affordable(monkeypatch):
    """Cages of many faces have coarser panels; those of too many are refused, and the text says what else there is."""
    cage = MAKERS["star_prism"]()
    frame = UnitFrame.of(cage.vertices)
    planes = FacePlanes(cage, frame)
    counts = [len(face_panels(cage, frame, planes, 1.0, grading).face) for grading in panelling.GRADINGS]
    assert counts == sorted(counts, reverse=True)
    assert counts[0] > 3 * counts[-1]
    monkeypatch.setattr(panelling, "_ENOUGH_UNKNOWNS", 2 * counts[-1])
    assert len(affordable_panels(cage, frame, planes, 1.0).face) < counts[0]
    monkeypatch.setattr(panelling, "_ENOUGH_UNKNOWNS", 1)
    monkeypatch.setattr(panelling, "_MOST_UNKNOWNS", 20)
    with pytest.raises(ValueError, match=r"12 faces has \d+ unknowns, 20 at most: take correction='harmonic'"):
        affordable_panels(cage, frame, planes, 1.0)

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Undo: rewound cuts and restored coordinates are what they were, to the last bit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cage_shapes import box, random_blade
from harmonic_shapes import MAKERS, UNITS
from newton_cagecut.cage import Cage, Cut
from newton_cagecut.harmonic import HarmonicCoordinates
from newton_cagecut.section import Blade
from newton_cagecut.surface import SurfaceCut
from plane_shapes import PLANES
from solver_scenes import both_dimensions, make_solver, simulated
from surface_shapes import bumpy_sphere

BLADE = Blade([0.52, 0.5, 0.5], [0.1, 1.0, 0.05], [0.1, 0.0, -1.0])
BLADES = {2: Blade([0.52, 0.5], [0.1, -1.0]), 3: BLADE}


def _arrays(coordinates: HarmonicCoordinates) -> dict[str, np.ndarray]:
    domain = coordinates.domain
    arrays = {"weights": coordinates.weights, "gradients": coordinates.gradients, "bounds": coordinates.bounds}
    arrays |= coordinates.landings | {"degrees": coordinates.degrees}
    arrays |= {"corner": domain.walls.data.rows.numpy()["corner_0"], "items": domain.grid.cells.items.numpy()}
    arrays |= {"first": domain.grid.cells.first.numpy(), "nearest": domain.grid._nearest.numpy()}
    arrays |= {"loops": domain.faces.loop_vertex.numpy(), "position": coordinates._cache.points.position.numpy()}
    return {name: array.copy() for name, array in arrays.items()}


def _assert_same_cage(one: Cage, two: Cage) -> None:
    assert one.faces == two.faces
    np.testing.assert_array_equal(one.vertices, two.vertices)
    np.testing.assert_array_equal(one.face_key, two.face_key)
    assert len(one.walls) == len(two.walls)


def _coordinates(dimension: int = 3, **options) -> HarmonicCoordinates:
    cage, points = MAKERS[UNITS[dimension - 2]](), np.random.default_rng(3).uniform(0.1, 0.9, (12, dimension))
    return HarmonicCoordinates(cage, points, walks=64, seed=5, gradients=True, device="cpu", **options)


@pytest.mark.parametrize("name", ["box", "star_prism", "square_torus", *PLANES])
def test_rewound_cut_is_what_it_was(name):
    """A cut rewound to a depth, or to a snapshot, equals the cut on its way there, and goes on as it did."""
    base = MAKERS[name]()
    cut = Cut(base, BLADES[base.dimension])
    known, snapshots = {}, {}
    for part in (0.0, 0.2, 0.5, 0.9, 1.2):
        known[part] = cut.advance(to=part * cut.length).cage
        snapshots[part] = cut.snapshot()
    for part in (0.9, 0.5, 0.2, 0.0):
        _assert_same_cage(cut.rewind(part * cut.length), known[part])
        assert cut.cage.vertex_count == known[part].vertex_count
    assert cut.rewind() is base
    assert cut.rewind(snapshots[0.5]) is known[0.5]
    edit = cut.advance(to=0.9 * cut.length)
    assert edit.before is known[0.5]
    _assert_same_cage(edit.cage, known[0.9])


@pytest.mark.parametrize("name", ["box", "star_prism", *PLANES])
@settings(max_examples=5, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_random_rewinds(name, seed):
    """A cut in an already cut cage, with random steps and turns, comes back to the last bit at every depth it had."""
    rng, base = np.random.default_rng(seed), MAKERS[name]()
    first = Cut(base, random_blade(rng, base))
    cut = Cut(first.advance(to=0.6 * first.length).cage, random_blade(rng, base))
    known = [(0.0, cut.cage)]
    for _ in range(5):
        edit = cut.advance(to=cut.depth + rng.uniform(0.01, 0.4) * max(0.1, cut.length - cut.depth))
        known.append((cut.depth, edit.cage))
        if cut.complete:
            break
        if rng.random() < 0.5:
            cut.turn(cut.plane.across + rng.uniform(-2.0, 2.0) * cut.plane.normal)
    for depth, cage in reversed(known):
        _assert_same_cage(cut.rewind(depth), cage)
        assert cut.depth == depth


def test_rewind_refusals():
    """A cut is not rewound to where it has not been, nor to another cut's snapshot; it stays where it is."""
    cut = Cut(box(), BLADE)
    cage = cut.advance(to=0.4).cage
    for wrong, text in ((0.5, "between 0 and 0.4"), (-0.1, "between 0 and 0.4"), (np.nan, "got nan")):
        with pytest.raises(ValueError, match=text):
            cut.rewind(wrong)
    with pytest.raises(TypeError, match="must be a number"):
        cut.rewind("deep")
    with pytest.raises(ValueError, match="of another cut"):
        cut.rewind(Cut(box(), BLADE).snapshot())
    assert cut.cage is cage
    assert cut.depth == 0.4


def test_rewound_surface_cut():
    """A surface's cut rewinds with the cage's."""
    surface, plane = bumpy_sphere(2), Cut(box(), BLADE).plane
    cut = SurfaceCut(surface, plane, 6)
    first = cut.advance(-0.1).surface
    snapshot = cut.snapshot()
    last = cut.advance(0.3).surface
    assert cut.rewind(snapshot) is first
    assert cut.rewind() is surface
    again = cut.advance(0.3).surface
    for name in ("points", "triangles", "uvs", "triangle_cap", "point_key"):
        np.testing.assert_array_equal(getattr(again, name), getattr(last, name))
    with pytest.raises(ValueError, match="of another cut"):
        SurfaceCut(surface, plane, 6).rewind(snapshot)


@pytest.mark.parametrize("options", [{}, {"vertex_capacity": 40, "point_capacity": 20}])
@pytest.mark.parametrize("dimension", [2, 3])
def test_restored_coordinates_are_bit_identical(dimension, options):
    """Restoring brings back every array, twice, and updates from there give what they gave."""
    coordinates = _coordinates(dimension, **options)
    cut = Cut(coordinates.cage, BLADES[dimension])
    coordinates.update(cut.advance(to=0.3))
    here, before, known = cut.snapshot(), coordinates.snapshot(), _arrays(coordinates)
    for _ in range(2):
        for depth in (0.5, 1.4):
            coordinates.update(cut.advance(to=depth))
        if options:
            coordinates.set_points(np.array([12]), np.full((1, dimension), 0.2))
        after = _arrays(coordinates)
        assert not np.array_equal(after["weights"], known["weights"])
        coordinates.restore(before)
        assert cut.rewind(here) is coordinates.cage
        for name, array in _arrays(coordinates).items():
            np.testing.assert_array_equal(array, known[name], err_msg=name)
    coordinates.recompute()
    np.testing.assert_array_equal(coordinates.weights, known["weights"])
    assert before.byte_count > coordinates.bounds.nbytes


def test_restore_refuses_other_coordinates():
    """A snapshot belongs to the coordinates that it was taken of."""
    one, two = _coordinates(), _coordinates()
    with pytest.raises(ValueError, match="of other coordinates"):
        one.restore(two.snapshot())


@both_dimensions
def test_restored_body_is_bit_identical(dimension):
    """A body restored after pieces came off is what it was, array by array, and its cut goes on as it did."""
    model, solver, state, _ = make_solver(gravity=-9.81, dimension=dimension)
    body = simulated(solver)
    cut = solver.begin_cut(0, BLADE if dimension == 3 else Blade([0.52, 0.5], [0.1, -1.0]))
    solver.advance_cut(cut, 0.4, states=(state,))

    def arrays() -> dict[str, np.ndarray]:
        found = {"q": state.particle_q, "qd": state.particle_qd, "mass": body.system.mass, "rest": body.rest}
        found |= {"particle_mass": model.particle_mass, "volumes": body.system.volumes, "count": body.vertex_count}
        values = {name: array.numpy().copy() for name, array in found.items()}
        return values | _arrays(body.coordinates) | {"triangles": body.surface.triangles, "points": body.surface.points}

    snapshot, known = solver.snapshot(0, states=(state,), cuts=(cut,)), arrays()
    results = []
    for _ in range(2):
        assert solver.advance_cut(cut, to=2.0, states=(state,)).separated
        results.append(arrays())
        solver.restore(snapshot)
        for name, array in arrays().items():
            np.testing.assert_array_equal(array, known[name], err_msg=name)
        assert cut.depth == 0.4
    for name, array in results[0].items():
        np.testing.assert_array_equal(array, results[1][name], err_msg=name)

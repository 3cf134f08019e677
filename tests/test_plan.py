# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The plan of a scene: its bytes are all that is there, and what is left out is neither allocated, compiled nor run."""

from __future__ import annotations

import gc
import subprocess
import sys

import newton
import numpy as np
import pytest
import warp as wp

import newton_cagecut as cagecut
from cage_shapes import hexagonal_prism
from newton_cagecut import SolverCageCut
from solver_scenes import make_solver, run, slanted_blade
from surface_shapes import sphere

SCENES = {
    "plain": {},
    "contact": {"contact_radius": 0.01},
    "not cuttable": {"cuttable": False},
    "keyframed": {"cuttable": False, "quadrature": 0},
    "plane": {"dimension": 2},
    "fitted": {"correction": "fitted", "walks": 0},
}


def owned() -> dict[int, wp.array]:
    """Every array alive that owns memory, by its address."""
    gc.collect()
    arrays = [found for found in gc.get_objects() if type(found) is wp.array]
    return {array.ptr: array for array in arrays if array.capacity and array.deleter is not None}


def ground(builder: newton.ModelBuilder | None = None) -> newton.ModelBuilder:
    """A builder with a ground plane far below."""
    builder = builder or newton.ModelBuilder()
    builder.add_ground_plane(height=-5.0)
    return builder


FEATURES = ("weights", "gradients", "walk cache", "walls and grid", "fitted weights", "nested walks", "quadrature")
FEATURES += ("elasticity", "third dimension", "surface", "caps", "contact", "room for cuts", "vertices", "edit numbers")
FEATURES += ("step statistics",)


@pytest.mark.parametrize("name", SCENES)
def test_bytes_are_those_of_all_arrays(name):
    """The bytes sum to those of all arrays that a new solver holds, but for Newton's; what is off has none."""
    model, first, *_ = make_solver(**{"walks": 8, "quadrature": 30, **SCENES[name]})
    del first  # what is made once for all stays out of the count
    before = owned()
    solver = SolverCageCut(model)
    total = sum(array.capacity for address, array in owned().items() if address not in before)
    plan = solver.plan()
    assert sum(entry.byte_count for entry in plan) == total
    assert tuple(entry.feature for entry in plan) == (*FEATURES, "USD")
    for entry in plan:
        assert entry.reason
        assert entry.on or entry.byte_count == 0


def test_room_for_cuts_is_what_a_cut_may_use():
    """Without room nothing counts as room; with it, what is in use stays what it was, but for the cut's own rows."""
    tight, roomy = (
        {entry.feature: entry for entry in make_solver(walks=16, capacity=capacity)[1].plan()}
        for capacity in (cagecut.Capacity(vertices=8, surface_points=162, surface_triangles=320), None)
    )
    assert roomy["room for cuts"].on
    assert roomy["room for cuts"].byte_count > 2 * tight["room for cuts"].byte_count
    for feature in ("surface", "gradients", "walls and grid", "vertices"):
        assert tight[feature].byte_count == pytest.approx(roomy[feature].byte_count, rel=0.02, abs=64)


def test_reasons_are_true():
    """Contact is there with a contact radius, and only then."""
    plan = {entry.feature: entry for entry in make_solver(**SCENES["contact"], walks=16)[1].plan()}
    assert plan["contact"].on
    assert plan["contact"].reason == "contact_radius was given"
    plan = {entry.feature: entry for entry in make_solver(walks=16)[1].plan()}
    assert plan["contact"].reason == "no contact_radius"


@pytest.fixture
def launched(monkeypatch) -> dict[str, set[str]]:
    """Names of the kernels that were launched, or recorded, with the modules that were compiled for them."""
    found: dict[str, set[str]] = {}
    launch, replay = wp.launch, wp.Launch.launch

    def record(kernel: wp.Kernel, *arguments: object, **options: object) -> object:
        found.setdefault(kernel.func.__name__, set()).add(kernel.module.name)
        return launch(kernel, *arguments, **options)

    def record_replay(self: wp.Launch, *arguments: object, **options: object) -> object:
        found.setdefault(self.kernel.func.__name__, set()).add(self.kernel.module.name)
        return replay(self, *arguments, **options)

    monkeypatch.setattr(wp, "launch", record)
    monkeypatch.setattr(wp.Launch, "launch", record_replay)
    return found


def launched_by(launched: dict[str, set[str]], *, cage: bool = False, **options: object) -> dict[str, set[str]]:
    """Kernels and modules of a scene's making and of two steps above a ground."""
    launched.clear()
    builder = ground()
    if cage:
        SolverCageCut.register_custom_attributes(builder)
        small = sphere(level=1, radius=0.2, center=(0.0, 0.0, 0.5))
        cagecut.add_cage_body(builder, hexagonal_prism(), small, walks=16, quadrature=20, **options)
        model = builder.finalize(device="cpu")
        solver, states = SolverCageCut(model), (model.state(), model.state())
    else:
        model, solver, *states = make_solver(builder=builder, walks=16, **options)
    pipeline = newton.CollisionPipeline(model)
    contacts = pipeline.contacts()
    pipeline.collide(states[0], contacts)
    run(solver, states, 2, contacts=contacts)
    return {name: set(modules) for name, modules in launched.items()}


def steps_by(launched: dict[str, set[str]], *, dimension: int) -> set[str]:
    """Kernels of two steps of the paper's integrator."""
    model, _, *states = make_solver(builder=ground(), walks=16, dimension=dimension)
    solver = SolverCageCut(model, integrator="paper")
    launched.clear()
    run(solver, states, 2)
    return set(launched)


def test_contact_left_out_is_never_run(launched):
    """Without a contact radius no kernel of contact is compiled or launched; with one they are."""
    without, with_it = launched_by(launched), launched_by(launched, contact_radius=0.01)
    own = {name for name, modules in with_it.items() if any("contact_kernels" in module for module in modules)}
    assert {"begin_contacts", "place_forces"} <= own
    assert not own & set(without)


def test_elasticity_left_out_is_never_run(launched):
    """A keyframed body compiles and launches nothing of the elastic room, nor of contact."""
    without = launched_by(launched, **SCENES["keyframed"])
    with_it = launched_by(launched)
    elastic = {name for name, modules in with_it.items() if any(".elastic." in module for module in modules)}
    elastic |= {"strain", "elastic_energy", "begin_solve"}
    assert len(elastic) > 8
    assert not elastic & set(without)
    assert not {"begin_contacts", "place_forces"} & set(without)


def test_a_plane_body_runs_nothing_in_space(launched):
    """Plane and solid bodies share no walk, landing or strain kernel, and confinement is run in the plane alone."""
    plane, solid = launched_by(launched, dimension=2), launched_by(launched)
    for name in ("walk_on_spheres", "land", "resolve", "strain"):
        assert plane[name]
        assert not plane[name] & solid[name], name
    confining = {name for name in steps_by(launched, dimension=2) if name.startswith("confine_")}
    assert len(confining) == 3
    assert not confining & set(steps_by(launched, dimension=3))
    assert not confining & set(solid)


def test_a_walk_cache_left_out_is_neither_filled_nor_marked(launched):
    """Without cuts the walk kernel is one that keeps no bounds, and nothing marks walks."""
    kept, forgotten = launched_by(launched), launched_by(launched, cuttable=False)
    assert not kept["walk_on_spheres"] & forgotten["walk_on_spheres"]
    for name in ("mark_walks", "meet_first_spheres", "unmark_walks"):
        assert name not in forgotten


def test_gradients_left_out_have_no_kernel(launched):
    """Without quadrature points weights are resolved by a kernel that knows no gradients."""
    with_it, without = launched_by(launched, cuttable=False), launched_by(launched, cuttable=False, quadrature=0)
    assert not with_it["resolve"] & without["resolve"]


def test_nested_walks_left_out_have_no_kernel(launched):
    """A cage of quads evaluates landings by a kernel without walks on faces; one with hexagons does not."""
    quads, hexagons = launched_by(launched), launched_by(launched, cage=True)
    assert not quads["land"] & hexagons["land"]


def test_a_fit_left_out_has_no_kernel(launched):
    """Walked weights compile and launch nothing of boundary fits."""
    without, with_it = launched_by(launched), launched_by(launched, correction="fitted", quads="harmonic")
    own = {name for name, modules in with_it.items() if any(".fit." in module for module in modules)}
    assert own
    assert not own & set(without)


def test_caps_left_out_are_not_made():
    """A cut through a solid body is closed by triangles; a plane body gets none, and room for none."""
    caps = {}
    for dimension in (2, 3):
        _, solver, *states = make_solver(dimension=dimension, walks=16)
        solver.advance_cut(solver.begin_cut(0, slanted_blade(dimension)), 10.0, states=states)
        caps[dimension] = np.count_nonzero(solver.bodies[0].surface.triangle_cap >= 0)
        entry = next(entry for entry in solver.plan() if entry.feature == "caps")
        assert (entry.on, entry.byte_count) == (dimension == 3, 0)
    assert caps[2] == 0
    assert caps[3] > 0


def test_usd_left_out_is_not_imported():
    """A solver of a scene that reads and writes no USD does not import the room, and its plan says so."""
    code = """
import sys
import newton
import numpy as np
import newton_cagecut as cagecut
builder = newton.ModelBuilder()
cagecut.SolverCageCut.register_custom_attributes(builder)
corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
mesh = np.array([[0.2, 0.2, 0.5], [0.8, 0.2, 0.5], [0.5, 0.8, 0.5]]), np.array([[0, 1, 2]])
cage = cagecut.Cage(corners, faces)
cagecut.add_cage_body(builder, cage, mesh, walks=4, quadrature=0, cuttable=False)
solver = cagecut.SolverCageCut(builder.finalize(device="cpu"))
entry = next(entry for entry in solver.plan() if entry.feature == "USD")
print(entry.on, "newton_cagecut.usd" in sys.modules)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "False False"


def test_plan_says_which_correction_and_why():
    """A body of correction "auto" is fitted, without walks by default, and the plan says why; others are told of it."""
    plans = {}
    for correction in ("auto", "harmonic"):
        model, solver, *_ = make_solver(correction=correction, quadrature=30)
        plans[correction] = {entry.feature: entry for entry in solver.plan()}
    assert plans["auto"]["fitted weights"].on
    assert "unknowns" in plans["auto"]["fitted weights"].reason
    assert not plans["auto"]["nested walks"].on
    assert not plans["harmonic"]["fitted weights"].on
    assert 'correction="auto"' in plans["harmonic"]["fitted weights"].reason

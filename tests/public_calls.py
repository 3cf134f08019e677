# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Every public call with arguments that are right, and which other values each argument may have too."""

from __future__ import annotations

import newton
import numpy as np

import newton_cagecut as cagecut
from bad_values import FINITE, NOT_NEGATIVE, POSITIVE
from call_world import Call, box_file, frame_writer, kept_file
from newton_cagecut.elastic.constitutive import CONSTITUTIVE_MODELS
from newton_cagecut.usd import AnimationWriter

TABLE = ("a table of 3", "an empty table")
OPTION = ("None",)
INDEX = ("0", "1")


_POINTS = {"points": TABLE}
CALLS: dict[str, Call] = {
    "Cage": Call(
        lambda w: cagecut.Cage,
        lambda w: {"vertices": w.cage.vertices, "faces": w.cage.faces, "tolerance": 1e-6, "repair": False},
        {"repair": ("True",)},
        {"vertices": ("vertex", "vertices"), "faces": ("face", "cage")},
    ),
    "Cage.winding_numbers": Call(lambda w: w.cage.winding_numbers, lambda w: {"points": w.points}, _POINTS),
    "Cage.contains": Call(lambda w: w.cage.contains, lambda w: {"points": w.points}, _POINTS),
    "Cage.piece_of": Call(lambda w: w.cage.piece_of, lambda w: {"points": w.points}, _POINTS),
    "Cage.extrude": Call(
        lambda w: w.cage.extrude,
        lambda w: {"face": 1, "distance": 0.2},
        {"face": INDEX, "distance": POSITIVE},
        {"distance": ("moves", "run into")},
    ),
    "Cage.move_face": Call(
        lambda w: w.cage.move_face,
        lambda w: {"face": 1, "distance": 0.2},
        {"face": INDEX, "distance": POSITIVE},
        {"distance": ("moves", "run into")},
    ),
    "Cage.inflated": Call(
        lambda w: w.cage.inflated, lambda w: {"distance": 0.1}, {"distance": ("1", "0.5", "1e9", "1e30", "a number")}
    ),
    "Cage.insert": Call(
        lambda w: w.cage.insert,
        lambda w: {"obstacle": cagecut.Cage(0.4 + 0.2 * w.cage.vertices, w.cage.faces)},
    ),
    "Blade": Call(
        lambda w: cagecut.Blade,
        lambda w: {"origin": [0, 0, 1], "edge": [1, 0, 0], "direction": [0, 0, -1], "width": 0.2, "start": -1.0},
        {
            "origin": ("three numbers", "three zeros"),
            "edge": ("three numbers",),
            "direction": (),
            "width": (*OPTION, *POSITIVE, "inf", "1e30"),
            "start": (*OPTION, *FINITE, "-inf", "1e30"),
        },
        {"origin": ("origin", "in the plane"), "width": ("width", "heel")},
    ),
    "Cut": Call(lambda w: cagecut.Cut, lambda w: {"cage": w.cage, "blade": w.blade}),
    "Cut.advance": Call(
        lambda w: w.cut.advance,
        lambda w: {"to": 0.4},
        {"to": ("1", "0.5", "1e9", "inf", "1e30")},
        {"to": ("depth",)},
    ),
    "Cut.turn": Call(
        lambda w: w.cut.turn,
        lambda w: {"direction": [0.3, -0.1, -1.0]},
        {"direction": ("three numbers",)},
    ),
    "Cut.resume": Call(lambda w: w.cut.resume, lambda w: {"cage": w.cut.cage}),
    "Cut.rewind": Call(
        lambda w: w.cut.rewind,
        lambda w: {"to": 0.2},
        {"to": ("0", "a number")},
        {"to": ("depth", "rewound", "snapshot")},
    ),
    "HarmonicCoordinates": Call(
        lambda w: cagecut.HarmonicCoordinates,
        lambda w: {
            "cage": w.cage,
            "points": w.points,
            "walks": 4,
            "seed": 0,
            "gradients": False,
            "cuttable": True,
            "device": "cpu",
            "correction": "affine",
            "bounds": "dop18",
            "distance": "grid",
            "quads": "harmonic",
            "epsilon": 1e-4,
            "max_steps": 256,
            "degree": 2,
            "point_keys": np.full(6, -1),
            "point_capacity": 8,
            "vertex_capacity": 8,
            "progress": lambda fraction: None,
        },
        {
            "points": (),
            "walks": ("1",),
            "seed": ("0", "1", "1e9"),
            "gradients": ("True",),
            "cuttable": ("True",),
            "device": OPTION,
            "distance": OPTION,
            "quads": OPTION,
            "max_steps": ("1",),
            "degree": ("1",),
            "point_keys": OPTION,
            "point_capacity": OPTION,
            "vertex_capacity": OPTION,
            "progress": (*OPTION, "a class"),
        },
        {"points": ("points", "point_keys"), "point_keys": ("key",)},
    ),
    "HarmonicCoordinates.update": Call(
        lambda w: w.coordinates.update,
        lambda w: {"edit": cagecut.Cut(w.cage, w.blade).advance(0.2), "points": None},
        {"points": OPTION},
        {"edit": ("edit",)},
    ),
    "HarmonicCoordinates.snapshot": Call(lambda w: w.coordinates.snapshot, lambda w: {"of": None}, {"of": OPTION}),
    "HarmonicCoordinates.restore": Call(
        lambda w: w.coordinates.restore, lambda w: {"snapshot": w.coordinates.snapshot()}
    ),
    "HarmonicCoordinates.save": Call(
        lambda w: w.coordinates.save,
        lambda w: {"path": w.folder / "kept.npz"},
        {"path": ("a word", "a number as text")},
    ),
    "HarmonicCoordinates.load": Call(
        lambda w: cagecut.HarmonicCoordinates.load,
        lambda w: {"path": kept_file(w), "cage": w.cage, "points": w.points, "device": "cpu", "seed": 0},
        {"device": OPTION, "seed": ("0",)},
        {"path": ("path", "file", "folder")},
    ),
    "HarmonicCoordinates.set_points": Call(
        lambda w: w.coordinates.set_points,
        lambda w: {"indices": [1, 2], "points": w.points[:2], "point_keys": None},
        {"points": ("a table of 3",), "point_keys": (*OPTION, "the same twice")},
        {"points": ("points", "indices"), "point_keys": ("key",)},
    ),
    "HarmonicCoordinates.remove_points": Call(
        lambda w: w.coordinates.remove_points,
        lambda w: {"indices": [1, 2]},
        {"indices": ("no list", "one index")},
        {"indices": ("indices", "no point", "remove_points")},
    ),
    "HarmonicCoordinates.boundary_weights": Call(
        lambda w: w.coordinates.boundary_weights,
        lambda w: {"points": w.cage.vertices[[0, 1]], "point_keys": [0, 0], "walks": 4},
        {"points": ("a table of 3",), "point_keys": ("the same twice",), "walks": ("1",)},
        {"points": ("points", "point_keys"), "point_keys": ("key",)},
    ),
    "HarmonicCoordinates.weights_at": Call(
        lambda w: w.coordinates.weights_at,
        lambda w: {"points": w.points[:2], "point_keys": [-1, -1], "walks": 4},
        {"points": ("a table of 3",), "point_keys": (*OPTION, "the same twice"), "walks": ("1",)},
        {"points": ("points", "point_keys"), "point_keys": ("key",)},
    ),
    "Surface": Call(
        lambda w: cagecut.Surface,
        lambda w: {
            "points": w.surface.points,
            "triangles": w.surface.triangles,
            "uvs": w.surface.points[:, :2],
            "normals": w.surface.points,
            "triangle_cap": np.full(len(w.surface.triangles), -1),
            "point_key": np.full(len(w.surface.points), -1),
            "weld": None,
            "data": {"heat": np.zeros(len(w.surface.points))},
        },
        {
            "points": (),
            "triangles": (),
            "uvs": OPTION,
            "normals": OPTION,
            "triangle_cap": OPTION,
            "point_key": OPTION,
            "weld": (*OPTION, *FINITE, "inf", "-inf", "1e30"),
            "data": OPTION,
        },
        {"triangles": ("triangle",)},
    ),
    "Surface.corner_uvs": Call(
        lambda w: w.surface.corner_uvs,
        lambda w: {"walls": w.cage.walls, "scale": 1.0},
        {"walls": ("no list",), "scale": (*FINITE, "1e30")},
    ),
    "Surface.corner_normals": Call(
        lambda w: w.surface.corner_normals, lambda w: {"walls": w.cage.walls}, {"walls": ("no list",)}
    ),
    "Surface.with_data": Call(
        lambda w: w.surface.with_data,
        lambda w: {"data": {"heat": np.zeros(len(w.surface.points))}},
        {"data": OPTION},
    ),
    "Surface.directions_inward": Call(
        lambda w: w.surface.directions_inward,
        lambda w: {"sites": [0, 1]},
        {"sites": ("no list", "one index", "the same twice")},
    ),
    "Surface.on_several_cuts": Call(
        lambda w: w.surface.on_several_cuts,
        lambda w: {"sites": [0, 1]},
        {"sites": ("no list", "one index", "the same twice")},
    ),
    "Material": Call(
        lambda w: cagecut.Material,
        lambda w: {"young": 1e4, "poisson": 0.3, "density": 1e3, "damping": 0.0, "model": "stvk"},
        {
            "young": (*POSITIVE, "1e30"),
            "poisson": ("0", "a number"),
            "density": (*POSITIVE, "1e30"),
            "damping": (*NOT_NEGATIVE, "1e30"),
        },
    ),
    "ConstitutiveModel": Call(
        lambda w: cagecut.ConstitutiveModel,
        lambda w: {
            "name": "mine",
            **{name: getattr(CONSTITUTIVE_MODELS["stvk"], name) for name in ("energy", "stress", "stretch_block")},
            "symmetric_modes": None,
            "antisymmetric_modes": None,
        },
        {
            "name": ("a word", "a number as text"),
            "symmetric_modes": OPTION,
            "antisymmetric_modes": OPTION,
        },
    ),
    "Capacity": Call(
        lambda w: cagecut.Capacity,
        lambda w: {"vertices": 8, "surface_points": 200, "surface_triangles": 400},
        {"vertices": ("1",), "surface_points": ("1",), "surface_triangles": ("1",)},
        {"surface_points": ("surface points", "surface_points"), "surface_triangles": ("surface_triangles",)},
    ),
    "Capacity.for_cuts": Call(
        lambda w: cagecut.Capacity.for_cuts,
        lambda w: {"cage": w.cage, "surface": w.surface, "cuts": 3},
        {"cuts": ("0", "1")},
    ),
    "Capacity.without_cuts": Call(
        lambda w: cagecut.Capacity.without_cuts, lambda w: {"cage": w.cage, "surface": w.surface}
    ),
    "Capacity.require": Call(
        lambda w: cagecut.Capacity.for_cuts(w.cage, w.surface).require,
        lambda w: {"cage": w.cage, "surface": w.surface},
    ),
    "add_cage_body": Call(
        lambda w: cagecut.add_cage_body,
        lambda w: {
            "builder": w.builder,
            "cage": w.cage,
            "mesh": w.surface,
            "material": None,
            "xform": None,
            "velocity": (0.0, 0.0, 0.0),
            "fixed": [0],
            "walks": 4,
            "quadrature": 12,
            "capacity": None,
            "cuttable": True,
            "contact_radius": 0.01,
            "contact_stiffness": 1e3,
            "contact_damping": None,
            "friction": 0.5,
            "self_contact": False,
            "pieces_touch": True,
            "thickness": None,
            "seed": 0,
            "label": "ball",
            "epsilon": 1e-3,
            "correction": "affine",
            "quads": "harmonic",
        },
        {
            "mesh": (),
            "material": OPTION,
            "xform": OPTION,
            "velocity": ("three numbers", "three zeros"),
            "fixed": (*OPTION, "no list", "one index", "the same twice"),
            "walks": ("None", "1"),
            "quadrature": (*OPTION, *INDEX),
            "capacity": OPTION,
            "cuttable": ("True",),
            "contact_radius": (*OPTION, "1", "0.5", "a number"),
            "contact_stiffness": (*OPTION, "1", "0.5", "a number", "1e9"),
            "contact_damping": (*OPTION, "0", "1", "0.5", "a number", "1e9"),
            "self_contact": ("True",),
            "pieces_touch": ("True",),
            "friction": (*OPTION, "0", "1", "0.5", "a number", "1e9"),
            "thickness": OPTION,
            "seed": ("0", "1", "1e9"),
            "label": (*OPTION, "a word", "a number as text"),
            "quads": OPTION,
        },
        {"mesh": ("mesh", "surface")},
    ),
    "SolverCageCut": Call(
        lambda w: cagecut.SolverCageCut,
        lambda w: {
            "model": w.scene[0],
            "config": cagecut.SolverCageCut.Config(),
            "progress": False,
            "integrator": "paper",
            "strain": "averaged",
            "newton_iterations": 1,
            "max_iterations": 20,
            "tolerance": 1e-3,
            "dense_vertices": 100,
        },
        {
            "dense_vertices": (*OPTION, "0", "1", "1e9", "1e30"),
            "config": OPTION,
            "progress": (*OPTION, "True", "a class"),
            "newton_iterations": ("1",),
            "max_iterations": ("1", "1e9"),
            "tolerance": ("0.5", "a number"),
        },
    ),
    "SolverCageCut.register_custom_attributes": Call(
        lambda w: cagecut.SolverCageCut.register_custom_attributes, lambda w: {"builder": newton.ModelBuilder()}
    ),
    "SolverCageCut.step": Call(
        lambda w: w.solver.step,
        lambda w: {
            "state_in": w.scene[2],
            "state_out": w.scene[3],
            "control": None,
            "contacts": None,
            "dt": 0.01,
            "observables": None,
        },
        {"control": OPTION, "contacts": OPTION, "observables": OPTION, "dt": POSITIVE},
    ),
    "SolverCageCut.warm_up": Call(
        lambda w: w.solver.warm_up, lambda w: {"progress": False}, {"progress": (*OPTION, "True")}
    ),
    "SolverCageCut.begin_cut": Call(
        lambda w: w.solver.begin_cut, lambda w: {"body": 0, "blade": w.blade}, {"body": ("0",)}
    ),
    "SolverCageCut.advance_cut": Call(
        lambda w: w.solver.advance_cut,
        lambda w: {"cut": w.body_cut, "by": 0.05, "to": None, "states": w.scene[2:]},
        {"by": (*NOT_NEGATIVE, "inf", "1e30"), "to": OPTION, "states": ("no list",)},
        {"by": ("by", "length", "depth"), "to": ("to=", "depth")},
    ),
    "SolverCageCut.snapshot": Call(
        lambda w: w.solver.snapshot,
        lambda w: {"body": 0, "states": w.scene[2:], "cuts": (w.body_cut,)},
        {"body": ("0",), "states": ("no list",), "cuts": ("no list",)},
    ),
    "SolverCageCut.restore": Call(lambda w: w.solver.restore, lambda w: {"snapshot": w.solver.snapshot(0)}),
    "SolverCageCut.surface": Call(
        lambda w: w.solver.surface,
        lambda w: {"state": w.scene[2], "body": 0, "data": False},
        {"body": ("0",), "data": ("True",)},
    ),
    "SolverCageCut.scene_frame": Call(lambda w: w.solver.scene_frame, lambda w: {"state": w.scene[2]}),
    "SolverCageCut.pieces": Call(lambda w: w.solver.pieces, lambda w: {"body": 0}, {"body": ("0",)}),
    "SolverCageCut.body": Call(lambda w: w.solver.body, lambda w: {"body": 0}, {"body": ("0",)}),
    "SolverCageCut.log": Call(
        lambda w: w.solver.log, lambda w: {"viewer": newton.viewer.ViewerNull(), "state": w.scene[2]}
    ),
    "BodyCut.advance": Call(
        lambda w: w.body_cut.advance,
        lambda w: {"to": 0.2, "states": w.scene[2:]},
        {"to": ("1", "0.5", "1e9", "inf", "1e30", "a number"), "states": ("no list",)},
        {"to": ("depth",)},
    ),
    "BodyCut.turn": Call(
        lambda w: w.body_cut.turn,
        lambda w: {"direction": [0.3, -0.1, -1.0]},
        {"direction": ("three numbers",)},
    ),
    "CageBody.energy": Call(lambda w: w.solver.bodies[0].energy, lambda w: {"state": w.scene[2]}),
    "CageBody.to_world": Call(lambda w: w.solver.bodies[0].to_world, lambda w: {"points": w.points}, _POINTS),
    "read_mesh": Call(
        lambda w: cagecut.read_mesh,
        lambda w: {"path": box_file(w), "scale": 1.0, "up_axis": "Y", "name": None, "weld": True},
        {"scale": (*POSITIVE, "1e30"), "up_axis": OPTION, "name": OPTION, "weld": ("True",)},
        {"path": ("path", "file", "folder"), "name": ("name", "mesh")},
    ),
    "read_cage": Call(
        lambda w: cagecut.read_cage,
        lambda w: {"path": box_file(w), "scale": 1.0, "up_axis": "Y", "name": None, "tolerance": 1e-6},
        {"scale": (*POSITIVE, "1e30"), "up_axis": OPTION, "name": OPTION},
        {"path": ("path", "file", "folder"), "name": ("name", "mesh")},
    ),
    "wrap_cage": Call(
        lambda w: cagecut.wrap_cage,
        lambda w: {
            "points": w.surface.points,
            "triangles": w.surface.triangles,
            "face_count": 40,
            "offset": 0.02,
            "separate": False,
            "polygons": False,
            "progress": False,
        },
        {"offset": ("a number",), "separate": ("True",), "polygons": ("True",), "progress": ("None", "True")},
        {"face_count": ("faces",), "triangles": ("triangle",)},
    ),
    "AnimationWriter": Call(
        lambda w: AnimationWriter,
        lambda w: {"path": w.folder / "new.usda", "fps": 24.0, "up_axis": "Y", "meters_per_unit": 1.0, "normals": True},
        {"fps": (*POSITIVE, "1e30"), "meters_per_unit": (*POSITIVE, "1e30"), "normals": ("True",)},
        {"path": ("path", "file", "folder", "end", "usd")},
    ),
    "AnimationWriter.write_frame": Call(
        lambda w: frame_writer(w.writer),
        lambda w: {
            "frame": 0,
            "name": "ball",
            "points": w.surface.points,
            "triangles": w.surface.triangles,
            "triangle_cap": np.full(len(w.surface.triangles), -1),
            "rest_points": w.surface.points,
            "cage_points": w.cage.vertices,
            "cage_faces": w.cage.faces,
            "skin_color": (0.1, 0.2, 0.3),
            "cap_color": (0.1, 0.2, 0.3),
        },
        {
            "frame": (*FINITE, "1e30"),
            "name": ("a word",),
            "triangle_cap": OPTION,
            "rest_points": OPTION,
            "cage_points": OPTION,
            "cage_faces": (),
            "skin_color": ("three numbers", "three zeros"),
            "cap_color": ("three numbers", "three zeros"),
        },
        {
            "points": ("points", "surface of body"),
            "triangles": ("triangles", "surface of body"),
            "cage_points": ("cage",),
            "cage_faces": ("cage",),
        },
    ),
}
"""The calls by name; with what there is in ``newton_cagecut.__all__`` and its classes, see the test."""

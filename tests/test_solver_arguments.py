# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Arguments of a body: what is wrong is named, and nothing of the body has been added then."""

from __future__ import annotations

import newton
import numpy as np
import pytest
import warp as wp

import newton_cagecut as cagecut
from solver_scenes import ball, box_cage

NAN = float("nan")
BAD = {
    "material of another type": ({"material": "rubber"}, TypeError, "material must be a Material"),
    "misspelt option": ({"wallks": 5}, TypeError, "no option wallks; options of the weights are walks, seed"),
    "option's value": ({"quads": "linear"}, ValueError, "quads must be one of mean_value, harmonic"),
    "epsilon of another type": ({"epsilon": "small"}, ValueError, "epsilon must lie between"),
    "no walks": ({"walks": 0}, ValueError, "walks must be a whole number from 1"),
    "half a walk": ({"walks": 64.5}, ValueError, "walks must be a whole number from 1"),
    "negative seed": ({"seed": -1}, ValueError, "seed must be a whole number from 0"),
    "negative radius": ({"contact_radius": -0.1}, ValueError, "contact_radius must be positive"),
    "radius that is no number": ({"contact_radius": NAN}, ValueError, "contact_radius must be positive"),
    "radius above the body": ({"contact_radius": 100.0}, ValueError, "100 m is more than the cage's size"),
    "radius of another type": ({"contact_radius": "thin"}, TypeError, "contact_radius must be a length"),
    "velocity that is no number": ({"velocity": (0.0, NAN, 0.0)}, ValueError, "velocity is not finite"),
    "velocity of two numbers": ({"velocity": (0.0, 1.0)}, TypeError, "velocity must be three numbers"),
    "position that is no number": ({"xform": wp.transform((0.0, NAN, 0.0))}, ValueError, "xform is not finite"),
    "rotation of length zero": ({"xform": wp.transform((0, 0, 0), (0, 0, 0, 0))}, ValueError, "quaternion is zero"),
    "pose of another type": ({"xform": (0.0, 0.0, 1.0)}, TypeError, "xform must be a position and a quaternion"),
    "half a point": ({"quadrature": 10.5}, TypeError, "quadrature, the number of quadrature points, must be"),
    "negative points": ({"quadrature": -1}, ValueError, "quadrature is a number of points"),
    "label of another type": ({"label": 5}, TypeError, "label must be text"),
    "empty label": ({"label": ""}, ValueError, "label is empty"),
    "label that is taken": ({"label": "first"}, ValueError, "there is a cage body 'first' already"),
    "fixed by a word": ({"fixed": "all"}, TypeError, "indices of cage vertices or a mask over all 8"),
    "fixed by halves": ({"fixed": [0.5]}, TypeError, "indices of cage vertices or a mask"),
    "fixed that is not there": ({"fixed": [-1]}, ValueError, "fixed names vertex -1"),
    "short mask": ({"fixed": np.ones(3, dtype=bool)}, ValueError, r"mask fixed must have the shape \(8,\)"),
    "capacity as a number": ({"capacity": 100}, TypeError, "capacity must be a Capacity"),
    "flag as a number": ({"cuttable": 2}, TypeError, "cuttable must be True or False"),
    "thickness of a solid": ({"thickness": 0.1}, ValueError, "only a plane body has a thickness"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_arguments_add_nothing(name: str):
    """Each is refused with its name and what it must be, and the builder is as it was."""
    options, error, text = BAD[name]
    builder = newton.ModelBuilder()
    cagecut.SolverCageCut.register_custom_attributes(builder)
    cagecut.add_cage_body(builder, box_cage(), ball(), label="first")
    count, rows = builder.particle_count, len(builder.custom_attributes["cagecut:definition"].values)
    with pytest.raises(error, match=text):
        cagecut.add_cage_body(builder, box_cage(), ball(), **options)
    assert builder.particle_count == count
    assert len(builder.custom_attributes["cagecut:definition"].values) == rows


def test_swapped_arguments_are_named():
    """A cage in the builder's place, and a mesh in the cage's, are told by their types."""
    builder = newton.ModelBuilder()
    cagecut.SolverCageCut.register_custom_attributes(builder)
    with pytest.raises(TypeError, match="builder must be a newton.ModelBuilder, got Cage"):
        cagecut.add_cage_body(box_cage(), builder, ball())
    with pytest.raises(TypeError, match="cage must be a Cage, got Surface"):
        cagecut.add_cage_body(builder, ball(), box_cage())
    with pytest.raises(TypeError, match="mesh must be a Surface"):
        cagecut.add_cage_body(builder, box_cage(), box_cage())


def test_empty_lists_and_long_rotations_are_good():
    """No vertex fixed may be said by an empty list, and a rotation need not be of length one."""
    builder = newton.ModelBuilder()
    cagecut.SolverCageCut.register_custom_attributes(builder)
    turned = wp.transform((0.0, 0.0, 1.0), wp.quat(0.0, 0.0, 2.0, 2.0))
    cagecut.add_cage_body(builder, box_cage(), ball(), fixed=[], xform=turned)
    definition = builder.custom_attributes["cagecut:definition"].values[0]
    assert not definition.fixed.any()
    side = np.linalg.norm(np.subtract(builder.particle_q[1], builder.particle_q[0]))
    assert side == pytest.approx(1.0)

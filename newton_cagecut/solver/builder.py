# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Adding cage bodies to a Newton model.

The degrees of freedom of a body are Newton particles: one for each vertex that its cage has or may get by cuts.
They carry no ACTIVE flag, so other solvers and the collision pipeline leave them alone. With a contact radius, the
points of the embedded surface are particles too: ACTIVE, without mass, moved by the cage. A plane body moves in one
plane of the world, in plane strain (two dimensions of the paper's elasticity, section 6.1).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import newton
import numpy as np
import warp as wp

from ..cage import Cage, check_inside
from ..elastic import Material
from ..geometry import as_flag, as_instance
from ..harmonic import chosen_correction
from ..surface import Surface
from . import body_arguments as arguments
from .body.capacity import Capacity
from .body.definition import BodyDefinition
from .body.rest_frame import RestFrame

FREQUENCY = "cagecut:body"

_MODEL, _STATE = newton.Model.AttributeAssignment.MODEL, newton.Model.AttributeAssignment.STATE

_ROWS = (
    ("definition", str, None, _MODEL, ""),
    ("body_label", str, None, _MODEL, ""),
    ("vertex_start", wp.int32, "particle", _MODEL, -1),
    ("surface_start", wp.int32, "particle", _MODEL, -1),
    ("body_world", wp.int32, "world", _MODEL, -1),
    ("edit", wp.int32, None, _STATE, 0),
)
"""Name, type, what it refers to, whose attribute it is, and default of each row; ``edit``: see ``edit_stamps``."""

NO_TARGET = (math.inf, math.inf, math.inf)
"""Where a vertex without a target is to go; not NaN, which Newton finds unequal to itself when builders are merged."""


def register_custom_attributes(builder: newton.ModelBuilder) -> None:
    """Declare the rows that describe cage bodies; calling it again changes nothing.

    Args:
        builder: The model builder.

    Raises:
        TypeError: It is none.
    """
    as_instance(builder, newton.ModelBuilder, "builder")
    frequency = newton.ModelBuilder.CustomFrequency(
        name="body", namespace="cagecut", label_attribute="cagecut:body_label"
    )
    builder.add_custom_frequency(frequency)
    for name, dtype, references, assignment, default in _ROWS:
        builder.add_custom_attribute(
            newton.ModelBuilder.CustomAttribute(
                name=name,
                namespace="cagecut",
                dtype=dtype,
                frequency=FREQUENCY,
                references=references,
                assignment=assignment,
                default=default,
            )
        )
    builder.add_custom_attribute(
        newton.ModelBuilder.CustomAttribute(
            name="target_q",
            namespace="cagecut",
            dtype=wp.vec3,
            frequency=newton.Model.AttributeFrequency.PARTICLE,
            assignment=newton.Model.AttributeAssignment.CONTROL,
            default=wp.vec3(*NO_TARGET),
        )
    )


def add_cage_body(
    builder: newton.ModelBuilder,
    cage: Cage,
    mesh: Surface | tuple[np.ndarray, np.ndarray] | newton.Mesh,
    *,
    material: Material | None = None,
    xform: wp.transform | None = None,
    velocity: Sequence[float] = (0.0, 0.0, 0.0),
    fixed: np.ndarray | Sequence[int] | None = None,
    walks: int | str | None = None,
    error: float | None = None,
    quadrature: int | None = None,
    capacity: Capacity | None = None,
    cuttable: bool = True,
    contact_radius: float | None = None,
    contact_stiffness: float | None = None,
    contact_damping: float | None = None,
    friction: float | None = None,
    self_contact: bool = False,
    pieces_touch: bool = False,
    thickness: float | None = None,
    seed: int = 0,
    label: str | None = None,
    weld: float | None = None,
    data: Mapping[str, object] | None = None,
    **options: object,
) -> int:
    """Add an elastic body that a cage deforms.

    With a cage of segments it is a plane body: it lies in the plane z = 0 of the rest frame, moves only in the plane of
    the world into which ``xform`` turns that, and resists as plane strain does. What of gravity, velocities, forces and
    contacts sticks out of the plane does not act on it.

    Args:
        builder: The model builder, with ``SolverCageCut.register_custom_attributes`` called.
        cage: The cage, in its rest frame [m].
        mesh: The embedded surface, wholly inside the cage: a ``Surface``, a ``newton.Mesh``, or points
            (n, 3) [m] and triangles (m, 3). In a plane cage a flat ``Surface``, or points (n, 2) and triangles.
        material: The elastic material; the default is soft rubber.
        xform: Pose of the rest frame in the world.
        velocity: Initial velocity [m/s]; fixed vertices do not travel with it.
        fixed: Cage vertices that no step moves: their indices, or a mask over all; to move them, write targets
            to ``control.cagecut.target_q``. A vertex that a cut makes on a face, among fixed ones, is fixed too.
        walks: Walks a point; 256 on a CPU and 2048 (the paper's) on CUDA by default, none of fitted weights.
        error: Wanted error of the weights, as in ``HarmonicCoordinates``, which walks are then chosen for.
        quadrature: Wanted number of quadrature points, by default 8 for each cage vertex and at least 300. 0 makes a
            body that is moved by its cage vertices alone, without elasticity.
        capacity: Room for cuts, by default ``Capacity.for_cuts(cage, surface)``, for a dozen of them.
        cuttable: Whether the body can be cut. Without, no walk cache is kept. What was done to the mesh for it, and
            where it is open, so that cuts make no caps, is said in a warning: ``surface.notes``.
        contact_radius: Makes the surface points collide as particles of this radius [m]; None for no contact.
        contact_stiffness: Stiffness of each surface point [N/m], which the mean with the shape's is taken of; None for
            ``model.soft_contact_ke``.
        contact_damping: Damping of each surface point [N s/m]; None for ``model.soft_contact_kd``.
        friction: Coefficient of friction, which the mean with the shape's is taken of; None for
            ``model.soft_contact_mu``.
        self_contact: Whether each piece touches itself: the sides of a slit, and where it folds. Of solid bodies with a
            contact radius; gaps are between the surfaces, without the radius.
        pieces_touch: Whether pieces that cuts have separated touch each other, likewise.
        thickness: Thickness of a plane body [m], which its mass is proportional to; 1 m by default.
        seed: Seed of walks and quadrature.
        label: Name of the body.
        weld: Distance up to which ends of open edges of the mesh count as one, as at seams of texture coordinates; by
            default 1e-6 of its size, as in ``Surface`` [m]. A ``Surface`` has been welded when it was made.
        data: Arrays of the mesh's points, corners or triangles, as in ``Surface``, which cuts carry along and
            ``SolverCageCut.surface(state, body, data=True)`` gives back.
        options: Further keyword options of ``HarmonicCoordinates``.

    Returns:
        The body's index, for ``SolverCageCut``.

    Raises:
        TypeError: An argument has the wrong type.
        ValueError: Attributes are not registered, a mesh point lies outside the cage, the mesh is not of the cage's
            dimension or cannot be cut, or a value is out of range.
    """
    as_instance(builder, newton.ModelBuilder, "builder")
    as_instance(cage, Cage, "cage")
    if FREQUENCY not in builder.custom_frequencies:
        raise ValueError("call SolverCageCut.register_custom_attributes(builder) before add_cage_body")
    surface = arguments.as_surface(mesh, weld=weld, data=data)
    thickness = arguments.as_thickness(thickness, cage, surface)
    check_inside(cage, surface.points)
    cuttable = as_flag(cuttable, "cuttable")
    if cuttable:
        arguments.check_cuttable(surface)
    if "correction" in options:
        options["correction"] = chosen_correction(options["correction"], cage)
    labels = builder.custom_attributes["cagecut:body_label"].values or []
    index = len(labels)
    definition = BodyDefinition(
        label=arguments.as_label(label, index, labels),
        cage=cage,
        surface=surface,
        material=arguments.as_material(material),
        fixed=arguments.as_fixed(fixed, cage.vertex_count),
        walks=arguments.as_walks(walks, error, cage, surface.site_points, seed, options),
        seed=seed,
        quadrature_count=arguments.as_quadrature_count(quadrature, cage.vertex_count),
        cuttable=cuttable,
        capacity=arguments.as_capacity(capacity, cage, surface, cuttable=cuttable),
        contact_radius=arguments.as_contact_radius(contact_radius, cage, quadrature),
        contact_material=arguments.as_contact_material(
            contact_radius, contact_stiffness=contact_stiffness, contact_damping=contact_damping, friction=friction
        ),
        **arguments.as_touching(contact_radius, cage, self_contact=self_contact, pieces_touch=pieces_touch),
        thickness=thickness,
        options=options,
    )
    capacity, contact_radius = definition.capacity, definition.contact_radius
    frame, velocity = RestFrame.of_pose(arguments.as_pose(xform)), arguments.as_velocity(velocity)
    if cage.dimension == 2:
        velocity = frame.in_plane(velocity)
    vertex_start = _add_particles(builder, cage.vertices, capacity.vertices, frame, velocity, radius=0.0, active=False)
    surface_start = -1
    if contact_radius is not None:
        points, room = surface.site_points, capacity.surface_points
        surface_start = _add_particles(builder, points, room, frame, velocity, radius=contact_radius, active=True)
    builder.add_custom_values(
        **{
            # Newton keeps string attributes as the Python objects that they are: the definition rides in one.
            "cagecut:definition": definition,
            "cagecut:body_label": definition.label,
            "cagecut:vertex_start": vertex_start,
            "cagecut:surface_start": surface_start,
            "cagecut:edit": 0,
        }
    )
    return index


def _add_particles(
    builder: newton.ModelBuilder,
    points: np.ndarray,
    capacity: int,
    frame: RestFrame,
    velocity: Sequence[float],
    *,
    radius: float,
    active: bool,
) -> int:
    """Add particles at rest positions and spare ones behind them; returns the first index."""
    start = builder.particle_count
    placed = np.zeros((capacity, 3))
    placed[: len(points)] = frame.to_world(points)
    placed[len(points) :] = placed[0]
    flags = np.where(np.arange(capacity) < len(points), int(newton.ParticleFlags.ACTIVE) if active else 0, 0)
    builder.add_particles(
        pos=placed.tolist(),
        vel=[list(map(float, velocity))] * capacity,
        mass=[0.0] * capacity,
        radius=[radius] * capacity,
        flags=flags.tolist(),
    )
    return start

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What a scene looks like in a state, for animations: cage bodies, the model's shapes and where rigid bodies are."""

from __future__ import annotations

from collections.abc import Sequence

import newton
import numpy as np
import warp as wp

from ..usd import BodyFrame, SceneFrame, SceneShape
from .body.simulated_body import SimulatedBody

_MAKERS = {
    newton.GeoType.SPHERE: lambda size: newton.Mesh.create_sphere(size[0], compute_inertia=False),
    newton.GeoType.BOX: lambda size: newton.Mesh.create_box(*size, compute_inertia=False),
    newton.GeoType.ELLIPSOID: lambda size: newton.Mesh.create_ellipsoid(*size, compute_inertia=False),
    newton.GeoType.CAPSULE: lambda size: _upright(newton.Mesh.create_capsule, size),
    newton.GeoType.CYLINDER: lambda size: _upright(newton.Mesh.create_cylinder, size),
    newton.GeoType.CONE: lambda size: _upright(newton.Mesh.create_cone, size),
}


class SceneRecorder:
    """Tells what a model's scene looks like; the shapes are made once.

    Args:
        model: The model.
        bodies: Its cage bodies.
    """

    def __init__(self, model: newton.Model, bodies: Sequence[SimulatedBody]) -> None:
        self._model, self._bodies = model, bodies
        self._shapes = _shapes_of(model)

    def frame(self, state: newton.State) -> SceneFrame:
        """The scene in a state, read on the host."""
        return SceneFrame(
            bodies=tuple(_body_frame(body, state) for body in self._bodies),
            shapes=self._shapes,
            rigid_names=tuple(self._model.body_label),
            rigid_poses=state.body_q.numpy() if self._model.body_count else None,
            up_axis=self._model.up_axis.name,
        )


def _body_frame(body: SimulatedBody, state: newton.State) -> BodyFrame:
    """A cage body in a state."""
    surface, rest = body.surface, body.surface.mesh.vertices
    has_uvs = surface.uvs is not None or surface.own_corner_uvs is not None
    return BodyFrame(
        name=body.label.replace("/", "_"),
        points=body.surface_points(state).numpy().copy(),
        triangles=surface.triangles,
        triangle_cap=surface.triangle_cap,
        rest_points=rest if surface.point_site is None else rest[surface.point_site],
        velocities=body.surface_velocities(state),
        uvs=None if body.is_plane and not has_uvs else surface.corner_uvs(body.cage.walls),
        has_skin_uvs=has_uvs,
        cage_points=state.particle_q[body.vertices].numpy()[: body.cage.vertex_count],
        cage_faces=body.cage.faces,
    )


def _shapes_of(model: newton.Model) -> tuple[SceneShape, ...]:
    """The visible shapes of a model, each as a mesh in the frame of its body; kinds without a mesh are left out."""
    if model.shape_count == 0:
        return ()
    kinds, flags, sizes = (a.numpy() for a in (model.shape_type, model.shape_flags, model.shape_scale))
    bodies, places, colors = (a.numpy() for a in (model.shape_body, model.shape_transform, model.shape_color))
    shapes = []
    for i, label in enumerate(model.shape_label):
        if not int(flags[i]) & int(newton.ShapeFlags.VISIBLE):
            continue
        kind, size = newton.GeoType(int(kinds[i])), [float(value) for value in sizes[i]]
        endless = kind == newton.GeoType.PLANE and min(size[:2]) <= 0.0
        mesh = _mesh_of(kind, [2.0, 2.0] if endless else size, model.shape_source[i])
        if mesh is None:
            continue
        points, triangles, normals = mesh
        turn = np.array(wp.quat_to_matrix(wp.quat(*map(float, places[i][3:])))).reshape(3, 3)
        shapes.append(
            SceneShape(
                name=label,
                points=points @ turn.T + places[i][:3],
                triangles=triangles,
                normals=None if normals is None else normals @ turn.T,
                body=int(bodies[i]),
                color=tuple(map(float, colors[i])),
                endless=endless,
            )
        )
    return tuple(shapes)


def _mesh_of(
    kind: newton.GeoType, size: list[float], source: object
) -> tuple[np.ndarray, np.ndarray, np.ndarray | None] | None:
    """Points, triangles and normals of a shape; None for a kind without a mesh."""
    scale = np.ones(3)
    if kind == newton.GeoType.PLANE:
        mesh = newton.Mesh.create_plane(size[0], size[1], compute_inertia=False)
    elif kind in _MAKERS:
        mesh = _MAKERS[kind](size)
    elif isinstance(source, newton.Mesh):
        mesh, scale = source, np.array(size)
    else:
        return None
    triangles = np.asarray(mesh.indices, dtype=np.int32).reshape(-1, 3)
    normals = None if mesh.normals is None else np.asarray(mesh.normals, dtype=np.float64) / scale
    if normals is not None:
        normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1.0e-12)
    triangles = triangles[:, ::-1] if np.prod(scale) < 0.0 else triangles
    return np.asarray(mesh.vertices, dtype=np.float64) * scale, triangles, normals


def _upright(create: object, size: list[float]) -> newton.Mesh:
    """A shape with a radius and a half height along z."""
    return create(size[0], size[1], up_axis=newton.Axis.Z, compute_inertia=False)

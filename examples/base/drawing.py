# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What a scene looks like as coloured meshes, for pictures: shapes where their bodies are, surfaces, textures."""

from __future__ import annotations

import numpy as np
import warp as wp
from PIL import Image

from newton_cagecut.usd import BodyFrame, SceneFrame

from .picture import Mesh, cage_edges, tube_mesh

CAGE_RADIUS, CAGE_COLOR = 0.004, (0.03, 0.03, 0.04)  # of a cage's edges: as a share of its size, linear RGB
CAP_PARTS = 10  # parts of the edges of a textured cap's triangles, which are large


def drawn_meshes(frame: SceneFrame, *, cages: bool = False) -> list[Mesh]:
    """Return the meshes of a scene; endless planes are left out, the picture has a ground of its own.

    Args:
        frame: The scene.
        cages: Whether the edges of the cages are drawn too.
    """
    meshes = []
    for shape in frame.shapes:
        if not shape.endless:
            points = shape.points if shape.body < 0 else _posed(shape.points, frame.rigid_poses[shape.body])
            meshes.append((points, shape.triangles, shape.color))
    for body in frame.bodies:
        meshes += _body_meshes(body)
        if cages:
            radius = CAGE_RADIUS * float(np.ptp(body.cage_points, axis=0).max())
            meshes.append(tube_mesh(body.cage_points, cage_edges(body.cage_faces), radius, CAGE_COLOR))
    return meshes


def _posed(points: np.ndarray, pose: np.ndarray) -> np.ndarray:
    turn = np.array(wp.quat_to_matrix(wp.quat(*map(float, pose[3:])))).reshape(3, 3)
    return points @ turn.T + pose[:3]


def _body_meshes(body: BodyFrame) -> list[Mesh]:
    """Return skin and caps, each smooth by itself."""
    is_cap = np.zeros(len(body.triangles), bool) if body.triangle_cap is None else body.triangle_cap >= 0
    meshes = []
    if not is_cap.all():
        color = body.skin_color
        if body.skin_texture is not None:
            color = _sampled(body.skin_texture, body.uvs[~is_cap])
        meshes.append((body.points, body.triangles[~is_cap], color))
    for cap in np.unique(body.triangle_cap[is_cap]) if is_cap.any() else ():  # each has sharp edges
        rows = body.triangle_cap == cap
        if body.cap_texture is None:
            meshes.append((body.points, body.triangles[rows], body.cap_color))
            continue
        corners, uvs = (_divided(a, CAP_PARTS) for a in (body.points[body.triangles[rows]], body.uvs[rows]))
        triangles = np.arange(3 * len(corners)).reshape(-1, 3)
        meshes.append((corners.reshape(-1, 3), triangles, _sampled(body.cap_texture, uvs)))
    return meshes


def _divided(corners: np.ndarray, parts: int) -> np.ndarray:
    """Return the values at the corners of ``parts**2`` parts of each triangle, shape ``(m, 3, k)`` each."""
    steps = [(i, j) for i in range(parts) for j in range(parts - i)]
    upright = [((i, j), (i + 1, j), (i, j + 1)) for i, j in steps]
    turned = [((i + 1, j), (i + 1, j + 1), (i, j + 1)) for i, j in steps if i + j < parts - 1]
    shares = np.array(upright + turned) / parts
    shares = np.concatenate([1.0 - shares.sum(axis=2, keepdims=True), shares], axis=2)
    return np.einsum("pck,mkd->mpcd", shares, corners).reshape(-1, 3, corners.shape[2])


def _sampled(texture: str, uvs: np.ndarray) -> np.ndarray:
    """Return a texture's linear RGB at texture coordinates, whose origin is the picture's lower left corner."""
    pixels = np.asarray(Image.open(texture).convert("RGB"), dtype=np.float32) / 255.0
    height, width, _ = pixels.shape
    column, row = uvs[..., 0] % 1.0 * width, (1.0 - uvs[..., 1]) % 1.0 * height
    shown = pixels[np.minimum(row.astype(int), height - 1), np.minimum(column.astype(int), width - 1)]
    return np.where(shown <= 0.04045, shown / 12.92, ((shown + 0.055) / 1.055) ** 2.4)

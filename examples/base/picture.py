# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Draws a picture of triangle meshes with nothing but Warp: no OpenGL, no window, no driver.

A ray a sub-pixel, a few towards the lamp and a few over the half-sphere (ambient occlusion), on a ground without end
that fades into the background. The same picture on the CPU and on CUDA.
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from os import PathLike

import numpy as np
import warp as wp
from PIL import Image

from newton_cagecut.usd.normals import vertex_normals

from .picture_kernels import Look, render_rows

Color = tuple[float, float, float]
Mesh = tuple[np.ndarray, np.ndarray, "np.ndarray | Color"]


@dataclass(frozen=True, kw_only=True)
class Camera:
    """Where the picture is taken from.

    Attributes:
        eye: Position [m].
        target: Point in the middle of the picture [m].
        field_of_view: Vertical opening angle [deg].
    """

    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    field_of_view: float = 28.0

    @staticmethod
    def framing(
        points: np.ndarray, *, direction: Sequence[float] = (0.35, -1.0, 0.75), aspect: float = 16 / 9
    ) -> Camera:
        """Return a camera that sees all of ``points``.

        Args:
            points: What to see [m], shape ``(n, 3)``.
            direction: From the points to the camera.
            aspect: Width of the picture over its height.
        """
        back = np.asarray(direction, dtype=np.float64) / np.linalg.norm(direction)
        right, up, _ = _axes(-back)
        tangent = math.tan(math.radians(0.5 * Camera.field_of_view)) * 0.84
        target = 0.5 * (points.min(axis=0) + points.max(axis=0))
        for _ in range(3):
            across, along, depth = ((points - target) @ axis for axis in (right, up, back))
            distance = max((abs(along) / tangent + depth).max(), (abs(across) / (tangent * aspect) + depth).max())
            seen = np.stack([across, along]) / (distance - depth)
            shift = 0.5 * distance * (seen.min(axis=1) + seen.max(axis=1))
            target = target + shift[0] * right + shift[1] * up
        return Camera(eye=tuple(target + distance * back), target=tuple(target))


def render_png(path: str | PathLike, *arguments: object, **options: object) -> None:
    """Draw meshes, +Z up, to a PNG; the arguments are those of :func:`render_pixels`.

    Args:
        path: The file.
        arguments: What to draw, and from where.
        options: How.
    """
    Image.fromarray(render_pixels(*arguments, **options)).save(path, optimize=True)


def render_pixels(
    meshes: Sequence[Mesh],
    camera: Camera | None = None,
    size: tuple[int, int] = (1280, 720),
    *,
    ground: float | None = None,
    lamp: Sequence[float] = (-0.55, -0.45, 1.0),
    background: tuple[Color, Color] = ((0.40, 0.37, 0.33), (0.90, 0.88, 0.84)),
    ray_count: int = 4,
    device: str | None = None,
) -> np.ndarray:
    """Draw meshes, +Z up, and return 8-bit sRGB, shape ``(height, width, 3)``.

    Args:
        meshes: Of each mesh the points [m] ``(n, 3)``, the triangles ``(m, 3)`` and linear RGB: one colour, one a
            triangle ``(m, 3)`` (the shading is smooth among triangles of one colour only), one a vertex ``(n, 3)`` or
            one a corner ``(m, 3, 3)``.
        camera: Where from; ``None`` frames the meshes.
        size: Width and height in pixels.
        ground: Height of the ground [m]; ``None`` puts it under the lowest point.
        lamp: Direction to the lamp.
        background: Linear RGB near the camera and at the horizon.
        ray_count: Rays to the lamp, and rays over the half-sphere, for each of the four samples of a pixel.
        device: Warp device; ``None`` takes the current one.

    Raises:
        ValueError: There is no triangle, or colours do not fit a mesh.
    """
    points, triangles, normals, colors = _merge(meshes)
    camera = camera or Camera.framing(points, aspect=size[0] / size[1])
    look = Look()
    right, up, forward = _axes(np.subtract(camera.target, camera.eye))
    half = math.tan(math.radians(0.5 * camera.field_of_view))
    look.eye = wp.vec3(*camera.eye)
    look.forward, look.right, look.up = wp.vec3(*forward), wp.vec3(*(right * half)), wp.vec3(*(up * half))
    look.lamp = wp.normalize(wp.vec3(*lamp))
    look.near, look.horizon = wp.vec3(*background[0]), wp.vec3(*background[1])
    look.target = wp.vec3(*camera.target)
    look.scale = float(np.linalg.norm(np.ptp(points, axis=0)))
    look.ground = float(points[:, 2].min() - 1e-3 * look.scale) if ground is None else float(ground)
    look.ray_count = ray_count
    with wp.ScopedDevice(device):
        pixels = _render(points, triangles, normals, colors, look, size)
    return _to_bytes(pixels)


def tube_mesh(points: np.ndarray, edges: np.ndarray, radius: float, color: Color, *, sides: int = 8) -> Mesh:
    """Return the edges of a cage as a mesh of thin prisms.

    Args:
        points: Vertices [m], shape ``(n, 3)``.
        edges: Pairs of vertices, shape ``(e, 2)``.
        radius: Of the prisms [m].
        color: Linear RGB.
        sides: Of each prism.
    """
    points = np.asarray(points, dtype=np.float64)
    start, end = points[edges[:, 0]], points[edges[:, 1]]
    along = (end - start) / np.maximum(np.linalg.norm(end - start, axis=1, keepdims=True), 1e-12)
    helper = np.where(np.abs(along[:, 2:]) < 0.9, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    side = np.cross(along, helper)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    angle = 2.0 * np.pi * np.arange(sides)[:, None, None] / sides
    ring = radius * (np.cos(angle) * side + np.sin(angle) * np.cross(along, side))
    corners = np.concatenate([start + ring, end + ring]).reshape(2, sides, -1, 3)
    index = np.arange(corners.size // 3).reshape(2, sides, -1)
    a, b = index, np.roll(index, -1, axis=1)
    quads = [(a[0], b[0], b[1]), (a[0], b[1], a[1])]
    triangles = np.concatenate([np.stack(quad, axis=-1).reshape(-1, 3) for quad in quads])
    return corners.reshape(-1, 3), triangles, color


def cage_edges(faces: Sequence[Sequence[int]]) -> np.ndarray:
    """Return the edges of polygons, each once, shape ``(e, 2)``."""
    pairs = {(min(a, b), max(a, b)) for face in faces for a, b in zip(face, (*face[1:], face[0]))}
    return np.array(sorted(pairs))


def _axes(forward: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return unit vectors to the right, up and forward of a camera."""
    forward = forward / np.linalg.norm(forward)
    helper = (0.0, 0.0, 1.0) if abs(forward[2]) < 0.999 else (0.0, 1.0, 0.0)
    right = np.cross(forward, helper)
    right /= np.linalg.norm(right)
    return right, np.cross(right, forward), forward


def _merge(meshes: Sequence[Mesh]) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return all meshes as one: points, triangles, and a normal and a colour for each corner."""
    parts = [_with_corners(k, *mesh) for k, mesh in enumerate(meshes)]
    if not sum(len(part[1]) for part in parts):
        raise ValueError("there is no triangle to draw")
    starts = np.cumsum([0] + [len(part[0]) for part in parts])
    points, _, normals, colors = (np.concatenate(arrays) for arrays in zip(*parts))
    return points, np.concatenate([part[1] + start for part, start in zip(parts, starts)]), normals, colors


def _with_corners(number: int, points: np.ndarray, triangles: np.ndarray, color: np.ndarray | Color) -> tuple:
    """Return points and triangles of one mesh with a normal and a colour for each corner."""
    points, triangles = np.asarray(points, dtype=np.float32), np.asarray(triangles, dtype=np.int32)
    color = np.asarray(color, dtype=np.float32)
    patch = np.zeros(len(triangles), dtype=np.int64)
    if color.shape == (3,):
        corners = np.tile(color, (3 * len(triangles), 1))
    elif color.shape == (len(triangles), 3):
        corners = np.repeat(color, 3, axis=0)
        patch = np.unique(color, axis=0, return_inverse=True)[1].reshape(-1)
    elif color.shape == (len(triangles), 3, 3):
        corners = color.reshape(-1, 3)
    elif color.shape == (len(points), 3):
        corners = color[triangles.reshape(-1)]
    else:
        raise ValueError(f"mesh {number}: colours of shape {color.shape} fit neither its triangles nor its points")
    return points, triangles, _corner_normals(points, triangles, patch), corners


def _corner_normals(points: np.ndarray, triangles: np.ndarray, patch: np.ndarray) -> np.ndarray:
    """Return a normal for each corner, smooth among the triangles of one patch only, shape ``(3 m, 3)``."""
    normals = np.empty((len(triangles), 3, 3), dtype=np.float32)
    for number in np.unique(patch):
        rows = patch == number
        normals[rows] = vertex_normals(points, triangles[rows])[triangles[rows]]
    return normals.reshape(-1, 3)


def _render(
    points: np.ndarray,
    triangles: np.ndarray,
    normals: np.ndarray,
    colors: np.ndarray,
    look: Look,
    size: tuple[int, int],
) -> np.ndarray:
    """Return linear RGB, shape ``(height, width, 3)``."""
    width, height = size
    mesh = wp.Mesh(wp.array(points, dtype=wp.vec3), wp.array(triangles.reshape(-1), dtype=wp.int32))
    corner_normal, corner_color = wp.array(normals, dtype=wp.vec3), wp.array(colors, dtype=wp.vec3)
    pixels = wp.zeros((height, width), dtype=wp.vec3)
    device = pixels.device
    strip = height if device.is_cuda else 8

    def draw(first: int) -> None:
        rows = min(strip, height - first)
        inputs = [mesh.id, corner_normal, corner_color, look, first, pixels]
        wp.launch(render_rows, dim=(rows, width), inputs=inputs, device=device)

    wp.load_module(render_rows.module, device=device)
    with ThreadPoolExecutor(1 if device.is_cuda else os.cpu_count()) as pool:  # a launch on the CPU is serial
        list(pool.map(draw, range(0, height, strip)))
    return pixels.numpy()


def _to_bytes(linear: np.ndarray) -> np.ndarray:
    """Return 8-bit sRGB, with the filmic curve of Narkowicz (2016)."""
    x = 0.5 * linear
    shown = np.clip(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0)
    encoded = np.where(shown <= 0.0031308, 12.92 * shown, 1.055 * shown ** (1 / 2.4) - 0.055)
    return (encoded * 255.0 + 0.5).astype(np.uint8)

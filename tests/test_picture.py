# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from examples.base.picture import Camera, cage_edges, render_png, tube_mesh

BOX = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
BOX_FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
BOX_TRIANGLES = np.array([triangle for a, b, c, d in BOX_FACES for triangle in ((a, b, c), (a, c, d))])


def test_picture_shows_the_mesh_in_its_colour_and_its_shadow(tmp_path):
    """A red box is in the middle, lit from the left; the ground on its right is darker than on its left."""
    camera = Camera(eye=(0.5, -6.0, 5.0), target=(0.5, 0.5, 0.5))
    box = (BOX, BOX_TRIANGLES, (0.8, 0.05, 0.05))
    render_png(tmp_path / "box.png", [box], camera, (96, 64), lamp=(-1.0, -0.2, 0.8), ray_count=2)
    pixels = np.array(Image.open(tmp_path / "box.png")).astype(float)
    assert pixels.shape == (64, 96, 3)
    middle = pixels[28:34, 45:51].mean(axis=(0, 1))
    assert middle[0] > 2.0 * middle[1]
    assert pixels[34:38, 60:66].mean() < 0.6 * pixels[34:38, 28:34].mean()


def test_camera_frames_all_points():
    """All points are within the picture, and they fill it in one direction."""
    camera = Camera.framing(BOX * (3.0, 1.0, 1.0), direction=(0.0, -1.0, 0.0), aspect=1.5)
    eye = np.array(camera.eye)
    depth = BOX[:, 1] - eye[1]
    reach = np.abs((BOX[:, 0] * 3.0 - eye[0]) / depth) / (1.5 * np.tan(np.radians(camera.field_of_view / 2)))
    assert 0.75 < reach.max() < 1.0


def test_edges_of_a_cage_are_drawn_as_closed_prisms():
    """A box has 12 edges; each becomes an open prism of eight sides at the radius asked for."""
    edges = cage_edges(BOX_FACES)
    assert len(edges) == 12
    points, triangles, _ = tube_mesh(BOX, edges, 0.01, (0.1, 0.2, 0.3))
    assert (points.shape, triangles.shape) == ((12 * 16, 3), (12 * 16, 3))
    along = np.argmax(np.abs(BOX[edges[:, 1]] - BOX[edges[:, 0]]), axis=1)
    offset = points.reshape(2, 8, 12, 3)[0] - BOX[edges[:, 0]]
    np.testing.assert_allclose(np.linalg.norm(offset, axis=-1), 0.01)
    np.testing.assert_allclose(np.take_along_axis(offset, along[None, :, None], axis=-1), 0.0, atol=1e-12)


def test_colours_that_fit_nothing_are_refused(tmp_path):
    """Colours must be one, one a triangle or one a vertex."""
    with pytest.raises(ValueError, match=r"mesh 0: colours of shape \(5, 3\)"):
        render_png(tmp_path / "box.png", [(BOX, BOX_TRIANGLES, np.zeros((5, 3)))])


def test_nothing_to_draw_is_refused(tmp_path):
    """A scene without a triangle is an error, not an empty picture."""
    with pytest.raises(ValueError, match="no triangle"):
        render_png(tmp_path / "none.png", [(BOX, np.zeros((0, 3), dtype=int), (0.5, 0.5, 0.5))])

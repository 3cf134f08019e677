# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Meshes of any kind become sheets, which are cut as what they are."""

import numpy as np
import pytest

from cage_shapes import box
from newton_cagecut.cage import Cut
from newton_cagecut.section import Blade
from newton_cagecut.surface import Surface, SurfaceCut
from odd_meshes import CLOSED, PARTLY_OPEN
from surface_shapes import check_closed

BLADES = (
    Blade([0.45, 0.5, 0.5], [0.1, 1.0, 0.15], [0.2, -0.1, -1.0]),
    Blade([0.5, 0.47, 0.5], [1.0, 0.1, -0.05], [0.0, 0.2, -1.0]),
    Blade([0.5, 0.5, 0.53], [0.1, 1.0, 0.15], [1.0, -0.1, 0.1]),
)


def cut_through(surface: Surface, blades=BLADES, steps: int = 4):
    """Cut a surface in the unit box by blades, one after the other; yields the surface after each step."""
    cage = box()
    for blade in blades:
        cut = Cut(cage, blade)
        surface_cut = SurfaceCut(surface, cut.plane, cut.wall, window=cut.window)
        for depth in cut.length * np.linspace(0.2, 1.01, steps):
            edit = cut.advance(to=depth)
            surface = surface_cut.advance(edit.front).surface
            yield surface
        cage = edit.cage


def closed_volume(surface: Surface) -> tuple[float, int]:
    """Volume in the closed components, and their number."""
    mesh = surface.mesh
    is_open = np.zeros(mesh.component_count, dtype=bool)
    is_open[mesh.face_component[mesh.face[mesh.twin < 0]]] = True
    return float(mesh.component_volumes[~is_open].sum()), int(np.count_nonzero(~is_open))


def check_sheets(surface: Surface) -> None:
    """Assert that every edge has one triangle, or two in opposite directions, and every site one fan."""
    mesh = surface.mesh
    surface.refuse_branches()
    border = mesh.twin < 0
    for ends in (mesh.face_vertex[border], mesh.destination[border]):
        assert np.bincount(ends).max(initial=0) <= 1
    assert np.bincount(mesh.face_vertex, minlength=surface.site_count).min() > 0


def skin_area(surface: Surface) -> float:
    """Area of what is no cap."""
    return float(np.linalg.norm(surface.mesh.face_area_vector[surface.triangle_cap < 0], axis=1).sum())


@pytest.mark.parametrize("name", CLOSED)
def test_closed_sheets_stay_closed(name):
    """Solids that touch or cross, or of which triangles are turned, are cut into closed pieces of the same volume."""
    make, count = CLOSED[name]
    points, triangles = make()
    surface = Surface(points, triangles)
    np.testing.assert_array_equal(surface.points[: len(points)], points)
    assert (surface.closed, surface.mesh.component_count) == (True, count)
    assert surface.volume > 0.0
    area = skin_area(surface)
    for now in cut_through(surface):
        check_closed(now, surface.volume)
        assert skin_area(now) == pytest.approx(area)
    assert len(np.unique(now.triangle_cap)) == 1 + len(BLADES)
    assert now.mesh.component_outward.all()


@pytest.mark.parametrize("name", PARTLY_OPEN)
def test_open_sheets_get_no_caps(name):
    """Fins, walls within and open sheets are cut without caps; what is closed beside them stays so."""
    make, count, volume = PARTLY_OPEN[name]
    points, triangles = make()
    surface = Surface(points, triangles)
    np.testing.assert_array_equal(surface.points[: len(points)], points)
    assert surface.mesh.component_count == count
    assert closed_volume(surface)[0] == pytest.approx(volume)
    area = skin_area(surface)
    check_sheets(surface)
    for now in cut_through(surface):
        check_sheets(now)
        assert skin_area(now) == pytest.approx(area)
        assert closed_volume(now)[0] == pytest.approx(volume)
    assert (now.triangle_cap >= 0).any() == (volume > 0.0)
    assert now.mesh.component_count > count

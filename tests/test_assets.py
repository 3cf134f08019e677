# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from assets import bunny, gingerbread, starfish
from newton_cagecut.cage import boundary_distances
from newton_cagecut.usd import MeshData, read_cage, read_mesh, read_surface

ASSETS = Path(__file__).parent.parent / "assets"


@pytest.fixture(scope="module")
def starfish_mesh() -> MeshData:
    """The stored starfish."""
    return read_mesh(ASSETS / "starfish.usdc")


@pytest.fixture(scope="module")
def bunny_mesh() -> tuple[np.ndarray, np.ndarray]:
    """Newton's bunny, +Z up."""
    return bunny.bunny_mesh()


def least_distance(points: np.ndarray, triangles: np.ndarray) -> float:
    """Return the least distance of points from triangles, shape ``(t, 3, 3)``."""
    least = np.inf
    for corners in triangles:
        edges = np.roll(corners, -1, axis=0) - corners
        normal = np.cross(edges[0], edges[1])
        normal /= np.linalg.norm(normal)
        height = (points - corners[0]) @ normal
        over = np.ones(len(points), dtype=bool)
        for corner, edge in zip(corners, edges):
            along = np.clip((points - corner) @ edge / (edge @ edge), 0.0, 1.0)
            least = min(least, np.linalg.norm(points - corner - along[:, None] * edge, axis=1).min())
            over &= (points - corner) @ np.cross(normal, edge) >= 0.0
        least = min(least, np.abs(height[over]).min(initial=np.inf))
    return float(least)


def edge_uses(triangles: np.ndarray) -> np.ndarray:
    """Return how often each directed edge of triangles occurs together with its twin, -1 without one."""
    directed = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    edges = {tuple(edge) for edge in directed.tolist()}
    assert len(edges) == len(directed)
    return np.array([(b, a) in edges for a, b in edges])


def test_starfish_is_a_closed_sphere_of_8158_vertices(starfish_mesh):
    """The starfish has the vertex count of the paper's, no open edge and no handle, and uses every vertex."""
    triangles = starfish_mesh.triangles
    assert starfish_mesh.points.shape == (8158, 3)
    assert len(triangles) == 2 * 8158 - 4
    assert edge_uses(triangles).all()
    assert len(np.unique(triangles)) == 8158


def test_starfish_faces_outward_with_even_triangles(starfish_mesh):
    """Its volume is positive and no triangle is a needle."""
    corners = starfish_mesh.points[starfish_mesh.triangles]
    assert np.linalg.det(corners).sum() > 0.0
    lengths = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    quality = 4.0 * np.sqrt(3.0) * area / (lengths**2).sum(axis=1)
    assert quality.min() > 0.35
    assert quality.mean() > 0.9


def test_starfish_cage_has_the_counts_of_the_paper():
    """50 vertices and 53 faces: triangles, quads and a pentagon, and one closed component."""
    cage = read_cage(ASSETS / "starfish_cage.usda")
    assert (cage.vertex_count, cage.face_count) == (50, 53)
    assert {len(face) for face in cage.faces} == {3, 4, 5}
    assert (cage.euler_characteristic, cage.component_count) == (2, 1)


def test_starfish_is_inside_its_cage_with_a_margin(starfish_mesh):
    """Every vertex is inside, at least 2.5 cm from the skin of a cage of about a metre."""
    cage = read_cage(ASSETS / "starfish_cage.usda")
    assert cage.contains(starfish_mesh.points).all()
    assert least_distance(starfish_mesh.points, cage.vertices[cage.triangles]) > 0.025


def test_bunny_cage_is_closed_and_coarse():
    """30 to 60 faces, one closed component."""
    cage = read_cage(ASSETS / "bunny_cage.usda")
    assert 30 <= cage.face_count <= 60
    assert (cage.euler_characteristic, cage.component_count) == (2, 1)


def test_bunny_is_inside_its_cage_with_a_margin(bunny_mesh):
    """Every vertex is inside, at least 5 cm from the skin of a cage of about two metres."""
    cage = read_cage(ASSETS / "bunny_cage.usda")
    assert cage.contains(bunny_mesh[0]).all()
    assert least_distance(bunny_mesh[0], cage.vertices[cage.triangles]) > 0.05


def test_stored_starfish_is_what_its_script_makes(starfish_mesh):
    """Running the script again gives the stored arrays."""
    points, triangles = starfish.starfish_mesh()
    np.testing.assert_allclose(starfish_mesh.points, points, atol=1e-5)
    np.testing.assert_array_equal(starfish_mesh.triangles, triangles)


def test_stored_cages_are_what_their_scripts_make():
    """Running the scripts again gives the stored vertices and faces."""
    for name, make in (("starfish_cage", starfish.starfish_cage), ("bunny_cage", bunny.bunny_cage)):
        stored = read_mesh(ASSETS / f"{name}.usda")
        vertices, faces = make()
        np.testing.assert_allclose(stored.points, vertices, atol=1e-5)
        assert stored.faces == tuple(faces)


def test_starfish_is_a_surface_to_embed(starfish_mesh):
    """The reader makes a closed surface of it with the same arrays."""
    surface = read_surface(ASSETS / "starfish.usdc")
    assert surface.closed
    np.testing.assert_array_equal(surface.points, starfish_mesh.points)
    np.testing.assert_array_equal(surface.triangles, starfish_mesh.triangles)


def test_gingerbread_man_fills_his_cage():
    """One flat part of even triangles without a hole, at least 7 mm inside of a cage of 30 segments, 1 m tall."""
    surface, cage = read_surface(ASSETS / "gingerbread.usdc", flat=True), read_cage(ASSETS / "gingerbread_cage.usda")
    mesh = surface.mesh
    assert (surface.dimension, mesh.component_count, len(np.unique(surface.triangles))) == (2, 1, surface.point_count)
    assert surface.point_count - mesh.edge_count + surface.triangle_count == 1
    surface.refuse_branches()
    assert (cage.dimension, cage.face_count, cage.component_count) == (2, 30, 1)
    assert cage.contains(surface.points).all()
    assert boundary_distances(cage, surface.points).min() > 0.007
    lengths = np.linalg.norm(np.diff(surface.points[mesh.edges], axis=1)[:, 0], axis=1)
    assert lengths.max() < 2.5 * gingerbread.SPACING
    assert lengths.min() > 0.25 * gingerbread.SPACING


def test_icing_has_edges_along_its_borders():
    """Every segment around the icing is an edge of the gingerbread man, so that no triangle is half covered."""
    surface, icing = read_surface(ASSETS / "gingerbread.usdc", flat=True), gingerbread.icing()
    distance, place = cKDTree(surface.points).query(icing.vertices)
    assert distance.max() < 1e-6
    edges = set(map(tuple, surface.mesh.edges.tolist()))
    assert all(tuple(edge) in edges for edge in np.sort(place[np.array(icing.faces)], axis=1).tolist())
    assert icing.component_count == 10


def test_stored_gingerbread_man_is_what_his_script_makes():
    """Running the script again gives the stored mesh and cage."""
    stored = read_surface(ASSETS / "gingerbread.usdc", flat=True)
    points, triangles = gingerbread.gingerbread_mesh()
    np.testing.assert_allclose(stored.points, points, atol=1e-5)
    np.testing.assert_array_equal(stored.triangles, triangles)
    cage, made = read_cage(ASSETS / "gingerbread_cage.usda"), gingerbread.gingerbread_cage()
    np.testing.assert_allclose(cage.vertices, made.vertices, atol=1e-6)
    assert cage.faces == made.faces


def test_stored_assets_are_small():
    """No stored asset is larger than 1.5 MB."""
    for path in ASSETS.glob("*.usd?"):
        assert path.stat().st_size < 1.5e6

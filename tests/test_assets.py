# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import importlib
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from assets import bunny, gingerbread
from newton_cagecut.cage import Cage, boundary_distances
from newton_cagecut.report.paper.published import TABLE_1
from newton_cagecut.usd import MeshData, read_cage, read_mesh, read_surface

ASSETS = Path(__file__).parent.parent / "assets"
HANDLES = {"key": 1}  # the others are spheres


@cache
def stored_mesh(name: str) -> MeshData:
    """A stored mesh."""
    return read_mesh(ASSETS / f"{name}.usdc")


@cache
def stored_cage(name: str) -> Cage:
    """A stored cage."""
    return read_cage(ASSETS / f"{name}_cage.usda")


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


@pytest.mark.parametrize("name", TABLE_1)
def test_mesh_is_closed_and_has_the_vertices_of_the_paper(name):
    """A mesh has the paper's vertex count and uses every vertex; it is a sphere, the key a ring."""
    mesh, vertex_count = stored_mesh(name), TABLE_1[name].mesh_vertex_count
    assert mesh.points.shape == (vertex_count, 3)
    assert len(mesh.triangles) == 2 * vertex_count - 4 + 4 * HANDLES.get(name, 0)
    assert edge_uses(mesh.triangles).all()
    assert len(np.unique(mesh.triangles)) == vertex_count


@pytest.mark.parametrize("name", TABLE_1)
def test_mesh_faces_outward_with_even_triangles(name):
    """Its volume is positive and no triangle is a needle."""
    mesh = stored_mesh(name)
    corners = mesh.points[mesh.triangles]
    assert np.linalg.det(corners).sum() > 0.0
    lengths = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    quality = 4.0 * np.sqrt(3.0) * area / (lengths**2).sum(axis=1)
    assert quality.min() > 0.35
    assert quality.mean() > 0.9


@pytest.mark.parametrize("name", TABLE_1)
def test_cage_has_the_counts_of_the_paper(name):
    """One closed component of the paper's vertices and faces; the jelly's has as many faces as its vertices allow."""
    cage, paper = stored_cage(name), TABLE_1[name]
    most = 2 * paper.vertex_count - 4 + 4 * HANDLES.get(name, 0)
    assert (cage.vertex_count, cage.face_count) == (paper.vertex_count, min(paper.face_count, most))
    assert (paper.face_count > most) == (name == "jelly")
    assert cage.euler_characteristic == 2 - 2 * HANDLES.get(name, 0)
    assert cage.component_count == 1


@pytest.mark.parametrize("name", TABLE_1)
def test_mesh_is_inside_its_cage_with_a_margin(name):
    """Every vertex is inside, at least half a percent of the cage's diagonal from its faces."""
    cage, mesh = stored_cage(name), stored_mesh(name)
    assert cage.contains(mesh.points).all()
    assert least_distance(mesh.points, cage.vertices[cage.triangles]) > 0.005 * cage.diameter


def test_starfish_cage_is_of_triangles_quads_and_a_pentagon():
    """The faces have three to five corners."""
    assert {len(face) for face in stored_cage("starfish").faces} == {3, 4, 5}


def test_bunny_cage_is_closed_and_coarse():
    """30 to 60 faces, one closed component."""
    cage = stored_cage("bunny")
    assert 30 <= cage.face_count <= 60
    assert (cage.euler_characteristic, cage.component_count) == (2, 1)


def test_bunny_is_inside_its_cage_with_a_margin(bunny_mesh):
    """Every vertex is inside, at least 5 cm from the skin of a cage of about two metres."""
    cage = stored_cage("bunny")
    assert cage.contains(bunny_mesh[0]).all()
    assert least_distance(bunny_mesh[0], cage.vertices[cage.triangles]) > 0.05


@pytest.mark.parametrize("name", TABLE_1)
def test_stored_mesh_is_what_its_script_makes(name):
    """Running the script again gives the stored arrays."""
    points, triangles = getattr(importlib.import_module(f"assets.{name}"), f"{name}_mesh")()
    np.testing.assert_allclose(stored_mesh(name).points, points, atol=1e-5)
    np.testing.assert_array_equal(stored_mesh(name).triangles, triangles)


@pytest.mark.parametrize("name", [*TABLE_1, "bunny"])
def test_stored_cage_is_what_its_script_makes(name):
    """Running the script again gives the stored vertices and faces."""
    stored = read_mesh(ASSETS / f"{name}_cage.usda")
    vertices, faces = getattr(importlib.import_module(f"assets.{name}"), f"{name}_cage")()
    np.testing.assert_allclose(stored.points, vertices, atol=1e-5)
    assert stored.faces == tuple(faces)


def test_every_stored_asset_has_been_looked_at():
    """There is no cage or mesh in the folder that these tests leave out."""
    names = {path.stem.removesuffix("_cage") for path in ASSETS.glob("*.usd?")}
    assert names == {*TABLE_1, "bunny", "gingerbread", "gingerbread_icing"}


def test_stored_icing_is_what_its_script_makes():
    """Running the script again gives the stored borders."""
    stored, made = read_cage(ASSETS / "gingerbread_icing.usda"), gingerbread.icing()
    np.testing.assert_allclose(stored.vertices, made.vertices, atol=1e-6)
    assert stored.faces == made.faces


@pytest.mark.parametrize("name", TABLE_1)
def test_mesh_is_a_surface_to_embed(name):
    """The reader makes a closed surface of it with the same arrays."""
    surface = read_surface(ASSETS / f"{name}.usdc")
    assert surface.closed
    np.testing.assert_array_equal(surface.points, stored_mesh(name).points)
    np.testing.assert_array_equal(surface.triangles, stored_mesh(name).triangles)


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

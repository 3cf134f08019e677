# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Plane bodies in USD: outlines as curves, flat meshes, animations."""

from __future__ import annotations

import numpy as np
import pytest
from pxr import Gf, Usd, UsdGeom

from newton_cagecut.cage import Cut
from newton_cagecut.geometry import lifted
from newton_cagecut.section import Blade
from newton_cagecut.surface import SurfaceCut
from newton_cagecut.usd import (
    AnimationWriter,
    BodyFrame,
    read_cage,
    read_surface,
    validate_animation,
    write_cage,
    write_mesh,
)
from plane_shapes import PLANES, outline, rectangle, square
from surface_shapes import flower, grid


def _loops(cage) -> set[tuple]:
    """The segments of a cage as pairs of positions."""
    return {tuple(np.round(cage.vertices[list(face)].ravel(), 6).tolist()) for face in cage.faces}


def _curves(stage: Usd.Stage, path: str = "/World/cage") -> UsdGeom.BasisCurves:
    return UsdGeom.BasisCurves(stage.GetPrimAtPath(path))


@pytest.mark.parametrize("name", PLANES)
def test_plane_cage_survives_a_round_trip(tmp_path, name):
    """A plane cage is written as guide curves, one a loop, and read back with the same segments, in any unit."""
    cage = PLANES[name]()
    write_cage(tmp_path / "cage.usda", cage, meters_per_unit=0.01)
    again = read_cage(tmp_path / "cage.usda")
    assert (again.dimension, again.component_count) == (2, cage.component_count)
    assert _loops(again) == _loops(cage)
    stage = Usd.Stage.Open(str(tmp_path / "cage.usda"))
    curves = _curves(stage)
    assert len(curves.GetCurveVertexCountsAttr().Get()) == cage.component_count
    assert curves.GetPurposeAttr().Get() == UsdGeom.Tokens.guide


def test_cut_cage_survives_a_round_trip(tmp_path):
    """The outline of a cut in progress, whose sides coincide, is one loop."""
    cage = Cut(square(), Blade([0.513, 0.5], [0.0, 1.0])).advance(to=0.3).cage
    write_cage(tmp_path / "cut.usda", cage)
    stage = Usd.Stage.Open(str(tmp_path / "cut.usda"))
    curves = _curves(stage)
    assert list(curves.GetCurveVertexCountsAttr().Get()) == [7]


def test_outlines_are_placed_and_turned_counterclockwise(tmp_path):
    """The world's transform applies, also one that mirrors; a stage with +Y up can be turned where it stays flat."""
    write_cage(tmp_path / "cage.usda", PLANES["holed_square"](), up_axis="Y")
    stage = Usd.Stage.Open(str(tmp_path / "cage.usda"))
    place = UsdGeom.Xformable(stage.GetPrimAtPath("/World/cage"))
    place.AddTranslateOp().Set(Gf.Vec3d(5.0, 0.0, 2.0))
    place.AddScaleOp().Set(Gf.Vec3f(-1.0, 1.0, 1.0))
    cage = read_cage(stage)
    assert cage.volume == pytest.approx(8.0)
    assert (cage.vertices.min(axis=0).tolist(), cage.vertices.max(axis=0).tolist()) == ([2.0, 0.0], [5.0, 3.0])
    with pytest.raises(ValueError, match=r"is not flat: point \d+ is 3 m away"):
        read_cage(stage, up_axis="Z")


def test_cage_beside_a_mesh_is_chosen_by_its_path(tmp_path):
    """Where a stage has a mesh too, the mesh is the cage unless the curves are named; several curves must be named."""
    write_cage(tmp_path / "cage.usda", square())
    stage = Usd.Stage.Open(str(tmp_path / "cage.usda"))
    mesh = UsdGeom.Mesh.Define(stage, "/World/box")
    points = [Gf.Vec3f(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    mesh.CreatePointsAttr(points)
    mesh.CreateFaceVertexCountsAttr([4] * 6)
    mesh.CreateFaceVertexIndicesAttr([0, 1, 3, 2, 4, 6, 7, 5, 0, 4, 5, 1, 2, 3, 7, 6, 0, 2, 6, 4, 1, 5, 7, 3])
    assert read_cage(stage).dimension == 3
    assert read_cage(stage, "/World/cage").dimension == 2
    stage.RemovePrim("/World/box")
    UsdGeom.BasisCurves.Define(stage, "/World/more")
    with pytest.raises(ValueError, match="2 prims of curves; choose one by its path"):
        read_cage(stage)


@pytest.mark.parametrize(
    ("attribute", "value", "message"),
    [
        ("type", "cubic", "linear and periodic curves, these are cubic and periodic"),
        ("wrap", "nonperiodic", "these are linear and nonperiodic"),
        ("curveVertexCounts", [3], "add up to 3, but there are 4 points"),
        ("points", [], "add up to 4, but there are 0 points"),
        ("points", [Gf.Vec3f(x, y, 0.1 * x * y) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], "is not flat: point 2"),
    ],
)
def test_curves_that_are_no_outline_are_refused(tmp_path, attribute, value, message):
    """Curves of another kind, with counts that do not fit, or not in a plane are refused with the reason."""
    write_cage(tmp_path / "cage.usda", square())
    stage = Usd.Stage.Open(str(tmp_path / "cage.usda"))
    stage.GetPrimAtPath("/World/cage").GetAttribute(attribute).Set(value)
    with pytest.raises(ValueError, match=message):
        read_cage(stage)


@pytest.mark.parametrize("backward", [False, True])
def test_flat_mesh_is_read_as_a_plane_surface(tmp_path, backward):
    """A mesh in a plane normal to z loses its z; one that faces -z is reversed; texture coordinates stay."""
    surface = flower()
    triangles = surface.triangles[:, ::-1] if backward else surface.triangles
    points = np.c_[surface.points, np.full(surface.point_count, 0.4)]
    write_mesh(tmp_path / "flat.usdc", points, triangles, uvs=surface.uvs)
    again = read_surface(tmp_path / "flat.usdc", flat=True)
    assert again.dimension == 2
    assert again.volume == pytest.approx(surface.volume, rel=1e-6)
    np.testing.assert_allclose(again.points, surface.points, atol=1e-6)
    np.testing.assert_allclose(again.uvs, surface.uvs, atol=1e-6)
    with pytest.raises(ValueError, match="is not flat"):
        read_surface(tmp_path / "flat.usdc", flat=True, up_axis="Y")


def test_animation_of_a_plane_body(tmp_path):
    """Surface and outline change their topology with the cut, are valid between samples, and are seen from behind."""
    surface, cut = grid(), Cut(square(), Blade([0.513, 0.5], [0.0, 1.0]))
    surface_cut = SurfaceCut(surface, cut.plane, cut.wall)
    with AnimationWriter(tmp_path / "plane.usda") as writer:
        for frame, depth in enumerate((0.0, 0.3, 0.6, 2.0)):
            edit = cut.advance(to=depth)
            now = surface_cut.advance(edit.front).surface
            body = BodyFrame(
                name="sheet",
                points=lifted(now.points) + [0.0, 0.0, 0.1 * frame],
                triangles=now.triangles,
                triangle_cap=now.triangle_cap,
                cage_points=lifted(cut.cage.vertices),
                cage_faces=cut.cage.faces,
            )
            writer.write_frame(frame, body)
    stage = Usd.Stage.Open(str(tmp_path / "plane.usda"))
    assert validate_animation(stage) == []
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/World/sheet/skin"))
    assert mesh.GetDoubleSidedAttr().Get()
    assert len(mesh.GetFaceVertexIndicesAttr().Get(3.0)) == 3 * now.triangle_count
    counts = _curves(stage, "/World/sheet/cage").GetCurveVertexCountsAttr()
    assert [sorted(counts.Get(float(frame))) for frame in range(4)] == [[4], [7], [7], [4, 4]]
    assert counts.GetNumTimeSamples() == 3
    stage.GetPrimAtPath("/World/sheet/cage").GetAttribute("curveVertexCounts").Set([2, 5], 1.0)
    assert any("do not go round" in problem for problem in validate_animation(stage))


def test_cage_that_is_no_outline_is_refused(tmp_path):
    """Segments that leave a vertex twice, or not at all, are refused before anything is written."""
    cage = outline(rectangle((0, 0), (1, 1)))
    options = {"name": "sheet", "points": lifted(cage.vertices), "triangles": [[0, 1, 2], [0, 2, 3]]}
    with AnimationWriter(tmp_path / "plane.usda") as writer:
        for faces in (((0, 1), (1, 2), (2, 0)), ((0, 1), (1, 2), (2, 3), (2, 0))):
            with pytest.raises(ValueError, match="the cage of body sheet is no outline"):
                writer.write_frame(0, BodyFrame(cage_points=lifted(cage.vertices), cage_faces=faces, **options))
        writer.write_frame(0, BodyFrame(cage_points=lifted(cage.vertices), cage_faces=cage.faces, **options))

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import numpy as np
import pytest
from pxr import Sdf, Usd, UsdGeom, UsdShade

from newton_cagecut.cage import Cage, Cut
from newton_cagecut.section import Blade
from newton_cagecut.surface import Surface, SurfaceCut
from newton_cagecut.usd import AnimationWriter, BodyFrame, validate_animation
from newton_cagecut.usd.normals import split_caps, vertex_normals

TETRAHEDRON = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
TRIANGLES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def whole_body(*, offset: float = 0.0, name: str = "body") -> BodyFrame:
    """Return a tetrahedron that is its own cage."""
    points = TETRAHEDRON + (0.0, 0.0, offset)
    cage = {"cage_points": points * 1.2, "cage_faces": TRIANGLES.tolist()}
    return BodyFrame(name=name, points=points, triangles=TRIANGLES, **cage)


def cut_body(*, offset: float = 0.0) -> BodyFrame:
    """Return two tetrahedra, each with its slanted face as a cap of wall 4."""
    points = np.concatenate([TETRAHEDRON, -TETRAHEDRON - 0.5]) + (0.0, 0.0, offset)
    triangles = np.concatenate([TRIANGLES, TRIANGLES[:, ::-1] + 4])
    cap = np.where(np.arange(8) % 4 == 3, 4, -1)
    cage = {"cage_points": points * 1.2, "cage_faces": triangles.tolist()}
    return BodyFrame(name="body", points=points, triangles=triangles, triangle_cap=cap, **cage)


@pytest.fixture
def animation(tmp_path):
    """Four frames of a body that is cut at the third."""
    path = tmp_path / "cut.usda"
    with AnimationWriter(path, fps=30.0, meters_per_unit=0.01, separate_caps=False, normals=True) as writer:
        writer.add_ground_plane(-1.0)
        for frame in range(4):
            make = whole_body if frame < 2 else cut_body
            writer.write_frame(frame, make(offset=0.1 * frame))
    return Usd.Stage.Open(str(path))


def surface_of(stage: Usd.Stage) -> UsdGeom.Mesh:
    """Return the surface of the body."""
    return UsdGeom.Mesh(stage.GetPrimAtPath("/World/body/surface"))


def test_every_sample_is_valid(animation):
    """An animation with changing topology has no problem at any sample or between two."""
    assert validate_animation(animation) == []


def test_extent_holds_the_points_between_samples(tmp_path):
    """Where the number of points changes USD holds the old ones until the next sample, and the extent has them in."""
    with AnimationWriter(tmp_path / "fast.usda", separate_caps=False) as writer:
        writer.write_frame(0, whole_body())
        writer.write_frame(1, cut_body(offset=50.0))
    stage = Usd.Stage.Open(str(tmp_path / "fast.usda"))
    assert validate_animation(stage) == []
    assert np.array(surface_of(stage).GetPointsAttr().Get(0.9))[:, 2].max() == 1.0
    assert surface_of(stage).GetExtentAttr().Get(0.9)[0][2] <= 0.0


def test_stage_metrics(animation):
    """The stage says its unit, up axis, rate, range and default prim."""
    assert UsdGeom.GetStageMetersPerUnit(animation) == pytest.approx(0.01)
    assert UsdGeom.GetStageUpAxis(animation) == UsdGeom.Tokens.z
    assert animation.GetTimeCodesPerSecond() == 30.0
    assert (animation.GetStartTimeCode(), animation.GetEndTimeCode()) == (0.0, 3.0)
    assert animation.GetDefaultPrim().GetPath() == Sdf.Path("/World")


def test_topology_is_sampled_only_where_it_changes(animation):
    """Points, normals and extents have a sample a frame; topology, caps and colours have one a change."""
    mesh = surface_of(animation)
    every, changes = [0.0, 1.0, 2.0, 3.0], [0.0, 2.0]
    assert mesh.GetPointsAttr().GetTimeSamples() == every
    assert mesh.GetNormalsAttr().GetTimeSamples() == every
    assert mesh.GetExtentAttr().GetTimeSamples() == every
    assert mesh.GetFaceVertexCountsAttr().GetTimeSamples() == changes
    assert mesh.GetFaceVertexIndicesAttr().GetTimeSamples() == changes
    assert mesh.GetDisplayColorPrimvar().GetIndicesAttr().GetTimeSamples() == changes
    assert UsdGeom.Subset.GetAllGeomSubsets(mesh)[0].GetIndicesAttr().GetTimeSamples() == changes


def test_points_are_written_in_the_units_of_the_stage(animation):
    """One metre is a hundred units of a stage in centimetres."""
    points = np.array(surface_of(animation).GetPointsAttr().Get(3.0))[:8]
    np.testing.assert_allclose(points, cut_body(offset=0.3).points * 100.0, rtol=1e-6)


def test_caps_are_a_subset_with_a_material_and_a_colour(animation):
    """The triangles with a wall are the subset, which has its own material and display colour."""
    mesh = surface_of(animation)
    (subset,) = UsdGeom.Subset.GetAllGeomSubsets(mesh)
    assert subset.GetFamilyNameAttr().Get() == "materialBind"
    assert list(subset.GetIndicesAttr().Get(1.0)) == []
    assert list(subset.GetIndicesAttr().Get(2.0)) == [3, 7]
    skin, _ = UsdShade.MaterialBindingAPI(mesh.GetPrim()).ComputeBoundMaterial()
    cap, _ = UsdShade.MaterialBindingAPI(subset.GetPrim()).ComputeBoundMaterial()
    assert skin
    assert cap
    assert skin.GetPath() != cap.GetPath()
    colors = np.array(mesh.GetDisplayColorPrimvar().ComputeFlattened(2.0))
    assert len(colors) == 8
    assert (colors[3] != colors[0]).any()
    np.testing.assert_array_equal(colors[[3, 7]], colors[[3, 3]])


def test_cage_is_a_guide(animation):
    """The cage is a mesh of purpose guide that follows the cut."""
    cage = UsdGeom.Mesh(animation.GetPrimAtPath("/World/body/cage"))
    assert cage.GetPurposeAttr().Get() == UsdGeom.Tokens.guide
    assert len(cage.GetFaceVertexCountsAttr().Get(1.0)) == 4
    assert len(cage.GetFaceVertexCountsAttr().Get(2.0)) == 8


def test_normals_are_smooth_on_the_skin_and_flat_on_a_flat_cap(animation):
    """There is a normal for each point: of the skin around it, or for the copies that a cap has of its plane."""
    mesh = surface_of(animation)
    assert mesh.GetNormalsInterpolation() == UsdGeom.Tokens.vertex
    points, normals = np.array(mesh.GetPointsAttr().Get(2.0)), np.array(mesh.GetNormalsAttr().Get(2.0))
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get(2.0)).reshape(-1, 3)
    assert len(points) == len(normals) == 8 + 6
    np.testing.assert_allclose(normals[corners[3]], np.full((3, 3), 1 / np.sqrt(3)), atol=1e-6)
    np.testing.assert_allclose(normals[corners[7]], np.full((3, 3), -1 / np.sqrt(3)), atol=1e-6)
    np.testing.assert_array_equal(points[corners[[3, 7]]], points[cut_body().triangles[[3, 7]]])
    np.testing.assert_allclose(normals[0], np.full(3, -1 / np.sqrt(3)), atol=1e-6)
    np.testing.assert_allclose(normals[1], np.array([0.0, -1.0, -1.0]) / np.sqrt(2), atol=1e-6)


def partly_cut_box() -> Surface:
    """Return a box of unit size that a cut in the plane x = 0.5 has opened up to z = 0.3."""
    points = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
    quads = np.array([(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)])
    cut = Cut(Cage(points, quads.tolist()), Blade((0.5, 0.0, -0.5), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    edit = cut.advance(to=0.3)
    surface_cut = SurfaceCut(Surface(points, quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)), edit.plane, edit.wall)
    return surface_cut.advance(edit.front).surface


def opened(surface: Surface, slope: float) -> np.ndarray:
    """Return the points with the lips of the cut drawn apart; at slope 1 they stand at right angles."""
    points = surface.points.copy()
    lip = np.where(surface.point_key % 2 == 1, 1.0, -1.0) * (surface.point_key >= 0)
    points[:, 0] += slope * lip * np.maximum(0.3 - points[:, 2], 0.0)
    return points


@pytest.mark.parametrize("slope", [0.0, 0.2, 3.0])
def test_sides_of_a_cut_share_no_vertices(tmp_path, slope):
    """Closed or wide open, the front of a cut has a sharp edge: each side has copies with its own normal there."""
    surface = partly_cut_box()
    caps = {"triangle_cap": surface.triangle_cap, "rest_points": surface.points}
    with AnimationWriter(tmp_path / "open.usda", separate_caps=False, normals=True) as writer:
        writer.write_frame(
            0, BodyFrame(name="body", points=opened(surface, slope), triangles=surface.triangles, **caps)
        )
    stage = Usd.Stage.Open(str(tmp_path / "open.usda"))
    mesh = surface_of(stage)
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get(0.0)).reshape(-1, 3)[surface.triangle_cap >= 0]
    normals = np.array(mesh.GetNormalsAttr().Get(0.0))[corners]
    left = (surface.point_key[surface.triangles[surface.triangle_cap >= 0]] % 2 == 0).any(axis=1)
    for side, sign in ((left, 1.0), (~left, -1.0)):
        expected = np.array([sign, 0.0, -slope]) / np.hypot(1.0, slope)
        np.testing.assert_allclose(normals[side], np.broadcast_to(expected, normals[side].shape), atol=1e-6)
    assert not np.intersect1d(corners[left], corners[~left]).size


def test_copies_come_from_the_points_that_the_caps_use():
    """Caps refer to copies of their own points, in the place of each; the skin keeps its points and triangles."""
    surface = partly_cut_box()
    source, triangles = split_caps(surface.points, surface.triangles, surface.triangle_cap)
    cap = surface.triangle_cap >= 0
    np.testing.assert_array_equal(source[triangles], surface.triangles)
    np.testing.assert_array_equal(triangles[~cap], surface.triangles[~cap])
    assert triangles[cap].min() == surface.point_count
    assert len(source) == surface.point_count + len(np.unique(triangles[cap])) == 16 + 5 + 5


def test_vertex_without_area_has_a_unit_normal():
    """Vertices of no triangle, or of one without area, get a normal that is valid."""
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [5.0, 5.0, 5.0]])
    np.testing.assert_array_equal(vertex_normals(points, np.array([[0, 1, 2]])), [[0.0, 0.0, 1.0]] * 4)


def test_normals_left_out(tmp_path):
    """Without normals no vertex is copied and the file holds the body's own triangles."""
    with AnimationWriter(tmp_path / "bare.usda", separate_caps=False, normals=False) as writer:
        writer.write_frame(0, cut_body())
    stage = Usd.Stage.Open(str(tmp_path / "bare.usda"))
    mesh = surface_of(stage)
    assert not mesh.GetNormalsAttr().IsAuthored()
    assert len(mesh.GetPointsAttr().Get(0.0)) == 8
    assert list(mesh.GetFaceVertexIndicesAttr().Get(0.0)) == cut_body().triangles.reshape(-1).tolist()
    assert validate_animation(stage) == []


def test_failed_run_leaves_a_valid_file(tmp_path):
    """An exception inside the block still writes the frames so far."""
    path = tmp_path / "failed.usdc"
    writer = AnimationWriter(path)
    with pytest.raises(KeyError, match="simulation"), writer:  # noqa: PT012
        writer.write_frame(0, whole_body())
        writer.write_frame(1, whole_body(offset=1.0))
        raise KeyError("simulation")
    assert validate_animation(path) == []
    assert Usd.Stage.Open(str(path)).GetEndTimeCode() == 1.0
    assert [file.name for file in tmp_path.iterdir()] == ["failed.usdc"]


def test_no_frame_at_all_leaves_a_valid_file(tmp_path):
    """A run that fails before its first frame leaves an empty stage with its metrics."""
    with AnimationWriter(tmp_path / "empty.usd"):
        pass
    assert validate_animation(tmp_path / "empty.usd") == []


def test_refused_frame_writes_nothing(tmp_path):
    """A frame with an invalid body is refused before any of its bodies is written."""
    with AnimationWriter(tmp_path / "refused.usda", separate_caps=False) as writer:
        writer.write_frame(0, whole_body())
        bad = BodyFrame(name="bad", points=TETRAHEDRON, triangles=TRIANGLES + 1)
        with pytest.raises(ValueError, match="body bad: face 1 refers to vertex 4, but there are 4"):
            writer.write_frame(1, whole_body(offset=1.0), bad)
        writer.write_frame(2, whole_body(offset=2.0))
    stage = Usd.Stage.Open(str(tmp_path / "refused.usda"))
    assert surface_of(stage).GetPointsAttr().GetTimeSamples() == [0.0, 2.0]
    assert not stage.GetPrimAtPath("/World/bad")


def test_late_body_is_invisible_before(tmp_path):
    """A body that first comes at frame 2 is hidden until then."""
    with AnimationWriter(tmp_path / "late.usda") as writer:
        writer.write_frame(0, whole_body())
        writer.write_frame(2, whole_body(), whole_body(name="late"))
    stage = Usd.Stage.Open(str(tmp_path / "late.usda"))
    late = UsdGeom.Imageable(stage.GetPrimAtPath("/World/late"))
    assert late.ComputeVisibility(1.0) == UsdGeom.Tokens.invisible
    assert late.ComputeVisibility(2.0) == UsdGeom.Tokens.inherited
    assert validate_animation(stage) == []


@pytest.mark.parametrize(
    ("frame", "bodies", "message"),
    [
        (0.0, [whole_body()], r"larger than the last one \(0\), got 0.0"),
        (float("nan"), [whole_body()], "got nan"),
        (1.0, [whole_body(), whole_body()], "each body comes once a frame, got body, body"),
        (1.0, [whole_body(name="a b")], "'a_b' would be"),
        (1.0, [whole_body(name="ground")], "'ground' is taken"),
    ],
)
def test_frame_errors_say_what_is_wrong(tmp_path, frame, bodies, message):
    """Frames out of order, bodies that come twice and names that USD cannot take are refused."""
    with AnimationWriter(tmp_path / "errors.usda") as writer:
        writer.add_ground_plane()
        writer.write_frame(0, whole_body())
        with pytest.raises(ValueError, match=message):
            writer.write_frame(frame, *bodies)


def test_closed_writer_refuses_frames(tmp_path):
    """A frame after the end of the block is an error, not a silent loss."""
    with AnimationWriter(tmp_path / "closed.usda") as writer:
        writer.write_frame(0, whole_body())
    with pytest.raises(RuntimeError, match=r"closed.usda is closed"):
        writer.write_frame(1, whole_body())


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (lambda mesh: mesh.GetFaceVertexIndicesAttr().Clear(), "at 0.0: "),
        (lambda mesh: mesh.GetFaceVertexCountsAttr().Clear(), "at 0.0: it has no points or no faces"),
        (lambda mesh: mesh.GetNormalsAttr().ClearAtTime(2.0), "normals has 4 values, vertex needs 14"),
        (lambda mesh: mesh.GetPointsAttr().Set(mesh.GetPointsAttr().Get(0.0), 2.0), "at 2.0: "),
        (lambda mesh: mesh.GetExtentAttr().Set([(0, 0, 0), (1, 1, 1)], 3.0), "at 3.0: points leave the extent"),
    ],
)
def test_validation_finds_damage(animation, damage, message):
    """Each kind of damage to one sample is reported with its time."""
    damage(surface_of(animation))
    assert message in "\n".join(validate_animation(animation))


def test_validation_finds_a_bad_subset(animation):
    """A subset that names a face which does not exist is reported."""
    UsdGeom.Subset.GetAllGeomSubsets(surface_of(animation))[0].GetIndicesAttr().Set([3, 8], 2.0)
    assert any("subset cap names face 8 of 8" in problem for problem in validate_animation(animation))

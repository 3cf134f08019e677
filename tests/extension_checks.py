# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What must hold of every edit that extends or obstructs a cage, found by plain loops."""

from __future__ import annotations

import numpy as np

from cage_shapes import check_manifold
from newton_cagecut.cage import Cage, CageEdit


def check_edit(edit: CageEdit, added_volume: float) -> None:
    """Assert what an edit that adds to a cage, or takes an obstacle's room from it, must keep and tell."""
    before, after = edit.before, edit.cage
    hollow = bool((after.component_volumes < 0.0).any())
    check_manifold(after, before.volume + added_volume, hollow=hollow)
    assert not edit.is_empty
    assert after.length_tolerance == before.length_tolerance
    _check_numbers(edit)
    _check_swept(edit)
    _check_changes(edit)


def _check_numbers(edit: CageEdit) -> None:
    """What was there keeps its number and, but for what moved, its place to the last bit."""
    before, after = edit.before, edit.cage
    count = before.vertex_count
    assert edit.created.tolist() == list(range(count, after.vertex_count))
    moved = np.flatnonzero((before.vertices != after.vertices[:count]).any(axis=1))
    assert edit.moved.tolist() == moved.tolist()
    assert edit.source_faces.tolist() == [-1] * (len(edit.created) + len(edit.moved))
    assert all(one is other for one, other in zip(before.walls, after.walls[: len(before.walls)], strict=True))
    retired = set(edit.retired_walls.tolist())
    assert retired == set(before.face_wall.tolist()) - set(after.face_wall.tolist())
    for face in range(before.face_count):
        kept = int(before.face_wall[face]) not in retired
        assert (before.face_key[face] == after.face_key[face]) == kept
        assert not kept or before.faces[face] == after.faces[face]


def _check_swept(edit: CageEdit) -> None:
    """The swept polygons lie on their walls, counterclockwise, and are as large as the walls' new part."""
    before, after = edit.before, edit.cage
    for walls in (edit.swept_wall, edit.swept_simplex_wall):
        assert (np.diff(walls) >= 0).all()
    assert set(range(len(before.walls), len(after.walls))) <= set(edit.swept_wall.tolist())
    for pieces, owners in ((edit.swept, edit.swept_wall), (edit.swept_simplices, edit.swept_simplex_wall)):
        area = np.zeros(len(after.walls))
        for piece, number in zip(pieces, owners.tolist(), strict=True):
            wall = after.walls[number]
            assert np.abs((piece - wall.origin) @ wall.normal).max() <= after.length_tolerance
            assert _area(piece, wall.normal) > 0.0
            area[number] += _area(piece, wall.normal)
        gained = _wall_areas(after, len(after.walls)) - _wall_areas(before, len(after.walls))
        gained[edit.retired_walls] = 0.0
        np.testing.assert_allclose(area, gained, rtol=1e-9, atol=1e-12 * after.diameter ** (after.dimension - 1))


def _check_changes(edit: CageEdit) -> None:
    """Changed faces and keys are those that a comparison of the two cages finds."""
    before, after = edit.before, edit.cage
    moved = set(edit.moved.tolist())
    same = {
        f
        for f in range(before.face_count)
        if before.faces[f] == after.faces[f]
        and before.face_key[f] == after.face_key[f]
        and not moved & set(after.faces[f])
    }
    changed = sorted(set(range(after.face_count)) - same)
    assert edit.changed_faces.tolist() == changed
    keys = {int(before.face_key[f]) for f in range(before.face_count) if f not in same}
    assert edit.changed_keys.tolist() == sorted(keys | {int(after.face_key[f]) for f in changed})


def _area(polygon: np.ndarray, normal: np.ndarray) -> float:
    """Area of a polygon, or length of a segment, negative if it runs clockwise about the normal."""
    if polygon.shape[1] == 2:
        along = polygon[1] - polygon[0]
        return float(along[1] * normal[0] - along[0] * normal[1])
    offset = polygon - polygon[0]
    return 0.5 * float(np.cross(offset, np.roll(offset, -1, axis=0)).sum(axis=0) @ normal)


def _wall_areas(cage: Cage, wall_count: int) -> np.ndarray:
    """Area, or length in the plane, of the faces on each wall."""
    return np.bincount(cage.face_wall, np.linalg.norm(cage.mesh.face_area_vector, axis=1), minlength=wall_count)

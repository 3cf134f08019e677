# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Landing: the face that a walk ended on and, where that needs one, the nested walk on it."""

from functools import cache

import warp as wp

from ..launch import launch
from ..options import WalkOptions
from ..walks.landing import KEY_MASK, NOWHERE, landing_type, point_functions
from ..walks.query_points import QueryPoints
from ..walks.records import WalkRecords
from ..walks.work import Work, WorkList, number_of, place_of, point_of
from .boundary_value import BoundaryValue, make_landing_value
from .face_tables import QUAD, TRIANGLE, FaceTables, face_of_landing, plane_point
from .face_walk import walk_on_face

wp.set_module_options({"enable_backward": False})


@wp.func
def landed_face(tables: FaceTables, key: int, local: wp.vec2, piece: int) -> int:
    """The face of a landing: on its own side; on the other where rounding put the walk's end across a cut."""
    face = face_of_landing(tables, key, local, piece)
    if face < 0:
        face = face_of_landing(tables, key ^ 1, local, piece)
    if face < 0:
        face = face_of_landing(tables, key, local, -1)
    if face < 0:
        face = face_of_landing(tables, key ^ 1, local, -1)
    return face


@wp.func
def values_differ(before: FaceTables, old: BoundaryValue, tables: FaceTables, new: BoundaryValue) -> bool:
    """Whether two boundary values differ in a vertex, a weight or a vertex's rest position, in any bit."""
    if old.count != new.count:
        return True
    for i in range(new.count):
        if old.vertex[i] != new.vertex[i] or old.weight[i] != new.weight[i]:
            return True
        step = tables.rest[new.vertex[i]] - before.rest[old.vertex[i]]
        if step[0] != wp.float64(0.0) or step[1] != wp.float64(0.0) or step[2] != wp.float64(0.0):
            return True
    return False


@cache
def make_land_kernel(*, dimension: int, nested: bool, compare: bool) -> wp.Kernel:
    """Make the kernel that looks up the faces of landings and, where needed, walks on them.

    Args:
        dimension: 2 or 3.
        nested: Whether any face needs a nested walk; without, its code is left out.
        compare: Whether to mark the points of which a landing's boundary value is another one than it was on the
            faces before.
    """
    Landings = landing_type(dimension)
    to_space = point_functions(dimension)[0]
    landing_value = make_landing_value(dimension)

    @wp.kernel(enable_backward=False, module="unique")
    def land(
        offset: int,
        work: WorkList,
        points: QueryPoints,
        before: FaceTables,
        tables: FaceTables,
        landings: Landings,
        epsilon: float,
        max_steps: int,
        touched: wp.array[wp.uint8],
    ):
        walk = place_of(work, offset + wp.tid())
        point = point_of(work, walk)
        old = BoundaryValue()
        if wp.static(compare):
            # A walk that has landed elsewhere since has touched its point already, whatever stands here then.
            old = landing_value(before, landings, walk)
        key = landings.key[walk] & KEY_MASK
        local = plane_point(tables, key // 2, to_space(landings.point[walk]))
        face = landed_face(tables, key, local, points.piece[point])
        landings.face[walk] = face
        if wp.static(dimension == 3):
            edge = NOWHERE
            param = float(0.0)
            if wp.static(nested):
                if tables.kind[face] != TRIANGLE and tables.kind[face] != QUAD:
                    number = number_of(work, walk)
                    hit = walk_on_face(tables, face, local, work.seed, wp.uint32(point), number, epsilon, max_steps)
                    edge = hit.row
                    param = hit.param
            landings.edge[walk] = edge
            landings.param[walk] = param
        if wp.static(compare):
            if values_differ(before, old, tables, landing_value(tables, landings, walk)):
                touched[point] = wp.uint8(1)

    return land


def land_walks(
    work: Work,
    records: WalkRecords,
    points: QueryPoints,
    faces: FaceTables,
    options: WalkOptions,
    *,
    before: FaceTables,
    touched: wp.array | None = None,
    nested: bool = True,
) -> None:
    """Evaluate landings on the faces as they are.

    Args:
        work: The walks that have landed.
        records: Their landings, and where the evaluation is written.
        points: Where they started.
        faces: The faces.
        options: Options of the walks.
        before: The faces on which the landings were evaluated before, if they were.
        touched: Where to mark points of which a boundary value is another one than on the faces before, shape
            (point_count,).
        nested: Whether walks go on in faces that ask for it; otherwise landings there only know their face.
    """
    nested = nested and faces.nested_count > 0
    kernel = make_land_kernel(dimension=records.dimension, nested=nested, compare=touched is not None)
    if touched is None:
        touched = wp.empty(0, dtype=wp.uint8, device=records.device)
    inputs = [work.list, points, before, faces, records.landings, options.epsilon, options.max_steps, touched]
    launch(kernel, work.count, inputs, device=records.device)

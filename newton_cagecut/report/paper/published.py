# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Table 1 of the paper: 2048 walks a vertex, cuts in steps of about 3 %, on an NVIDIA RTX 5090."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class PaperRow:
    """A row of the table; counts, then means over the steps of a cut.

    Attributes:
        face_count: Faces of the cage.
        vertex_count: Vertices of the cage.
        mesh_vertex_count: Vertices of the embedded mesh.
        rewalk_percent: Walks walked again [%].
        on_face_percent: Walks whose landing was evaluated again on a changed face [%].
        check_ms: Time of the check of the bounding volumes [ms].
        rewalk_ms: Time of walking again [ms].
        on_face_ms: Time of the landings on changed faces [ms].
        update_ms: Time of the whole update [ms].
        recompute_ms: Time of a full recompute [ms].
        ratio: The speed-up, of the recompute's time over the update's.
        memory_gb: Size of the walk cache [GB].
    """

    face_count: int
    vertex_count: int
    mesh_vertex_count: int
    rewalk_percent: float
    on_face_percent: float
    check_ms: float
    rewalk_ms: float
    on_face_ms: float
    update_ms: float
    recompute_ms: float
    ratio: float
    memory_gb: float


TABLE_1 = {
    "dude": PaperRow(35, 34, 2314, 4.81, 6.05, 1.18, 7.13, 0.41, 9.55, 112.27, 11.8, 0.55),
    "starfish": PaperRow(53, 50, 8158, 3.22, 5.58, 3.54, 20.66, 1.18, 27.17, 513.77, 18.9, 1.93),
    "key": PaperRow(81, 74, 1256, 2.68, 4.99, 0.69, 3.84, 0.28, 5.65, 86.16, 15.2, 0.30),
    "octopus": PaperRow(407, 375, 2784, 0.36, 0.44, 1.48, 15.06, 0.29, 20.22, 845.00, 41.8, 0.66),
    "jelly": PaperRow(21, 12, 2210, 14.87, 5.54, 1.14, 12.18, 0.67, 14.86, 62.36, 4.2, 0.52),
    "sphere": PaperRow(12, 8, 10242, 15.87, 28.53, 4.71, 36.08, 4.44, 46.65, 130.89, 2.8, 2.42),
}
"""The rows by the names of the scenes."""

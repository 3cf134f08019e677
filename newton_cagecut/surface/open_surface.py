# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What an opened section makes of a surface: split triangles, caps, attributes carried over.

Section 6.3 of the paper. Attributes of new points are linear along the edges and chords on which they lie.
"""

from __future__ import annotations

import numpy as np

from ..geometry import units
from ..section import Opening
from .splitting import cap_triangles, split_triangles
from .surface import Surface


def open_surface(base: Surface, opening: Opening, wall: int) -> Surface:
    """The surface that a section opened up to a front leaves.

    Args:
        base: The surface before the cut.
        opening: The section opened.
        wall: Number of the wall on which new points lie.
    """
    kept, added, owner = split_triangles(opening)
    caps, side = cap_triangles(opening)
    keys = np.full(opening.vertices.count, 2 * wall + 1, dtype=np.int32)
    minus, plus = (ids[opening.region.labels] for ids in opening.vertices.sides)
    keys[minus[minus != plus] - base.point_count] = 2 * wall
    return Surface._assembled(
        np.concatenate([base.points, opening.vertices.positions[:, : base.dimension]]),
        np.concatenate([kept, added, caps]).astype(np.int32),
        _carried(opening, base.uvs),
        None if base.normals is None else units(_carried(opening, base.normals)),
        np.concatenate([base.triangle_cap, base.triangle_cap[owner], np.full(len(caps), wall, dtype=np.int32)]),
        np.concatenate([base.cap_side, base.cap_side[owner], side]),
        np.concatenate([base.point_key, keys]),
    )


def _carried(opening: Opening, values: np.ndarray | None) -> np.ndarray | None:
    """Values of all points from those of the points before."""
    if values is None:
        return None
    section = opening.section
    at_nodes = section.nodes.values(values)
    at_tips = section.values_on_chords(at_nodes, opening.region.upper, opening.vertices.tip_chords)
    return np.concatenate([values, opening.vertices.values(at_nodes, at_tips)])

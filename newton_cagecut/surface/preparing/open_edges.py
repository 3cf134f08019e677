# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Open edges of a surface, in words.

Where cuts (paper, section 6.3) meet them they make no caps; some look like cracks that were meant to be closed.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...geometry import PolygonMesh
from .welding import WELD, open_half_edges

_WIDTH = 1e-3
"""Width up to which a gap is a crack, in longest sides of the box around the mesh."""
_NARROW = 0.25
"""The same in lengths of the edge."""
_ALIGNED = 0.9
_NEIGHBOURS = 12
_SAMPLES = 32


def open_notes(mesh: PolygonMesh) -> list[str]:
    """Sentences about the open edges of a mesh.

    Args:
        mesh: The triangles, of which some edge is open.
    """
    border = open_half_edges(mesh)
    if not len(border):
        return []
    notes = [f"{_counted(mesh, border)} one triangle: where a cut meets such edges it makes no caps"]
    size = float(np.ptp(mesh.vertices, axis=0).max())
    cracks = border[_along_others(mesh, border, _WIDTH * size)]
    if len(cracks):
        notes.append(
            f"{_counted(mesh, cracks)} another one beside it, at less than {_WIDTH * size:.2g} m, that does not end "
            f"where it ends: a crack, which stays open; weld=, now {WELD:g} of the size unless given, joins ends that "
            "are near each other"
        )
    return notes


def _counted(mesh: PolygonMesh, half_edges: np.ndarray) -> str:
    first = int(half_edges[0])
    which = f"({mesh.face_vertex[first]}, {mesh.destination[first]}) of triangle {mesh.face[first]}"
    return f"edge {which} has" if len(half_edges) == 1 else f"{len(half_edges)} edges, the first {which}, have"


def _along_others(mesh: PolygonMesh, border: np.ndarray, width: float) -> np.ndarray:
    """Whether another edge runs back along each of some, near its middle, shape (count,)."""
    start, end = mesh.vertices[mesh.face_vertex[border]], mesh.vertices[mesh.destination[border]]
    along = end - start
    length = np.linalg.norm(along, axis=1)
    count = np.clip(np.ceil(length / max(float(np.median(length)), 1e-300)), 1, _SAMPLES).astype(np.int64)
    of_sample = np.repeat(np.arange(len(border)), count)
    within = np.arange(len(of_sample)) - np.repeat(np.cumsum(count) - count, count)
    samples = start[of_sample] + ((within + 0.5) / count[of_sample])[:, None] * along[of_sample]
    middle = 0.5 * (start + end)
    near = cKDTree(samples).query(middle, k=min(_NEIGHBOURS, len(samples)))[1].reshape(len(border), -1)
    other = of_sample[near]
    squared = np.maximum(length**2, 1e-300)
    share = np.clip(np.einsum("ijk,ijk->ij", middle[:, None] - start[other], along[other]) / squared[other], 0.0, 1.0)
    distance = np.linalg.norm(middle[:, None] - start[other] - share[..., None] * along[other], axis=2)
    back = np.einsum("ik,ijk->ij", along, along[other]) < -_ALIGNED * length[:, None] * length[other]
    limit = np.minimum(width, _NARROW * length)[:, None]
    return (back & (distance <= limit) & (other != np.arange(len(border))[:, None])).any(axis=1)

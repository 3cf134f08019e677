# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Values of sites carried over to the sites that an opened section makes, linear along edges and chords."""

from __future__ import annotations

import numpy as np

from ..section import Opening


def carried(opening: Opening, values: np.ndarray) -> np.ndarray:
    """Values of the sites that are new; of whole numbers and flags those of the nearest old one.

    Args:
        opening: The opened section.
        values: Values of the sites before, shape (site_count, ...).

    Returns:
        Values of the created ones, shape (created_count, ...).
    """
    if values.dtype.kind != "f":
        return values[_nearest(opening)]
    flat = values.reshape(len(values), -1)
    section = opening.section
    at_nodes = section.nodes.values(flat)
    at_tips = section.values_on_chords(at_nodes, opening.region.upper, opening.vertices.tip_chords)
    new = opening.vertices.values(at_nodes, at_tips)
    return new.reshape(len(new), *values.shape[1:]).astype(values.dtype)


def _nearest(opening: Opening) -> np.ndarray:
    """The old site that is nearest to each created one, along the edges and chords on which it lies."""
    section, nodes, vertices = opening.section, opening.section.nodes, opening.vertices
    at_nodes = np.where(nodes.fraction < 0.5, nodes.above, nodes.below)
    for one, other, share in nodes.between:
        at_nodes = np.concatenate([at_nodes, np.where(share.reshape(-1) < 0.5, at_nodes[one], at_nodes[other])])
    at_nodes = at_nodes if nodes.which is None else at_nodes[nodes.which]
    low, high = section.chord_ends[vertices.tip_chords].T
    s = nodes.coordinates[:, 1]
    at_tips = np.where(2.0 * (opening.region.upper - s[low]) < s[high] - s[low], at_nodes[low], at_nodes[high])
    nearest = vertices.values(at_nodes, at_tips)
    middles, first = opening.region.middles, section.mesh.vertex_count
    for ids in (vertices.numbering.middle_plus, vertices.numbering.middle_minus):
        nearest[ids[middles] - first] = at_nodes[section.chord_ends[middles, 0]]
    return nearest

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Segments split, and sides opened, with the front of a cut in the plane at one place.

Sections 4.3 of the paper: the first step splits a segment, the next ones extend the sides. What is opened is told from
the nodes that the front has reached; the tip lies inside the body.
"""

from __future__ import annotations

import numpy as np

from .opening import Opening


class LineOpening(Opening):
    """What a line's section becomes when it is opened up to a front."""

    def _walk_faces(self) -> None:
        """Split the crossed segments, the first part of each keeping the segment's place."""
        section, mesh = self.section, self.section.mesh
        plus, minus = self.numbering.plus, self.numbering.minus
        swept = self.region.swept
        self.face_vertex = mesh.face_vertex.copy()
        """Vertex at which each half-edge of the mesh starts, after the opening, shape (half_edge_count,)."""
        parted = swept[section.parted_node]
        self.face_vertex[section.parted[parted]] = minus[section.parted_node[parted]]
        order = np.argsort(section.node_rank)
        node = order[swept[order] & (section.node_vertex[order] < 0)]
        half_edge = section.node_half_edge[node]
        before = np.where(section.enters[node], plus[node], minus[node])
        after = np.where(section.enters[node], minus[node], plus[node])
        self.faces = mesh.face[half_edge]
        """Segments that are split, in the order in which the front reached them, shape (touched_count,)."""
        self.first_loops = np.stack([mesh.face_vertex[half_edge], before], axis=1).tolist()
        """What stays in the place of each of them."""
        self.extra_loops = np.stack([after, mesh.face_vertex[half_edge + 1]], axis=1).tolist()
        """The further part of each of them."""
        self.extra_face = self.faces.tolist()
        """Segment of which each further part was split off."""
        self.half_edge_face = mesh.face.copy()
        """Face, after the opening, that walks each half-edge of the mesh, shape (half_edge_count,)."""
        self.half_edge_face[half_edge + 1] = mesh.face_count + np.arange(len(node))

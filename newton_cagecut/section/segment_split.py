# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Segments split with the front of a cut in the plane at one place.

Section 4.3 of the paper: the first step splits a segment, the next ones extend the sides. What is opened is told from
the nodes that the front has reached; the tip lies inside the body.
"""

from __future__ import annotations

import numpy as np

from .created_vertices import CreatedVertices
from .opening import OpenedFaces


def split_segments(created: CreatedVertices) -> OpenedFaces:
    """Split the crossed segments, in the order in which the front reached them.

    The first part of each keeps the segment's place.

    Args:
        created: The vertices of an opened section of segments.
    """
    section, mesh, nodes = created.section, created.section.mesh, created.section.nodes
    plus, minus, swept = created.numbering.plus, created.numbering.minus, created.region.swept
    face_vertex = mesh.face_vertex.copy()
    parted = swept[section.parted_node]
    face_vertex[section.parted[parted]] = minus[section.parted_node[parted]]
    order = np.argsort(nodes.rank)
    node = order[swept[order] & (nodes.vertex[order] < 0)]
    half_edge = nodes.half_edge[node]
    enters = np.zeros(nodes.count, dtype=bool)
    enters[section.chord_node[:, 0]] = True
    before = np.where(enters[node], plus[node], minus[node])
    after = np.where(enters[node], minus[node], plus[node])
    touched, half_edge_face = mesh.face[half_edge], mesh.face.copy()
    half_edge_face[half_edge + 1] = mesh.face_count + np.arange(len(node))
    return OpenedFaces(
        touched=touched,
        first_loops=np.stack([face_vertex[half_edge], before], axis=1).tolist(),
        extra_loops=np.stack([after, mesh.face_vertex[half_edge + 1]], axis=1).tolist(),
        extra_face=touched.tolist(),
        face_vertex=face_vertex,
        half_edge_face=half_edge_face,
        slits=[],
    )

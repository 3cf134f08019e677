# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Vertex ids of a progressive cut that do not change as it advances.

Section 5.2 of the paper keeps the vertices that a cut creates or displaces. Here a tip travels along its chord and on
through the next one, until it becomes one of the two vertices that open where the cut passes the last edge.
"""

from __future__ import annotations

import numpy as np

from .section import Section


class Numbering:
    """Ids of the vertices that opening a section creates, for every front at once."""

    def __init__(self, section: Section):
        """Hand out ids in the order in which the front reaches the nodes.

        Args:
            section: The section.
        """
        count = section.node_count
        touching: list[list[int]] = [[] for _ in range(count)]
        first = section.chord_ends[:, 0].tolist()
        existing = section.node_vertex.tolist()
        for chord, (start, end) in enumerate(section.chord_node[section.chord_face >= 0].tolist()):
            touching[start].append(chord)
            touching[end].append(chord)
        base = section.mesh.vertex_count
        plus, minus, tip = [0] * count, [0] * count, [0] * section.chord_count
        total = np.zeros(count + 1, dtype=np.int64)
        created = base
        for place, node in enumerate(np.argsort(section.node_rank).tolist()):
            arriving = [tip[chord] for chord in touching[node] if first[chord] != node]
            leaving = [chord for chord in touching[node] if first[chord] == node]
            own = 2 if existing[node] < 0 else 1
            missing = max(0, len(leaving) + own - len(arriving))
            ids = arriving + list(range(created, created + missing))
            created += missing
            for k, chord in enumerate(leaving):
                tip[chord] = ids[k]
            minus[node] = ids[len(leaving) + own - 1]
            plus[node] = ids[len(leaving)] if own == 2 else existing[node]
            total[place + 1] = created - base
        self.plus = np.array(plus, dtype=np.int64)
        """Vertex on the positive side of each opened node, shape (node_count,)."""
        self.minus = np.array(minus, dtype=np.int64)
        """Vertex on the negative side of each opened node, shape (node_count,)."""
        self.tip = np.array(tip, dtype=np.int64)
        """Vertex at the tip in each half-opened chord, shape (chord_count,)."""
        self.created = total
        """Number of ids in use once the front has reached so many nodes, shape (node_count + 1,)."""

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
        count = section.nodes.count
        touching: list[list[int]] = [[] for _ in range(count)]
        first = section.chord_ends[:, 0].tolist()
        tipped = np.flatnonzero(section.chord_tipped)
        for chord, (start, end) in zip(tipped.tolist(), section.chord_node[tipped].tolist(), strict=True):
            touching[start].append(chord)
            touching[end].append(chord)
        base = section.mesh.vertex_count
        existing, pinned = section.nodes.vertex.tolist(), section.nodes.pinned.tolist()
        swells, bulges = section.chord_swells.tolist(), section.chord_bulges.tolist()
        plus, minus, tip = [0] * count, [0] * count, [0] * section.chord_count
        middle = {}
        total = np.zeros(count + 1, dtype=np.int64)
        created = base
        for place, node in enumerate(np.argsort(section.nodes.rank).tolist()):
            arriving = [chord for chord in touching[node] if first[chord] != node]
            leaving = [chord for chord in touching[node] if first[chord] == node]
            swelling = [chord for chord in leaving if swells[chord]] + [chord for chord in arriving if bulges[chord]]
            own = 2 if existing[node] < 0 and not pinned[node] else 1
            ids = [tip[chord] for chord in arriving]
            missing = max(0, len(leaving) + own + 2 * len(swelling) - len(ids))
            ids += range(created, created + missing)
            created += missing
            for chord in leaving:
                tip[chord] = ids.pop(0)
            minus[node] = ids.pop(own - 1)
            plus[node] = existing[node] if existing[node] >= 0 else (minus[node] if pinned[node] else ids.pop(0))
            for chord in swelling:
                middle[chord] = (ids.pop(0), ids.pop(0))
            for left in ids:
                middle[next(c for c in arriving if section.chord_face[c] < 0 and c not in middle)] = (left, left)
            total[place + 1] = created - base
        self.plus = np.array(plus, dtype=np.int64)
        """Vertex on the positive side of each opened node, shape (node_count,)."""
        self.minus = np.array(minus, dtype=np.int64)
        """Vertex on the negative side of each opened node, shape (node_count,)."""
        self.tip = np.array(tip, dtype=np.int64)
        """Vertex at the tip in each half-opened chord, shape (chord_count,)."""
        self.created = total
        """Number of ids in use once the front has reached so many nodes, shape (node_count + 1,)."""
        self.middle_plus = np.full(section.chord_count, -1)
        """Vertex on the positive side between a chord's ends, -1 where there is none, shape (chord_count,)."""
        self.middle_minus = np.full(section.chord_count, -1)
        """Vertex on the negative side between a chord's ends, shape (chord_count,)."""
        for chord, (above, below) in middle.items():
            self.middle_plus[chord], self.middle_minus[chord] = above, below

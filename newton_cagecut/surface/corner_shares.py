# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Where corners of split triangles lie in the triangles that they were split from.

Attributes of corners differ across seams; so what a new corner gets follows from its own triangle alone. Section 6.3 of
the paper makes new points on edges and chords, where attributes are linear.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..section import Nodes, Opening

_NONE = -1


@dataclass(frozen=True, eq=False)
class CornerShares:
    """Which node, tip or middle each created vertex of an opened section is."""

    opening: Opening
    """The opened section."""
    node: np.ndarray
    """Node at which each created vertex stands, -1 for none, shape (created_count,)."""
    tip: np.ndarray
    """Chord at whose tip each stands, -1 for none, shape (created_count,)."""
    middle: np.ndarray
    """Chord halfway along whose opened part each stands, -1 for none, shape (created_count,)."""

    @classmethod
    def of(cls, opening: Opening) -> CornerShares:
        """Look them up.

        Args:
            opening: The opened section.
        """
        numbering, region = opening.vertices.numbering, opening.region
        first = opening.section.mesh.vertex_count
        node, tip, middle = (np.full(opening.vertices.count, _NONE) for _ in range(3))
        swept = np.flatnonzero(region.swept)
        opened = swept[opening.section.nodes.vertex[swept] < 0]
        node[numbering.plus[opened] - first] = opened
        node[numbering.minus[swept] - first] = swept
        tip[numbering.tip[opening.vertices.tip_chords] - first] = opening.vertices.tip_chords
        for ids in (numbering.middle_plus, numbering.middle_minus):
            middle[ids[region.middles] - first] = region.middles
        return cls(opening, node, tip, middle)

    def at(self, vertex: np.ndarray, corners: np.ndarray) -> np.ndarray:
        """Shares of a triangle's corners in a vertex, shape (count, 3).

        Args:
            vertex: Vertices on the triangles, old or created, shape (count,).
            corners: The vertices of the triangles before the opening, shape (count, 3).
        """
        shares = (vertex[:, None] == corners).astype(np.float64)
        created = vertex - self.opening.section.mesh.vertex_count
        for kind, find in ((self.node, self._at_nodes), (self.tip, self._at_tips), (self.middle, self._at_middles)):
            found = np.flatnonzero(created >= 0)
            found = found[kind[created[found]] >= 0]
            if len(found):
                shares[found] = find(kind[created[found]], corners[found])
        return shares

    def _at_nodes(self, node: np.ndarray, corners: np.ndarray) -> np.ndarray:
        nodes = self.opening.section.nodes
        return _node_shares(nodes, node if nodes.which is None else nodes.which[node], corners)

    def _at_tips(self, chord: np.ndarray, corners: np.ndarray) -> np.ndarray:
        section = self.opening.section
        low, high = section.chord_ends[chord].T
        s = section.nodes.coordinates[:, 1]
        t = ((self.opening.region.upper - s[low]) / (s[high] - s[low]))[:, None]
        return (1.0 - t) * self._at_nodes(low, corners) + t * self._at_nodes(high, corners)

    def _at_middles(self, chord: np.ndarray, corners: np.ndarray) -> np.ndarray:
        low, high = self.opening.section.chord_ends[chord].T
        end = self._at_nodes(high, corners)
        shut = np.flatnonzero(~self.opening.region.swept[high])
        end[shut] = self._at_tips(chord[shut], corners[shut])
        return 0.5 * (self._at_nodes(low, corners) + end)


def _node_shares(nodes: Nodes, number: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Shares of corners in nodes, which are numbered in the order of adding, shape (count, 3)."""
    shares = np.zeros((len(number), 3))
    base = len(nodes.above)
    plain = np.flatnonzero(number < base)
    f = nodes.fraction[number[plain]][:, None]
    above, below = (ids[number[plain]][:, None] == corners[plain] for ids in (nodes.above, nodes.below))
    shares[plain] = (1.0 - f) * above + f * below
    for one, other, share in nodes.between:
        mine = np.flatnonzero((number >= base) & (number < base + len(one)))
        if len(mine):
            row = number[mine] - base
            t = share.reshape(-1)[row][:, None]
            shares[mine] = (1.0 - t) * _node_shares(nodes, one[row], corners[mine])
            shares[mine] += t * _node_shares(nodes, other[row], corners[mine])
        base += len(one)
    return shares

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Sections clipped to the part of the plane that a knife of finite width sweeps.

Section 5.2 of the paper sweeps a whole line. A knife ends at its heel and its tip, and may begin inside the body. Where
its path ends inside a face or inside the body, the section gets a *pinned* node, which both sides of the cut share;
from one to the next the section runs along the window's border, through no face. Where it begins without touching a
face, its two sides share their whole border at first: a *hub* amidst each side is what they open at.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from .pairing import alternate
from .section import Section


class ClippedSection(Section):
    """A section less what lies beyond the window's borders."""

    def __init__(self, section: Section, heel: float, tip: float, start: float, tolerance: float):
        """Clip a section; borders too close to a node move outward.

        Args:
            section: The whole plane's section.
            heel: Least coordinate a [m].
            tip: Greatest coordinate a [m].
            start: Least coordinate s [m].
            tolerance: Distance that borders keep from nodes [m].
        """
        self.mesh, self.plane = section.mesh, section.plane
        self.arrive, self.leave = section.arrive, section.leave
        self.parted, self.parted_node, self.hinge_corner = section.parted, section.parted_node, section.hinge_corner
        self._ordinary_count = len(section.arrive)
        self._whole = section
        self.node_half_edge, self.node_vertex = section.node_half_edge, section.node_vertex
        self.node_position, self.node_coordinates = section.node_position, section.node_coordinates
        self.node_pinned = np.zeros(section.node_count, dtype=bool)
        self.chord_slot, self.chord_face, self.chord_node = section.chord_slot, section.chord_face, section.chord_node
        self._group, self._next, self._closed = section.chord_group, section.chord_next, section.chord_loop >= 0
        self._between: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
        borders = []
        for axis, sign, border in ((0, 1.0, heel), (0, -1.0, tip), (1, 1.0, start)):
            value = sign * self.node_coordinates[:, axis]
            limit = _clear(value, sign * border, tolerance)
            borders.append(sign * limit)
            if not (value > limit).all():
                self._clip(axis, sign, value - limit, borders[-1])
        self.window = tuple(borders)
        self._drop_unused()

    def _clip(self, axis: int, sign: float, inside: np.ndarray, border: float) -> None:
        """Keep what lies inside of a border; the nodes' distances from it are positive there."""
        ends = (inside > 0.0)[self.chord_node]
        crossing = np.flatnonzero(ends[:, 0] != ends[:, 1])
        first = self.node_count
        a, b = self.chord_node[crossing].T
        share = (inside[a] / (inside[a] - inside[b]))[:, None]
        position = self.node_position[a] + share * (self.node_position[b] - self.node_position[a])
        coordinates = self.node_coordinates[a] + share * (self.node_coordinates[b] - self.node_coordinates[a])
        coordinates[:, axis] = border
        self._between.append((a, b, share))
        self._add_pinned(position, coordinates)
        exits = ends[crossing, 0]
        nodes, following = self.chord_node.copy(), self._next.copy()
        pinned = first + np.arange(len(crossing))
        nodes[crossing, np.where(exits, 1, 0)] = pinned
        following[crossing[exits]] = -1
        pairs = self._pair(axis, sign, crossing, exits, coordinates)
        count = len(nodes)
        new = count + np.arange(len(pairs))
        out, back = pairs.T if len(pairs) else np.zeros((2, 0), dtype=np.int64)
        following[crossing[out]] = new
        self._next = np.concatenate([following, crossing[back]])
        self.chord_node = np.concatenate([nodes, np.stack([pinned[out], pinned[back]], axis=1)])
        self.chord_slot = np.concatenate([self.chord_slot, np.full((len(pairs), 2), -1)])
        self.chord_face = np.concatenate([self.chord_face, np.full(len(pairs), -1)])
        self._group = np.concatenate([self._group, self._group[crossing[out]]])
        self._closed = np.concatenate([self._closed, np.ones(len(pairs), dtype=bool)])
        self._keep_chords(np.concatenate([ends.any(axis=1), np.ones(len(pairs), dtype=bool)]))

    def _pair(
        self, axis: int, sign: float, crossing: np.ndarray, exits: np.ndarray, coordinates: np.ndarray
    ) -> np.ndarray:
        """Crossings from and to which the border runs through the body, shape (pair_count, 2)."""
        along = coordinates[:, 1 - axis]
        enters = exits == (sign * (1 - 2 * axis) < 0.0)
        closed = self._closed[crossing]
        pairs = []
        for group in np.unique(self._group[crossing[closed]]).tolist():
            mine = np.flatnonzero(closed & (self._group[crossing] == group))
            for one, other in alternate(along[mine], enters[mine]):
                low, high = mine[one], mine[other]
                pairs.append((low, high) if exits[low] else (high, low))
        return np.array(pairs, dtype=np.int64).reshape(-1, 2)

    def _add_pinned(self, position: np.ndarray, coordinates: np.ndarray) -> None:
        none = np.full(len(position), -1)
        self.node_half_edge = np.concatenate([self.node_half_edge, none])
        self.node_vertex = np.concatenate([self.node_vertex, none])
        self.node_position = np.concatenate([self.node_position, position])
        self.node_coordinates = np.concatenate([self.node_coordinates, coordinates])
        self.node_pinned = np.concatenate([self.node_pinned, np.ones(len(position), dtype=bool)])

    def _keep_chords(self, kept: np.ndarray) -> None:
        place = np.append(np.cumsum(kept) - 1, -1)
        place[:-1][~kept] = -1
        self._next = place[self._next[kept]]
        self.chord_node, self.chord_slot, self.chord_face = (
            array[kept] for array in (self.chord_node, self.chord_slot, self.chord_face)
        )
        self._group, self._closed = self._group[kept], self._closed[kept]

    def _drop_unused(self) -> None:
        """Forget the nodes outside, and find the half-edge of each pinned node in a face."""
        used = np.unique(self.chord_node)
        place = np.full(self.node_count, -1)
        place[used] = np.arange(len(used))
        half_edge = self.node_half_edge.copy()
        for end in (0, 1):
            pinned = (self.chord_face >= 0) & self.node_pinned[self.chord_node[:, end]]
            half_edge[self.chord_node[pinned, end]] = self.arrive[self.chord_slot[pinned, end]]
        self._used = used
        self.node_half_edge, self.node_vertex = half_edge[used], self.node_vertex[used]
        self.node_position, self.node_coordinates = self.node_position[used], self.node_coordinates[used]
        self.node_pinned = self.node_pinned[used]
        self.chord_node = place[self.chord_node]

    def node_values(self, values: np.ndarray) -> np.ndarray:
        """Values at the nodes from those at the vertices, shape (node_count, ...)."""
        at_nodes = self._whole.node_values(values)
        for a, b, share in self._between:
            at_nodes = np.concatenate([at_nodes, at_nodes[a] + share * (at_nodes[b] - at_nodes[a])])
        return at_nodes[self._used]

    @property
    def tipped(self) -> np.ndarray:
        """Whether a chord has a vertex where the front crosses it: all have, shape (chord_count,)."""
        return np.ones(self.chord_count, dtype=bool)

    @property
    def chord_next(self) -> np.ndarray:
        """Chord that continues each chord, -1 at an open edge, shape (chord_count,)."""
        return self._next

    @property
    def chord_group(self) -> np.ndarray:
        """Number of the solid whose section each chord bounds, shape (chord_count,)."""
        return self._group

    @cached_property
    def chord_hubs(self) -> np.ndarray:
        """Whether a chord runs along the start from border to border, with a hub beside it, shape (chord_count,)."""
        on_face = np.zeros(self.node_count, dtype=bool)
        on_face[self.chord_node[self.chord_face >= 0]] = True
        return ~on_face[self.chord_node].any(axis=1)

    @cached_property
    def chord_swells(self) -> np.ndarray:
        """Chords in a face that begin at a pinned node, whose slit gets a vertex on each side to open at."""
        low = self.chord_ends[:, 0]
        return (self.chord_face >= 0) & self.node_pinned[low]


def _clear(values: np.ndarray, border: float, tolerance: float) -> float:
    """The border moved outward, to lower values, until no value is within the tolerance of it."""
    for value in np.sort(values)[::-1].tolist():
        if border - tolerance < value < border + tolerance:
            border = value - tolerance
    return border

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Polygons, or in 2D segments, of a section between two fronts.

Section 5.2 of the paper needs the faces that a cut opens and the polygon that its latest step sweeps. Both are the part
of the section between two front lines, as loops of labels; loops around holes are bridged to the loop around them.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ..geometry import bridge_holes, contains_point, signed_area
from .pairing import alternate
from .section import Section

_FLAT = 1e-13


class SweptRegion:
    """The part of a section with ``lower < s <= upper``.

    Labels: node ``i`` is ``i``; where chord ``c`` crosses the upper front is ``node_count + c``; where it crosses the
    lower front is ``node_count + chord_count + c``; a vertex between its ends, or its hub, is
    ``node_count + 2 * chord_count + c``. A loop walks to a hub and back.
    """

    def __init__(self, section: Section, upper: float, lower: float = -np.inf, *, middles: np.ndarray | None = None):
        """Clip a section.

        Args:
            section: The section.
            upper: Coordinate s of the front [m].
            lower: Coordinate s of an earlier front [m].
            middles: Chords that may have a vertex between their ends; None for none.
        """
        self._section = section
        self.upper = upper
        """Coordinate s of the front [m]."""
        s = section.nodes.coordinates[:, 1]
        self.swept = s <= upper
        """Nodes that the upper front has reached, shape (node_count,)."""
        self._done = s <= lower
        self.reached = self.swept & ~self._done
        """Nodes between the fronts, shape (node_count,)."""
        crossing = self.swept[section.chord_node]
        self.upper_chords = np.flatnonzero(crossing[:, 0] != crossing[:, 1])
        """Chords that cross the upper front, shape (tip_count,)."""
        crossing = self._done[section.chord_node]
        self._lower_chords = np.flatnonzero(crossing[:, 0] != crossing[:, 1])
        nodes, chords = section.nodes.count, section.chord_count
        self.position = np.full((nodes + 3 * chords, section.plane.dimension), np.nan)
        """Position of each label in use, shape (label_count, dimension) [m]."""
        self.coordinates = np.full((nodes + 3 * chords, 2), np.nan)
        """Coordinates (a, s) of each label in use, shape (label_count, 2) [m]."""
        self.position[:nodes] = section.nodes.position
        self.coordinates[:nodes] = section.nodes.coordinates
        for front, shift, which in ((upper, nodes, self.upper_chords), (lower, nodes + chords, self._lower_chords)):
            if len(which):
                self.position[shift + which], self.coordinates[shift + which] = section.chord_points(front, which)
        self.middles = self._place_middles(np.zeros(0, dtype=np.int64) if middles is None else middles)
        """Chords that have a vertex between their ends or a hub, shape (middle_count,)."""
        self.middle_labels = nodes + 2 * chords + self.middles
        """Labels of those, shape (middle_count,)."""

    @property
    def labels(self) -> np.ndarray:
        """Labels behind and on the upper front: nodes, crossings of chords, vertices between, shape (count,)."""
        nodes = np.flatnonzero(self.swept)
        return np.concatenate([nodes, self._section.nodes.count + self.upper_chords, self.middle_labels])

    def _place_middles(self, chords: np.ndarray) -> np.ndarray:
        """Put vertices halfway along what is open of chords: of slits from their begin on, of borders at their end."""
        section, nodes, count = self._section, self._section.nodes.count, self._section.chord_count
        low, high = section.chord_ends[chords].T
        chords = chords[np.where(section.chord_swells[chords], self.swept[low], self.swept[high])]
        low, high = section.chord_ends[chords].T
        end = np.where(self.swept[high], high, nodes + chords)
        for values in (self.position, self.coordinates):
            values[nodes + 2 * count + chords] = 0.5 * (values[low] + values[end])
        self._move_hubs(chords[section.chord_hubs[chords]])
        return chords

    def _move_hubs(self, chords: np.ndarray) -> None:
        """Move hubs off the border, halfway to the next node or to the front, so that nothing is in between."""
        section, shift = self._section, self._section.nodes.count + 2 * self._section.chord_count
        s = section.nodes.coordinates[:, 1]
        for chord in chords.tolist():
            border = s[section.chord_node[chord, 0]]
            step = 0.5 * (min(self.upper, s[s > border].min(initial=np.inf)) - border)
            self.position[shift + chord] += step * section.plane.direction
            self.coordinates[shift + chord, 1] += step

    @cached_property
    def polygons(self) -> list[list[int]]:
        """The region as polygons without holes, counterclockwise about the plane's normal, as loops of labels.

        In 2D they are segments, which have the normal on their right.
        """
        if self._section.plane.dimension == 2:
            return self._segments()
        outer, holes = [], []
        for loop, group in self._boundary_loops():
            if len(loop) < 3:
                continue
            area = signed_area(self.coordinates[loop])
            flat = _FLAT * float(np.ptp(self.coordinates[loop], axis=0).max()) ** 2
            (outer if area > flat else holes).append((loop, group, abs(area)))
        inside: list[list[list[int]]] = [[] for _ in outer]
        for loop, group, _ in holes:
            owner = self._owner(loop, group, outer)
            if owner is None:
                outer.append((loop, group, 0.0))
                inside.append([])
            else:
                inside[owner].append(loop)
        return [bridge_holes(loop, inside[i], self.coordinates) for i, (loop, _, _) in enumerate(outer)]

    def _segments(self) -> list[list[int]]:
        """What of each chord lies between the fronts, from its far to its near end."""
        section = self._section
        low, high = section.chord_node.T
        chord = np.flatnonzero(self.swept[low] & ~self._done[high])
        low, high = low[chord], high[chord]
        near = np.where(self._done[low], section.nodes.count + section.chord_count + chord, low)
        far = np.where(self.swept[high], high, section.nodes.count + chord)
        return np.stack([far, near], axis=1).tolist()

    def _owner(self, hole: list[int], group: int, outer: list[tuple[list[int], int, float]]) -> int | None:
        """Number of the smallest outer loop of the group that contains a hole."""
        point = self.coordinates[hole[0]]
        around = [
            (area, i)
            for i, (loop, other, area) in enumerate(outer)
            if other == group and contains_point(self.coordinates[loop], point)
        ]
        return min(around)[1] if around else None

    def _boundary_loops(self) -> list[tuple[list[int], int]]:
        """Loops of labels around the region, each with its group."""
        section = self._section
        start, end = section.chord_node.T
        active = ~(self._done[start] & self._done[end]) & (self.swept[start] | self.swept[end])
        active &= section.chord_loop >= 0
        top = self._front_jumps(section.nodes.count, self.upper_chords, self.swept)
        bottom = self._front_jumps(section.nodes.count + section.chord_count, self._lower_chords, self._done)
        state = np.where(self.reached, 0, np.where(self._done, -1, 1)).tolist()
        todo = active.tolist()
        middles, middle_shift = set(self.middles.tolist()), section.nodes.count + 2 * section.chord_count
        hubs = set(np.flatnonzero(section.chord_hubs).tolist())
        start, end, following = start.tolist(), end.tolist(), section.chord_next.tolist()
        shift = {1: section.nodes.count, -1: section.nodes.count + section.chord_count}
        loops = []
        for first in np.flatnonzero(active).tolist():
            chord, loop = first, []
            while todo[chord]:
                todo[chord] = False
                side = state[start[chord]]
                loop.append(shift[side] + chord if side else start[chord])
                if chord in middles:
                    loop += [middle_shift + chord, loop[-1]] if chord in hubs else [middle_shift + chord]
                side = state[end[chord]]
                if side:
                    loop.append(shift[side] + chord)
                    chord = top[chord] if side > 0 else bottom[chord]
                else:
                    chord = following[chord]
            if loop:
                loops.append((loop, int(section.chord_group[first])))
        return loops

    def _front_jumps(self, shift: int, chords: np.ndarray, reached: np.ndarray) -> dict[int, int]:
        """For each chord that leaves the region through a front, the chord by which the loop comes back."""
        section = self._section
        chords = chords[section.chord_loop[chords] >= 0]
        downward = reached[section.chord_node[chords, 1]]
        jumps: dict[int, int] = {}
        for group in np.unique(section.chord_group[chords]).tolist():
            mine = section.chord_group[chords] == group
            along, enters, names = self.coordinates[shift + chords[mine], 0], downward[mine], chords[mine].tolist()
            for entry, leave in alternate(along, enters):
                low, high = names[entry], names[leave]
                jumps[high], jumps[low] = low, high
        return jumps

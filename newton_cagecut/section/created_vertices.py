# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Vertices that an opened section creates: two at each opened node, one at each tip, some beside chords.

Section 5.2 of the paper creates and displaces them step by step; here they follow from the front alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .numbering import Numbering
from .section import Section
from .swept_region import SweptRegion


@dataclass(frozen=True, eq=False)
class CreatedVertices:
    """The vertices beyond the mesh's own, in the order of their ids."""

    section: Section
    """The section."""
    numbering: Numbering
    """Its vertex ids."""
    region: SweptRegion
    """What of it is open."""

    @cached_property
    def count(self) -> int:
        """Number of created vertices."""
        return int(self.numbering.created[np.count_nonzero(self.region.swept)])

    @property
    def tip_chords(self) -> np.ndarray:
        """Chords that end in a tip, shape (tip_count,)."""
        return self.region.upper_chords

    def values(self, at_nodes: np.ndarray, at_tips: np.ndarray) -> np.ndarray:
        """Values of the created vertices from those at nodes and at tips, halfway between them in the middle of chords.

        Args:
            at_nodes: Values at all nodes, shape (node_count, ...).
            at_tips: Values at the tips, shape (tip_count, ...).

        Returns:
            Values in the order of their ids, shape (count, ...).
        """
        section, numbering = self.section, self.numbering
        first, swept = section.mesh.vertex_count, self.region.swept
        values = np.zeros((self.count, *at_nodes.shape[1:]), dtype=at_nodes.dtype)
        opened = swept & (section.nodes.vertex < 0)
        values[numbering.plus[opened] - first] = at_nodes[opened]
        values[numbering.minus[swept] - first] = at_nodes[swept]
        values[numbering.tip[self.tip_chords] - first] = at_tips
        middles = self.region.middles
        if len(middles):
            low, high = section.chord_ends[middles].T
            end = np.where(swept[high], numbering.plus[high], numbering.tip[middles]) - first
            halfway = (0.5 * (values[numbering.plus[low] - first] + values[end])).astype(values.dtype)
            values[numbering.middle_plus[middles] - first] = halfway
            values[numbering.middle_minus[middles] - first] = halfway
        return values

    @cached_property
    def positions(self) -> np.ndarray:
        """Their positions, shape (count, dimension) [m]."""
        section, numbering, region = self.section, self.numbering, self.region
        tips = region.position[section.nodes.count + self.tip_chords]
        positions = self.values(section.nodes.position, tips)
        for ids in (numbering.middle_plus[region.middles], numbering.middle_minus[region.middles]):
            positions[ids - section.mesh.vertex_count] = region.position[region.middle_labels]
        return positions

    def positions_of(self, vertices: np.ndarray | list[int]) -> np.ndarray:
        """Positions of vertices, old or created, shape (..., dimension) [m].

        Args:
            vertices: Vertices, of any shape.
        """
        old, ids = self.section.mesh.vertices, np.asarray(vertices)
        positions = np.empty((*ids.shape, old.shape[1]))
        below = ids < len(old)
        positions[below] = old[ids[below]]
        positions[~below] = self.positions[ids[~below] - len(old)]
        return positions

    @cached_property
    def sides(self) -> tuple[np.ndarray, np.ndarray]:
        """Vertices of the region's labels on the negative and on the positive side, shapes (label_count,)."""
        numbering = self.numbering
        return (
            np.concatenate([numbering.minus, numbering.tip, numbering.tip, numbering.middle_minus]),
            np.concatenate([numbering.plus, numbering.tip, numbering.tip, numbering.middle_plus]),
        )

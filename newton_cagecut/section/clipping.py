# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Sections clipped to the part of the plane that a knife of finite width sweeps.

Section 5.2 of the paper sweeps a whole line. A knife ends at its heel and its tip, and may begin inside the body. Where
its path ends inside a face or inside the body, the section gets a *pinned* node, which both sides of the cut share;
from one to the next the section runs along the window's border, through no face. Where it begins without touching a
face, its two sides share their whole border at first: a *hub* amidst each side is what they open at.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .nodes import Nodes
from .pairing import alternate
from .section import Section


@dataclass(frozen=True, eq=False)
class _Chords:
    """Chords as borders leave them, row by row."""

    node: np.ndarray
    slot: np.ndarray
    face: np.ndarray
    next: np.ndarray
    group: np.ndarray
    closed: np.ndarray
    """Whether each belongs to a closed loop."""

    def only(self, kept: np.ndarray) -> _Chords:
        """Some of them, as a mask, renumbered."""
        place = np.append(np.cumsum(kept) - 1, -1)
        place[:-1][~kept] = -1
        rows = {name: values[kept] for name, values in vars(self).items()}
        return _Chords(**{**rows, "next": place[rows["next"]]})


def clipped(section: Section, window: tuple[float, float, float], tolerance: float) -> Section:
    """A section less what lies beyond a window's borders; borders too close to a node move outward.

    Args:
        section: The whole plane's section.
        window: Heel and tip, which bound coordinate a, and start, which bounds s from below [m].
        tolerance: Distance that borders keep from nodes [m].
    """
    nodes, borders = section.nodes, []
    chords = _Chords(
        section.chord_node,
        section.chord_slot,
        section.chord_face,
        section.chord_next,
        section.chord_group,
        section.chord_loop >= 0,
    )
    for (axis, sign), border in zip(((0, 1.0), (0, -1.0), (1, 1.0)), window, strict=True):
        value = sign * nodes.coordinates[:, axis]
        limit = _clear(value, sign * border, tolerance)
        borders.append(sign * limit)
        if not (value > limit).all():
            nodes, chords = _clip(nodes, chords, axis, sign, value - limit, borders[-1])
    used = np.unique(chords.node)
    place = np.full(nodes.count, -1)
    place[used] = np.arange(len(used))
    half_edge = nodes.half_edge.copy()
    for end in (0, 1):
        pinned = (chords.face >= 0) & nodes.pinned[chords.node[:, end]]
        half_edge[chords.node[pinned, end]] = section.arrive[chords.slot[pinned, end]]
    return replace(
        section,
        nodes=replace(nodes, half_edge=half_edge).only(used),
        chord_slot=chords.slot,
        chord_face=chords.face,
        chord_node=place[chords.node],
        chord_next=chords.next,
        chord_group=chords.group,
        window=tuple(borders),
    )


def _clip(
    nodes: Nodes, chords: _Chords, axis: int, sign: float, inside: np.ndarray, border: float
) -> tuple[Nodes, _Chords]:
    """Keep what lies inside of a border; the nodes' distances from it are positive there."""
    ends = (inside > 0.0)[chords.node]
    crossing = np.flatnonzero(ends[:, 0] != ends[:, 1])
    a, b = chords.node[crossing].T
    pinned = nodes.count + np.arange(len(crossing))
    nodes = nodes.with_pinned(a, b, inside[a] / (inside[a] - inside[b]), axis, border)
    exits = ends[crossing, 0]
    node, following = chords.node.copy(), chords.next.copy()
    node[crossing, np.where(exits, 1, 0)] = pinned
    following[crossing[exits]] = -1
    out, back = _pair(axis, sign, crossing, exits, nodes.coordinates[pinned, 1 - axis], chords)
    count = len(out)
    following[crossing[out]] = len(node) + np.arange(count)
    joined = _Chords(
        np.concatenate([node, np.stack([pinned[out], pinned[back]], axis=1)]),
        np.concatenate([chords.slot, np.full((count, 2), -1)]),
        np.concatenate([chords.face, np.full(count, -1)]),
        np.concatenate([following, crossing[back]]),
        np.concatenate([chords.group, chords.group[crossing[out]]]),
        np.concatenate([chords.closed, np.ones(count, dtype=bool)]),
    )
    return nodes, joined.only(np.concatenate([ends.any(axis=1), np.ones(count, dtype=bool)]))


def _pair(
    axis: int, sign: float, crossing: np.ndarray, exits: np.ndarray, along: np.ndarray, chords: _Chords
) -> np.ndarray:
    """Crossings from and to which the border runs through the body, shape (2, pair_count)."""
    enters = exits == (sign * (1 - 2 * axis) < 0.0)
    closed, group = chords.closed[crossing], chords.group[crossing]
    pairs = []
    for number in np.unique(group[closed]).tolist():
        mine = np.flatnonzero(closed & (group == number))
        for one, other in alternate(along[mine], enters[mine]):
            low, high = mine[one], mine[other]
            pairs.append((low, high) if exits[low] else (high, low))
    return np.array(pairs, dtype=np.int64).reshape(-1, 2).T


def _clear(values: np.ndarray, border: float, tolerance: float) -> float:
    """The border moved outward, to lower values, until no value is within the tolerance of it."""
    for value in np.sort(values)[::-1].tolist():
        if border - tolerance < value < border + tolerance:
            border = value - tolerance
    return border

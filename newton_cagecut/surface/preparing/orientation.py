# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""One orientation for triangles that hang together, whatever a file says of some of them.

The paper's cuts (section 6.3) tell inside from outside by the order of a triangle's points. Each triangle stands for
two nodes of a graph, as it is and turned; edges that run alike in both triangles join unlike nodes. What is in one part
with its own turned self, as on a Moebius strip, has no orientation, and is torn along some edges.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, connected_components


def connected_parts(count: int, one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Number of the connected part of each node, shape (count,).

    Args:
        count: Number of nodes.
        one: A node of each edge, shape (edge_count,).
        other: The other node of each, shape (edge_count,).
    """
    graph = coo_array((np.ones(len(one), dtype=bool), (one, other)), shape=(count, count))
    return connected_components(graph, directed=False)[1]


def find_turned(count: int, one: np.ndarray, other: np.ndarray, alike: np.ndarray) -> np.ndarray:
    """Triangles to turn, the fewer of each connected part, as a mask, shape (count,).

    Args:
        count: Number of triangles.
        one: A triangle of each edge, shape (edge_count,).
        other: The other triangle of each, shape (edge_count,).
        alike: Whether the edge runs alike in both, shape (edge_count,).
    """
    if not alike.any():
        return np.zeros(count, dtype=bool)
    forth, back = np.where(alike, other + count, other), np.where(alike, other, other + count)
    label = connected_parts(2 * count, np.concatenate([one, one + count]), np.concatenate([forth, back]))
    part = connected_parts(count, one, other)
    first = np.unique(part, return_index=True)[1]
    turned = label[:count] != label[first][part]
    one_sided = label[first] == label[first + count]
    if one_sided.any():
        _follow_trees(turned, first[one_sided], one, other, alike)
    size, minority = np.bincount(part), np.bincount(part, weights=turned)
    return turned ^ (2.0 * minority > size)[part]


def _follow_trees(turned: np.ndarray, roots: np.ndarray, one: np.ndarray, other: np.ndarray, alike: np.ndarray) -> None:
    """Turn triangles by the edges of trees from some roots on; the other edges of their parts may stay alike."""
    graph = coo_array((1.0 + alike, (one, other)), shape=(len(turned), len(turned))).tocsr()
    graph = graph.maximum(graph.T)
    for root in roots.tolist():
        order, before = breadth_first_order(graph, root, directed=False)
        turned[root] = False
        for triangle in order[1:].tolist():
            turned[triangle] = turned[before[triangle]] ^ (graph[before[triangle], triangle] > 1.5)

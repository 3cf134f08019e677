# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The rows on which the energy is taken: corrected gradients of the points, and their means in clusters."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .clusters import cluster_points
from .fields import ClusterFields, cluster_fields
from .gradients import CorrectedGradients, corrected_gradients


class StrainRows(NamedTuple):
    """Rows of the points, then of the clusters; those not in use are zero."""

    gradients: np.ndarray
    """Gradients, shape (row_count, n, 3) [1/m]."""
    volumes: np.ndarray
    """Volumes, shape (row_count,) [m^3]."""
    anchors: np.ndarray
    """The vertex of greatest mean weight, of the clusters, shape (row_count - point_count,)."""
    clusters: np.ndarray
    """The cluster that a row is of, counted from 0, shape (row_count,)."""
    fields: list[ClusterFields | None]
    """Displacements of the clusters in use."""


def strain_rows(
    vertices: np.ndarray,
    weights: np.ndarray,
    gradients: np.ndarray,
    volumes: np.ndarray,
    piece: np.ndarray,
    row_count: int,
) -> StrainRows:
    """Rows of a body.

    Args:
        vertices: Rest positions of the cage's vertices, shape (n, dimension) [m].
        weights: Weights at the quadrature points, shape (q, n).
        gradients: Gradients of the weights, shape (q, n, 3) [1/m].
        volumes: Volumes of the points, shape (q,) [m^3]; points without one are left alone.
        piece: The piece of each vertex, shape (n,).
        row_count: Number of rows: of points, and room for clusters.
    """
    dimension, count = vertices.shape[1], len(volumes)
    used = np.flatnonzero(volumes > 0.0)
    weights, volumes = weights[used].astype(float), volumes[used].astype(float)
    points = weights @ vertices
    result = np.zeros((row_count, *gradients.shape[1:]))
    result[:count] = gradients
    corrected = corrected_gradients(vertices, points, weights, gradients[used, :, :dimension].astype(float))
    result[used, :, :dimension] = corrected.gradients
    room = row_count - count
    cluster = cluster_points(vertices, points, weights, volumes, piece[weights.argmax(axis=1)], room)
    shares = np.zeros((room, len(used)))
    shares[cluster, np.arange(len(used))] = volumes
    totals = shares.sum(axis=1)
    shares /= np.where(totals > 0.0, totals, 1.0)[:, None]
    result[count:, :, :dimension] = np.einsum("cq,qjk->cjk", shares, corrected.gradients, optimize=True)
    all_volumes, clusters = np.zeros(row_count), np.zeros(row_count, dtype=int)
    all_volumes[used], all_volumes[count:] = volumes, totals
    clusters[used], clusters[count:] = cluster, np.arange(room)
    fields = [_fields(share, points, corrected) for share in shares[totals > 0.0]]
    return StrainRows(result, all_volumes, (shares @ weights).argmax(axis=1), clusters, fields)


def _fields(share: np.ndarray, points: np.ndarray, corrected: CorrectedGradients) -> ClusterFields | None:
    """Displacements of a cluster, by the shares of its points."""
    own = np.flatnonzero(share)
    share, offset = share[own], points[own] - share[own] @ points[own]
    seen, squares = (np.einsum("q,qkl->kl", share, part[own]) for part in (corrected.seen, corrected.squares))
    return cluster_fields(np.einsum("q,qa,qb->ab", share, offset, offset), seen, squares)

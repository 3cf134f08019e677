# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A point and a site for each sheet that meets there, so that cuts (paper, section 6.3) open each on its own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Parting:
    """Points and sites of sheets; those before keep their numbers, and further ones follow."""

    triangles: np.ndarray
    """Points of the triangles' corners, shape (triangle_count, 3)."""
    point_site: np.ndarray
    """Site of each point, shape (point_count,)."""
    point: np.ndarray
    """The point before that each point was, shape (point_count,)."""
    site: np.ndarray
    """The site before that each site was, shape (site_count,)."""

    @classmethod
    def of(cls, triangles: np.ndarray, point_site: np.ndarray, site_count: int, fan: np.ndarray) -> Parting:
        """Give each fan of corners around a site a site of its own.

        Args:
            triangles: Points of the triangles' corners, shape (triangle_count, 3).
            point_site: Site of each point, shape (point_count,).
            site_count: Number of sites.
            fan: Number of the fan that each corner is of, shape (triangle_count, 3).
        """
        point, fan = triangles.reshape(-1).astype(np.int64), fan.reshape(-1)
        site = point_site[point]
        fans, first = np.unique(fan, return_index=True)
        fans, first = fans[np.argsort(first)], np.sort(first)
        of_fan = site[first]
        keeps = np.zeros(len(fans), dtype=bool)
        keeps[np.unique(of_fan, return_index=True)[1]] = True
        new_site = np.zeros(int(fan.max(initial=-1)) + 1, dtype=np.int64)
        new_site[fans] = np.where(keeps, of_fan, site_count + np.cumsum(~keeps) - 1)
        sites = np.concatenate([np.arange(site_count), of_fan[~keeps]])
        cells, number = np.unique(np.stack([new_site[fan], point], axis=1), axis=0, return_inverse=True)
        keeps = np.zeros(len(cells), dtype=bool)
        keeps[np.unique(cells[:, 1], return_index=True)[1]] = True
        place = np.where(keeps, cells[:, 1], len(point_site) + np.cumsum(~keeps) - 1)
        point_site = np.concatenate([point_site, cells[~keeps, 0]])
        point_site[cells[keeps, 1]] = cells[keeps, 0]
        points = np.concatenate([np.arange(len(point_site) - np.count_nonzero(~keeps)), cells[~keeps, 1]])
        return cls(place[number.reshape(-1)].reshape(-1, 3).astype(triangles.dtype), point_site, points, sites)

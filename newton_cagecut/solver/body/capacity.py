# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The room that a body reserves for cuts, and how much of it a cut takes.

A complete cut makes two vertices or points for each edge that it crosses, one a side; the triangles that it crosses
fall into three, and its caps have about as many triangles as points. So what a cut takes follows from how many edges a
plane crosses, which is counted on planes through all of the body.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ...cage import Cage
from ...geometry import as_flag, as_index, as_instance
from ...surface import Surface

MOST = 1 << 24
"""Most of each that there can be room for."""

_CUTS = 12
_MOST_CUTS = 1000
_PLANES = 48
_SHARE = 0.75
"""Share of planes that cross no more edges than a cut is taken to."""
_CROSSED_VERTICES = 1.2
_CROSSED_POINTS = 0.7
"""What each earlier cut adds to the next one's, of what that takes alone, if all go through one another (measured)."""
_SPARE = 16
_MORE = 0.5
"""Share of the present size that a suggested room leaves beyond what is needed."""


@dataclass(frozen=True, kw_only=True)
class Capacity:
    """Room that a body reserves for cuts. Arrays never grow afterwards, so captured CUDA graphs stay valid.

    Args:
        vertices: Vertices of the cage.
        surface_points: Points of the embedded surface, those along seams counting as one.
        surface_triangles: Triangles of the embedded surface, caps included.

    Raises:
        TypeError: One is not a whole number.
        ValueError: One is out of its range.
    """

    vertices: int
    surface_points: int
    surface_triangles: int

    def __post_init__(self) -> None:
        for field in fields(self):
            value = as_index(getattr(self, field.name), f"Capacity {field.name}", limits=(1, MOST))
            object.__setattr__(self, field.name, value)

    @classmethod
    def for_cuts(cls, cage: Cage, surface: Surface, *, cuts: int = _CUTS, crossing: bool = False) -> Capacity:
        """Room for a number of complete cuts, each as long as three in four planes through the body would make it.

        Args:
            cage: The cage, as the body starts with it.
            surface: The surface.
            cuts: Number of cuts.
            crossing: Whether all of them go through one another, in all of the body; a dozen take five to eight
                times the room then.

        Raises:
            TypeError: An argument has the wrong type.
            ValueError: The number of cuts is out of its range.
        """
        cage, surface = _checked(cage, surface)
        cuts = as_index(cuts, "cuts, the number of cuts,", limits=(0, _MOST_CUTS))
        earlier = 0.5 * (cuts - 1) * as_flag(crossing, "crossing")
        vertices, points = (cuts * count for count in _taken_by_a_cut(cage, surface))
        points = int(points * (1.0 + _CROSSED_POINTS * earlier))
        spare = _SPARE if cuts else 0
        return cls(
            vertices=cage.vertex_count + int(vertices * (1.0 + _CROSSED_VERTICES * earlier)) + spare,
            surface_points=surface.site_count + points + spare,
            surface_triangles=surface.triangle_count + 2 * points + 2 * spare,
        )

    @classmethod
    def without_cuts(cls, cage: Cage, surface: Surface) -> Capacity:
        """No room to spare.

        Args:
            cage: The cage.
            surface: The surface.
        """
        return cls.for_cuts(cage, surface, cuts=0)

    def require(self, cage: Cage, surface: Surface) -> None:
        """Refuse a cage and a surface that do not fit.

        Args:
            cage: The cage.
            surface: The surface.

        Raises:
            TypeError: An argument has the wrong type.
            ValueError: Something does not fit; the message has the argument of ``add_cage_body`` that makes room.
        """
        cage, surface = _checked(cage, surface)
        needed = {
            "vertices": cage.vertex_count,
            "surface_points": surface.site_count,
            "surface_triangles": surface.triangle_count,
        }
        for name, count in needed.items():
            room = getattr(self, name)
            if count > room:
                more = {key: max(getattr(self, key), int((1.0 + _MORE) * size)) for key, size in needed.items()}
                words = ", ".join(f"{key}={size}" for key, size in more.items())
                raise ValueError(
                    f"{count} {name.replace('_', ' ')} are needed, room was reserved for {room}. It is reserved when a "
                    f"body is added: add_cage_body(..., capacity=cagecut.Capacity({words}))"
                )


def _checked(cage: Cage, surface: Surface) -> tuple[Cage, Surface]:
    return as_instance(cage, Cage, "cage"), as_instance(surface, Surface, "surface")


def _taken_by_a_cut(cage: Cage, surface: Surface) -> tuple[int, int]:
    """Vertices and points that a complete cut makes, where it is as long as three in four are."""
    draw = np.random.default_rng(0)
    corners, edges = surface.triangles, cage.mesh.edges if cage.dimension == 3 else cage.simplices
    crossed = np.zeros((_PLANES, 2))
    for number in range(_PLANES):
        normal, origin = draw.normal(size=surface.dimension), surface.points[draw.integers(surface.point_count)]
        above = ((surface.points - origin) @ normal > 0.0)[corners]
        ends = ((cage.vertices - origin[: cage.dimension]) @ normal[: cage.dimension] > 0.0)[edges]
        crossed[number] = (ends[:, 0] != ends[:, 1]).sum(), (above.any(axis=1) != above.all(axis=1)).sum()
    vertices, points = (int(np.ceil(2.0 * count)) for count in np.quantile(crossed, _SHARE, axis=0))
    return vertices, points

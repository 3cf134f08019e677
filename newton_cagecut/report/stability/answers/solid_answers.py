# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The answers of triquadratic finite elements, for bodies of which no book has one."""

from __future__ import annotations

from functools import cache

import numpy as np

from ....elastic import Material
from ..shapes import Blocks, bar, bracket
from .solid import Solid

ELEMENTS = "quadratic finite elements"
_NEAR = 1.0e-6


@cache
def torsion_energy(size: tuple[float, float, float], poisson: float, angle: float) -> float:
    """Elastic energy, over Young's modulus [m^3], of a bar whose ends are held and turned against each other.

    Args:
        size: Length, width and height [m].
        poisson: Poisson's ratio.
        angle: How far one end is turned [rad].
    """
    solid = Solid(bar(1, size), Material(young=1.0, poisson=poisson), min(size) / 3.0)

    def turned(places: np.ndarray) -> np.ndarray:
        share = angle * (places[0] > 0.5 * size[0])
        return np.stack([0.0 * share, -share * places[2], share * places[1]])

    def ends(places: np.ndarray) -> np.ndarray:
        return _all((places[0] < _NEAR) | (places[0] > size[0] - _NEAR))

    return solid.solve(ends, moved=turned).energy


@cache
def bar_deflection(size: tuple[float, float, float], poisson: float, axis: int) -> float:
    """How far the free end of a clamped bar goes under a force of 1 N across it, times Young's modulus [N/m].

    Args:
        size: Length, width and height [m].
        poisson: Poisson's ratio.
        axis: The force's axis, 1 or 2.
    """
    blocks = bar(1, size)
    found = Solid(blocks, Material(young=1.0, poisson=poisson), min(size) / 2.0).solve(
        lambda places: _all(places[0] < _NEAR),
        loaded=lambda middles: middles[0] > size[0] - _NEAR,
        traction=tuple(np.eye(3)[axis] / (size[1] * size[2])),
    )
    return found.mean(blocks.cage().vertices[-4:], axis)


@cache
def bracket_deflection(leg: float, thickness: float, poisson: float, axis: int) -> float:
    """How far the upper end of a clamped L goes under a force of 1 N, times Young's modulus [N/m].

    Args:
        leg: Length of a leg, its corner not counted [m].
        thickness: Width and height of a leg [m].
        poisson: Poisson's ratio.
        axis: The force's axis.
    """
    blocks = bracket(1, leg, thickness)
    top = blocks.axes[2][-1]
    found = Solid(blocks, Material(young=1.0, poisson=poisson), thickness / 3.0).solve(
        lambda places: _all(places[0] < _NEAR),
        loaded=lambda middles: middles[2] > top - _NEAR,
        traction=tuple(np.eye(3)[axis] / thickness**2),
    )
    vertices = blocks.cage().vertices
    return found.mean(vertices[vertices[:, 2] > top - _NEAR], axis)


@cache
def crack_opening(size: tuple[float, float, float], poisson: float) -> float:
    """How far a bar that is cut half through in its middle opens, over how far its ends are pulled apart.

    Args:
        size: Length, width and height [m].
        poisson: Poisson's ratio.
    """
    half = (0.5 * size[0], size[1], size[2])
    # Symmetric about the cut; elements get smaller towards its front, where stresses are infinite.
    apart = np.concatenate([[0.0], 0.5 ** np.arange(7.0, -1.0, -1.0)])
    axes = (half[0] * (1.0 - apart[::-1]), bar(1, half).axes[1], 0.5 * half[2] * np.append(-apart[:0:-1], apart))
    blocks = Blocks(axes, np.ones([len(axis) - 1 for axis in axes], dtype=bool))

    def held(places: np.ndarray) -> np.ndarray:
        end, joined = places[0] < _NEAR, (places[0] > half[0] - _NEAR) & (places[2] < _NEAR)
        return np.stack([end | joined, end, end])

    def moved(places: np.ndarray) -> np.ndarray:
        return np.stack([-0.5 * (places[0] < _NEAR), 0.0 * places[0], 0.0 * places[0]])

    found = Solid(blocks, Material(young=1.0, poisson=poisson), 0.5 * size[1]).solve(held, moved=moved)
    vertices = blocks.cage().vertices
    mouth = vertices[(vertices[:, 0] > half[0] - _NEAR) & (vertices[:, 2] > 0.5 * half[2] - _NEAR)]
    return -2.0 * found.mean(mouth, 0)


def _all(chosen: np.ndarray) -> np.ndarray:
    """A mask of nodes, for all three components."""
    return np.broadcast_to(chosen, (3, len(chosen)))

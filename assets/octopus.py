# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""An octopus and its cage: ``python -m assets.octopus`` writes octopus.usdc and octopus_cage.usda.

As many vertices and faces as OCTOPUS in Table 1 of the paper: a surface of 2784 vertices in a cage of 375 vertices and
407 planar faces. The paper's cage is an alpha wrap; this one is built of tubes that follow the arms. Metres, +Z up,
1.7 m across; it looks along -Y.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from assets.fields import ball, ellipsoid, union
from assets.implicit import mesh_field
from assets.planar_tube import planar_tube, tube_faces
from assets.prism import split_quads
from assets.write import write_asset

VERTEX_COUNT = 2784
ARM_COUNT = 8
LINK = 0.075  # length of a link of the cage's arms [m]
# Of each arm: links, sideways swing and its phase, height of the tip's curl [rad]
ARMS = (
    (10, 1.0, 0.0, 1.5),
    (10, -0.9, 0.35, 0.7),
    (10, 0.8, 0.95, 1.7),
    (10, 0.9, 0.25, 0.9),
    (10, -0.8, 0.3, 1.4),
    (10, 0.9, 0.9, 0.8),
    (11, -1.0, 0.15, 1.2),
    (10, -0.9, 1.05, 1.0),
)
_ROOT = 0.215  # distance of the arms' roots from the axis [m]
_LOW, _HIGH = -0.005, 0.165  # of the roots [m]
_MARGIN = 0.025  # of the cage around an arm [m]
# Rings of the mantle: its axis's place backward and up, its radius [m], its lean backward [rad]
_MANTLE = ((0.0, 0.24, 0.2, 0.0), (0.03, 0.36, 0.225, 0.15), (0.09, 0.5, 0.24, 0.3), (0.15, 0.61, 0.19, 0.42))
_MANTLE_END = (0.0, 0.19, 0.69)
_EYES = ((0.08, -0.13, 0.3), (-0.08, -0.13, 0.3))
_EYE_ENDS = ((0.12, -0.25, 0.3), (-0.12, -0.25, 0.3))  # of the cage over them


def arm_curve(number: int, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return points along an arm from its root [m] and unit vectors along and across it, shape ``(count, 3)`` each."""
    links, swing, phase, curl = ARMS[number]
    s = np.linspace(0.0, 1.0, count)
    turn = 2.0 * np.pi * (number + 0.5) / ARM_COUNT + swing * s * np.sin(2.0 * np.pi * (0.9 * s + phase))
    pitch = 0.3 * np.cos(np.pi * np.clip(2.0 * s, 0.0, 1.0)) - 0.02 + curl * np.clip(s - 0.45, 0.0, None) ** 2 / 0.3
    along = np.stack([np.cos(turn) * np.cos(pitch), np.sin(turn) * np.cos(pitch), np.sin(pitch)], axis=1)
    across = np.stack([-np.sin(turn), np.cos(turn), np.zeros(count)], axis=1)
    steps = 0.5 * (along[1:] + along[:-1]) * links * LINK / (count - 1)
    first = _ROOT * np.array([np.cos(turn[0]), np.sin(turn[0]), 0.0]) + (0.0, 0.0, 0.5 * (_LOW + _HIGH))
    return first + np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)]), along, across


def octopus_field(points: np.ndarray) -> np.ndarray:
    """Return a function that is negative inside the octopus and roughly the distance near its skin [m]."""
    distance, nearest = _arm_tree.query(points)
    arms = distance - _ARM_RADII[nearest]
    tilted = points @ _TILT
    mantle = ellipsoid(tilted, np.array([0.0, 0.07, 0.44]) @ _TILT, (0.175, 0.175, 0.225))
    head = ellipsoid(points, (0.0, 0.0, 0.2), (0.17, 0.165, 0.16))
    web = ellipsoid(points, (0.0, 0.0, 0.09), (0.205, 0.205, 0.065))
    body = union([mantle, head, web], 0.08)
    eyes = [ball(points, centre, 0.05) for centre in _EYES]
    return union([union([arms, body], 0.05), *eyes], 0.03)


def _arm_samples(count: int = 240) -> tuple[np.ndarray, np.ndarray]:
    """Return points close to one another along the arms' middles, and the arms' radii there [m]."""
    curves = [arm_curve(number, count)[0] for number in range(ARM_COUNT)]
    keep = slice(0, int(0.92 * count))  # the round tip ends short of the cage's
    share = np.linspace(0.0, 1.0, count)[keep]
    return np.concatenate([curve[keep] for curve in curves]), np.tile(_arm_radius(share), ARM_COUNT)


def _arm_radius(share: np.ndarray) -> np.ndarray:
    """Return the radius of an arm at a share of its length [m]."""
    return 0.056 - 0.026 * share


_ARM_POINTS, _ARM_RADII = _arm_samples()
_arm_tree = cKDTree(_ARM_POINTS)
_LEAN = 0.42  # of the mantle backward [rad]
_TILT = np.array([[1, 0, 0], [0, np.cos(_LEAN), np.sin(_LEAN)], [0, -np.sin(_LEAN), np.cos(_LEAN)]])


def octopus_mesh() -> tuple[np.ndarray, np.ndarray]:
    """Return the points ``(2784, 3)`` [m] and the outward triangles ``(5564, 3)`` of the octopus."""
    return mesh_field(
        octopus_field,
        (-0.9, -0.9, -0.05),
        (0.9, 0.9, 0.68),
        VERTEX_COUNT,
        seed=2,
        iterations=30,
        spacing=octopus_spacing,
    )


def octopus_spacing(points: np.ndarray) -> np.ndarray:
    """Return the relative spacing of the vertices: 1 at the eyes, more where the octopus is thicker."""
    distance, nearest = _arm_tree.query(points)
    eyes = np.min([0.35 * np.linalg.norm(points - centre, axis=1) for centre in _EYES], axis=0)
    return np.clip(np.minimum(distance, eyes), 0.02, 0.04) / 0.02


def octopus_cage() -> tuple[np.ndarray, list[tuple[int, ...]]]:
    """Return the vertices ``(375, 3)`` [m] and the 407 planar faces of the cage.

    An octagonal body, whose sides are the roots of the arms; on it the mantle, of octagonal rings and an end; a
    pyramid over each eye. The upper half of the mantle, the end of it and the arms' ends are of triangles.
    """
    corner = 2.0 * np.pi * np.arange(ARM_COUNT) / ARM_COUNT
    circle = np.stack([np.cos(corner), np.sin(corner), np.zeros(ARM_COUNT)], axis=1)
    size = _ROOT / np.cos(np.pi / ARM_COUNT)
    rings = [size * circle + (0.0, 0.0, z) for z in (_LOW, _HIGH)]
    rings += planar_tube(rings[1], [_mantle_ring(circle, *ring) for ring in _MANTLE])
    vertices = [*np.concatenate(rings), _MANTLE_END, *_EYE_ENDS]
    rows = np.arange(8 * len(rings)).reshape(-1, 8).tolist()
    end = 8 * len(rings)
    links = tube_faces(rows[1:])
    faces = [(0, 6, 4, 2), (0, 7, 6), (6, 5, 4), (4, 3, 2), (2, 1, 0)]
    faces += [*links[:13], *links[15:16], *_fan(links[13], end + 2), *_fan(links[14], end + 1)]
    faces += split_quads(links[16:]) + _fan(rows[-1], end)
    for arm in range(ARM_COUNT):
        root = [arm, (arm + 1) % ARM_COUNT, 8 + (arm + 1) % ARM_COUNT, 8 + arm]
        tube = planar_tube(np.array([vertices[v] for v in root]), _arm_rings(arm))
        rows = [root, *(len(vertices) + np.arange(4 * len(tube)).reshape(-1, 4)).tolist()]
        vertices += list(np.concatenate(tube))
        faces += tube_faces(rows) + split_quads([tuple(rows[-1])])
    return np.array(vertices), faces


def _mantle_ring(circle: np.ndarray, back: float, up: float, radius: float, lean: float) -> np.ndarray:
    """Return corners around the axis of the mantle, which leans backward there."""
    x, y, _ = radius * circle.T
    return np.stack([x, y * np.cos(lean) + back, up - y * np.sin(lean)], axis=1)


def _arm_rings(arm: int) -> list[np.ndarray]:
    """Return squares around an arm, one a link."""
    links = ARMS[arm][0]
    rings = []
    for place, along, across, share in zip(*arm_curve(arm, links + 1), np.linspace(0.0, 1.0, links + 1)):
        up = np.cross(along, across)
        half = _arm_radius(share) + _MARGIN
        rings.append(np.array([place + half * (i * across + j * up) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]))
    return rings[1:]


def _fan(face: tuple[int, ...] | list[int], end: int) -> list[tuple[int, ...]]:
    """Return the triangles between the edges of a face and a vertex over it."""
    return [(a, b, end) for a, b in zip(face, (*face[1:], face[0]))]


if __name__ == "__main__":
    write_asset("octopus", octopus_mesh(), octopus_cage())

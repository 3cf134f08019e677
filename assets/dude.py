# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A dude with a hat, and his cage: ``python -m assets.dude`` writes dude.usdc and dude_cage.usda.

As many vertices and faces as DUDE in Table 1 of the paper: a surface of 2314 vertices in a cage of 34 vertices and 35
planar faces. Metres, +Z up, 1 m tall; he looks along -Y.
"""

from __future__ import annotations

import numpy as np

from assets.fields import ball, cone, ellipsoid, slab, union
from assets.implicit import mesh_field
from assets.prism import prism_faces
from assets.write import write_asset

VERTEX_COUNT = 2314
HAT_HEIGHT = 0.743  # of the place where the hat sits on the head [m]
_CORNER_COUNT = 17

# Half of the outline, seen from the front: x, z [m]
CROTCH = (0.0, 0.14)
OUTLINE = {
    "instep": (0.03, -0.025),
    "foot": (0.215, -0.025),
    "armpit": (0.2, 0.36),
    "palm": (0.405, 0.215),
    "knuckles": (0.505, 0.39),
    "temple": (0.09, 0.735),
    "brim": (0.275, 0.81),
    "crown": (0.15, 0.985),
}
# How far the cage reaches to the front and to the back there [m]; the chest's plane tells at the armpit, the arm's at
# the palm
DEPTHS = {
    "crotch": (0.275, 0.22),
    "instep": (0.185, 0.11),
    "foot": (0.185, 0.11),
    "knuckles": (0.1, 0.09),
    "temple": (0.09, 0.09),
    "brim": (0.27, 0.27),
    "crown": (0.14, 0.14),
}


def dude_field(points: np.ndarray) -> np.ndarray:
    """Return a function that is negative inside the dude and roughly the distance near his skin [m]."""
    points = np.stack([np.abs(points[:, 0]), points[:, 1], points[:, 2]], axis=1)  # left as right
    leg = cone(points, (0.095, 0.0, 0.26), (0.115, 0.0, 0.07), 0.068, 0.056)
    foot = ellipsoid(points, (0.12, -0.045, 0.045), (0.064, 0.1, 0.045))
    arm = cone(points, (0.12, 0.0, 0.47), (0.36, -0.02, 0.355), 0.052, 0.044)
    thumb = cone(points, (0.36, -0.02, 0.37), (0.4, -0.045, 0.4), 0.026, 0.024)
    limbs = union([leg, foot, arm, ball(points, (0.385, -0.02, 0.345), 0.056), thumb], 0.04)
    torso = cone(points, (0.0, 0.0, 0.3), (0.0, 0.0, 0.45), 0.145, 0.115)
    head = ellipsoid(points, (0.0, 0.0, 0.62), (0.116, 0.098, 0.14))
    nose = ball(points, (0.0, -0.093, 0.595), 0.027)
    return union([union([union([limbs, torso, head], 0.05), hat_field(points)], 0.03), nose], 0.015)


def hat_field(points: np.ndarray) -> np.ndarray:
    """Return the distance to a hat whose brim is turned up all round and whose crown is dented [m]."""
    radius = np.hypot(points[:, 0], points[:, 1])
    brim = slab(np.hypot(points[:, 0], 1.25 * points[:, 1]), points[:, 2] - 0.775 - 0.9 * radius**2, 0.22, 0.02, 0.019)
    dent = 0.03 * np.exp(-((points[:, 0] / 0.04) ** 2) - (points[:, 1] / 0.1) ** 2)
    crown = slab(radius + 0.2 * (points[:, 2] - 0.86), points[:, 2] - 0.86 + 0.5 * dent, 0.112, 0.1, 0.035)
    return union([brim, crown], 0.03)


def dude_mesh() -> tuple[np.ndarray, np.ndarray]:
    """Return the points ``(2314, 3)`` [m] and the outward triangles ``(4624, 3)`` of the dude."""
    return mesh_field(dude_field, (-0.5, -0.26, -0.02), (0.5, 0.26, 1.0), VERTEX_COUNT, seed=4)


def dude_cage() -> tuple[np.ndarray, list[tuple[int, ...]]]:
    """Return the vertices ``(34, 3)`` [m] and the 35 planar faces of the cage.

    A prism over his outline, 17 corners: the crotch, then the right half upward and the left half downward.
    """
    half = np.array(list(OUTLINE.values()))
    outline = np.concatenate([[CROTCH], half, half[::-1] * [-1.0, 1.0]])
    depths = np.array([_depths(side) for side in (0, 1)])
    depths = np.concatenate([depths, depths[:, :0:-1]], axis=1)
    front, back = (
        np.stack([outline[:, 0], sign * depth, outline[:, 1]], axis=1) for sign, depth in zip((-1.0, 1.0), depths)
    )
    crotch, instep, foot, armpit, palm, knuckles, temple, brim, crown = range(9)
    right = [(crotch, instep, foot), (crotch, foot, armpit), (armpit, palm, knuckles, temple)]
    left = [tuple(-v % _CORNER_COUNT for v in reversed(piece)) for piece in right]
    middle = [(crotch, armpit, temple, -temple, -armpit), (temple, brim, -brim, -temple), (brim, crown, -crown, -brim)]
    pieces = right + left + [tuple(v % _CORNER_COUNT for v in piece) for piece in middle]
    return np.concatenate([front, back]), prism_faces(pieces, _CORNER_COUNT)


def _depths(side: int) -> np.ndarray:
    """Return the depth at the nine corners of the right half, at the front (0) or the back (1) [m]."""
    depth = {name: both[side] for name, both in DEPTHS.items()}
    chest = (depth["temple"] - depth["crotch"]) / (OUTLINE["temple"][1] - CROTCH[1])
    depth["armpit"] = depth["crotch"] + chest * (OUTLINE["armpit"][1] - CROTCH[1])
    corners = ["armpit", "knuckles", "temple"]
    plane = np.linalg.solve([[1.0, *OUTLINE[name]] for name in corners], [depth[name] for name in corners])
    depth["palm"] = float(plane @ [1.0, *OUTLINE["palm"]])
    return np.array([depth[name] for name in ("crotch", *OUTLINE)])


if __name__ == "__main__":
    write_asset("dude", dude_mesh(), dude_cage())

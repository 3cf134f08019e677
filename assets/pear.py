# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A pear: ``python -m assets.pear`` writes pear.obj, of quads and triangles, with a stalk. +Z up, in centimetres."""

from __future__ import annotations

from pathlib import Path

import numpy as np

RING_COUNT, RING_SIZE = 28, 32
STALK_LENGTH, STALK_RADIUS = 1.6, 0.25  # [cm]


def pear_profile(count: int) -> np.ndarray:
    """Return radii and heights from the pear's bottom to the end of its stalk [cm], shape (count, 2)."""
    s = np.linspace(0.0, 1.0, count - 4)
    turn = np.pi * s**0.9
    width = 3.9 - 1.9 * 0.5 * (1.0 + np.tanh(5.0 * (s - 0.58)))
    radius, height = width * np.sin(turn), 4.6 * (1.0 - np.cos(turn)) + 0.5 * np.exp(-((s / 0.12) ** 2))
    height -= 0.5 * np.exp(-(((1.0 - s) / 0.1) ** 2))
    body = np.stack([radius, height], axis=1)[1:-1]
    end = height[-1]
    stalk = [(STALK_RADIUS, end), (0.8 * STALK_RADIUS, end + 0.5 * STALK_LENGTH), (STALK_RADIUS, end + STALK_LENGTH)]
    return np.array([(0.0, height[0]), *body, *stalk, (0.0, end + STALK_LENGTH)])


def pear_mesh() -> tuple[np.ndarray, list[tuple[int, ...]]]:
    """Return the points [cm] and the outward faces of the pear."""
    profile = pear_profile(RING_COUNT)
    angle = 2.0 * np.pi * np.arange(RING_SIZE) / RING_SIZE
    rings = [np.column_stack([r * np.cos(angle), r * np.sin(angle), np.full(RING_SIZE, z)]) for r, z in profile[1:-1]]
    points = np.concatenate([[[0.0, 0.0, profile[0, 1]]], *rings, [[0.0, 0.0, profile[-1, 1]]]])
    points[:, 0] += 0.006 * np.maximum(points[:, 2] - 6.0, 0.0) ** 2  # it leans
    first = 1 + RING_SIZE * np.arange(len(rings))
    after = [(j, (j + 1) % RING_SIZE) for j in range(RING_SIZE)]
    faces = [(0, 1 + k, 1 + j) for j, k in after]
    faces += [(a + j, a + k, a + RING_SIZE + k, a + RING_SIZE + j) for a in first[:-1] for j, k in after]
    faces += [(len(points) - 1, first[-1] + j, first[-1] + k) for j, k in after]
    return points, faces


def main(folder: Path = Path(__file__).parent) -> None:
    """Write pear.obj.

    Args:
        folder: Where to.
    """
    points, faces = pear_mesh()
    lines = [f"v {x:.4f} {y:.4f} {z:.4f}" for x, y, z in points]
    lines += ["f " + " ".join(str(int(k) + 1) for k in face) for face in faces]
    (folder / "pear.obj").write_text("# A pear, in centimetres\n" + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()

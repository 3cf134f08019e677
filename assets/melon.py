# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Pictures of a melon's skin and flesh: ``python -m assets.melon`` writes melon_skin.png and melon_flesh.png."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

STRIPE_COUNT = 9
SEED_RINGS = ((0.52, 13), (0.68, 19))  # distance from the middle, in radii, and how many


def melon_skin(width: int = 512, height: int = 256) -> np.ndarray:
    """Return dark jagged stripes from pole to pole on light green, 8-bit sRGB."""
    u, v = np.meshgrid(np.arange(width) / width, np.arange(height) / height)
    wobble = 0.012 * np.sin(2 * np.pi * 9 * v + 3.0 * np.sin(2 * np.pi * 2 * u)) + 0.006 * np.sin(2 * np.pi * 23 * v)
    stripe = 0.5 + 0.5 * np.cos(2.0 * np.pi * STRIPE_COUNT * (u + wobble))
    share = np.clip((stripe - 0.45) * 3.0, 0.0, 1.0)[..., None]
    return _blend((150, 186, 84), (22, 74, 30), share)


def melon_flesh(size: int = 384) -> np.ndarray:
    """Return red flesh with seeds, a pale ring and a green rim at the edge of the unit disk, 8-bit sRGB."""
    x, y = np.meshgrid(*[2.0 * (np.arange(size) + 0.5) / size - 1.0] * 2)
    radius = np.hypot(x, y)[..., None]
    picture = _blend((240, 84, 72), (206, 30, 40), np.clip(radius / 0.8, 0.0, 1.0))
    for share, count in SEED_RINGS:
        for angle in 2.0 * np.pi * (np.arange(count) + 0.5 * share) / count:
            along, across = x * np.cos(angle) + y * np.sin(angle) - share, y * np.cos(angle) - x * np.sin(angle)
            picture[np.hypot(along / 0.05, across / 0.026) < 1.0] = (38, 20, 16)
    picture = _blend(picture, (236, 240, 196), np.clip((radius - 0.84) / 0.05, 0.0, 1.0))
    return _blend(picture, (70, 120, 50), np.clip((radius - 0.94) / 0.02, 0.0, 1.0))


def _blend(a: np.ndarray | tuple, b: tuple, share: np.ndarray) -> np.ndarray:
    return np.round(np.array(a) * (1.0 - share) + np.array(b) * share).astype(np.uint8)


def main(folder: Path = Path(__file__).parent) -> None:
    """Write both pictures.

    Args:
        folder: Where to.
    """
    Image.fromarray(melon_skin()).save(folder / "melon_skin.png", optimize=True)
    Image.fromarray(melon_flesh()).save(folder / "melon_flesh.png", optimize=True)


if __name__ == "__main__":
    main()

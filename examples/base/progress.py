# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Progress bars over what takes longer than a moment."""

from __future__ import annotations

from tqdm import tqdm


def frame_bar(frame_count: int) -> tqdm:
    """Return a bar over the frames of a scene that nobody watches.

    Args:
        frame_count: Frames of the scene.
    """
    return tqdm(total=frame_count, desc="frames ", unit="frame")

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Progress over what takes longer than a moment: bars, and words for who sees it for the first time."""

from __future__ import annotations

from tqdm import tqdm

DEMO_STEPS = 3


def say(number: int, text: str) -> None:
    """Say which step of a demo begins.

    Args:
        number: Number of the step.
        text: What happens in it.
    """
    print(f"{number} of {DEMO_STEPS}  {text}", flush=True)


def frame_bar(frame_count: int) -> tqdm:
    """Return a bar over the frames of a scene that nobody watches.

    Args:
        frame_count: Frames of the scene.
    """
    return tqdm(total=frame_count, desc="frames ", unit="frame")

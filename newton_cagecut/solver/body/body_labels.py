# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The names of a model's bodies, each its own: viewers, files and records tell bodies apart by them."""

from __future__ import annotations

from collections import Counter

import newton


def body_labels(model: newton.Model) -> list[str]:
    """The labels of the bodies' rows; those that worlds have in common start with the world, as in ``world_1/arm``.

    Args:
        model: The model.

    Raises:
        ValueError: Two bodies of one world have the same label.
    """
    labels, worlds = list(model.cagecut.body_label), model.particle_world.numpy()
    places = [int(worlds[start]) for start in model.cagecut.vertex_start.numpy()]
    counts = Counter(labels)
    found = [
        f"world_{world}/{label}" if counts[label] > 1 and world >= 0 else label
        for label, world in zip(labels, places, strict=True)
    ]
    twice = [label for label, count in Counter(found).items() if count > 1]
    if twice:
        raise ValueError(
            f"two cage bodies have the label {twice[0]!r}; viewers and files tell bodies apart by their labels: give "
            "add_cage_body a label=, or add_builder a label_prefix="
        )
    return found

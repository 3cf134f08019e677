# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The maps as a picture."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from .rows.starts import MODELS
from .sweep import Cell, Map
from .text import share, step_text

_LEAST_GAIN, _MOST_GAIN = 1.0e-4, 10.0


def draw(maps: Sequence[Map], path: Path) -> None:
    """Draw energy gain and angular momentum of each map.

    Args:
        maps: The maps.
        path: The file; its ending says the format.

    Raises:
        ImportError: matplotlib is not installed.
    """
    from matplotlib.colors import LogNorm, Normalize
    from matplotlib.figure import Figure

    kinds: list[tuple[str, Callable[[Cell], float | None], str, object]] = [
        ("highest energy above the start's", lambda cell: cell.outcome.energy_gain, "YlOrRd", LogNorm),
        ("angular momentum kept", lambda cell: cell.kept, "RdYlGn", Normalize),
    ]
    figure = Figure(figsize=(6.4 * len(maps), 4.6 * len(kinds)), layout="constrained")
    panels = figure.subplots(len(kinds), len(maps), squeeze=False)
    for row, (title, value, colors, scale) in zip(panels, kinds, strict=True):
        norm = scale(_LEAST_GAIN, _MOST_GAIN) if scale is LogNorm else scale(0.0, 1.0)
        for panel, found in zip(row, maps, strict=True):
            image = _draw_panel(panel, found, value, colors, norm)
            panel.set_title(f"{MODELS[found.model]}: {title}")
        figure.colorbar(image, ax=list(row), extend="both")
    figure.savefig(path, dpi=110)


def _draw_panel(panel: object, found: Map, value: Callable[[Cell], float | None], colors: str, norm: object) -> object:
    values = np.full((len(found.young), len(found.time_steps)), np.nan)
    for i, young in enumerate(found.young):
        for j, dt in enumerate(found.time_steps):
            number = value(found.cells[young, dt])
            values[i, j] = np.nan if number is None else number
            text = "n/a" if number is None else share(number)
            panel.text(j, i, text, ha="center", va="center", fontsize=7)
    shown = np.where(np.isfinite(values), np.clip(values, norm.vmin, norm.vmax), np.nan)
    panel.set_facecolor("0.6")
    image = panel.imshow(shown, cmap=colors, norm=norm, origin="lower", aspect="auto", alpha=0.6)
    panel.set_xticks(range(len(found.time_steps)), [step_text(dt) for dt in found.time_steps])
    panel.set_yticks(range(len(found.young)), [f"1e{round(math.log10(young))}" for young in found.young])
    panel.set_xlabel("time step [s]")
    panel.set_ylabel("Young's modulus [Pa]")
    return image

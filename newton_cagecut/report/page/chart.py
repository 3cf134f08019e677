# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Plots with logarithmic axes, as data, and their drawing with Matplotlib; the same data give the same bytes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_COLORS = ("#1b6ca8", "#d1603d", "#3a8a4d", "#7a4e9c", "#8a6d1f", "#4a4a4a", "#c04a86", "#2aa198")
_FIXED = {"svg.hashsalt": "newton_cagecut", "font.size": 9.0, "path.simplify": False}


@dataclass(frozen=True)
class Line:
    """A line of a plot.

    Attributes:
        label: Its name in the legend.
        x: Abscissae.
        y: Ordinates.
        like: Name of the line whose colour it has, and beside which it is drawn dashed and hollow; its own without.
        marker: Matplotlib's marker.
    """

    label: str
    x: Sequence[float]
    y: Sequence[float]
    like: str = ""
    marker: str = "o"


@dataclass(frozen=True)
class Panel:
    """One pair of axes.

    Attributes:
        title: Its heading.
        x_label: Name of the abscissa.
        y_label: Name of the ordinate.
        lines: What is drawn.
        floor: An ordinate below which nothing can be told apart; drawn as a grey band.
    """

    title: str
    x_label: str
    y_label: str
    lines: Sequence[Line]
    floor: float | None = None


@dataclass(frozen=True)
class Chart:
    """A picture of one or more panels.

    Attributes:
        name: Its file's name without ending.
        title: Its heading.
        panels: Rows of panels.
    """

    name: str
    title: str
    panels: Sequence[Sequence[Panel]]


def draw(chart: Chart, folder: Path) -> None:
    """Write a plot as ``NAME.png`` and ``NAME.svg``.

    Args:
        chart: The plot.
        folder: Where to.
    """
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context({**matplotlib.rcParamsDefault, **_FIXED, "backend": "agg"}):
        rows, columns = len(chart.panels), max(map(len, chart.panels))
        figure = Figure(figsize=(4.6 * columns, 3.4 * rows + 0.9), layout="constrained")
        axes = figure.subplots(rows, columns, squeeze=False)
        lines = [line for row in chart.panels for panel in row for line in panel.lines]
        labels = list(dict.fromkeys(line.like or line.label for line in lines))
        colors = {label: _COLORS[k % len(_COLORS)] for k, label in enumerate(labels)}
        for place, panel in zip(axes.ravel(), [panel for row in chart.panels for panel in row]):
            _draw_panel(place, panel, colors)
        figure.suptitle(chart.title)
        _add_legend(figure, axes)
        figure.savefig(folder / f"{chart.name}.png", dpi=120, metadata={"Software": None})
        figure.savefig(folder / f"{chart.name}.svg", metadata={"Date": None, "Creator": None})


def _draw_panel(axes: Axes, panel: Panel, colors: dict[str, str]) -> None:
    for line in panel.lines:
        color = colors[line.like or line.label]
        axes.loglog(
            line.x,
            line.y,
            f"{line.marker}{'--' if line.like else '-'}",
            color=color,
            markersize=4,
            markerfacecolor="white" if line.like else color,
            linewidth=1.2,
            label=line.label,
        )
    if panel.floor:
        axes.axhspan(0.0, panel.floor, color="0.85", zorder=0, label="error of the reference")
        values = [y for line in panel.lines for y in line.y]
        axes.set_ylim(0.5 * min([panel.floor, *values]), 2.0 * max([panel.floor, *values]))
    axes.xaxis.set_minor_formatter("")
    axes.yaxis.set_minor_formatter("")
    axes.set(title=panel.title, xlabel=panel.x_label, ylabel=panel.y_label)
    axes.grid(alpha=0.3, which="both", linewidth=0.5)


def _add_legend(figure: object, axes: object) -> None:
    """One legend under all panels."""
    entries = {}
    for place in axes.ravel():
        for handle, label in zip(*place.get_legend_handles_labels()):
            entries.setdefault(label, handle)
    figure.legend(list(entries.values()), list(entries), loc="outside lower center", ncols=4, fontsize=8, frameon=False)

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Plots drawn with Matplotlib; the same data and the same Matplotlib give the same bytes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .chart import Chart, Line, Panel

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

_COLORS = ("#2f6fab", "#d9662b", "#2f9456", "#8250a6", "#b08a1e", "#555555", "#c8498c", "#1fa3a3")
_PAPER, _INK, _PALE = "#ffffff", "#333333", "#d9d9d9"
_STYLE = {
    "svg.hashsalt": "newton_cagecut",
    "svg.fonttype": "none",
    "path.simplify": False,
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.edgecolor": "#888888",
    "axes.labelcolor": _INK,
    "text.color": _INK,
    "xtick.color": _INK,
    "ytick.color": _INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.7,
}
_UNITS = ((1.0, "s"), (1e-3, "ms"), (1e-6, "us"))


def draw(chart: Chart, folder: Path) -> None:
    """Write a plot as ``NAME.png`` and ``NAME.svg``.

    Args:
        chart: The plot.
        folder: Where to.
    """
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context({**matplotlib.rcParamsDefault, **_STYLE, "backend": "agg"}):
        rows, columns = len(chart.panels), max(map(len, chart.panels))
        height = max([3.1, *(1.0 + 0.3 * len(panel.rows) for row in chart.panels for panel in row)])
        figure = Figure(
            figsize=(4.5 * columns if columns > 1 else 6.4, height * rows + 1.0), layout="constrained", facecolor=_PAPER
        )
        axes = figure.subplots(rows, columns, squeeze=False, sharey="row" if chart.shared else False)
        colors = _colors_of(chart)
        for places, panels in zip(axes, chart.panels):
            for place, panel in zip(places, panels):
                _draw_panel(place, panel, colors)
            for place in places[len(panels) :]:
                place.remove()
            for place in places[1:] if chart.shared else ():
                place.set_ylabel("")
        figure.suptitle(chart.title, fontsize=12.0, fontweight="bold")
        _add_legend(figure, chart, colors)
        figure.savefig(folder / f"{chart.name}.png", dpi=110, metadata={"Software": None})
        creator = f"Matplotlib {matplotlib.__version__}"
        figure.savefig(folder / f"{chart.name}.svg", metadata={"Date": None, "Creator": creator})


def _all_lines(chart: Chart) -> list[Line]:
    return [line for row in chart.panels for panel in row for line in panel.lines]


def _colors_of(chart: Chart) -> dict[str, str]:
    labels = dict.fromkeys(line.like or line.label for line in _all_lines(chart))
    return {label: _COLORS[k % len(_COLORS)] for k, label in enumerate(labels)}


def _draw_panel(axes: Axes, panel: Panel, colors: dict[str, str]) -> None:
    for line in panel.lines:
        axes.plot(line.x, line.y, **_look(line, colors[line.like or line.label], dots=bool(panel.rows)))
    axes.set_xscale("log" if "x" in panel.logarithmic else "linear")
    if panel.rows:
        axes.set_yticks(range(len(panel.rows)), panel.rows)
        axes.set_ylim(len(panel.rows) - 0.4, -0.6)
    else:
        axes.set_yscale("log" if "y" in panel.logarithmic else "linear")
        _limit(axes, panel)
        _mark_ticks(axes.yaxis, panel.y_label, logarithmic="y" in panel.logarithmic)
    _mark_ticks(axes.xaxis, panel.x_label, logarithmic="x" in panel.logarithmic)
    if panel.mark is not None:
        axes.axvline(panel.mark, color="#888888", linewidth=1.0, linestyle=":", zorder=1)
    axes.set(title=panel.title, xlabel=_plain(panel.x_label), ylabel=_plain(panel.y_label))
    axes.grid(which="major")


def _look(line: Line, color: str, *, dots: bool) -> dict:
    """How a line is drawn."""
    return {
        "color": color,
        "linestyle": "none" if dots else "--" if line.like else "-",
        "linewidth": 1.0 if line.like else 1.6,
        "marker": line.marker,
        "markersize": 6.0 if dots else 4.0 if line.like else 5.0,
        "markerfacecolor": _PAPER if line.like else color,
        "markeredgewidth": 1.0,
        "zorder": 2 if line.like else 3,
    }


def _limit(axes: Axes, panel: Panel) -> None:
    """Show all values, and some of the band of what cannot be told apart."""
    values = [y for line in panel.lines for y in line.y]
    if "y" not in panel.logarithmic:
        axes.set_ylim(bottom=min(0.0, *axes.get_ylim()))
    elif panel.floor:
        bottom, top = axes.get_ylim()
        bottom = min(bottom, 0.4 * min([panel.floor, *values]))
        axes.axhspan(0.01 * bottom, panel.floor, color=_PALE, zorder=0, linewidth=0.0)
        axes.set_ylim(bottom, max(top, 2.0 * max(values, default=panel.floor)))


def _mark_ticks(axis: Axis, label: str, *, logarithmic: bool) -> None:
    """Ticks at 1, and at 2 and 5 where there is but a decade or so; times with their units."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    if logarithmic:
        low, high = axis.get_view_interval()
        wide = np.log10(high / low) > 1.7
        axis.set_major_locator(LogLocator(subs=(1.0,) if wide else (1.0, 2.0, 5.0), numticks=12))
        axis.set_minor_formatter(NullFormatter())
    if label.endswith("[s]"):
        axis.set_major_formatter(FuncFormatter(lambda value, _: _time_text(value)))
    elif logarithmic:
        axis.set_major_formatter(FuncFormatter(lambda value, _: _number_text(value)))


def _time_text(seconds: float) -> str:
    for scale, unit in _UNITS:
        if abs(seconds) >= 0.999 * scale:
            return f"{seconds / scale:g} {unit}"
    return f"{seconds:g}"


def _number_text(value: float) -> str:
    if 0.0099 < value < 99999.0:
        return f"{value:g}"
    power = int(np.floor(np.log10(value) + 1e-9))
    first = value / 10.0**power
    return f"$10^{{{power}}}$" if abs(first - 1.0) < 1e-6 else rf"${first:g}\cdot10^{{{power}}}$"


def _plain(label: str) -> str:
    """A label without the unit, where the ticks tell it."""
    return label.removesuffix("[s]").rstrip() if label.endswith("[s]") else label


def _add_legend(figure: object, chart: Chart, colors: dict[str, str]) -> None:
    """One legend under all panels: the lines by their colours, then what dashed ones are, and the band."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    panels = [panel for row in chart.panels for panel in row]
    entries = {}
    for panel in panels:
        for line in panel.lines:
            color = "#777777" if line.like else colors[line.label]
            entries.setdefault(
                (bool(line.like), line.label), Line2D([], [], **_look(line, color, dots=bool(panel.rows)))
            )
    if len(entries) < 2 and not any(panel.floor for panel in panels):
        return
    order = sorted(entries, key=lambda entry: entry[0])
    handles, names = [entries[entry] for entry in order], [label for _, label in order]
    if any(panel.floor for panel in panels):
        handles.append(Patch(color=_PALE))
        names.append("error of the reference")
    columns = min(len(names), 4)
    figure.legend(handles, names, loc="outside lower center", ncols=columns, fontsize=8.5, frameon=False)

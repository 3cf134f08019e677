# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Plots as data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Line:
    """A line of a plot.

    Attributes:
        label: Its name in the legend.
        x: Abscissae.
        y: Ordinates; in a panel with rows the numbers of these.
        like: Name of the line whose colour it has, and beside which it is drawn dashed and hollow; its own without.
            The legend has one grey entry for all such lines of a label.
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
        x_label: Name of the abscissa; one that ends in "[s]" has times at its ticks.
        y_label: Name of the ordinate; likewise.
        lines: What is drawn.
        floor: An ordinate below which nothing can be told apart; drawn as a grey band.
        logarithmic: Which of the axes "x" and "y" are.
        rows: Names of rows from the top down, where the ordinate is not a number: lines are dots then.
        mark: An abscissa that is marked by an upright line.
    """

    title: str
    x_label: str
    y_label: str
    lines: Sequence[Line]
    floor: float | None = None
    logarithmic: str = "xy"
    rows: Sequence[str] = ()
    mark: float | None = None


@dataclass(frozen=True)
class Chart:
    """A picture of one or more panels.

    Attributes:
        name: Its file's name without ending.
        title: Its heading.
        panels: Rows of panels; those of a row share their ordinate.
        shared: Whether they do.
    """

    name: str
    title: str
    panels: Sequence[Sequence[Panel]]
    shared: bool = True

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The page ``docs/accuracy``: errors for time of all corrections, as tables and a picture, from the figures alone."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np
import warp as wp

from benchmarks.error_for_time import FULL, STAGES, Effort, measure_scene
from benchmarks.report_scenes import SCENES
from newton_cagecut.report.machine import machine_of
from newton_cagecut.report.page.markdown import markdown_lines

LABELS = {
    "none": "plain walks",
    "affine": "affine (the paper)",
    "harmonic": "harmonic controls",
    "fitted": "fit, and walks",
    "elements": "finite elements, P2",
}
_COLORS = dict(zip(LABELS, ("#8a8a8a", "#d1603d", "#1b6ca8", "#3a8a4d", "#7a4e9c")))
_TITLES = {"before": "before", "during": "half way", "after": "after"}
_WALKED = 64
_PLANE = "gingerbread"
_INTRODUCTION = """\
Root mean square errors over {point_count} points of each scene, half of them vertices of its mesh and half quadrature
points: of the Euclidean norm of the errors of all weights of a point, and of that of its gradients relative to the
gradients. Measured against a fit that is evaluated at every landing of {reference_walks} walks a point, with other
seeds and a smaller shell (`fitted_walks`). Its own error is taken off; where hardly more is left, the figure is an
upper bound (<). Times are of all points of a scene with 600 quadrature points, on {machine}:
of the first weights, and of a step of 3 % half way through the cut; those of walks are linear in their number, measured
with 4 and 32. Other work ran on the machine: compare times within a scene only. Finite elements are meshed and solved
anew in each step, for the points whose errors are measured alone. Made by
`python -m benchmarks.accuracy --page docs/accuracy`.
"""


def write_error_page(folder: Path, names: Sequence[str], device: wp.context.Device, effort: Effort = FULL) -> None:
    """Measure scenes that are not in a folder yet, and write the page.

    Args:
        folder: Where to; it is made.
        names: Scenes of Table 1; the gingerbread man, in the plane, is always there.
        device: Where to measure.
        effort: How much is measured.
    """
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "accuracy.json"
    settings = asdict(effort) | {"machine": machine_of(device)}
    found = {"settings": settings, "scenes": {}}
    if path.exists():
        found["scenes"] = json.loads(path.read_text())["scenes"]
    for name in (*names, _PLANE):
        if name not in found["scenes"]:
            found["scenes"][name] = measure_scene(SCENES[name](), effort, device, folder=folder)
            path.write_text(json.dumps(found) + "\n")
    write_page(found, folder)


def write_page(found: dict, folder: Path) -> None:
    """Write ``accuracy.md`` and its picture.

    Args:
        found: Figures of all scenes, and of what they were measured with.
        folder: Where to.
    """
    lines = ["# Accuracy", "", _INTRODUCTION.format(**_sizes(found)), "![errors for time](accuracy.png)", ""]
    for against, name in (("affine", "the paper's method"), ("harmonic", "harmonic controls")):
        lines += [f"## Squared error of {name} over that of a fit at the same time", "", *_gain_lines(found, against)]
        lines += [""]
    lines += ["## The references", "", *_reference_lines(found)]
    for name, scene in found["scenes"].items():
        lines += ["", f"## {name}: {scene['faces']} faces, {scene['points']} points", "", *_scene_lines(scene)]
    (folder / "accuracy.md").write_text("\n".join(lines) + "\n")
    _draw(found, folder / "accuracy.png")


def _sizes(found: dict) -> dict:
    machine = found["settings"]["machine"]
    return found["settings"] | {"machine": f"{machine['cores']} cores of {machine['processor']}"}


def net_error(row: dict, scene: dict, stage: str, kind: str) -> tuple[float, bool]:
    """Return a root mean square error without the reference's part, and whether it is an upper bound.

    Args:
        row: A method's figures.
        scene: Its scene's.
        stage: One of the stages.
        kind: "weights" or "gradients".
    """
    squared, own = row["squared"][stage][kind], scene["references"][stage]["own"][kind]
    return float(np.sqrt(max(squared - own, 0.5 * own))), squared < 1.5 * own


def gain(scene: dict, stage: str, kind: str, *, walks: int, against: str = "affine") -> tuple[float, bool]:
    """Return the squared error of another method over that of a fit with walks, in the fit's time.

    The squared error of walks is inverse to their number, which is what they make in that time.

    Args:
        scene: A scene's figures.
        stage: "before" or "during".
        kind: "weights" or "gradients".
        walks: Walks on top of the fit.
        against: The other method.

    Returns:
        The gain, and whether it is a lower bound.
    """
    clock = "first" if stage == "before" else "step"
    own = next(row for row in scene["rows"] if row["method"] == "fitted" and row["amount"] == walks)
    error, bounded = net_error(own, scene, stage, kind)
    others = [row for row in scene["rows"] if row["method"] == against]
    most = others[-1]
    slope = (most["seconds"][clock] - others[0]["seconds"][clock]) / (most["amount"] - others[0]["amount"])
    start = max(0.0, most["seconds"][clock] - slope * most["amount"])
    made = max(1.0, (own["seconds"][clock] - start) / slope) if slope > 0.0 else np.inf
    squared = net_error(most, scene, stage, kind)[0] ** 2 * most["amount"] / made
    return float(squared / error**2), bounded


def _gain_lines(found: dict, against: str) -> Iterator[str]:
    rows = []
    for name, scene in found["scenes"].items():
        cells = []
        for kind in ("weights", "gradients"):
            for stage in ("before", "during"):
                for walks in (0, _WALKED):
                    value, bounded = gain(scene, stage, kind, walks=walks, against=against)
                    cells.append(f"{'>' if bounded else ''}{value:.3g}")
        rows.append([name, *cells])
    head = ["scene"] + [
        f"{kind}, {_TITLES[stage]}, {walks} walks"
        for kind in ("weights", "gradients")
        for stage in ("before", "during")
        for walks in (0, _WALKED)
    ]
    yield from markdown_lines(head, rows)


def _reference_lines(found: dict) -> Iterator[str]:
    yield (
        "Squared difference from plain walks over what both their errors lead to expect (1 but for chance), and the "
        "root mean square of what tables of residuals change of a point's weights:"
    )
    yield ""
    rows = []
    for name, scene in found["scenes"].items():
        for stage, each in scene["references"].items():
            checks = [f"{check:.2f}" for check in each["check"]]
            own = f"{np.sqrt(each['own']['weights']):.1e}"
            rows.append([name, _TITLES[stage], own, *checks, f"{each['table_bias']:.1e}"])
    yield from markdown_lines(["scene", "when", "own error", "weights", "gradients", "tables"], rows)


def _scene_lines(scene: dict) -> Iterator[str]:
    rows = []
    for row in scene["rows"]:
        cells = [LABELS[row["method"]], str(row["amount"])]
        for kind in ("weights", "gradients"):
            for stage in STAGES:
                cells.append("")
                if stage in row["squared"]:
                    error, bounded = net_error(row, scene, stage, kind)
                    cells[-1] = f"{'<' if bounded else ''}{error:.1e}"
        rows.append(cells + [f"{row['seconds'][clock]:.2f}" for clock in ("first", "step")])
    columns = [f"{kind} {_TITLES[stage]}" for kind in ("weights", "gradients") for stage in STAGES]
    yield from markdown_lines(["method", "walks or unknowns", *columns, "first [s]", "step [s]"], rows)


def _draw(found: dict, path: Path) -> None:
    """Two panels a scene: weights before the cut, and half way through it."""
    import matplotlib
    from matplotlib.figure import Figure

    panels = [(name, stage) for name in found["scenes"] for stage in ("before", "during")]
    columns = 4
    with matplotlib.rc_context({**matplotlib.rcParamsDefault, "backend": "agg", "font.size": 8.0}):
        row_count = -(-len(panels) // columns)
        figure = Figure(figsize=(3.1 * columns, 2.5 * row_count + 0.5), layout="constrained")
        axes = figure.subplots(row_count, columns, squeeze=False).ravel()
        for place, (name, stage) in zip(axes, panels):
            scene = found["scenes"][name]
            for method in LABELS:
                rows = [row for row in scene["rows"] if row["method"] == method and stage in row["squared"]]
                seconds = [row["seconds"]["first" if stage == "before" else "step"] for row in rows]
                errors = [net_error(row, scene, stage, "weights")[0] for row in rows]
                place.loglog(seconds, errors, "o-", color=_COLORS[method], markersize=3.5, label=LABELS[method])
            own = np.sqrt(scene["references"][stage]["own"]["weights"])
            place.axhspan(0.0, own, color="0.88", zorder=0, label="error of the reference")
            place.set_title(
                f"{name}, {'first weights' if stage == 'before' else 'a step of the cut'} [s]", fontsize=8.5
            )
            place.grid(alpha=0.3, which="major", linewidth=0.5)
            place.xaxis.set_minor_formatter("")
        for place in axes[len(panels) :]:
            place.set_axis_off()
        figure.supylabel("error of a point's weights")
        handles, labels = axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper center", ncols=6, frameon=False)
        figure.savefig(path, dpi=100, metadata={"Software": None})

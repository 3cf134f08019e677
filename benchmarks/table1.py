# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Table 1 of the paper: how much faster an update is than a full recompute, on six scenes.

``python -m benchmarks.table1`` cuts each scene in steps of 3 % and prints means over the steps, with the paper's row
under each. The points are the vertices of the embedded mesh, as in the paper. The full recompute walks every walk
again on the walls as they are, at the beginning, in the middle and at the end of the cuts; the weights must be the
same before and after, bit for bit.
"""

from __future__ import annotations

from collections.abc import Sequence

from tqdm import tqdm

from benchmarks.progressive import add_scenes, parsed, parser_of, show
from benchmarks.scenes import SCENES
from newton_cagecut.report.page.markdown import Table
from newton_cagecut.report.paper.cutting import step_count
from newton_cagecut.report.paper.table1 import HEAD, QUADRATURE_COUNT, Measured, measure_table, paper_cells


def main(arguments: Sequence[str] | None = None) -> list[Measured]:
    """Measure the scenes of the command line and print the table.

    Args:
        arguments: The command line; that of the program by default.
    """
    parser = parser_of(__doc__.split("\n")[0])
    add_scenes(parser)
    parser.add_argument("--bounds", default="dop18", help="bounding volume of a walk (default: dop18)")
    parser.add_argument(
        "--gradients", action="store_true", help=f"add {QUADRATURE_COUNT} quadrature points, with gradients"
    )
    options = parsed(parser, arguments)
    chosen = {"gradients": options.gradients, "bounds": options.bounds, "device": options.device}
    measured = []
    for scene in (SCENES[name] for name in options.scene):
        with tqdm(total=len(scene.blades) * step_count(), desc=scene.name, unit="step") as bar:
            measured.append(measure_table(scene, options.walks, on_step=bar.update, **chosen))
    rows = [cells for result in measured for cells in (result.cells(), paper_cells(SCENES[result.name].paper))]
    title = (
        f"Means over the steps of 3 %: {options.walks} walks a point, {options.bounds} bounds, on {options.device}. "
        "The weights of the full recompute were those of the updates, bit for bit."
    )
    show([Table(title, HEAD, rows)], options)
    return measured


if __name__ == "__main__":
    main()

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Volume and time of cages around ten meshes: ``python -m benchmarks.wrap [--faces N] [--mesh NAME ...]``.

Times are those of the processor, so that other programs change them little.
"""

from __future__ import annotations

import time

import numpy as np

from benchmarks.progressive import parsed, parser_of, show
from benchmarks.wrap_assets import MESHES
from newton_cagecut.report.page.markdown import Table
from newton_cagecut.wrap import wrap_cage

KINDS = {"triangles": {}, "separate": {"separate": True}, "polygons": {"polygons": True}}
HEAD = ("mesh", "options", "faces", "pieces", "handles", "volume", "of the mesh", "s")


def row(name: str, kind: str, face_count: int) -> list[str]:
    """Make a cage and return its row.

    Args:
        name: Of the mesh.
        kind: Of the options.
        face_count: Faces.
    """
    points, triangles = MESHES[name]()
    own = abs(float(np.linalg.det(points[triangles]).sum())) / 6.0
    start = time.process_time()
    try:
        cage = wrap_cage(points, triangles, face_count, progress=False, **KINDS[kind])
    except ValueError as error:
        return [name, kind, str(error).split(";")[0], "", "", "", "", f"{time.process_time() - start:.1f}"]
    seconds = time.process_time() - start
    handles = cage.component_count - cage.euler_characteristic // 2
    share = "" if name in ("bowl", "leaf") else f"{cage.volume / own:.2f}"
    counts = [str(cage.face_count), str(cage.piece_count), str(handles)]
    return [name, kind, *counts, f"{cage.volume:.4g}", share, f"{seconds:.1f}"]


def main(arguments: list[str] | None = None) -> None:
    """Make the cages and print what they are.

    Args:
        arguments: Of the command line.
    """
    parser = parser_of(__doc__)
    parser.add_argument("--faces", type=int, default=60, help="faces of each cage (60)")
    parser.add_argument("--mesh", nargs="+", choices=MESHES, default=list(MESHES), metavar="NAME", help="which meshes")
    parser.add_argument("--kind", nargs="+", choices=KINDS, default=list(KINDS), metavar="KIND", help="which options")
    options = parsed(parser, arguments)
    rows = [row(name, kind, options.faces) for name in options.mesh for kind in options.kind]
    show([Table(f"Cages of {options.faces} faces.", HEAD, rows)], options)


if __name__ == "__main__":
    main()

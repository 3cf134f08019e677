# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The command ``python -m newton_cagecut cage``: a mesh file in, a cage file out."""

from __future__ import annotations

from argparse import ArgumentParser, ArgumentTypeError, Namespace
from collections.abc import Callable
from pathlib import Path
from time import perf_counter

import numpy as np

from ..cage import Cage, check_inside, mesh_clearance
from ..surface import Surface
from ..usd import checked_path, write_cage
from .any_mesh import read_any_mesh
from .wrap import checked_face_count, checked_offset, wrap_cage

DESCRIPTION = """\
Make a closed cage of a few triangles around a mesh and write it to a USD file,
as a guide. The cage holds every triangle of the mesh at a distance, and passes
all checks of a cage. It needs the extra: pip install 'newton_cagecut[wrap]'
"""
EPILOG = """\
The mesh may be open or in pieces: an alpha wrap closes it. Besides USD, the
formats of PyMeshLab are read: obj, stl, ply, off, gltf, glb, dae, 3mf and more.

example:
  python -m newton_cagecut cage bunny.obj --faces 60 -o bunny_cage.usda
"""


def add_options(parser: ArgumentParser) -> None:
    """Add the command's arguments.

    Args:
        parser: Its parser.
    """
    parser.add_argument("mesh", metavar="MESH", type=Path, help="the mesh file")
    parser.add_argument(
        "-o",
        "--output",
        metavar="CAGE",
        type=_option(str, checked_path),
        required=True,
        help="the USD file to write; one that is there is replaced",
    )
    parser.add_argument(
        "--faces", metavar="N", type=_option(int, checked_face_count), default=60, help="triangles of the cage (60)"
    )
    parser.add_argument(
        "--offset",
        metavar="SHARE",
        type=_option(float, checked_offset),
        default=0.01,
        help="least distance between mesh and cage, of the diagonal of the mesh's box (0.01)",
    )
    parser.add_argument(
        "--separate", action="store_true", help="give each connected component of the mesh a piece of the cage"
    )
    parser.add_argument(
        "--polygons", action="store_true", help="join triangles that lie nearly in a plane into polygons"
    )
    parser.add_argument("--prim", metavar="PATH", help="the mesh to take from a USD file with several")
    parser.add_argument(
        "--up-axis", choices=("Y", "Z"), help="turn the mesh so that this axis is up; the file's own without it"
    )


def run(options: Namespace) -> None:
    """Make the cage, write it and print what it is.

    Args:
        options: The parsed arguments.

    Raises:
        ImportError: The extra is not installed.
        OSError: A file is missing or cannot be written.
        ValueError: The mesh cannot be read or no cage was found.
    """
    output = options.output
    if options.mesh.exists() and Path(output).exists() and options.mesh.samefile(output):
        raise ValueError(f"{output} is the mesh itself; write the cage to another file")
    mesh = read_any_mesh(options.mesh, options.prim, up_axis=options.up_axis)
    start = perf_counter()
    surface = Surface(mesh.points, mesh.triangles)
    choices = {"separate": options.separate, "polygons": options.polygons}
    cage = wrap_cage(surface.points, surface.triangles, options.faces, offset=options.offset, **choices)
    cage = _as_stored(cage, surface)
    seconds = perf_counter() - start
    write_cage(output, cage, up_axis=mesh.up_axis)
    print(f"{output}: {report(cage, surface)}\n  made in    {seconds:.1f} s")


def report(cage: Cage, surface: Surface) -> str:
    """Return a few lines on a cage and the mesh that it holds.

    Args:
        cage: The cage.
        surface: The mesh.
    """
    corners = surface.points[np.unique(surface.triangles)]
    diagonal = float(np.linalg.norm(np.ptp(corners, axis=0)))
    clearance = mesh_clearance(cage, surface.points, surface.triangles)
    if not surface.closed:
        volume = "the mesh is open, which the cage is not"
    elif surface.volume == 0.0:
        volume = "the mesh has none"
    else:
        volume = f"{cage.volume / abs(surface.volume):.2f} times the mesh's"
    pieces = "" if cage.piece_count == 1 else f", {cage.piece_count} pieces"
    return (
        f"{cage.face_count} faces, {cage.vertex_count} vertices{pieces}\n"
        f"  volume     {cage.volume:.4g} m^3, {volume}\n"
        f"  distance   {clearance:.4g} m at least between mesh and cage, {clearance / diagonal:.4f} of the diagonal"
    )


def _as_stored(cage: Cage, surface: Surface) -> Cage:
    """Return the cage as a USD file keeps it, with 32 bits a coordinate, if it still holds the mesh."""
    try:
        stored = Cage(cage.vertices.astype(np.float32).astype(np.float64), cage.faces)
        check_inside(stored, surface.points)
        held = mesh_clearance(stored, surface.points, surface.triangles) > 0.0
    except ValueError:
        held = False
    if not held:
        far = float(np.abs(cage.vertices).max())
        raise ValueError(
            f"the mesh, {cage.diameter:.4g} m across, lies {far:.4g} m from the origin: the 32 bits that a USD file "
            "keeps of each coordinate are too few for its cage; move the mesh nearer to the origin"
        )
    return stored


def _option(kind: type, checked: Callable) -> Callable[[str], object]:
    """Return a converter for the parser that refuses what ``checked`` refuses, in its words."""

    def convert(text: str) -> object:
        try:
            return checked(kind(text))
        except ValueError as error:
            raise ArgumentTypeError(str(error)) from None

    return convert

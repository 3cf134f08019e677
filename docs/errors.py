# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What the library says to bad input: ``python -m docs.errors`` writes docs/errors.md."""

from __future__ import annotations

import json
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path

import newton
import numpy as np
import warp as wp
from pxr import Usd, UsdGeom

import newton_cagecut as cagecut
from newton_cagecut.usd import AnimationWriter, write_mesh

PAGE = Path(__file__).parent / "errors.md"
BOX = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
QUADS = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6))
TRIANGLES = np.array([(a, b, c) for p, q, r, s in QUADS for a, b, c in ((p, q, r), (p, r, s))])
INSIDE = 0.25 + 0.5 * BOX
HEAD = """\
# What is said to bad input

Each line is made by running the case: `python -m docs.errors` writes this page, a test holds it to what the library
says. Refusals come before anything has changed; `FOLDER` stands for the folder of the file.
"""

Case = Callable[[Path], object]


def changed(array: np.ndarray, row: int | tuple, value: object) -> np.ndarray:
    """Return a copy of an array with one row or entry replaced."""
    copy = array.copy()
    copy[row] = value
    return copy


def cage(vertices: np.ndarray = BOX, faces: tuple = QUADS, **options: object) -> cagecut.Cage:
    """Return a cage, the unit box by default."""
    return cagecut.Cage(vertices, faces, **options)


def written(path: Path, content: str | bytes) -> Path:
    """Write a file and return its path."""
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def body(points: np.ndarray = INSIDE, triangles: np.ndarray = TRIANGLES, **options: object) -> object:
    """Add a body to a new builder; the box in the box by default."""
    builder = newton.ModelBuilder()
    cagecut.SolverCageCut.register_custom_attributes(builder)
    options = {"walks": 8, "quadrature": 20, **options}
    return cagecut.add_cage_body(builder, options.pop("cage", None) or cage(), (points, triangles), **options)


def flattened_stage(folder: Path) -> Path:
    """Write a mesh under a prim with a scale of zero."""
    path = folder / "flat.usda"
    write_mesh(path, BOX, QUADS, name="box")
    stage = Usd.Stage.Open(str(path))
    UsdGeom.Xformable(stage.GetPrimAtPath("/World")).AddScaleOp().Set((1.0, 1.0, 0.0))
    stage.Save()
    return path


def two_meshes(folder: Path) -> Path:
    """Write an OBJ file of two tetrahedra."""
    corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    faces = "f {0} {2} {1}\nf {0} {1} {3}\nf {1} {2} {3}\nf {2} {0} {3}\n"
    text = corners + "o left\n" + faces.format(1, 2, 3, 4) + corners + "o right\n" + faces.format(5, 6, 7, 8)
    return written(folder / "two.obj", text)


def empty_gltf(folder: Path) -> Path:
    """Write a glTF without meshes."""
    return written(folder / "empty.gltf", json.dumps({"asset": {"version": "2.0"}, "scenes": [{"nodes": []}]}))


def short_stl(folder: Path) -> Path:
    """Write a binary STL that promises more triangles than it holds."""
    return written(folder / "short.stl", bytes(80) + (12).to_bytes(4, "little") + bytes(100))


def two_balls() -> tuple[np.ndarray, np.ndarray]:
    """Two boxes that almost touch."""
    return np.concatenate([BOX, BOX + [1.01, 0, 0]]), np.concatenate([TRIANGLES, TRIANGLES + 8])


def cut_of(blade: cagecut.Blade, *depths: float) -> None:
    """Advance a blade in the unit box to depths."""
    cut = cagecut.Cut(cage(), blade)
    for depth in depths:
        cut.advance(to=depth)


BLADE = {"origin": (0.5, 0.0, 2.0), "edge": (0.0, 1.0, 0.0), "direction": (0.0, 0.0, -1.0)}

CASES: dict[str, dict[str, Case]] = {
    "Files": {
        "a file that is not there": lambda f: cagecut.read_mesh(f / "none.obj"),
        "a folder": lambda f: (f / "meshes.obj").mkdir() or cagecut.read_mesh(f / "meshes.obj"),
        "an unknown ending": lambda f: cagecut.read_mesh(written(f / "mesh.fbx", "")),
        "text that is no USD": lambda f: cagecut.read_mesh(written(f / "bad.usda", "hello")),
        "a stage without meshes": lambda f: cagecut.read_mesh(written(f / "empty.usda", "#usda 1.0\n")),
        "a scale of zero on a parent": lambda f: cagecut.read_mesh(flattened_stage(f)),
        "a glTF without meshes": lambda f: cagecut.read_mesh(empty_gltf(f)),
        "a glTF cut short": lambda f: cagecut.read_mesh(written(f / "short.gltf", '{"asset": {"vers')),
        "an STL cut short": lambda f: cagecut.read_mesh(short_stl(f)),
        "an OBJ with a damaged line": lambda f: cagecut.read_mesh(written(f / "bad.obj", "v 0 0 0\nv 1 x 0\n")),
        "an OBJ with a corner too many": lambda f: cagecut.read_mesh(
            written(f / "far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
        ),
        "an OFF with another header": lambda f: cagecut.read_mesh(written(f / "bad.off", "PLY\n1 1 0\n")),
        "several meshes, one cage wanted": lambda f: cagecut.read_cage(two_meshes(f)),
        "a name that no mesh has": lambda f: cagecut.read_mesh(two_meshes(f), name="middle"),
        "a negative scale": lambda f: cagecut.read_mesh(two_meshes(f), scale=-1.0),
        "an axis that is none": lambda f: cagecut.read_mesh(two_meshes(f), up_axis="X"),
        "an animation to another format": lambda f: AnimationWriter(f / "cut.mp4"),
        "an animation to no folder": lambda f: AnimationWriter(f / "nowhere" / "cut.usd"),
    },
    "Cages": {
        "a vertex that is not a number": lambda f: cage(changed(BOX, (3, 1), np.nan)),
        "a face with a vertex that is not there": lambda f: cage(faces=(*QUADS[:5], (2, 0, 4, 9))),
        "a face with a vertex twice": lambda f: cage(faces=(*QUADS[:5], (2, 0, 0, 6))),
        "a missing face": lambda f: cage(faces=QUADS[:5]),
        "a face turned over": lambda f: cage(faces=(*QUADS[:5], QUADS[5][::-1])),
        "inside out": lambda f: cage(faces=tuple(face[::-1] for face in QUADS)),
        "a quad that is not planar": lambda f: cage(changed(BOX, 7, (1.3, 1.2, 1.4))),
        "a cage that crosses itself": lambda f: cage(
            np.concatenate([BOX, BOX + 0.5]), (*QUADS, *(tuple(v + 8 for v in face) for face in QUADS))
        ),
        "a face three times": lambda f: cage(faces=(*QUADS, QUADS[0], QUADS[0])),
        "a tolerance of a half": lambda f: cage(tolerance=0.5),
    },
    "Meshes in cages": {
        "points outside the cage": lambda f: body(points=changed(INSIDE, 5, (1.5, 0.25, 0.75))),
        "a triangle with a point that is not there": lambda f: body(triangles=changed(TRIANGLES, (4, 1), 8)),
        "a point that is not finite": lambda f: body(points=changed(INSIDE, (2, 0), np.inf)),
        "no triangles": lambda f: body(triangles=TRIANGLES[:0]),
        "points for coordinates outside": lambda f: cagecut.HarmonicCoordinates(cage(), 1.5 * BOX[7:], walks=8),
        "swapped arguments": lambda f: cagecut.HarmonicCoordinates(BOX, cage(), walks=8),
    },
    "Bodies": {
        "an unknown option": lambda f: body(wallks=5),
        "a material that is none": lambda f: body(material=2e4),
        "a stiffness below zero": lambda f: cagecut.Material(young=-1.0),
        "an incompressible material": lambda f: cagecut.Material(young=1e4, poisson=0.5),
        "a negative contact radius": lambda f: body(contact_radius=-0.01),
        "a rotation of length zero": lambda f: body(xform=wp.transform((0.0, 0.0, 0.0), wp.quat(0.0, 0.0, 0.0, 0.0))),
        "a fixed vertex that is not there": lambda f: body(fixed=[0, 99]),
        "no walks": lambda f: body(walks=-3),
        "a number as capacity": lambda f: body(capacity=100),
    },
    "Blades and cuts": {
        "an edge along the direction": lambda f: cagecut.Blade(**{**BLADE, "edge": (0.0, 0.0, 2.0)}),
        "a direction of length zero": lambda f: cagecut.Blade(**{**BLADE, "direction": (0.0, 0.0, 0.0)}),
        "a blade of width below zero": lambda f: cagecut.Blade(**BLADE, width=-0.1),
        "a depth that is no number": lambda f: cut_of(cagecut.Blade(**BLADE), "deep"),
        "a blade that goes back": lambda f: cut_of(cagecut.Blade(**BLADE), 0.5, 0.3),
    },
    "Cages around meshes": {
        "too few faces": lambda f: cagecut.wrap_cage(BOX, TRIANGLES, 3),
        "too large an offset": lambda f: cagecut.wrap_cage(BOX, TRIANGLES, offset=0.7),
        "points at one place": lambda f: cagecut.wrap_cage(0.0 * BOX, TRIANGLES),
        "components too near to separate": lambda f: cagecut.wrap_cage(*two_balls(), separate=True),
        "components without faces enough": lambda f: cagecut.wrap_cage(*two_balls(), 6, separate=True),
    },
}
"""What is wrong, and what tries it, by subject."""


def said(case: Case) -> str:
    """Return what is raised for a case, or warned of, in one line.

    Args:
        case: The case.

    Raises:
        AssertionError: Nothing is said.
    """
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            case(Path(folder))
        except Exception as error:
            text = f"{type(error).__name__}: {error}"
        else:
            heard = [warning for warning in caught if issubclass(warning.category, UserWarning)]
            if not heard:
                raise AssertionError("nothing was said")
            text = f"(warning) {heard[0].message}"
        return " ".join(text.replace(f"{folder}/", "FOLDER/").replace("|", "\\|").split())


def page() -> str:
    """Return the page."""
    lines = [HEAD]
    for subject, cases in CASES.items():
        lines += [f"## {subject}", "", "| what is wrong | what is said |", "| --- | --- |"]
        lines += [f"| {what} | {said(case)} |" for what, case in cases.items()] + [""]
    return "\n".join(lines)


if __name__ == "__main__":
    PAGE.write_text(page())

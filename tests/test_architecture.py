# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The rooms of the library and who may know whom, read from the imports."""

import re
import subprocess
import sys
from collections import Counter, defaultdict
from graphlib import CycleError, TopologicalSorter
from pathlib import PurePosixPath

import pytest

from import_graph import PACKAGE, ROOT, Import, imports_of, library_files, public_names, room_of

# The rooms from the bottom up, each with those that it may know.
KNOWN_ROOMS = {
    "geometry": (),
    "section": ("geometry",),
    "cage": ("geometry", "section"),
    "harmonic": ("geometry", "section", "cage"),
    "surface": ("geometry", "section", "cage", "harmonic"),
    "elastic": ("geometry", "cage", "harmonic"),
    "usd": ("geometry", "cage", "surface"),
    "files": ("geometry", "cage", "surface", "usd"),
    "wrap": ("geometry", "cage", "surface", "usd", "files"),
    "solver": ("geometry", "section", "cage", "harmonic", "surface", "elastic", "usd", "files", "wrap"),
    "stage": ("geometry", "section", "elastic", "usd", "solver"),
    "report": (
        "geometry",
        "section",
        "cage",
        "harmonic",
        "surface",
        "elastic",
        "usd",
        "files",
        "wrap",
        "solver",
        "stage",
    ),
}
# What stands inside a room, from the bottom up: each line may know those above it and itself.
LEVELS = {
    "harmonic": (
        ("correction_choice",),
        ("journal", "launch", "options", "point_change", "stats", "wanted_error"),
        ("walls",),
        ("walks",),
        ("faces",),
        ("fit",),
        ("resolve",),
        ("cache",),
        ("point_checks",),
        ("placing",),
        ("coordinates",),
        (
            "closed_form_weights",
            "coordinates_warm_up",
        ),
        ("__init__",),
    ),
}
FEATURES = {
    "newton": ("solver", "stage", "report"),
    "pxr": ("usd", "stage"),
    "pymeshlab": ("wrap",),
    "scipy": ("surface", "elastic", "wrap", "solver", "report"),
    "trimesh": ("files",),
    "warp": ("harmonic", "elastic", "solver", "stage", "report"),
}
LINE_LIMIT, FILE_LIMIT = 450, 17


@pytest.fixture(scope="module")
def imports() -> list[Import]:
    """All imports of the library."""
    return [found for file in library_files() for found in imports_of(file)]


@pytest.fixture(scope="module")
def inner_imports(imports: list[Import]) -> list[Import]:
    """The imports of the library's own modules."""
    return [found for found in imports if found.module.split(".")[0] == PACKAGE]


def check(problems: list[str]) -> None:
    """Fail with all problems, one a line."""
    assert not problems, "\n" + "\n".join(problems)


def test_table_points_down():
    """The table itself names each room once, and only rooms below it."""
    rooms = list(KNOWN_ROOMS)
    check(
        [
            f"{room} knows {other}"
            for room in rooms
            for other in KNOWN_ROOMS[room]
            if other not in rooms[: rooms.index(room)]
        ]
    )
    assert {room_of(file) for file in library_files()} - {""} == set(rooms)


def test_imports_resolve(inner_imports: list[Import]):
    """Every import of the library's own names a file that is there."""
    check([f"{found.where}: no such module: {found.module}" for found in inner_imports if found.target is None])


def test_rooms_point_down(inner_imports: list[Import]):
    """A room knows only rooms below it, type annotations included; none knows the package's face but its version."""
    problems = []
    for found in inner_imports:
        room, other = room_of(found.file), room_of(found.target or "")
        if room == "" or other == room or found.module == f"{PACKAGE}._version":
            continue
        if other not in KNOWN_ROOMS[room]:
            problems.append(f"{found.where}: {room} may not know {other or 'the face of the package'}")
    check(problems)


def test_rooms_are_entered_by_their_faces(inner_imports: list[Import]):
    """Other rooms are imported by the names that they hand on, not by their modules."""
    problems = []
    for found in inner_imports:
        room, other = room_of(found.file), room_of(found.target or "")
        if other in ("", room):
            continue
        face = f"{PACKAGE}/{other}/__init__.py"
        hidden = [name for name in found.names if name not in public_names(face)]
        if found.target != face or not found.names:
            problems.append(f"{found.where}: reaches into {found.module}; import from the face of {other}")
        elif hidden:
            problems.append(f"{found.where}: {other} does not hand on {', '.join(hidden)}")
    check(problems)


@pytest.mark.parametrize("room", LEVELS)
def test_levels_point_down(room: str, inner_imports: list[Import]):
    """Inside a room, too, imports point down, type annotations included."""
    level = {name: height for height, names in enumerate(LEVELS[room]) for name in names}
    here = [file for file in library_files() if room_of(file) == room]
    missing = {_part(file) for file in here} - set(level)
    assert not missing, f"{', '.join(sorted(missing))} of {room} stand on no level of the table"
    problems = []
    for found in inner_imports:
        if found.target not in here or found.file not in here:
            continue
        part, other = _part(found.file), _part(found.target)
        if level[other] > level[part] or (level[other] == level[part] and other != part):
            problems.append(f"{found.where}: {room}/{part} may not know {room}/{other}")
    check(problems)


def test_no_cycles(inner_imports: list[Import]):
    """No file imports itself by way of others."""
    graph = defaultdict(set)
    for found in inner_imports:
        if not found.typing_only and found.target:
            graph[found.file].add(found.target)
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail("a cycle of imports: " + " <- ".join(error.args[1]))


def test_packages_stay_in_their_rooms(imports: list[Import]):
    """Packages that not all rooms need are imported only where they are needed; the top folders nowhere."""
    problems = []
    for found in imports:
        package = found.module.split(".")[0]
        allowed = FEATURES.get(package, tuple(KNOWN_ROOMS))
        if room_of(found.file) and room_of(found.file) not in allowed:
            problems.append(f"{found.where}: {package} may be imported in {', '.join(allowed)} only")
        if package in ("assets", "benchmarks", "examples", "tests"):
            problems.append(f"{found.where}: the library does not import {package}")
    check(problems)


def test_file_names_differ():
    """A file is found by its name: no two have the same one."""
    places = defaultdict(list)
    for file in library_files():
        places[PurePosixPath(file).stem].append(file)
    check([" and ".join(files) for stem, files in places.items() if len(files) > 1 and stem != "__init__"])


def test_files_and_folders_are_short():
    """No file is long, and no folder of the library holds many."""
    sizes = {path: len(path.read_text().splitlines()) for path in _sources()}
    problems = [
        f"{path.relative_to(ROOT)}: {n} lines, {LINE_LIMIT} at most" for path, n in sizes.items() if n > LINE_LIMIT
    ]
    counts = Counter(str(PurePosixPath(file).parent) for file in library_files())
    check(problems + [f"{folder}: {n} files, {FILE_LIMIT} at most" for folder, n in counts.items() if n > FILE_LIMIT])


COORDINATES = """
import numpy as np
import newton_cagecut as cagecut
cage = cagecut.Cage([[0, 0], [1, 0], [1, 1], [0, 1]], [(0, 1), (1, 2), (2, 3), (3, 0)])
coords = cagecut.HarmonicCoordinates(cage, np.array([[0.3, 0.4], [0.7, 0.6]]), walks=8, device="cpu")
coords.update(cagecut.Cut(cage, cagecut.Blade((0.5, 2.0), (0.0, -1.0))).advance(to=0.3))
"""


@pytest.mark.parametrize(
    ("code", "unwanted"),
    [
        ("import newton_cagecut", "newton pxr scipy warp pymeshlab trimesh"),
        (COORDINATES, "newton pxr scipy pymeshlab trimesh"),
    ],
    ids=["face", "coordinates"],
)
def test_nothing_is_imported_in_vain(code: str, unwanted: str):
    """The face imports no package, and coordinates with a cut neither Newton, USD nor SciPy."""
    report = f"import sys\nprint([name for name in {unwanted.split()} if name in sys.modules])"
    run = subprocess.run([sys.executable, "-c", f"{code}\n{report}"], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert run.stdout.splitlines()[-1] == "[]", run.stdout


def test_contributing_names_the_rooms_and_tests_that_there_are():
    """The tables of CONTRIBUTING.md list the rooms from the bottom up, and tests that exist."""
    text = (ROOT / "CONTRIBUTING.md").read_text()
    assert re.findall(r"^\| `(\w+)` \|", text.split("## Words")[0], re.MULTILINE) == list(KNOWN_ROOMS)
    named = re.findall(r"`(test_\w+\.py)::(test_\w+)`", text)
    assert len(named) > 20
    missing = [f"{file}::{test}" for file, test in named if f"\ndef {test}(" not in (ROOT / "tests" / file).read_text()]
    check([f"CONTRIBUTING.md: there is no {name}" for name in missing])


def _part(file: str) -> str:
    """The sub-room, or the file itself, of a file in its room."""
    return PurePosixPath(file).parts[2].removesuffix(".py")


def _sources() -> list:
    """All Python files of the project."""
    folders = (PACKAGE, "tests", "examples", "benchmarks", "assets")
    return sorted(path for folder in folders for path in (ROOT / folder).rglob("*.py"))

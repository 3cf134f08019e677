# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Coordinates in a file, to be cut later as if they had never been away.

A file holds the walks, bounds and weights, and besides them all that they are a function of: the cage, the points, the
options, and the walls as the edits so far have appended them, whose triangles a cut cage alone does not tell. What is
loaded is refused unless all of it is the same; and unless some walks, walked again, land on the same bits, since an
update may only keep walks that would repeat themselves (paper, section 4.2).
"""

from __future__ import annotations

import os
from dataclasses import asdict

import numpy as np
import warp as wp

from ..._version import __version__
from ...cage import Cage
from ...geometry import is_number, shown
from ..correction_choice import AUTO
from ..options import WalkOptions
from ..stats import UpdateStats
from ..walks.query_points import INSIDE, REMOVED
from ..walls.frame import UnitFrame
from ..walls.walls import Walls
from .container import read_container, write_container
from .domain import Domain
from .walk_cache import WalkCache

FORMAT = 1
"""Number of the present layout of the file."""

_REPEATED_WALKS = 1 << 14
_REPEATED_POINTS = 8


def save_cache(cache: WalkCache, domain: Domain, path: str | os.PathLike) -> None:
    """Write points, their walks and weights, and the walls, to a file.

    Args:
        cache: What to save; its walks are kept.
        domain: Walls and faces that its weights are for.
        path: Where to write it.

    Raises:
        OSError: The file cannot be written; one that was there is as it was.
    """
    header = {
        "format": FORMAT,
        "library": __version__,
        "made_on": _device_text(domain.device),
        "options": asdict(cache.options) | {"quads": domain.quads, "distance": domain.distance},
        "point_capacity": cache.point_capacity,
        "vertex_capacity": cache.vertex_capacity,
    }
    arrays = {"frame": np.append(domain.frame.center, domain.frame.half_side)}
    arrays |= {f"wall {name}": rows for name, rows in domain.walls.rows.items()}
    arrays |= {f"cage {name}": rows for name, rows in _cage_arrays(domain.cage).items()}
    arrays |= {"rest": cache.rest, "gradient_mask": cache.points.gradient_row.numpy() >= 0}
    arrays |= _used_rows(cache, domain.cage)
    write_container(path, header, arrays)


def load_cache(
    path: str | os.PathLike, cage: Cage, points: np.ndarray, *, device: wp.context.Device, options: dict[str, object]
) -> tuple[WalkCache, Domain]:
    """Read what ``save_cache`` wrote.

    Args:
        path: Where the file is.
        cage: The cage that the walks were in when they were saved.
        points: Rest positions of the points then [m], shape (point_count, dimension); those of removed points are free.
        device: Where to put everything.
        options: Options that the walks must have been made with, by name.

    Raises:
        OSError: There is no such file, or it cannot be read.
        TypeError: There is no such option.
        ValueError: The file is damaged, of another version, or of another cage, other points or options; or its walks
            do not repeat themselves here.
    """
    header, arrays = read_container(path)
    _refuse(path, _version_difference(header))
    kept = header["options"]
    for name in options:
        if name not in kept:
            raise TypeError(f"load: there is no option {name!r}; there are {', '.join(kept)}")
    _refuse(path, _cage_difference(arrays, cage))
    _refuse(path, _point_difference(arrays["rest"], points, arrays["point key"] == REMOVED))
    for name, value in options.items():
        chosen = name == "correction" and isinstance(value, str) and value == AUTO  # whichever it was then
        if not chosen and (not (isinstance(value, str) or is_number(value)) or kept[name] != value):
            _refuse(path, f"its {name} is {kept[name]!r}, not {shown(value)}")
    cache, domain = _filled_cache(header, arrays, cage, points, device)
    _check_repetition(path, header, arrays, cache, domain)
    return cache, domain


def _filled_cache(
    header: dict, arrays: dict[str, np.ndarray], cage: Cage, points: np.ndarray, device: wp.context.Device
) -> tuple[WalkCache, Domain]:
    options = dict(header["options"])
    frame = UnitFrame(arrays["frame"][:-1], float(arrays["frame"][-1]))
    walls = Walls(frame, _part(arrays, "wall"), device=device)
    domain = Domain(cage, quads=options.pop("quads"), distance=options.pop("distance"), device=device, walls=walls)
    cache = WalkCache(
        domain.now,
        WalkOptions(**options),
        point_capacity=header["point_capacity"],
        vertex_capacity=header["vertex_capacity"],
        gradient_mask=arrays["gradient_mask"],
        cuttable=True,
    )
    cache.rest = points
    for name, array in cache.arrays.items():
        rows = array.numpy()
        rows[_used(name, cache, cage)] = arrays[name]
        array.assign(rows)
    return cache, domain


def _used_rows(cache: WalkCache, cage: Cage) -> dict[str, np.ndarray]:
    """The arrays without what is reserved, by name."""
    return {name: array.numpy()[_used(name, cache, cage)] for name, array in cache.arrays.items()}


def _used(name: str, cache: WalkCache, cage: Cage) -> tuple[slice, ...]:
    """The part of an array that is in use; the rest is reserved."""
    points, vertices = slice(cache.point_count), slice(cage.vertex_count)
    walks = slice(cache.point_count * cache.options.walks)
    if name.startswith("landing "):
        return (walks,)
    shapes = {"bounds": (slice(None), walks), "weights": (points, vertices), "gradients": (slice(None), vertices)}
    shapes["errors"] = (points, vertices)
    return shapes.get(name, (points,))


def _cage_arrays(cage: Cage) -> dict[str, np.ndarray]:
    """All that a cage is, by name."""
    return {
        "vertices": cage.vertices,
        "face_start": np.asarray(cage.mesh.face_start),
        "face_vertex": np.asarray(cage.mesh.face_vertex),
        "face_key": cage.face_key,
        "wall_origin": np.array([wall.origin for wall in cage.walls]),
        "wall_axes": np.array([wall.axes for wall in cage.walls]),
        "wall_two_sided": np.array([wall.two_sided for wall in cage.walls]),
    }


def _part(arrays: dict[str, np.ndarray], prefix: str) -> dict[str, np.ndarray]:
    return {name.removeprefix(f"{prefix} "): rows for name, rows in arrays.items() if name.startswith(f"{prefix} ")}


def _refuse(path: str | os.PathLike, difference: str | None) -> None:
    if difference is not None:
        raise ValueError(f"{os.fspath(path)} cannot be used here: {difference}")


def _version_difference(header: dict) -> str | None:
    if header["format"] != FORMAT:
        return f"its format is number {header['format']}, this library's is {FORMAT}; make the coordinates again"
    if header["library"] != __version__:
        return (
            f"newton_cagecut {header['library']} has written it, this is {__version__}, whose walks may be other"
            " ones; make the coordinates again"
        )
    return None


def _cage_difference(arrays: dict[str, np.ndarray], cage: Cage) -> str | None:
    """What differs between the cage of a file and another, with a culprit."""
    kept, given = _part(arrays, "cage"), _cage_arrays(cage)
    advice = "; it is of the cage as it was when the file was written, after a cut that is cut.cage"
    if kept["vertices"].shape[1] != cage.dimension:
        return f"its cage has dimension {kept['vertices'].shape[1]}, the given one {cage.dimension}"
    for name, what in (("vertices", "vertices"), ("face_key", "faces"), ("wall_origin", "walls")):
        if len(kept[name]) != len(given[name]):
            return f"its cage has {len(kept[name])} {what}, the given one {len(given[name])}{advice}"
    for name, what in (("vertices", "vertex"), ("face_key", "the wall of face")):
        differs = np.flatnonzero((kept[name] != given[name]).reshape(len(given[name]), -1).any(axis=1))
        if len(differs):
            return (
                f"{what} {differs[0]} is {kept[name][differs[0]]} in its cage, {given[name][differs[0]]} here{advice}"
            )
    start, ends = kept["face_start"], given["face_start"]
    for face in range(len(start) - 1):
        loop = kept["face_vertex"][start[face] : start[face + 1]]
        if not np.array_equal(loop, given["face_vertex"][ends[face] : ends[face + 1]]):
            return f"face {face} is {loop.tolist()} in its cage, {list(cage.faces[face])} here{advice}"
    for name in ("wall_origin", "wall_axes", "wall_two_sided"):
        differs = np.flatnonzero((kept[name] != given[name]).reshape(len(given[name]), -1).any(axis=1))
        if len(differs):
            return f"wall {differs[0]} of its cage is another plane than here{advice}"
    return None


def _point_difference(kept: np.ndarray, given: np.ndarray, removed: np.ndarray) -> str | None:
    if len(kept) != len(given):
        return f"it is of {len(kept)} points, not {len(given)}"
    differs = np.flatnonzero((kept != given).any(axis=1) & ~removed)
    if len(differs):
        return f"point {differs[0]} lies at {kept[differs[0]]} in it, {given[differs[0]]} here"
    return None


def _check_repetition(
    path: str | os.PathLike, header: dict, arrays: dict[str, np.ndarray], cache: WalkCache, domain: Domain
) -> None:
    """Run some points again, and refuse a file whose bits do not come back."""
    keys = arrays["point key"]
    points = np.flatnonzero(keys == INSIDE)
    if not len(points):
        points = np.flatnonzero(keys != REMOVED)
    count = max(1, min(_REPEATED_POINTS, _REPEATED_WALKS // max(cache.options.walks, 1)))
    points = np.unique(points[np.linspace(0, len(points) - 1, count).astype(int)]) if len(points) else points
    cache.stages(domain.now, UpdateStats(len(points) * cache.options.walks)).run_points(points)
    for name, rows in _used_rows(cache, domain.cage).items():
        if not np.array_equal(rows, arrays[name]):
            _refuse(
                path,
                f"its walks do not repeat themselves bit for bit ({name}); it was made on {header['made_on']}, this is "
                f"{_device_text(domain.device)}; make the coordinates again here",
            )


def _device_text(device: wp.context.Device) -> str:
    """A device, and what compiles for it, in words."""
    return f"{'CUDA' if device.is_cuda else 'the CPU'} ({device.name}) with Warp {wp.__version__}"

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""``read_mesh`` and ``read_cage``: any file that there is a reader for, in metres."""

from __future__ import annotations

import warnings
from dataclasses import replace
from os import PathLike
from pathlib import Path

import numpy as np

from ..cage import Cage
from ..geometry import as_flag, as_number, as_path, polygon_triangles, shown
from ..surface import Surface
from ..usd import border_of, check_mesh, read_meshes, turn_up
from ..usd import read_cage as read_usd_cage
from .file_mesh import FileMesh, joined, split_at_seams, used_points, welded
from .obj_file import read_obj
from .off_file import read_off
from .ply_file import read_ply
from .trimesh_files import read_gltf, read_stl

_USD = (".usd", ".usda", ".usdc", ".usdz")
_READERS = {
    ".obj": (read_obj, None),
    ".off": (read_off, None),
    ".ply": (read_ply, None),
    ".stl": (read_stl, None),
    ".gltf": (read_gltf, "Y"),
    ".glb": (read_gltf, "Y"),
}
"""Readers of formats, with the axis that points up in them; the others do not say one."""


def read_mesh(
    path: str | PathLike, *, scale: float = 1.0, up_axis: str | None = None, name: str | None = None, weld: bool = False
) -> Surface:
    """Read a mesh file as a surface to embed; polygons are cut into triangles.

    USD, OBJ, OFF, PLY, STL and glTF are read, all meshes of a file as one unless one is named; those that have "cage"
    in their name, where others have not, are left out: :func:`read_cage` reads them. STL and glTF need the extra:
    ``pip install 'newton_cagecut[files]'``. Points keep the order of the file; texture coordinates and normals are
    kept. Where those differ between the corners of a point, it gets copies behind all points. Triangles with a point
    twice are left out.

    Args:
        path: The file; its ending tells the format.
        scale: What lengths are multiplied by. USD says its unit and glTF is in metres; the others are taken as metres.
        up_axis: ``"Y"`` or ``"Z"`` turns USD and glTF from their own up axis to this one. The others say no axis and
            stay as they stand.
        name: The mesh to read: its name, or in USD the path of a prim with meshes below it.
        weld: Whether points at one place are joined, as those of STL always are. Texture coordinates that differ
            there become those of corners, normals become their mean. Without, surfaces know seams by where their points
            stand.

    Returns:
        The surface [m].

    Raises:
        FileNotFoundError: There is no such file.
        ImportError: The format needs the extra.
        TypeError: An argument is of a wrong type.
        ValueError: An argument is wrong, the file cannot be read, or its mesh is none.
    """
    weld, (path, meshes) = as_flag(weld, "weld"), _read(path, scale, up_axis, name)
    cages = [] if name is not None else _cages_of(meshes)
    mesh = joined([used_points(mesh) for mesh in meshes if mesh not in cages] if cages else meshes)
    if mesh.uvs is not None and not np.isfinite(mesh.uvs).all():
        warnings.warn(f"{path}: its texture coordinates are not finite; they are left out", stacklevel=2)
        mesh = replace(mesh, uvs=None)
    corners = polygon_triangles(mesh.points[mesh.indices], mesh.counts, np.arange(len(mesh.indices)))
    uvs, corner_uvs = mesh.uvs, None if mesh.uvs is None else mesh.uvs[mesh.indices]
    if weld or path.suffix.lower() == ".stl":
        mesh = welded(mesh)
        uvs = mesh.uvs
    triangles = mesh.indices[corners]
    kept = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    if not kept.any():
        raise ValueError(f"{path} has no triangle whose points differ")
    triangles = triangles[kept]
    if uvs is None and corner_uvs is not None:
        uvs = corner_uvs[corners[kept]]
    return Surface(mesh.points, triangles, uvs=uvs, normals=_unit_normals(mesh, triangles))


def read_cage(
    path: str | PathLike, *, scale: float = 1.0, up_axis: str | None = None, name: str | None = None, **options
) -> Cage:
    """Read a mesh file as a cage; its polygons become the cage's faces.

    Formats, extra and order are those of :func:`read_mesh`. Points at one place are joined, and those without faces
    left out. A flat mesh that is open is the plane cage of its border. USD's curves may be a plane cage, as in
    :func:`newton_cagecut.usd.read_cage`.

    Args:
        path: The file; its ending tells the format.
        scale: As in :func:`read_mesh`.
        up_axis: As in :func:`read_mesh`.
        name: As in :func:`read_mesh`; may be left out where the file has one mesh, or one with "cage" in its name.
        options: Keyword arguments of :class:`~newton_cagecut.cage.Cage`, such as ``repair=True``.

    Returns:
        The validated cage [m].

    Raises:
        FileNotFoundError: There is no such file.
        ImportError: The format needs the extra.
        TypeError: An argument is of a wrong type.
        ValueError: As in :func:`read_mesh`, or there are several meshes, or the mesh is no valid cage.
    """
    path, meshes = _read(path, scale, up_axis, name, empty=True)
    if not meshes:  # of USD: curves, or an error that says what there is
        cage = read_usd_cage(path, up_axis=up_axis, **options)
        return cage if scale == 1.0 else Cage(cage.vertices * scale, cage.faces, **options)
    meshes = _cages_of(meshes) or meshes
    names = list(dict.fromkeys(mesh.name for mesh in meshes))
    if len(names) > 1:
        raise ValueError(f"{path} has {len(names)} meshes; choose the cage by its name (name=): {', '.join(names)}")
    mesh = welded(used_points(joined(meshes)))
    try:
        border = border_of("it", mesh.points, mesh.counts, mesh.indices)
        return Cage(*(border or (mesh.points, mesh.loops)), **options)
    except ValueError as error:
        raise ValueError(f"{path} is no valid cage: {error}") from None


def _read(
    path: str | PathLike, scale: float, up_axis: str | None, name: str | None, *, empty: bool = False
) -> tuple[Path, list[FileMesh]]:
    """Return the path and the checked meshes of a file in metres; none only where that may be and the file is USD."""
    path, scale = Path(as_path(path)), _checked_scale(scale)
    if not (up_axis is None or (isinstance(up_axis, str) and up_axis in ("Y", "Z"))):
        raise ValueError(f'up_axis must be "Y", "Z" or None, got {shown(up_axis)}')
    if name is not None and not isinstance(name, str):
        raise TypeError(f"name must be the name of a mesh, got {name!r}")
    suffix = path.suffix.lower()
    if suffix not in (*_USD, *_READERS):
        raise ValueError(f"{path}: files that end in {suffix or 'nothing'} are not read; {_endings()} are")
    if path.is_dir():
        raise ValueError(f"{path} is a folder, not a file")
    if not path.exists():
        raise FileNotFoundError(f"no such file: {path}")
    if suffix in _USD:
        below = name if name and name.startswith("/") else None
        meshes, own_axis = _usd_meshes(path, below, up_axis), None
    else:
        below, (reader, own_axis) = None, _READERS[suffix]
        meshes = reader(path)
    if not meshes and not (empty and name is None and suffix in _USD):
        raise ValueError(f"{path} has no meshes" if below is None else f"{path} has no mesh at or below {below}")
    meshes = meshes if name is None or below else _named(path, meshes, name)
    for mesh in meshes:
        check_mesh(f"mesh {mesh.name!r} of {path}", mesh.points, mesh.counts, mesh.indices)
    return path, _in_metres(meshes, scale, own_axis, up_axis)


def _cages_of(meshes: list[FileMesh]) -> list[FileMesh]:
    """Return the meshes that are a cage by their name, where others are not."""
    cages = [mesh for mesh in meshes if "cage" in mesh.name.lower()]
    return cages if len(cages) < len(meshes) else []


def _in_metres(meshes: list[FileMesh], scale: float, own_axis: str | None, up_axis: str | None) -> list[FileMesh]:
    """Return meshes scaled and turned; those that share an array of points go on sharing it."""
    axis = own_axis or up_axis or "Z"
    placed = {id(mesh.points): turn_up(mesh.points, axis, up_axis or axis) * scale for mesh in meshes}
    turned = [None if mesh.normals is None else turn_up(mesh.normals, axis, up_axis or axis) for mesh in meshes]
    return [replace(mesh, points=placed[id(mesh.points)], normals=normals) for mesh, normals in zip(meshes, turned)]


def _usd_meshes(path: Path, below: str | None, up_axis: str | None) -> list[FileMesh]:
    """Return the meshes of a USD file, in metres and turned."""
    meshes = []
    for data in read_meshes(path, below, up_axis=up_axis):
        counts = np.array([len(face) for face in data.faces], dtype=np.int64)
        indices = np.array([vertex for face in data.faces for vertex in face], dtype=np.int64)
        corner_uvs = data.uvs[indices] if data.uvs is not None else data.corner_uvs
        mesh = FileMesh(data.name, data.points, counts, indices)
        meshes.append(split_at_seams(mesh, corner_uvs, data.corner_normals))
    return meshes


def _named(path: Path, meshes: list[FileMesh], name: str) -> list[FileMesh]:
    """Return the meshes of a name, without points of others."""
    found = [used_points(mesh) for mesh in meshes if mesh.name == name]
    if not found:
        names = ", ".join(dict.fromkeys(mesh.name for mesh in meshes))
        raise ValueError(f"{path} has no mesh {name!r}; its meshes: {names}")
    return found


def _unit_normals(mesh: FileMesh, triangles: np.ndarray) -> np.ndarray | None:
    """Return normals of length one, or ``None`` where a triangle's point has none; others get any."""
    if mesh.normals is None:
        return None
    length = np.linalg.norm(mesh.normals, axis=1)
    bad = ~(np.isfinite(length) & (length > 0.0))
    if bad[triangles].any():
        return None
    return np.where(bad[:, None], [0.0, 0.0, 1.0], mesh.normals / np.where(bad, 1.0, length)[:, None])


def _checked_scale(scale: float) -> float:
    number = as_number(scale, "scale")
    if not (np.isfinite(number) and number > 0.0):
        raise ValueError(f"scale must be positive and finite, got {number}")
    return number


def _endings() -> str:
    endings = (*_USD, *_READERS)
    return f"{', '.join(endings[:-1])} and {endings[-1]}"

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Reads a mesh from USD or from any format that PyMeshLab knows."""

from __future__ import annotations

from os import PathLike, fspath
from pathlib import Path

from ..usd import MeshData, read_mesh
from .meshlab import read_triangles

_USD = (".usd", ".usda", ".usdc", ".usdz")
_Y_UP = (".gltf", ".glb")


def read_any_mesh(path: str | PathLike, prim_path: str | None = None, *, up_axis: str | None = None) -> MeshData:
    """Read a mesh file.

    USD is read by :func:`~newton_cagecut.usd.read_mesh`. Other formats know no unit: their lengths are taken as metres.
    All meshes of such a file are read as one. glTF has +Y up; the rest know no axis and are taken as they are.

    Args:
        path: The file; its ending tells the format.
        prim_path: The mesh in a USD file, or a prim with one mesh below it.
        up_axis: ``"Y"`` or ``"Z"`` turns the mesh from its own up axis to this one; where the format knows no axis,
            this one is its own, and ``"Z"`` without it.

    Raises:
        FileNotFoundError: There is no such file.
        ImportError: The format is none of USD's and the extra is not installed.
        ValueError: The file cannot be read, has no triangles, or the mesh cannot be told.
    """
    path = Path(fspath(path))
    suffix = path.suffix.lower()
    if suffix in _USD:
        return read_mesh(path, prim_path, up_axis=up_axis)
    if prim_path is not None:
        raise ValueError(f"{path} is no USD file, so there is no prim {prim_path} to choose in it")
    if not path.is_file():
        raise FileNotFoundError(f"no such file: {path}")
    points, triangles = read_triangles(str(path))
    if len(triangles) == 0:
        raise ValueError(f"{path} has {len(points)} points and no triangles; a cage needs a mesh to hold")
    own_axis = "Y" if suffix in _Y_UP else up_axis or "Z"
    mesh = MeshData(points, tuple(map(tuple, triangles.tolist())), name=path.stem, up_axis=own_axis)
    return mesh.turned(up_axis or own_axis)

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Reads PLY, in text or binary.

trimesh would cut its polygons into triangles, and cannot read binary files whose faces differ in length.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from .file_mesh import FileMesh, split_at_seams

_TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"float": "f4", "double": "f8", "float32": "f4", "float64": "f8"},
}
_FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_UVS = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"))
_POINT_IDS = ("vertex_indices", "vertex_index")


@dataclass
class _Element:
    """An element of the header: ``properties`` are its columns, each a name, a type, and a type of counts for lists."""

    name: str
    count: int
    properties: list[tuple[str, str, str]] = field(default_factory=list)


def read_ply(path: Path) -> list[FileMesh]:
    """Read a PLY file.

    Args:
        path: The file.

    Raises:
        ValueError: The file is no PLY, or cut short or damaged.
    """
    data = path.read_bytes()
    try:
        order, elements, start = _header(data)
    except (KeyError, ValueError, IndexError):
        raise ValueError(f"{path} cannot be read as PLY: its header is damaged or cut short") from None
    body = data[start:].split() if order == "" else data
    place, columns = 0 if order == "" else start, {}
    for element in elements:
        try:
            columns[element.name], place = _columns(body, place, element, order)
        except (ValueError, IndexError):
            raise ValueError(
                f"{path} is cut short or damaged: it does not hold the {element.count} rows of its "
                f"element {element.name!r}"
            ) from None
    return [_mesh(path, columns.get("vertex", {}), columns.get("face", {}))]


def _header(data: bytes) -> tuple[str, list[_Element], int]:
    """The order of bytes, empty for text, the elements, and where the data begin."""
    end = data.index(b"end_header")
    lines = [line.split() for line in data[:end].decode("ascii", errors="replace").splitlines()]
    if lines[0] != ["ply"]:
        raise ValueError
    order, elements = None, []
    for words in filter(None, lines[1:]):
        if words[0] == "format":
            order = _FORMATS[words[1]]
        elif words[0] == "element":
            elements.append(_Element(words[1], int(words[2])))
        elif words[0] == "property" and words[1] == "list":
            elements[-1].properties.append((words[4], _TYPES[words[3]], _TYPES[words[2]]))
        elif words[0] == "property":
            elements[-1].properties.append((words[2], _TYPES[words[1]], ""))
    if order is None or any(element.count < 0 for element in elements):
        raise ValueError
    return order, elements, data.index(b"\n", end) + 1


def _columns(body: list[bytes] | bytes, place: int, element: _Element, order: str) -> tuple[dict, int]:
    """The columns of an element by their names, those of lists as a pair of counts and values, and where it ends."""
    lists = [counts for _, _, counts in element.properties if counts]
    if lists:
        even = _even_lists(body, place, element, order) if order else None
        return even or _lists(body, place, element, order)
    size = len(element.properties)
    if order == "":
        words = body[place : place + size * element.count]
        table = np.array(words, dtype=np.float64).reshape(element.count, size)
        return {name: table[:, i] for i, (name, _, _) in enumerate(element.properties)}, place + table.size
    kind = np.dtype([(name, order + number) for name, number, _ in element.properties])
    rows = np.frombuffer(body, kind, element.count, place)
    return {name: rows[name].astype(np.float64) for name in kind.names or ()}, place + rows.nbytes


def _even_lists(body: bytes, place: int, element: _Element, order: str) -> tuple[dict, int] | None:
    """The columns of an element whose rows all have lists as long as the first's, or ``None``."""
    fields, offset = [], place
    for name, number, counts in element.properties:
        length = int(np.frombuffer(body, order + counts, 1, offset)[0]) if counts and element.count else 1
        if counts:
            fields.append((f"{name} counts", order + counts))
        fields.append((name, order + number, (length,)))
        offset = place + np.dtype(fields).itemsize
    kind = np.dtype(fields)
    if len(body) - place < element.count * kind.itemsize:
        return None
    rows = np.frombuffer(body, kind, element.count, place)
    found = {}
    for name, _, counts in element.properties:
        if counts and (rows[f"{name} counts"] != rows[name].shape[1]).any():
            return None
        lengths = np.full(element.count, rows[name].shape[1])
        found[name] = (lengths, rows[name].reshape(-1)) if counts else rows[name][:, 0].astype(np.float64)
    return found, place + rows.nbytes


def _lists(body: list[bytes] | bytes, place: int, element: _Element, order: str) -> tuple[dict, int]:
    """The same row by row, for lists of any lengths."""
    counts, values = {p[0]: [] for p in element.properties}, {p[0]: [] for p in element.properties}

    def take(number: str, length: int, place: int) -> tuple[np.ndarray, int]:
        if order == "":
            taken = np.array(body[place : place + length], dtype=np.float64)
            if len(taken) < length:
                raise ValueError
            return taken, place + length
        taken = np.frombuffer(body, order + number, length, place)
        return taken, place + taken.nbytes

    for _ in range(element.count):
        for name, number, of_counts in element.properties:
            length = 1
            if of_counts:
                read, place = take(of_counts, 1, place)
                length = int(read[0])
                if length < 0:
                    raise ValueError
                counts[name].append(length)
            read, place = take(number, length, place) if length else (np.zeros(0), place)
            values[name].append(read)
    found = {}
    for name, _, of_counts in element.properties:
        flat = np.concatenate([*values[name], np.zeros(0)])
        found[name] = (np.array(counts[name], dtype=np.int64), flat) if of_counts else flat
    return found, place


def _mesh(path: Path, vertex: dict, face: dict) -> FileMesh:
    """The mesh of what was read; texture coordinates of corners go before those of points."""
    missing = [axis for axis in "xyz" if axis not in vertex]
    ids = next((face[name] for name in _POINT_IDS if name in face), (np.zeros(0, dtype=np.int64), np.zeros(0)))
    if missing:
        raise ValueError(f"{path}: its points have no {', '.join(missing)}")
    points = np.column_stack([vertex[axis] for axis in "xyz"])
    counts, indices = ids[0].astype(np.int64), ids[1].astype(np.int64)
    uvs = next((np.column_stack([vertex[a], vertex[b]]) for a, b in _UVS if a in vertex and b in vertex), None)
    normals = np.column_stack([vertex[n] for n in ("nx", "ny", "nz")]) if {"nx", "ny", "nz"} <= set(vertex) else None
    mesh = FileMesh(path.stem, points, counts, indices)
    inside = len(indices) and indices.min() >= 0 and indices.max() < len(points)
    if inside and "texcoord" in face and (face["texcoord"][0] == 2 * counts).all():
        corner_uvs = face["texcoord"][1].astype(np.float64).reshape(-1, 2)
        return split_at_seams(mesh, corner_uvs, None if normals is None else normals[indices])
    return FileMesh(path.stem, points, counts, indices, uvs, normals)

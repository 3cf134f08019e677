# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Reads OFF, in which trimesh would cut polygons into triangles: a cage's stay whole here."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .file_mesh import FileMesh, split_at_seams

_HEADER = re.compile(r"^(ST)?(C)?(N)?OFF\b(?!\s*BINARY)")


def read_off(path: Path) -> list[FileMesh]:
    """Read an OFF file, its colours left out.

    Args:
        path: The file.

    Raises:
        ValueError: The file is no OFF in text, or cut short or damaged.
    """
    text = path.read_text(encoding="utf-8", errors="replace")
    lines = [line for line in (line.split("#", 1)[0].strip() for line in text.splitlines()) if line]
    header = _HEADER.match(lines[0]) if lines else None
    if header is None:
        raise ValueError(f"{path} cannot be read as OFF: its first line must be OFF, COFF, NOFF or STOFF")
    rest = lines[0][header.end() :].strip()
    lines = ([rest] if rest else []) + lines[1:]
    point_count, face_count = _numbers(path, lines[0].split()[:2] if lines else [], int, 2, "its counts")
    if min(point_count, face_count) < 0 or len(lines) - 1 < point_count + face_count:
        raise ValueError(
            f"{path} is cut short: it promises {point_count} points and {face_count} faces, "
            f"but has {len(lines) - 1} lines of them"
        )
    rows = [line.split() for line in lines[1 : 1 + point_count + face_count]]
    colored = header[2] is not None  # by three numbers or four
    width = 3 + 3 * (header[3] is not None) + 4 * colored + 2 * (header[1] is not None)
    table = [
        _numbers(path, row[:width], float, width - colored, f"point {i}") for i, row in enumerate(rows[:point_count])
    ]
    faces = [_face(path, row, i) for i, row in enumerate(rows[point_count:])]
    points = np.array([row[:3] for row in table]).reshape(-1, 3)
    indices = np.array([vertex for face in faces for vertex in face], dtype=np.int64)
    mesh = FileMesh(path.stem, points, np.array([len(face) for face in faces], dtype=np.int64), indices)
    return [_with_attributes(mesh, table, header)]


def _with_attributes(mesh: FileMesh, table: list[list[float]], header: re.Match) -> FileMesh:
    """The mesh with the normals and texture coordinates that its header names."""
    inside = len(mesh.indices) and mesh.indices.min() >= 0 and mesh.indices.max() < len(mesh.points)
    if not inside or not (header[1] or header[3]):
        return mesh
    normals = np.array([row[3:6] for row in table])[mesh.indices] if header[3] else None
    uvs = np.array([row[-2:] for row in table])[mesh.indices] if header[1] else None
    return split_at_seams(mesh, uvs, normals)


def _face(path: Path, row: list[str], number: int) -> list[int]:
    """The point ids of a face; colours behind them are left out."""
    (count,) = _numbers(path, row[:1], int, 1, f"face {number}")
    return _numbers(path, row[1 : 1 + max(count, 0)], int, max(count, 0), f"face {number}")


def _numbers(path: Path, words: list[str], kind: type, least: int, what: str) -> list:
    """Words as numbers."""
    try:
        numbers = [kind(word) for word in words]
    except ValueError:
        numbers = []
    if len(numbers) < least:
        raise ValueError(f"{path}: {what} is cut short or damaged: {' '.join(words)[:60]!r}")
    return numbers

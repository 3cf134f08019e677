# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Reads OBJ, in which trimesh would cut polygons into triangles: a cage's stay whole here."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .file_mesh import FileMesh, split_at_seams


def read_obj(path: Path) -> list[FileMesh]:
    """Read the objects (``o``) of an OBJ file; they share one array of points, in the order of the file.

    Args:
        path: The file.

    Raises:
        ValueError: A line is cut short or damaged, or a face refers to what is not there.
    """
    lines = _Lines()
    text = path.read_text(encoding="utf-8", errors="replace").replace("\\\n", " ")
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.split("#", 1)[0].split()
        try:
            if words:
                lines.add(words[0], words[1:])
        except (ValueError, IndexError):
            raise ValueError(f"{path}: line {number} is cut short or damaged: {line.strip()[:60]!r}") from None
    return lines.meshes(path)


class _Lines:
    """What the lines of a file have said so far."""

    def __init__(self) -> None:
        self.values = {"v": [], "vt": [], "vn": []}
        self.corners: list[tuple[int, int, int]] = []
        """Rows of the three tables from 0, -1 for none."""
        self.counts: list[int] = []
        self.face_object: list[int] = []
        self.objects: list[str] = []

    def add(self, key: str, words: list[str]) -> None:
        """Take one line in.

        Raises:
            ValueError: A word is no number, or too few are there.
        """
        if key in ("v", "vn"):
            x, y, z = map(float, words[:3])
            self.values[key].append((x, y, z))
        elif key == "vt":
            self.values[key].append((float(words[0]), float(words[1]) if len(words) > 1 else 0.0))
        elif key == "o":
            self._begin(" ".join(words))
        elif key == "f":
            if len(words) < 3:
                raise ValueError
            if not self.objects:
                self._begin("")
            self.corners += [self._corner(word) for word in words]
            self.counts.append(len(words))
            self.face_object.append(self.object)

    def meshes(self, path: Path) -> list[FileMesh]:
        """One mesh an object that has faces."""
        corners = np.array(self.corners, dtype=np.int64).reshape(-1, 3)
        tables = [np.array(self.values[key]).reshape(-1, width) for key, width in (("v", 3), ("vt", 2), ("vn", 3))]
        for what, rows, table in zip(("point", "texture coordinate", "normal"), corners.T, tables):
            if len(rows) and (rows.max() >= len(table) or rows.min() < -1 or (what == "point" and rows.min() < 0)):
                corner = int(np.argmax((rows >= len(table)) | (rows < (0 if what == "point" else -1))))
                face = int(np.searchsorted(np.cumsum(self.counts), corner, side="right"))
                raise ValueError(
                    f"{path}: face {face} refers to {what} {rows[corner] + 1}, but there are {len(table)}; "
                    "the file is cut short or damaged"
                )
        attributes = [_rows(table, rows) for table, rows in zip(tables[1:], corners.T[1:])]
        counts, owner = np.array(self.counts, dtype=np.int64), np.array(self.face_object, dtype=np.int64)
        whole = split_at_seams(FileMesh(path.stem, tables[0], counts, corners[:, 0].copy()), *attributes)
        corner_owner = np.repeat(owner, counts)
        return [
            FileMesh(
                self.objects[number] or path.stem,
                whole.points,
                counts[owner == number],
                whole.indices[corner_owner == number],
                whole.uvs,
                whole.normals,
            )
            for number in np.unique(owner).tolist()
        ] or [whole]

    def _begin(self, name: str) -> None:
        """Begin an object, or go on with one of this name."""
        if name not in self.objects:
            self.objects.append(name)
        self.object = self.objects.index(name)

    def _corner(self, word: str) -> tuple[int, int, int]:
        """The rows of a corner such as ``3``, ``3/1``, ``3//2`` or ``-1/-1/-1``."""
        parts = word.split("/")
        point = self._row("v", parts[0])
        uv = self._row("vt", parts[1]) if len(parts) > 1 and parts[1] else -1
        return point, uv, self._row("vn", parts[2]) if len(parts) > 2 and parts[2] else -1

    def _row(self, key: str, word: str) -> int:
        row = int(word)
        if row == 0 or row < -len(self.values[key]):
            raise ValueError
        return row - 1 if row > 0 else row + len(self.values[key])


def _rows(table: np.ndarray, rows: np.ndarray) -> np.ndarray | None:
    """Rows of a table, zeros for -1; ``None`` where all are -1."""
    if not (rows >= 0).any():
        return None
    return np.where(rows[:, None] >= 0, table[rows], 0.0)

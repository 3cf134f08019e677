# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A coarse cage around a mesh: wrap, decimate, tighten, check.

Section 3 of the paper takes the cage as given. An alpha wrap turns any mesh into a closed shell; decimation makes the
shell coarse, and linear programs make it hold the mesh closely. Only a cage that passes every check of
:class:`~newton_cagecut.cage.Cage` and keeps its distance from the whole mesh is handed on; otherwise a wider shell,
with less detail, is tried.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ..cage import Cage, check_inside, mesh_clearance
from ..geometry import as_index, as_number
from ..surface import Surface
from .broaden import broaden
from .meshlab import alpha_wrap, decimate, import_meshlab
from .sampling import spread_points
from .shell import Shell
from .tighten import tighten

_FACE_COUNTS = (4, 500)
_OFFSETS = (1e-3, 0.25)
_TRIES = 8
_FIRST_OFFSETS = (0.03, 3.0)  # of the first shell that is decimated: of the mesh's diagonal, of the offset
_WIDER = 1.6  # offset of the next try's shell
_SURPLUS = 1.1  # faces that decimation may leave, of those asked for
_ALPHA = 2.0  # size of the wraps' triangles and of the openings that they close, of their offset
_LARGEST_ALPHA = 0.2  # of the mesh's diagonal
_HELD_ALPHA = 0.03  # the least for the wrap that the cage must hold, of the mesh's diagonal
_SPACINGS = (0.004, 0.01)  # between the points that stand for the mesh, of its diagonal


def wrap_cage(points: np.ndarray, triangles: np.ndarray, face_count: int = 60, *, offset: float = 0.01) -> Cage:
    """Make a coarse cage that holds a mesh.

    The mesh may be open, in pieces, inside out or crossing itself; holes smaller than a few offsets are closed. Pieces
    that lie apart may get a piece of the cage each. Needs the extra: ``pip install 'newton_cagecut[wrap]'``.

    Args:
        points: Points of the mesh, shape (point_count, 3) [m].
        triangles: Point ids, shape (triangle_count, 3).
        face_count: Triangles of the cage, 4 to 500; the cage has at most a tenth more.
        offset: Least distance between the mesh and the cage's faces, of the diagonal of the mesh's bounding box,
            0.001 to 0.25.

    Returns:
        The cage; its faces are triangles.

    Raises:
        ImportError: The extra is not installed.
        TypeError: Something is not a number, or not an integer.
        ValueError: The mesh is no mesh, an argument is out of its range, or no cage was found; the text says which.
    """
    surface = Surface(points, triangles, weld=-1.0)
    face_count, offset = checked_face_count(face_count), checked_offset(offset)
    import_meshlab()
    used, corner = np.unique(surface.triangles, return_inverse=True)
    mesh = _Mesh(surface.points[used], corner.reshape(-1, 3), offset)
    reason = ""
    for number in range(_TRIES):
        try:
            cage = mesh.cage(face_count, number)
        except ValueError as error:
            reason = str(error)
            continue
        _refuse_strays(cage, surface.points, used)
        return cage
    raise ValueError(
        f"no cage of about {face_count} faces was found around the mesh in {_TRIES} tries; in the last one "
        f"{reason}. Allow more faces or another offset"
    )


class _Mesh:
    """A mesh to hold, moved to the origin and scaled to a diagonal of 1.

    Args:
        points: Its points, all of them used, shape (point_count, 3) [m].
        triangles: Point ids, shape (triangle_count, 3).
        offset: Least distance of a cage, of the diagonal.

    Raises:
        ValueError: All points coincide.
    """

    def __init__(self, points: np.ndarray, triangles: np.ndarray, offset: float):
        low, high = points.min(axis=0), points.max(axis=0)
        self.points, self.triangles, self.offset = points, triangles, offset
        self.centre, self.diagonal = 0.5 * (low + high), float(np.linalg.norm(high - low))
        if self.diagonal == 0.0:
            raise ValueError("all points of the mesh coincide; a cage needs a mesh with an extent")
        self.scaled = (points - self.centre) / self.diagonal
        self.broad = broaden(self.scaled, triangles)
        self.spacing = float(np.clip(0.5 * offset, *_SPACINGS))
        self.skin = cKDTree(spread_points(self.scaled, triangles, self.spacing))
        self.held = self._wrap(offset + min(0.5 * offset, _SPACINGS[1]), least_alpha=_HELD_ALPHA)[0]

    def cage(self, face_count: int, number: int) -> Cage:
        """Make one try at a cage.

        Args:
            face_count: Its faces.
            number: Number of the try; later ones start from wider shells.

        Raises:
            ValueError: It came to nothing; the text says how.
        """
        offset = max(_FIRST_OFFSETS[0], _FIRST_OFFSETS[1] * self.offset) * _WIDER**number
        shell = Shell(*decimate(*self._wrap(offset), face_count))
        if len(shell.triangles) > _SURPLUS * face_count:
            raise ValueError(f"decimation stopped at {len(shell.triangles)} faces")
        Cage(shell.vertices, shell.triangles)  # moves keep a shell from meeting itself, but do not free one that does
        margin = self.offset + 0.6 * self.spacing * (1 + number)
        shell = tighten(shell, self.held, self.skin, margin=margin, spacing=2.0 * self.spacing)
        cage = Cage(self.diagonal * shell.vertices + self.centre, shell.triangles)
        check_inside(cage, self.points)
        clearance, least = mesh_clearance(cage, self.points, self.triangles), self.offset * self.diagonal
        if clearance < least:
            raise ValueError(f"the cage came within {clearance:.4g} m of the mesh, less than {least:.4g} m")
        return cage

    def _wrap(self, offset: float, *, least_alpha: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Wrap the scaled mesh at a distance."""
        alpha = min(max(least_alpha, _ALPHA * offset), _LARGEST_ALPHA)
        return alpha_wrap(*self.broad, alpha=alpha, offset=offset)


def _refuse_strays(cage: Cage, points: np.ndarray, used: np.ndarray) -> None:
    """Raise if points that no triangle uses lie outside the cage."""
    strays = np.setdiff1d(np.arange(len(points)), used)
    strays = strays[~cage.contains(points[strays])]
    if len(strays):
        raise ValueError(
            f"{len(strays)} points of the mesh, the first of them point {strays[0]}, belong to no triangle and lie "
            "outside the cage around the triangles; remove them"
        )


def checked_face_count(face_count: int) -> int:
    """Return a number of faces that a cage may be asked for.

    Raises:
        TypeError: It is not an integer.
        ValueError: It is out of its range.
    """
    return as_index(face_count, "the number of faces", limits=_FACE_COUNTS)


def checked_offset(offset: float) -> float:
    """Return an offset that a cage may be asked for.

    Raises:
        TypeError: It is not a number.
        ValueError: It is out of its range.
    """
    return as_number(offset, "the offset, a share of the diagonal,", limits=_OFFSETS)

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""A coarse cage around a mesh: wrap, decimate, tighten, check.

Section 3 of the paper takes the cage as given. An alpha wrap turns any mesh into a closed shell; decimation makes the
shell coarse, and linear programs make it hold the mesh closely. A narrow shell keeps the shape of thin and knotted
meshes, a wide one has less detail to keep: of the cages that pass every check of :class:`~newton_cagecut.cage.Cage` and
keep their distance from the whole mesh, the smaller is handed on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress

import numpy as np
from scipy.spatial import cKDTree

from ..cage import Cage, check_inside, mesh_clearance
from ..geometry import as_flag, as_index, as_number
from ..surface import Surface
from .broaden import broaden
from .flat_panels import flat_panels, flattened, panel_loops
from .mesh_parts import joined_shells, parts_apart
from .meshlab import alpha_wrap, decimate, import_meshlab
from .sampling import spread_points
from .shell import Shell
from .tighten import tighten
from .wrap_progress import wrap_progress

_FACE_COUNTS = (4, 500)
_OFFSETS = (1e-3, 0.25)
_TRIES = 8
_FIRST_OFFSETS = (0.03, 3.0)  # of the first wide shell that is decimated: of the mesh's diagonal, of the offset
_NARROW = (0.5, 1.0)  # of the narrow shell: its offset, of the wide one's, and its alpha, of its own offset
_CLOSE = (1.3, 12.0)  # volume of a cage, of a close wrap's, with which no other shell is tried; over its faces, more
_WIDER = 1.6  # offset of the next try's shell
_SURPLUS = 1.1  # faces that decimation may leave, of those asked for
_SHARES = (1.0, 0.95, 1.1, 0.9, 0.85)  # of the faces asked for, that decimation is tried with
_ALPHA = 2.0  # size of the wraps' triangles and of the openings that they close, of their offset
_LARGEST_ALPHA = 0.2  # of the mesh's diagonal
_HELD_ALPHA = 0.03  # the least for the wrap that the cage must hold, of the mesh's diagonal
_SPACINGS = (0.004, 0.01)  # between the points that stand for the mesh, of its diagonal
_PANEL_ANGLES = (30.0, 12.0, 3.0)  # between faces that are joined into one; the next where no cage comes of it


def wrap_cage(
    points: np.ndarray,
    triangles: np.ndarray,
    face_count: int = 60,
    *,
    offset: float = 0.01,
    separate: bool = False,
    polygons: bool = False,
    progress: bool | None = None,
) -> Cage:
    """Make a coarse cage that holds a mesh.

    The mesh may be open, in pieces, inside out or crossing itself; holes smaller than a few offsets are closed. Pieces
    that lie apart may get a piece of the cage each. Needs the extra: ``pip install 'newton_cagecut[wrap]'``.

    Args:
        points: Points of the mesh, shape (point_count, 3) [m].
        triangles: Point ids, shape (triangle_count, 3).
        face_count: Faces of the cage, 4 to 500; the cage has at most a tenth more.
        offset: Least distance between the mesh and the cage's faces, of the diagonal of the mesh's bounding box,
            0.001 to 0.25.
        separate: Whether each connected component of the mesh gets a piece of the cage of its own; one that lies in
            another shares it.
        polygons: Whether triangles that lie nearly in a plane are made to, and joined into polygons, so that the cage
            has fewer faces.
        progress: Whether a bar is shown; ``None`` shows one in terminals.

    Returns:
        The cage; its faces are triangles, or polygons where those are wanted.

    Raises:
        ImportError: The extra is not installed.
        TypeError: Something is not a number, or not an integer.
        ValueError: The mesh is no mesh, an argument is out of its range, or no cage was found; the text says which.
    """
    surface = Surface(points, triangles, weld=-1.0)
    face_count, offset = checked_face_count(face_count), checked_offset(offset)
    separate, polygons = as_flag(separate, "separate"), as_flag(polygons, "polygons")
    progress = None if progress is None else as_flag(progress, "progress")
    import_meshlab()
    used, corner = np.unique(surface.triangles, return_inverse=True)
    with wrap_progress(progress) as tick:
        mesh = _Mesh(surface.points[used], corner.reshape(-1, 3), offset, tick)
        if separate:
            mesh.take_apart(face_count)
        cage = mesh.best_cage(face_count, polygons)
    _refuse_strays(cage, surface.points, used)
    return cage


class _Mesh:
    """A mesh to hold, moved to the origin and scaled to a diagonal of 1.

    Args:
        points: Its points, all of them used, shape (point_count, 3) [m].
        triangles: Point ids, shape (triangle_count, 3).
        offset: Least distance of a cage, of the diagonal.
        tick: Called with what is done next.

    Raises:
        ValueError: All points coincide.
    """

    def __init__(self, points: np.ndarray, triangles: np.ndarray, offset: float, tick: Callable[[str], None]):
        low, high = points.min(axis=0), points.max(axis=0)
        self.points, self.triangles, self.offset = points, triangles, offset
        self.centre, self.diagonal = 0.5 * (low + high), float(np.linalg.norm(high - low))
        if self.diagonal == 0.0:
            raise ValueError("all points of the mesh coincide; a cage needs a mesh with an extent")
        self._tick = tick
        self._tick("wrap")
        self.scaled = (points - self.centre) / self.diagonal
        self.parts = [broaden(self.scaled, triangles)]
        self.gap = np.inf
        self.spacing = float(np.clip(0.5 * offset, *_SPACINGS))
        self.skin = cKDTree(spread_points(self.scaled, triangles, self.spacing))
        self.held, held_triangles = self._wrap(
            self.parts[0], offset + min(0.5 * offset, _SPACINGS[1]), least_alpha=_HELD_ALPHA
        )
        self.least_volume = Shell(self.held, held_triangles).volume

    def take_apart(self, face_count: int) -> None:
        """Take the mesh as its components from now on.

        Args:
            face_count: Faces of the cage, of which each needs four.

        Raises:
            ValueError: They are too many for the faces, or two are too near each other.
        """
        self.parts, self.gap = parts_apart(
            self.scaled, self.triangles, offset=self.offset, face_count=face_count, size=self.diagonal
        )
        wraps = [
            self._wrap(part, self.offset + min(0.5 * self.offset, _SPACINGS[1]), least_alpha=_HELD_ALPHA)
            for part in self.parts
        ]
        self.held, self.least_volume = joined_shells(wraps)[0], sum(Shell(*wrap).volume for wrap in wraps)

    def best_cage(self, face_count: int, polygons: bool) -> Cage:
        """Make tries from wide shells until one comes to a cage, and one from a narrow shell if that is far too large.

        Args:
            face_count: Its faces.
            polygons: Whether faces are joined.

        Raises:
            ValueError: All tries came to nothing.
        """
        offset = min(max(_FIRST_OFFSETS[0], _FIRST_OFFSETS[1] * self.offset), 0.4 * self.gap)
        best, reason = None, ""
        for number in range(_TRIES):
            try:
                best = self._try(face_count, offset * _WIDER**number, alpha=_ALPHA, margins=1 + number)
                break
            except ValueError as error:
                reason = str(error)
        if best is None:
            raise ValueError(
                f"no cage of about {face_count} faces was found around the mesh in {_TRIES} tries; in the last one "
                f"{reason}. Allow more faces or another offset"
            )
        close = _CLOSE[0] + _CLOSE[1] / face_count
        if best[1].volume > close * self.least_volume * self.diagonal**3:
            narrow = max(_NARROW[0] * offset, min(1.2 * self.offset, offset))
            with suppress(ValueError):
                best = min(
                    best,
                    self._try(face_count, narrow, alpha=_NARROW[1], margins=1, many=True),
                    key=lambda found: found[1].volume,
                )
        return self._with_polygons(*best) if polygons else best[1]

    def _try(
        self, face_count: int, offset: float, *, alpha: float, margins: int, many: bool = False
    ) -> tuple[Shell, Cage]:
        """Make one try at a cage.

        Args:
            face_count: Its faces.
            offset: Of the shell that is decimated.
            alpha: Of that shell, of its offset.
            margins: Distances that the shell keeps beyond the offset that is asked for, in units of the sampling.
            many: Whether decimation is tried with several numbers of faces.

        Raises:
            ValueError: It came to nothing; the text says how.
        """
        self._tick("shell")
        wraps = [self._wrap(part, offset, alpha=alpha) for part in self.parts]
        shell = _coarse(wraps, face_count, _SHARES if many else _SHARES[:1])
        shell = self._tightened(shell, margin=self.offset + 0.6 * self.spacing * margins)
        return shell, self.checked_cage(shell, shell.triangles)

    def checked_cage(self, shell: Shell, faces: Sequence[Sequence[int]]) -> Cage:
        """Return a shell as a cage around the mesh.

        Args:
            shell: The shell.
            faces: Its faces.

        Raises:
            ValueError: It is no cage, or comes too near to the mesh.
        """
        cage = Cage(self.diagonal * shell.vertices + self.centre, faces)
        check_inside(cage, self.points)
        clearance, least = mesh_clearance(cage, self.points, self.triangles), self.offset * self.diagonal
        if clearance < least:
            raise ValueError(f"the cage came within {clearance:.4g} m of the mesh, less than {least:.4g} m")
        return cage

    def _with_polygons(self, shell: Shell, cage: Cage) -> Cage:
        """Return the cage with faces that are nearly in a plane as one, or as it is."""
        for angle in _PANEL_ANGLES:
            panels = flat_panels(shell, angle)
            try:
                flat = self._tightened(shell, margin=self.offset + 1.2 * self.spacing, panels=panels)
                flat = flattened(flat, panels)
                return self.checked_cage(flat, panel_loops(flat, panels))
            except ValueError:
                continue
        return cage

    def _tightened(self, shell: Shell, *, margin: float, panels: Sequence[np.ndarray] = ()) -> Shell:
        tick = self._tick
        options = {"margin": margin, "spacing": 2.0 * self.spacing}
        return tighten(shell, self.held, self.skin, **options, panels=panels, tick=lambda: tick("tighten"))

    def _wrap(
        self, part: tuple[np.ndarray, np.ndarray], offset: float, *, alpha: float = _ALPHA, least_alpha: float = 0.0
    ) -> tuple[np.ndarray, np.ndarray]:
        """Wrap a part of the scaled mesh at a distance."""
        return alpha_wrap(*part, alpha=min(max(least_alpha, alpha * offset), _LARGEST_ALPHA), offset=offset)


def _coarse(wraps: list[tuple[np.ndarray, np.ndarray]], face_count: int, shares: Sequence[float]) -> Shell:
    """Return a shell of few triangles that does not meet itself, which decimation to one number may and others not."""
    areas = np.array([Shell(*wrap).area for wrap in wraps])
    for share in shares:
        wanted = max(int(share * face_count), 4 * len(wraps))
        counts = 4 + 2 * np.floor(0.5 * (wanted - 4 * len(wraps)) * areas / areas.sum()).astype(int)
        counts = [wanted] if len(wraps) == 1 else counts.tolist()
        shell = Shell(*joined_shells([decimate(*wrap, count) for wrap, count in zip(wraps, counts)]))
        if len(shell.triangles) > _SURPLUS * face_count:
            raise ValueError(f"decimation stopped at {len(shell.triangles)} faces")
        try:  # moves keep a shell from meeting itself, but do not free one that does
            Cage(shell.vertices, shell.triangles)
            return shell
        except ValueError as error:
            reason = error
    raise reason


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

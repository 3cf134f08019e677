# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The scenes that ``python -m newton_cagecut report`` knows by their names: those of Table 1 and the examples."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from assets.bunny import bunny_mesh
from benchmarks.scenes import ASSETS
from benchmarks.scenes import SCENES as PAPER_SCENES
from newton_cagecut import Blade, Cage
from newton_cagecut.report.scenes.scene import PlainScene, Scene
from newton_cagecut.usd import read_cage


def bunny() -> Scene:
    """Newton's bunny, cut behind its neck."""
    cage = read_cage(ASSETS / "bunny_cage.usda")
    points, _ = bunny_mesh()
    blade = Blade((0.033, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0))
    return PlainScene("bunny", cage, np.asarray(points), (blade,))


def gingerbread() -> Scene:
    """The gingerbread man, in the plane, whose belly is slit."""
    from assets.gingerbread import icing

    cage: Cage = read_cage(ASSETS / "gingerbread_cage.usda")
    return PlainScene("gingerbread", cage, icing().vertices, (Blade((0.4, -0.06), (-0.8, 0.03)),))


def _paper_scene(name: str) -> Callable[[], Scene]:
    return lambda: PAPER_SCENES[name]


SCENES: dict[str, Callable[[], Scene]] = {
    **{name: _paper_scene(name) for name in PAPER_SCENES},
    "bunny": bunny,
    "gingerbread": gingerbread,
}
"""What loads each scene, by its name."""

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Small meshes of every kind that users bring: file, cage, body, three cuts, twenty frames, USD, and read back."""

from __future__ import annotations

import newton
import numpy as np
import pytest
from pxr import Sdf, Usd, UsdGeom

import newton_cagecut as cagecut
from cage_shapes import box
from mesh_files import write_obj, write_off, write_ply, write_stl, write_usd
from newton_cagecut.usd import AnimationWriter, validate_animation, write_mesh
from surface_shapes import sphere, torus

CUBE = np.array([[x, y, z] for z in (0.2, 0.8) for y in (0.2, 0.8) for x in (0.2, 0.8)])
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
TRIANGLES = np.array([(a, b, c) for p, q, r, s in QUADS for a, b, c in ((p, q, r), (p, r, s))])


def obj(path, points, faces) -> None:
    """Write an OBJ file."""
    lines = [f"v {' '.join(map(repr, map(float, point)))}" for point in points]
    path.write_text("\n".join([*lines, *("f " + " ".join(str(int(v) + 1) for v in face) for face in faces)]) + "\n")


def instanced(path) -> None:
    """Two instances of a small cube in a stage."""
    write_mesh(path, 0.3 * CUBE, QUADS, name="source")
    stage = Usd.Stage.Open(str(path))
    stage.GetPrimAtPath("/World").SetMetadata("kind", "group")
    UsdGeom.Xform.Define(stage, "/Prototype")
    UsdGeom.Mesh.Define(stage, "/Prototype/mesh")
    source, mesh = (UsdGeom.Mesh(stage.GetPrimAtPath(p)) for p in ("/World/source", "/Prototype/mesh"))
    mesh.CreatePointsAttr(source.GetPointsAttr().Get())
    mesh.CreateFaceVertexCountsAttr(source.GetFaceVertexCountsAttr().Get())
    mesh.CreateFaceVertexIndicesAttr(source.GetFaceVertexIndicesAttr().Get())
    stage.GetPrimAtPath("/Prototype").SetSpecifier(Sdf.SpecifierClass)
    stage.RemovePrim("/World/source")
    for k, place in enumerate(((0.2, 0.3, 0.3), (0.6, 0.3, 0.3))):
        prim = UsdGeom.Xform.Define(stage, f"/World/copy{k}").GetPrim()
        prim.GetInherits().AddInherit("/Prototype")
        prim.SetInstanceable(True)
        UsdGeom.Xformable(prim).AddTranslateOp().Set(place)
    stage.Save()


def fan() -> tuple[np.ndarray, np.ndarray]:
    """Two cubes that share an edge, along which four triangles meet."""
    low = 0.5 * CUBE
    high = low + [0.3, 0.3, 0.0]
    points, place = np.unique(np.round(np.concatenate([low, high]), 9), axis=0, return_inverse=True)
    return points, place.reshape(-1)[np.concatenate([TRIANGLES, TRIANGLES + 8])]


def two_balls() -> tuple[np.ndarray, np.ndarray]:
    """Two spheres apart."""
    one = sphere(1, 0.15, (0.3, 0.5, 0.5))
    points = np.concatenate([one.points, one.points + [0.4, 0, 0]])
    return points, np.concatenate([one.triangles, one.triangles + len(one.points)])


def crossing() -> tuple[np.ndarray, np.ndarray]:
    """Two spheres that cross."""
    one = sphere(1, 0.2, (0.4, 0.5, 0.5))
    points = np.concatenate([one.points, one.points + [0.17, 0.01, 0.02]])
    return points, np.concatenate([one.triangles, one.triangles + len(one.points)])


def made(points, faces):
    """A writer of an OBJ file."""
    return "obj", lambda path: obj(path, points, faces)


BALL, RING = sphere(1, 0.35), torus(12, 6)
CAP = np.arange(8) * np.pi / 4
PRISM = np.concatenate([[[0.5 + 0.3 * np.cos(a), 0.5 + 0.3 * np.sin(a), z] for a in CAP] for z in (0.3, 0.7)])
PRISM_SIDES = [(k, (k + 1) % 8, (k + 1) % 8 + 8, k + 8) for k in range(8)]
PRISM_FACES = [tuple(range(8))[::-1], tuple(range(8, 16)), *PRISM_SIDES]
SPLIT = CUBE[TRIANGLES.reshape(-1)], np.arange(36).reshape(-1, 3)

KINDS = {
    "quads": (*made(CUBE, QUADS), True),
    "polygons": (*made(PRISM, PRISM_FACES), True),
    "seams": (*made(*SPLIT), True),
    "uv splits": ("obj", write_obj, True),
    "off": ("off", write_off, True),
    "ply": ("ply", write_ply, True),
    "stl": ("stl", write_stl, True),
    "usd": ("usda", write_usd, True),
    "instances": ("usda", instanced, True),
    "ring": (*made(RING.points, RING.triangles), True),
    "open": (*made(CUBE, QUADS[:5]), False),
    "fan": (*made(*fan()), True),
    "doubled": (*made(CUBE, [*TRIANGLES, TRIANGLES[3]]), None),
    "degenerate": (*made(np.concatenate([CUBE, [[0.5, 0.5, 0.8]]]), [*TRIANGLES, (4, 4, 7)]), True),
    "components": (*made(*two_balls()), True),
    "crossing": (*made(*crossing()), None),
}
"""Ending and writer of each, and whether it is closed; None for what the library may make of it."""


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("kind", KINDS)
def test_from_a_file_to_a_film(kind, tmp_path):
    """Counts, finite points, closed where it was closed, a valid stage and the same triangles when read back."""
    ending, write, closed = KINDS[kind]
    write(tmp_path / f"mesh.{ending}")
    surface = cagecut.read_mesh(tmp_path / f"mesh.{ending}")
    low, size = surface.points.min(axis=0), np.ptp(surface.points, axis=0).max()
    surface = cagecut.Surface(0.15 + 0.7 * (surface.points - low) / size, surface.triangles)
    if closed is not None:
        assert surface.closed == closed
    builder = newton.ModelBuilder()
    cagecut.SolverCageCut.register_custom_attributes(builder)
    cage = box()
    room = cagecut.Capacity.for_cuts(cage, surface, cuts=4, crossing=True)
    body = cagecut.add_cage_body(builder, cage, surface, walks=8, quadrature=30, capacity=room)
    model = builder.finalize(device="cpu")
    solver, states = cagecut.SolverCageCut(model), [model.state(), model.state()]
    down = (0.0, 0.0, -1.0)
    blades = [
        cagecut.Blade((0.37, 0.0, 2.0), (0.0, 1.0, 0.0), down),
        cagecut.Blade((0.0, 0.41, 2.0), (1.0, 0.0, 0.0), down),
        cagecut.Blade((0.33, 0.0, 2.0), (0.2, 1.0, 0.0), down),
    ]
    film = tmp_path / "film.usda"
    with AnimationWriter(film, fps=30) as writer:
        for frame in range(20):
            if frame % 6 == 0 and frame < 18:
                cut = solver.begin_cut(body, blades[frame // 6])
                length = cut.length
            if frame < 18:
                solver.advance_cut(cut, to=length * (frame % 6 + 1) / 6, states=tuple(states))
            solver.step(states[0], states[1], None, None, dt=1.0 / 300.0)
            states.reverse()
            writer.write_frame(frame, solver, states[0])
    points, triangles = solver.surface(states[0], body)
    assert np.isfinite(points).all()
    assert len(triangles) > len(surface.triangles)
    if closed is not None:
        assert solver.bodies[0].surface.closed == closed
    assert validate_animation(film) == []
    stage, last = Usd.Stage.Open(str(film)), 19
    meshes = [UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
    skins = [mesh for mesh in meshes if mesh.ComputePurpose() != UsdGeom.Tokens.guide]
    counts = [len(mesh.GetFaceVertexCountsAttr().Get(last) or ()) for mesh in skins]
    assert sum(counts) == len(triangles)

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Stages in: a hand-written stage becomes bodies and blades, in metres and with the builder's up axis."""

from __future__ import annotations

from pathlib import Path

import newton
import numpy as np
import pytest
from pxr import Usd, UsdGeom

import newton_cagecut as cagecut
from newton_cagecut.__main__ import main
from newton_cagecut.usd import validate_animation

JELLY = Path(__file__).parent.parent / "assets" / "stages" / "jelly_cut.usda"


def _stage() -> Usd.Stage:
    """The hand-written stage in memory, to be changed."""
    stage = Usd.Stage.CreateInMemory()
    stage.GetRootLayer().TransferContent(Usd.Stage.Open(str(JELLY)).Flatten())
    return stage


def test_hand_written_stage_becomes_a_body():
    """Body, material, cage options and the blade with its track are those that the text says."""
    builder = newton.ModelBuilder()
    scene = cagecut.add_usd(builder, JELLY)
    assert scene.bodies == {"/World/jelly": 0}
    assert (scene.fps, scene.frame_count) == (24.0, 25)
    (track,) = scene.blades
    assert track.path == "/World/knife"
    assert track.depth_at(12.0 / 24.0) == pytest.approx(0.25)
    assert (track.depth_at(0.0), track.depth_at(9.0)) == (0.0, 0.5)
    body = cagecut.SolverCageCut(builder.finalize(device="cpu")).bodies[0]
    assert body.label == "World_jelly"
    assert body.material == cagecut.Material(
        young=2.0e4, poisson=np.float32(0.4), density=1.0e3, damping=np.float32(0.02)
    )
    assert body.coordinates.walks == 64
    assert body.surface_particles is not None


def test_units_and_up_axis_are_honoured():
    """A stage in centimetres with y up gives the body of the same stage in metres with z up."""
    stage = _stage()
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    UsdGeom.SetStageUpAxis(stage, "Y")
    sizes = []
    for source in (JELLY, stage):
        builder = newton.ModelBuilder()
        scene = cagecut.add_usd(builder, source, walks=8)
        solver = cagecut.SolverCageCut(builder.finalize(device="cpu"))
        sizes.append((solver.bodies[0].cage, scene.blades[0], solver.bodies[0].material))
    (cage, blade, material), (small, turned, stiff) = sizes
    x, y, z = 0.01 * cage.vertices.T
    np.testing.assert_allclose(small.vertices, np.stack([x, -z, y], axis=1), atol=1.0e-9)
    np.testing.assert_allclose(turned.depths, 0.01 * blade.depths)
    assert stiff.young == pytest.approx(100.0 * material.young)
    assert stiff.density == pytest.approx(1.0e6 * material.density)


def _remove(path: str):
    return lambda stage: stage.RemovePrim(path)


def _set(path: str, name: str, value: object):
    return lambda stage: stage.GetPrimAtPath(path).GetAttribute(name).Set(value)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (_remove("/World/jelly/cage"), "no cage bodies"),
        (_remove("/World/jelly/skin"), "/World/jelly must have one mesh to render beside its cage, it has none"),
        (
            _set("/World/gelatine", "physics:poissonsRatio", 0.7),
            "/World/jelly: its material /World/gelatine: Material poisson is 0.69",
        ),
        (_set("/World/jelly/cage", "cagecut:walks", -3), "/World/jelly: .*walks"),
        (
            lambda stage: (
                stage.GetPrimAtPath("/World/knife").GetRelationship("cagecut:body").SetTargets(["/World/knife"])
            ),
            "/World/knife: cagecut:body must name one of the cage bodies /World/jelly, it names /World/knife",
        ),
        (
            lambda stage: stage.GetPrimAtPath("/World/knife").RemoveProperty("cagecut:depth"),
            "/World/knife has no track",
        ),
        (
            lambda stage: stage.GetPrimAtPath("/World/jelly").ClearMetadata("apiSchemas"),
            "/World/jelly/cage is a cage, but no prim above it has PhysicsDeformableBodyAPI",
        ),
    ],
)
def test_what_is_wrong_is_named_by_its_prim(change, message: str):
    """Each wrong or missing thing is refused with the path of its prim."""
    stage = _stage()
    change(stage)
    with pytest.raises(ValueError, match=message):
        cagecut.add_usd(newton.ModelBuilder(), stage)


def test_run_cuts_and_writes(tmp_path: Path, capsys: pytest.CaptureFixture):
    """The command simulates the stage, its blade cuts it through, and the animation is valid USD."""
    out = tmp_path / "out.usda"
    command = ["run", str(JELLY), "-o", str(out), "--frames", "22", "--walks", "8", "--device", "cpu"]
    assert main(command) == 0
    assert "22 frames" in capsys.readouterr().out
    validate_animation(out)
    stage = Usd.Stage.Open(str(out))
    mesh = stage.GetPrimAtPath("/World/World_jelly/skin")
    counts = mesh.GetAttribute("faceVertexCounts")
    assert len(counts.GetTimeSamples()) > 10
    assert len(counts.Get(21)) > len(counts.Get(0))
    assert main([*command[:5], "0"]) == 1
    assert "--frames must be at least 1" in capsys.readouterr().err

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Materials that any USD renderer knows."""

from __future__ import annotations

from pxr import Sdf, Usd, UsdShade

from .layers import color


def bind_material(prim: Usd.Prim, diffuse: tuple[float, float, float], *, roughness: float = 0.55) -> None:
    """Make a UsdPreviewSurface of one colour, named after the prim, and bind it to the prim or subset.

    Args:
        prim: A mesh or a subset of one, two or more levels below the root.
        diffuse: Linear RGB.
        roughness: 0 for a mirror, 1 for chalk.
    """
    stage = prim.GetStage()
    stage.DefinePrim("/World/materials", "Scope")
    name = "_".join(str(prim.GetPath()).split("/")[2:])
    material = UsdShade.Material.Define(stage, f"/World/materials/{name}")
    shader = UsdShade.Shader.Define(stage, material.GetPath().AppendChild("surface"))
    shader.CreateIdAttr("UsdPreviewSurface")
    shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set(color(diffuse))
    shader.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(roughness)
    output = shader.CreateOutput("surface", Sdf.ValueTypeNames.Token)
    material.CreateSurfaceOutput().ConnectToSource(output)
    UsdShade.MaterialBindingAPI.Apply(prim).Bind(material)

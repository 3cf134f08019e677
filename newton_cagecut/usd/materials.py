# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Materials that any USD renderer knows."""

from __future__ import annotations

from pxr import Sdf, Usd, UsdShade

from .layers import color


def bind_material(
    prim: Usd.Prim, diffuse: tuple[float, float, float], *, roughness: float = 0.55, texture: str | None = None
) -> None:
    """Make a UsdPreviewSurface, named after the prim, and bind it to the prim or subset.

    Args:
        prim: A mesh or a subset of one, two or more levels below the root.
        diffuse: Linear RGB, where the texture does not say another.
        roughness: 0 for a mirror, 1 for chalk.
        texture: A picture that ``primvars:st`` lays over the prim, and repeats; as USD resolves paths.
    """
    stage = prim.GetStage()
    stage.DefinePrim("/World/materials", "Scope")
    name = "_".join(str(prim.GetPath()).split("/")[2:])
    material = UsdShade.Material.Define(stage, f"/World/materials/{name}")
    shader = _shader(material, "surface", "UsdPreviewSurface")
    shader.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(roughness)
    base = shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f)
    base.Set(color(diffuse))
    if texture is not None:
        base.ConnectToSource(_texture(material, texture))
    material.CreateSurfaceOutput().ConnectToSource(shader.CreateOutput("surface", Sdf.ValueTypeNames.Token))
    UsdShade.MaterialBindingAPI.Apply(prim).Bind(material)


def _texture(material: UsdShade.Material, path: str) -> UsdShade.Output:
    """Return the colour of a picture at ``primvars:st``."""
    reader = _shader(material, "st", "UsdPrimvarReader_float2")
    reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set("st")
    picture = _shader(material, "texture", "UsdUVTexture")
    picture.CreateInput("file", Sdf.ValueTypeNames.Asset).Set(path)
    for axis in ("wrapS", "wrapT"):
        picture.CreateInput(axis, Sdf.ValueTypeNames.Token).Set("repeat")
    place = reader.CreateOutput("result", Sdf.ValueTypeNames.Float2)
    picture.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(place)
    return picture.CreateOutput("rgb", Sdf.ValueTypeNames.Float3)


def _shader(material: UsdShade.Material, name: str, kind: str) -> UsdShade.Shader:
    """Return a new shader of a material."""
    shader = UsdShade.Shader.Define(material.GetPrim().GetStage(), material.GetPath().AppendChild(name))
    shader.CreateIdAttr(kind)
    return shader

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Tests of elastic materials: validation and constants."""

import dataclasses

import pytest

from newton_cagecut.elastic import Material


def test_lame_constants():
    """Lame's constants give back Young's modulus and Poisson's ratio."""
    mu, lam = Material(young=2.0e5, poisson=0.3).lame
    assert mu * (3.0 * lam + 2.0 * mu) / (lam + mu) == pytest.approx(2.0e5)
    assert lam / (2.0 * (lam + mu)) == pytest.approx(0.3)


def test_defaults_are_neo_hookean_and_frozen():
    """Users get the stable neo-Hookean model, and cannot change a material in place."""
    material = Material()
    assert material.model == "neo_hookean"
    with pytest.raises(dataclasses.FrozenInstanceError):
        material.young = 1.0


@pytest.mark.parametrize(
    ("field", "value"),
    [("young", 0.0), ("young", float("nan")), ("poisson", 0.5), ("poisson", -1.0), ("poisson", -0.9), ("density", -1.0)]
    + [("damping", -0.1), ("damping", float("inf")), ("model", "corotated")],
)
def test_out_of_range_is_refused(field, value):
    """A constant out of range is refused with its name and value."""
    with pytest.raises(ValueError, match=rf"Material {field} .*{value}"):
        Material(**{field: value})


def test_wrong_type_is_refused():
    """A constant that is no number is refused."""
    with pytest.raises(TypeError, match="Material young"):
        Material(young="stiff")


def test_strongly_auxetic_material_is_refused_with_a_way_out():
    """A Poisson's ratio at which the neo-Hookean body could stay squeezed is refused; other models take it."""
    with pytest.raises(ValueError, match="squeezed body can stay squeezed. Use 'corotational'"):
        Material(poisson=-0.86)
    assert Material(poisson=-0.86, model="corotational").lame[1] < 0.0

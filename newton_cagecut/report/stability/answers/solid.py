# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Small deformations of bodies made of boxes, by triquadratic hexahedra of scikit-fem."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ....elastic import Material
from ..shapes import Blocks

_INTEGRATION = 4


class Solid:
    """A body of triquadratic hexahedra.

    Args:
        blocks: Its shape.
        material: Young's modulus and Poisson's ratio are those of the elements.
        spacing: Longest edge of an element [m].
    """

    def __init__(self, blocks: Blocks, material: Material, spacing: float) -> None:
        from skfem import Basis, ElementHex2, ElementVector, MeshHex
        from skfem.models.elasticity import lame_parameters, linear_elasticity

        axes = [_refined(axis, spacing) for axis in blocks.axes]
        mesh = MeshHex.init_tensor(*axes)
        outside = ~blocks.contains(mesh.p[:, mesh.t].mean(axis=1).T)
        mesh = mesh.remove_elements(np.flatnonzero(outside))
        self._basis = Basis(mesh, ElementVector(ElementHex2()), intorder=_INTEGRATION)
        constants = lame_parameters(material.young, material.poisson)
        self._stiffness = linear_elasticity(*constants).assemble(self._basis)

    def solve(
        self,
        held: Callable[[np.ndarray], np.ndarray],
        *,
        moved: Callable[[np.ndarray], np.ndarray] | None = None,
        loaded: Callable[[np.ndarray], np.ndarray] | None = None,
        traction: tuple[float, float, float] = (0.0, 0.0, 0.0),
    ) -> Displacement:
        """Displacements at rest.

        Args:
            held: Tells from positions (3, n) [m] which components (3, n) are prescribed.
            moved: Gives the prescribed displacements (3, n) [m]; 0 without it.
            loaded: Tells from the middles of facets (3, n) [m] which are loaded.
            traction: The load [N/m^2].
        """
        from skfem import FacetBasis, LinearForm, condense, solve

        basis = self._basis
        places = basis.doflocs
        components = _components(basis)
        prescribed = np.flatnonzero(held(places)[components, np.arange(basis.N)])
        values = np.zeros(basis.N)
        if moved is not None:
            values[prescribed] = moved(places[:, prescribed])[components[prescribed], np.arange(len(prescribed))]
        load = np.zeros(basis.N)
        if loaded is not None:
            facets = basis.mesh.facets_satisfying(loaded, boundaries_only=True)
            form = LinearForm(lambda v, w: sum(traction[axis] * v[axis] for axis in range(3)))
            load = form.assemble(FacetBasis(basis.mesh, basis.elem, facets=facets))
        solution = solve(*condense(self._stiffness, load, x=values, D=prescribed))
        return Displacement(places, components, solution, float(0.5 * solution @ (self._stiffness @ solution)))


class Displacement:
    """A solution.

    Args:
        places: Positions of the unknowns (3, n) [m].
        components: Their components (n,).
        values: Their values (n,) [m].
        energy: Elastic energy [J].
    """

    def __init__(self, places: np.ndarray, components: np.ndarray, values: np.ndarray, energy: float) -> None:
        self.energy = energy
        self._places, self._components, self._values = places.T, components, values

    def mean(self, corners: np.ndarray, axis: int) -> float:
        """Mean of a component at some nodes [m].

        Args:
            corners: Their positions [m], shape (n, 3).
            axis: The component.
        """
        rows = np.flatnonzero(self._components == axis)
        found = [np.linalg.norm(self._places[rows] - corner, axis=1).argmin() for corner in corners]
        return float(self._values[rows][found].mean())


def _components(basis: object) -> np.ndarray:
    """The component of each unknown."""
    found = np.empty(basis.N, dtype=int)
    for rows in (basis.nodal_dofs, basis.edge_dofs, basis.facet_dofs, basis.interior_dofs):
        for axis in range(3):
            found[rows[axis]] = axis
    return found


def _refined(axis: np.ndarray, spacing: float) -> np.ndarray:
    """An axis with stations between, no farther apart than the spacing."""
    parts = [
        np.linspace(a, b, max(1, round((b - a) / spacing)) + 1)[:-1] for a, b in zip(axis[:-1], axis[1:], strict=True)
    ]
    return np.append(np.concatenate(parts), axis[-1])

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Work of loads on bodies that lock, over that of P2 finite elements: the table of ``docs/locking.md``.

``python -m benchmarks locking [SET ...]``; the columns hold Poisson's ratios 0.3, 0.45 and 0.499. Needs scikit-fem.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence

import numpy as np
import skfem
from scipy.sparse.linalg import splu
from skfem.helpers import ddot, dot, sym_grad, trace

from newton_cagecut import Cage, HarmonicCoordinates
from newton_cagecut.elastic import sample_quadrature
from newton_cagecut.elastic.averaging import softened_moduli, strain_rows

from .locking_shapes import SETS, Shape, extruded

POISSON = (0.3, 0.45, 0.499)
_YOUNG = 1.0e6


def lame(poisson: float) -> tuple[float, float]:
    """Lame's constants [Pa]."""
    return _YOUNG / 2.0 / (1.0 + poisson), _YOUNG * poisson / (1.0 + poisson) / (1.0 - 2.0 * poisson)


def elements(shape: Shape, parts: int = 2) -> dict[float, dict[str, float]]:
    """Work of each load at each Poisson's ratio by P2 finite elements [J]; every quad is divided into parts squared."""
    mesh = _tetrahedra(shape, parts)
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementTetP2()), intorder=2)
    held = basis.get_dofs(mesh.facets_satisfying(shape.held, boundaries_only=True)).all()
    loaded = mesh.facets_satisfying(shape.loaded, boundaries_only=True)
    ends = skfem.FacetBasis(mesh, basis.elem, facets=loaded, intorder=4)
    free = np.setdiff1d(np.arange(basis.N), held)
    forces = {
        name: skfem.LinearForm(lambda v, w, load=load: dot(load(w.x), v)).assemble(ends)[free]
        for name, load in shape.loads.items()
    }
    shear = skfem.BilinearForm(lambda u, v, w: 2.0 * ddot(sym_grad(u), sym_grad(v))).assemble(basis)
    bulk = skfem.BilinearForm(lambda u, v, w: trace(sym_grad(u)) * trace(sym_grad(v))).assemble(basis)
    result = {}
    for poisson in POISSON:
        mu, lam = lame(poisson)
        matrix = (mu * shear + lam * bulk)[free][:, free].tocsc()
        options = {"SymmetricMode": True}
        factors = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
        result[poisson] = {name: float(force @ factors.solve(force)) for name, force in forces.items()}
    return result


def _tetrahedra(shape: Shape, parts: int) -> skfem.MeshTet:
    """Boxes over the parts of the quads, each divided about its middle and those of its faces."""
    lengths = [np.linalg.norm(np.diff(shape.points[list(quad)], axis=0), axis=1).min() for quad in shape.quads]
    layers = max(2, round((shape.depth[1] - shape.depth[0]) / np.median(lengths) * parts))
    numbers, points, tetrahedra = {}, [], []

    def number(point: np.ndarray) -> int:
        key = tuple(np.round(point, 9) + 0.0)
        if key not in numbers:
            numbers[key] = len(points)
            points.append(point)
        return numbers[key]

    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)])
    sides = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
    for quad in shape.quads:
        for cell in np.ndindex(parts, parts, layers):
            u, v, t = ((corners + cell) / (parts, parts, layers)).T
            flat = np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=1) @ shape.points[list(quad)]
            box = np.insert(flat, 1, shape.depth[0] + (shape.depth[1] - shape.depth[0]) * t, axis=1)
            ids, middle = [number(point) for point in box], number(box.mean(axis=0))
            for side in sides:
                center = number(box[list(side)].mean(axis=0))
                tetrahedra += [(middle, center, ids[a], ids[b]) for a, b in zip(side, side[1:] + side[:1], strict=True)]
    return skfem.MeshTet(np.array(points).T, np.array(tetrahedra).T)


def bodies(shape: Shape, *, refined: bool = False, walks: int = 0) -> tuple[dict, dict]:
    """Work of each load at each Poisson's ratio [J], of the body and of the one whose strain is not averaged."""
    cage = Cage(*extruded(shape))
    cage = cage.refine() if refined else cage
    vertices, count = np.array(cage.vertices), max(300, 8 * cage.vertex_count)
    points, volumes = sample_quadrature(cage, count)
    coords = HarmonicCoordinates(
        cage, points, walks, gradients=True, correction="harmonic" if walks else "fitted", cuttable=False
    )
    weights, gradients = np.asarray(coords.weights, float), np.asarray(coords.gradients, float)
    rows = strain_rows(
        vertices, weights, gradients, volumes, np.zeros(len(vertices), int), count + max(len(vertices) // 3, 1)
    )
    grams = [_gram(rows.gradients[count + k][None], rows.volumes[count + k][None]) for k in range(len(rows.fields))]
    inside = [
        _gram(rows.gradients[own], rows.volumes[own]) - gram
        for k, gram in enumerate(grams)
        for own in [np.flatnonzero((rows.clusters[:count] == k) & (rows.volumes[:count] > 0.0))]
    ]
    plain, free = _gram(gradients, volumes), np.flatnonzero(np.repeat(~shape.held(vertices.T), 3))
    forces, result, before = _forces(shape, vertices, cage.faces), {}, {}
    for poisson in POISSON:
        constants = lame(poisson)
        total = _matrix(sum(grams), *constants)
        for gram, fields in zip(inside, rows.fields, strict=True):
            total = total + _matrix(gram, *softened_moduli(*constants, fields))
        for matrix, works in ((total, result), (_matrix(plain, *constants), before)):
            works[poisson] = {
                name: float(force[free] @ np.linalg.solve(matrix[np.ix_(free, free)], force[free]))
                for name, force in forces.items()
            }
    return result, before


def _gram(gradients: np.ndarray, volumes: np.ndarray) -> np.ndarray:
    return np.einsum("qia,qjb->ijab", volumes[:, None, None] * gradients, gradients, optimize=True)


def _matrix(gram: np.ndarray, mu: float, lam: float) -> np.ndarray:
    count = 3 * len(gram)
    matrix = lam * gram + mu * (np.einsum("ijcc,ab->ijab", gram, np.eye(3)) + gram.transpose(0, 1, 3, 2))
    return matrix.transpose(0, 2, 1, 3).reshape(count, count)


def _forces(shape: Shape, vertices: np.ndarray, faces) -> dict[str, np.ndarray]:
    """Forces on the vertices, by bilinear functions on the loaded faces."""
    result, nodes = {name: np.zeros_like(vertices) for name in shape.loads}, 0.5 + np.array([-1, 1]) / np.sqrt(12.0)
    for face in map(list, faces):
        if not shape.loaded(vertices[face].T).all():
            continue
        for u, v in ((u, v) for u in nodes for v in nodes):
            values = np.array([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v])
            sides = np.array([[v - 1, 1 - v, v, -v], [u - 1, -u, u, 1 - u]]) @ vertices[face]
            size, place = np.linalg.norm(np.cross(*sides)) / 4.0, values @ vertices[face]
            for name, load in shape.loads.items():
                result[name][face] += size * np.outer(values, load(place))
    return {name: force.ravel() for name, force in result.items()}


def main(arguments: Sequence[str]) -> None:
    """Print the table of the named sets, all if none is named."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks locking", description=__doc__)
    parser.add_argument("sets", nargs="*", help=f"sets of shapes, of {', '.join(SETS)}; all by default")
    chosen = parser.parse_args(arguments).sets or list(SETS)
    print(f"| set | body | load | {' | '.join(map(str, POISSON))} | before | after `refine()` | before |")
    print("| --- " * (6 + len(POISSON)) + "|")
    for name in chosen:
        for shape in SETS[name]:
            exact = elements(shape)
            small = len(shape.points) <= 40
            found = [bodies(shape), bodies(shape, refined=True)] if small else [bodies(shape)]
            for load in shape.loads:
                columns = [[works[p][load] / exact[p][load] for p in POISSON] for pair in found for works in pair]
                cells = [" ".join(f"{value:.2f}" for value in column) for column in columns]
                first = " | ".join(f"{value:.2f}" for value in columns[0])
                print("| " + " | ".join([name, shape.name, load, first, *cells[1:], *[""] * (4 - len(cells))]) + " |")

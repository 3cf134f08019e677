# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""What a body's motion keeps when an edit changes its shape functions.

Where vertices keep their places and velocities, the strain and the velocity at the quadrature points change with the
shape functions, and a stretched body gains energy. So the free vertices take those places whose displacement has the
gradient nearest to what it was at the points, by volume, and those velocities which are nearest there, by mass. Both
are projections: of strains that are linear, and of velocities, the energy cannot grow; and a motion that the new shape
functions have too, a rigid one above all, stays as it is. What is left is made exact:

- the centre of mass, the momentum and the angular momentum of every piece that nothing holds, by a rigid motion of all
  that it was cut into;
- kinetic energy above what there was is taken from the motion beside the rigid one of each piece;
- elastic energy above what there was is relaxed: the body moves from standstill for the shortest of a row of times
  after which it has no more than before, and takes the places of then;
- elastic energy below what there was is filled up as far as places between these and the inherited ones have it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import newton
import numpy as np
import warp as wp

from ...harmonic import Journal
from ..body.simulated_body import SimulatedBody

_HELD = 1.0e-9
"""Weight of the mass beside the gradients: it decides what these leave open."""

_RISE = 1.0e-7
"""Share of the elastic energy that is no rise but rounding."""

_ROUNDING = 1.0e-7
"""Strain of which the energy is rounding."""

_FILLED, _SECANTS = 1.0e-3, 4
"""Share of the elastic energy whose loss is left alone, and how many shares of the way are tried against it."""

_SHORTEST, _DOUBLINGS = 0.05, 10
"""Shortest time of relaxation, in which a wave goes this far through a cell, and how often it is doubled at most."""


class _Shapes(NamedTuple):
    """Shape functions of the vertices in use at the quadrature points."""

    weights: np.ndarray
    gradients: np.ndarray
    volumes: np.ndarray
    mass: np.ndarray


class _Kept(NamedTuple):
    """What a state keeps: fields at the points, and moments and momenta of each piece before the edit."""

    gradients: np.ndarray
    velocities: np.ndarray
    moments: np.ndarray
    momenta: np.ndarray
    spins: np.ndarray
    elastic: float
    kinetic: float


class MotionFit:
    """The motion of a body's states, read before an edit, to be fitted after it.

    Args:
        body: The body, before the edit.
        states: Its states.
    """

    def __init__(self, body: SimulatedBody, states: Sequence[newton.State]) -> None:
        self._body, self._states = body, states
        self._piece = body.cage.vertex_piece
        self._free = _free_pieces(self._piece, body.fixed.numpy()[: len(self._piece)])
        self._centers = body.to_world(_piece_means(body.cage.vertices, self._piece))
        shapes = self._shapes() if states and body.system is not None else None
        self._used = shapes.volumes > 0.0 if shapes else None
        self._kept = [self._read(state, shapes) for state in states] if shapes else []

    def apply(self, piece_before: np.ndarray, journal: Journal) -> None:
        """Fit the states to the body's new shape functions; the vertices have places and velocities to start from.

        Args:
            piece_before: The piece that each vertex belonged to, or came from, before the edit, shape (vertex_count,).
            journal: The edit's journal.
        """
        if not self._kept:
            return
        shapes = self._shapes()
        for state, kept in zip(self._states, self._kept, strict=True):
            inherited = self._rows(state.particle_q) - self._rest()
            displacement = self._fitted_displacement(inherited, kept, shapes, piece_before)
            self._write(state.particle_q, self._rest() + displacement)
            self._relax(state, kept, journal)
            self._fill(state, kept, self._centred(inherited, kept, shapes, piece_before))
            self._write(state.particle_qd, self._fitted_velocity(state, kept, shapes, piece_before))

    def _read(self, state: newton.State, shapes: _Shapes) -> _Kept:
        positions, velocity = self._rows(state.particle_q), self._rows(state.particle_qd)
        displacement = positions - self._rest()
        momentum = shapes.mass @ velocity
        pieces = range(len(self._centers))
        spins = [_spin(positions - self._centers[p], momentum, self._piece == p) for p in pieces]
        return _Kept(
            gradients=_gradient(displacement, self._piece, shapes),
            velocities=shapes.weights @ velocity,
            moments=_sums(shapes.mass @ displacement, self._piece),
            momenta=_sums(momentum, self._piece),
            spins=np.array(spins),
            elastic=self._elastic(state),
            kinetic=_kinetic(shapes.mass, velocity),
        )

    def _fitted_displacement(
        self, inherited: np.ndarray, kept: _Kept, shapes: _Shapes, piece_before: np.ndarray
    ) -> np.ndarray:
        body, (_, gradients, volumes, mass) = self._body, shapes
        piece, free = body.cage.vertex_piece, self._movable()
        displacement = inherited.copy()
        missing = kept.gradients - _gradient(displacement, piece, shapes)
        missing[~self._used] = 0.0
        ties = body.system.stabilizing_stiffness.numpy()[: len(piece), : len(piece)].astype(float)
        matrix = np.einsum("q,qia,qja->ij", volumes, gradients, gradients, optimize=True) + ties
        wanted = np.einsum("q,qca,qja->jc", volumes, missing, gradients, optimize=True) - ties @ displacement
        matrix += (_HELD * np.trace(matrix) / np.trace(mass)) * mass
        displacement[free] += np.linalg.solve(matrix[np.ix_(free, free)], wanted[free])
        return self._centred(displacement, kept, shapes, piece_before)

    def _centred(self, displacement: np.ndarray, kept: _Kept, shapes: _Shapes, piece_before: np.ndarray) -> np.ndarray:
        """Displacements with the centre of mass that each piece had, of those that nothing holds."""
        displacement = displacement.copy()
        for p in np.flatnonzero(self._free):
            rows = piece_before == p
            total = shapes.mass[rows].sum()
            displacement[rows] += (kept.moments[p] - (shapes.mass[rows] @ displacement).sum(axis=0)) / total
        return displacement

    def _fitted_velocity(
        self, state: newton.State, kept: _Kept, shapes: _Shapes, piece_before: np.ndarray
    ) -> np.ndarray:
        positions, velocity = self._rows(state.particle_q), self._rows(state.particle_qd)
        weights, mass, free = shapes.weights, shapes.mass, self._movable()
        missing = kept.velocities - weights @ velocity
        missing[~self._used] = 0.0
        density = self._body.definition.material.density
        wanted = weights.T @ (density * shapes.volumes[:, None] * missing)
        velocity[free] += np.linalg.solve(mass[np.ix_(free, free)], wanted[free])
        for p in np.flatnonzero(self._free):
            rows, places = piece_before == p, positions - self._centers[p]
            velocity += _rigid(mass, places, kept.momenta[p], kept.spins[p], rows, before=velocity)
        return self._calmed(mass, positions, velocity, kept.kinetic)

    def _calmed(self, mass: np.ndarray, positions: np.ndarray, velocity: np.ndarray, kinetic: float) -> np.ndarray:
        """Velocities whose kinetic energy is no more than a given one, with the same rigid motion of every piece."""
        if _kinetic(mass, velocity) <= kinetic:
            return velocity
        piece, rigid = self._body.cage.vertex_piece, np.zeros_like(velocity)
        momentum = mass @ velocity
        for p in np.flatnonzero(_free_pieces(piece, self._body.fixed.numpy()[: len(piece)])):
            rows = piece == p
            places = positions - positions[rows].mean(axis=0)
            rigid += _rigid(mass, places, momentum[rows].sum(axis=0), _spin(places, momentum, rows), rows)
        beside, least = velocity - rigid, _kinetic(mass, rigid)
        most = _kinetic(mass, beside)
        share = math.sqrt(min(max(kinetic - least, 0.0) / most, 1.0)) if most > 0.0 else 1.0
        return rigid + share * beside

    def _rounding(self) -> float:
        """Elastic energy that is rounding."""
        mu, lam = self._body.definition.material.lame
        return (lam + 2.0 * mu) * float(self._body.system.volumes.numpy().sum()) * _ROUNDING**2

    def _fill(self, state: newton.State, kept: _Kept, inherited: np.ndarray) -> None:
        """Go towards the inherited places as far as there is no more elastic energy than there was.

        A convex energy lies below its secants, so that a share found by a secant has none too much.
        """
        least = self._elastic(state)
        if kept.elastic - least <= _FILLED * kept.elastic + self._rounding():
            return
        rest, places = self._rest(), self._rows(state.particle_q)
        way, share = inherited - (places - rest), 1.0
        for _ in range(_SECANTS):
            self._write(state.particle_q, places + share * way)
            elastic = self._elastic(state)
            if least < elastic <= kept.elastic:
                return
            if elastic <= least:
                break
            share *= (kept.elastic - least) / (elastic - least)
        self._write(state.particle_q, places)

    def _relax(self, state: newton.State, kept: _Kept, journal: Journal) -> None:
        """Take off what elastic energy there is above what there was."""
        body, system = self._body, self._body.system
        allowed = kept.elastic * (1.0 + _RISE) + self._rounding()
        if self._elastic(state) <= allowed:
            return
        record = (system.record.counts, system.record.residuals)
        journal.keep(*record)
        counted = [wp.clone(array) for array in record]
        places = state.particle_q[body.vertices]
        moved, still = wp.clone(places), wp.zeros_like(places)
        gravity = wp.zeros(1, dtype=wp.vec3, device=body.device)
        edges = body.cage.vertices[body.cage.mesh.edges]
        cell = float(np.median(np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1)))
        mu, lam = body.definition.material.lame
        time = _SHORTEST * cell * math.sqrt(body.definition.material.density / (lam + 2.0 * mu))
        least, best = math.inf, None
        for _ in range(_DOUBLINGS):
            system.step(places, still, moved, wp.zeros_like(still), time, gravity=gravity)
            elastic = system.energy(moved, still).elastic
            if elastic < least:
                least, best = elastic, wp.clone(moved)
            if elastic <= allowed:
                break
            time *= 2.0
        for array, values in zip(record, counted, strict=True):
            wp.copy(array, values)
        if best is not None:
            wp.copy(places, best)

    def _shapes(self) -> _Shapes:
        system, count = self._body.system, self._body.cage.vertex_count
        arrays = (system.weights.numpy()[:, :count], system.gradients.numpy()[:, :count], system.volumes.numpy())
        return _Shapes(*(a.astype(float) for a in arrays), system.mass.numpy()[:count, :count].astype(float))

    def _movable(self) -> np.ndarray:
        return np.flatnonzero(self._body.fixed.numpy()[: self._body.cage.vertex_count] == 0)

    def _rest(self) -> np.ndarray:
        return self._body.rest.numpy()[: self._body.cage.vertex_count].astype(float)

    def _rows(self, field: wp.array) -> np.ndarray:
        return field[self._body.vertices].numpy()[: self._body.cage.vertex_count].astype(float)

    def _write(self, field: wp.array, values: np.ndarray) -> None:
        array = field[self._body.vertices]
        rows = array.numpy().copy()
        rows[: len(values)] = values
        array.assign(rows)

    def _elastic(self, state: newton.State) -> float:
        vertices = self._body.vertices
        return self._body.system.energy(state.particle_q[vertices], state.particle_qd[vertices]).elastic


def _gradient(displacement: np.ndarray, piece: np.ndarray, shapes: _Shapes) -> np.ndarray:
    """Gradients of displacements at the points; what a piece has as a whole is taken off before, for its digits."""
    relative = displacement - _piece_means(displacement, piece)[piece]
    return np.einsum("jc,qja->qca", relative, shapes.gradients, optimize=True)


def _piece_means(values: np.ndarray, piece: np.ndarray) -> np.ndarray:
    """Mean of values of each piece's vertices."""
    return _sums(values, piece) / np.bincount(piece)[:, None]


def _sums(values: np.ndarray, piece: np.ndarray) -> np.ndarray:
    """Sums of values over each piece's vertices."""
    return np.stack([np.bincount(piece, column) for column in values.T], axis=1)


def _free_pieces(piece: np.ndarray, fixed: np.ndarray) -> np.ndarray:
    """Whether nothing holds each piece."""
    return np.bincount(piece, fixed != 0) == 0


def _kinetic(mass: np.ndarray, velocity: np.ndarray) -> float:
    return 0.5 * float((velocity * (mass @ velocity)).sum())


def _spin(places: np.ndarray, momentum: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Angular momentum of some vertices about the origin of their places."""
    return np.cross(places[rows], momentum[rows]).sum(axis=0)


def _rigid(
    mass: np.ndarray,
    places: np.ndarray,
    momentum: np.ndarray,
    spin: np.ndarray,
    rows: np.ndarray,
    *,
    before: np.ndarray | None = None,
) -> np.ndarray:
    """Velocities of a rigid motion of some vertices, zero of the others, that has, with those before, given momenta."""
    carried = mass @ before if before is not None else np.zeros_like(places)
    vertex_mass = mass[:, rows].sum(axis=1)[rows]
    total = vertex_mass.sum()
    center = vertex_mass @ places[rows] / total
    missing = momentum - carried[rows].sum(axis=0)
    turning = spin - _spin(places, carried, rows) - np.cross(center, missing)
    arms = places[rows] - center
    second = arms.T @ mass[np.ix_(rows, rows)] @ arms
    inertia = np.trace(second) * np.eye(3) - 0.5 * (second + second.T)
    rate = np.linalg.lstsq(inertia, turning, rcond=1.0e-10)[0]
    velocity = np.zeros_like(places)
    velocity[rows] = missing / total + np.cross(rate, arms)
    return velocity

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The mean of long runs with seeds of their own, its own error, and a check against plain Monte Carlo.

The long runs have other seeds, more walks and a smaller shell than what is measured. Their own squared error follows
from how they differ. Control variates are unbiased only to the order of 1 / walks, so the mean is compared with that of
plain runs, again with other seeds: the squared difference over what both errors lead to expect is 1 but for chance.
"""

from __future__ import annotations

import zipfile
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import warp as wp

from ...cage import Cage
from ...harmonic import HarmonicCoordinates

_SEED = 1000  # the long runs' seeds start here
_PLAIN_SEED = 2000
_PLAIN_SHARE = 4  # as many times fewer walks have the plain runs
_EPSILON = 1e-5


@dataclass(frozen=True)
class Reference:
    """Weights and gradients, and how well they are known.

    Attributes:
        vertices: The cage's vertices [m], shape (v, dimension).
        weights: Weights, shape (n, v).
        gradients: Gradients [1/m] of the points that have them, shape (m, v, dimension).
        own_weights: Estimated squared error of the weights themselves, mean over the points of the sum over vertices.
        own_gradients: The same of the gradients, relative to their mean square.
        own_surface: The same of the deformed points, relative to the square of the cage's diameter.
        check: Squared difference from plain runs over what is expected of it, of the weights and of the gradients.
    """

    vertices: np.ndarray
    weights: np.ndarray
    gradients: np.ndarray
    own_weights: float
    own_gradients: float
    own_surface: float
    check: np.ndarray

    def squared_errors(self, weights: np.ndarray, gradients: np.ndarray) -> dict[str, float]:
        """Return mean squared errors over the points: of weights, gradients (relative) and deformed points (relative).

        Args:
            weights: Weights, shape (n, v).
            gradients: Gradients, shape (m, v, dimension).
        """
        difference = weights - self.weights
        moved = difference @ bent(self.vertices)
        return {
            "weights": _mean_square(difference),
            "gradients": _mean_square(gradients - self.gradients) / _mean_square(self.gradients),
            "surface": _mean_square(moved) / _diameter(self.vertices) ** 2,
        }

    @property
    def own(self) -> dict[str, float]:
        """Squared errors of the reference itself, as :meth:`squared_errors` has those against it."""
        return {"weights": self.own_weights, "gradients": self.own_gradients, "surface": self.own_surface}

    def save(self, path: Path) -> None:
        """Write it to a file, whole or not at all."""
        part = path.with_name(f".{path.name}")
        np.savez(part, **asdict(self))
        part.replace(path)

    @classmethod
    def load(cls, path: Path) -> Reference | None:
        """Read it from a file; None if that is damaged."""
        try:
            with np.load(path) as found:
                return cls(**{name: value if value.ndim else float(value) for name, value in found.items()})
        except (OSError, ValueError, TypeError, zipfile.BadZipFile):
            return None


def bent(vertices: np.ndarray) -> np.ndarray:
    """Return where a smooth motion that is not affine takes a cage's vertices [m], shape (v, dimension).

    Each axis is displaced by the square of the next one, in units of the cage's diameter.

    Args:
        vertices: Their rest positions [m], shape (v, dimension).
    """
    size = _diameter(vertices)
    place = (vertices - vertices.mean(axis=0)) / size
    return size * (place + np.roll(place, 1, axis=1) ** 2)


def long_walks(
    cage: Cage, points: np.ndarray, has_gradient: np.ndarray, *, runs: int, walks: int, device: wp.context.Device
) -> Reference:
    """Find the weights and gradients of points by long runs.

    Args:
        cage: The cage, cut or not.
        points: Points in it [m], shape (n, dimension).
        has_gradient: Which of them have gradients, as a mask.
        runs: Long runs, 2 or more; and as many plain ones.
        walks: Walks a point of each long run.
        device: The device.
    """

    def values(count: int, seed: int, correction: str) -> tuple[np.ndarray, np.ndarray]:
        coordinates = HarmonicCoordinates(
            cage,
            points,
            count,
            seed,
            gradients=has_gradient,
            cuttable=False,
            device=device,
            correction=correction,
            epsilon=_EPSILON,
        )
        return coordinates.weights.astype(np.float64), coordinates.gradients.astype(np.float64)

    long = [values(walks, _SEED + run, "harmonic") for run in range(runs)]
    plain = [values(max(1, walks // _PLAIN_SHARE), _PLAIN_SEED + run, "none") for run in range(runs)]
    means, own, checks = [], [], []
    for each, other in zip(zip(*long), zip(*plain)):
        mean, variance = _mean_and_variance(each)
        plain_mean, plain_variance = _mean_and_variance(other)
        means.append(mean)
        own.append(variance)
        checks.append(_mean_square(mean - plain_mean) / (variance + plain_variance))
    motion = bent(cage.vertices) / _diameter(cage.vertices)
    return Reference(
        vertices=cage.vertices,
        weights=means[0],
        gradients=means[1],
        own_weights=own[0],
        own_gradients=own[1] / _mean_square(means[1]),
        own_surface=_mean_and_variance([weights @ motion for weights, _ in long])[1],
        check=np.array(checks),
    )


def _mean_and_variance(each: list[np.ndarray]) -> tuple[np.ndarray, float]:
    """The mean of several estimates, and its squared error: mean over the points, sum over all else."""
    return np.mean(each, axis=0), _mean_square(np.std(each, axis=0, ddof=1)) / len(each)


def _mean_square(values: np.ndarray) -> float:
    """Mean over the first axis of the sum of squares over all others."""
    return float((values.reshape(len(values), -1) ** 2).sum(axis=1).mean())


def _diameter(vertices: np.ndarray) -> float:
    return float(np.linalg.norm(np.ptp(vertices, axis=0)))

# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Settings that must stand before anything is imported, and work that tests share."""

import os
import sys

import pytest
import warp as wp

# The matrices of the tests are small: threads of BLAS would spend their time waiting for one another.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# Nothing here is differentiated by Warp: without adjoints, Newton's kernels compile in half the time.
wp.config.enable_backward = False


@pytest.fixture(autouse=True)
def shared_samples(monkeypatch):
    """Bodies with the same cage share one sample of quadrature points, which they never write to."""
    module = sys.modules.get("newton_cagecut.solver.body.body_quadrature")
    if module is not None:
        original = module.sample_quadrature

        def sample_once(cage, count, *, seed):
            key = cage.vertices.tobytes(), cage.simplices.tobytes(), cage.dimension, count, seed
            if key not in _samples:
                _samples[key] = original(cage, count, seed=seed)
                for array in _samples[key]:
                    array.setflags(write=False)
            return _samples[key]

        monkeypatch.setattr(module, "sample_quadrature", sample_once)


_samples = {}

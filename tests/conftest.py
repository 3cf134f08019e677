# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Settings that must stand before anything is imported."""

import os

import warp as wp

# The matrices of the tests are small: threads of BLAS would spend their time waiting for one another.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# Nothing here is differentiated by Warp: without adjoints, Newton's kernels compile in half the time.
wp.config.enable_backward = False

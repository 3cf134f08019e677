# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The linear solve of a step: quadrature points in lanes, a dense factor, conjugate gradients in one launch."""

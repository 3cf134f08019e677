# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Strain averaged over clusters of quadrature points, against locking.

Harmonic coordinates are stiffer than the body in three ways. In bending, what they make of the quadratic field of the
vertices sags inside the cage and jags along it: gradients are corrected until they reproduce quadratic fields
(``gradients.py``). Nearly incompressible bodies cannot keep their volume at every point: the volumetric part acts on
the mean of F in clusters (``clusters.py``), after the mean-strain elements with energy sampling of Krysl 2015
("Mean-strain eight-node hexahedron with stabilization by energy sampling"): the energy is that of the means, and at the
points a softer material of the same model acts on what is beyond the means (``moduli.py``). And sections contract,
swell and warp in ways that vertices on the surface do not see (``fields.py``): that is what the softer material is
found from. It is one potential, of which forces and stiffness are the derivatives, for every constitutive model.
"""

from .fields import ClusterFields
from .moduli import softened_moduli
from .rows import StrainRows, strain_rows

__all__ = ["ClusterFields", "StrainRows", "softened_moduli", "strain_rows"]

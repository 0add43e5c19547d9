"""The tangent of an implicit step's equation and its Cholesky factors, in one compiled call.

    K(u) + c₁ C(u) + c₂ M = s (K̃ + (c₁ R + c₂ M)/s),   s = 1 + c₁ t

for dampers in proportion t to the springs, R of the masses' own damping: K̃ is the springs' tangent with their
stresses over s. For small lattices of central springs under loads that do not follow the sheet; there the
calls, one for each part, take longer than their work (`lumped.dynamics.system` has the others).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from lumped.dynamics.system import System
from lumped.springs import all_families
from lumped.springs.all_families import Springs
from sheetbench.numerics import banded


class Tangent(NamedTuple):
    """Springs; number of blocks of their tangent, `Pattern.mirror`, and which are each mass's own, (n,);
    masses (n,) [kg] and their damping [kg/s]; the dampers' time t [s]; where the entries go."""

    springs: Springs
    blocks: int
    mirror: np.ndarray
    own: np.ndarray
    mass: np.ndarray
    rate: np.ndarray
    time: float
    band: banded.Band


def tangent_of(system: System) -> Tangent | None:
    """What `factorised` takes; None where dampers are not in proportion, or springs not all central."""
    springs, band, damping = system.assembly.all_families, system.problem.system.band, system.damping
    if springs is None or band is None or (damping.dampers and not damping.time):
        return None
    own = np.arange(len(system.lattice_mass))
    pattern = system.assembly.pattern
    mass, rate = np.ascontiguousarray(system.lattice_mass), np.ascontiguousarray(damping.rate)
    place = pattern.blocks, pattern.mirror, pattern.slots(own, own)
    return Tangent(springs.springs, *place, mass, rate, damping.time, band)


@njit(cache=True, nogil=True)
def factorised(
    u: np.ndarray, mass_coefficient: float, damping_coefficient: float, tangent: Tangent
) -> tuple[bool, np.ndarray]:
    """Whether the tangent at u (n, 3) [m] with c₂ [1/s²] and c₁ [1/s] is positive definite; its factors."""
    both = 1.0 + damping_coefficient * tangent.time
    blocks = all_families.own_tangent(u, tangent.springs, 1.0 / both, tangent.blocks, tangent.mirror)
    for i in range(len(tangent.own)):
        inert = (mass_coefficient * tangent.mass[i] + damping_coefficient * tangent.rate[i]) / both
        for q in range(3):
            blocks[tangent.own[i], q, q] += inert
    factors = banded.stored(blocks, tangent.band)
    factors *= both
    return banded.factor(factors, len(tangent.band.order), tangent.band.width), factors

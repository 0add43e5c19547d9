"""A lattice's equations as compiled calls: the tangent with its factors, and what a displacement leaves over.

    K = s K̃(u, S) + diag(m) − p ∂f_p/∂u,   Tᵀ K T x = Tᵀ r,   δ = T x,   r = f + p f_p(u + δ) − f_int(u + δ)

of springs with an energy (`lumped.springs.all_families`) under dead loads f and pressure p. One call for each
costs a small lattice less than a call for each part. Statics and implicit integrators share the first.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from lumped import pressure
from lumped.assembly import Assembly
from lumped.springs import all_families
from lumped.springs.all_families import Springs, Stresses
from lumped.supports import Constraints
from sheetbench.numerics import banded
from sheetbench.numerics.maps import Rows, product, transposed_product


class Equations(NamedTuple):
    """springs; blocks, mirror: how many blocks the tangent has, and `Pattern.mirror`; own: (n,) each mass's
    own block; free, unknowns: T and how many columns it has; held: (n, 3) bool, components that supports act
    on; band: where the entries of TᵀKT go, of no unknowns where it has no banded factors; positions (n, 3)
    [m], cells (c, 4, p) and slots (c, 4p, 4p) of a pressure."""

    springs: Springs
    blocks: int
    mirror: np.ndarray
    own: np.ndarray
    free: Rows
    unknowns: int
    held: np.ndarray
    band: banded.Band
    positions: np.ndarray
    cells: np.ndarray
    slots: np.ndarray


def equations_of(
    assembly: Assembly, constraints: Constraints, band: banded.Band | None, pressed: bool
) -> Equations | None:
    """Return what the calls take; None for actuators, single precision, and springs that they do not know.
    pressed: whether there is a pressure."""
    if assembly.all_families is None or assembly.coupling is not None or assembly.precision != "double":
        return None
    lattice, pattern = assembly.lattice, assembly.pattern
    (cells,) = (family.nodes for family in lattice.cells if family.name == "mid_area")
    cells = cells[: len(cells) * pressed]
    place = pattern.blocks, pattern.mirror, pattern.diagonal
    free = constraints.transform_arrays, constraints.transform.shape[1], constraints.held
    slots = pattern.among(cells.reshape(len(cells), 4 * lattice.grid[2]))
    return Equations(
        assembly.all_families.springs, *place, *free, band or banded.NO_BAND, lattice.positions, cells, slots
    )


@njit(cache=True, nogil=True)
def linearise(
    u: np.ndarray,
    stress: Stresses,
    share: float,
    scale: float,
    inertia: np.ndarray,
    pressing: float,
    equations: Equations,
) -> tuple[bool, np.ndarray, np.ndarray]:
    """Return whether there are banded factors, the tangent's blocks (b, 3, 3) [N/m] at u (n, 3) [m] and the
    factors. stress, share: as `all_families.tangent` has them, times `scale`; inertia: (n,) [N/m] for the
    diagonal, or empty; pressing: [Pa]."""
    blocks = all_families.tangent(u, equations.springs, stress, share, equations.blocks, equations.mirror)
    if scale != 1.0:
        blocks *= scale
    for i in range(len(inertia)):
        for q in range(3):
            blocks[equations.own[i], q, q] += inertia[i]
    if pressing != 0.0:
        pressure.add_tangent(equations.positions + u, equations.cells, equations.slots, -pressing, blocks)
    if not len(equations.band.order):
        return False, blocks, np.empty((0, 0))
    factors = banded.stored(blocks, equations.band)
    return banded.factor(factors, len(equations.band.order), equations.band.width), blocks, factors


@njit(cache=True, nogil=True)
def advance(
    u: np.ndarray,
    step: np.ndarray,
    right: np.ndarray,
    factors: np.ndarray,
    predict: bool,
    dead: np.ndarray,
    pressing: float,
    equations: Equations,
) -> tuple[np.ndarray, float, Stresses, np.ndarray, np.ndarray, float, float]:
    """Go from u (n, 3) [m] by a step (n, 3), or by the one that banded factors give for the force `right`
    (m,) [N] on the unknowns: return where that leads and how far at most [m], the stresses that the
    linearisation at u predicts there (empty unless asked to `predict`), and `unbalanced_force` there under
    dead loads (n, 3) [N] and a pressure [Pa]."""
    band, springs = equations.band, equations.springs
    if len(right):
        found = banded.solve_unrefined(factors, band.width, band.order, right)
        step = product(equations.free, found).reshape(-1, 3)
    none = np.empty((0, 3))
    stresses: Stresses = np.empty(0), none, none, none
    if predict:
        stresses = all_families.extrapolated(u, step, springs)
    after, length = u + step, 0.0
    for value in step.ravel():
        length = max(length, abs(value)) if np.isfinite(value) else np.inf
    _, internal = all_families.force(after, springs)
    external = dead
    if pressing != 0.0:
        external = dead.copy()
        pressure.add_forces(equations.positions + after, equations.cells, pressing, external)
    left = unbalanced_force(internal, external, equations.held, equations.free, equations.unknowns)
    return after, length, stresses, left[0], left[1], left[2], left[3]


@njit(cache=True, nogil=True)
def unbalanced_force(
    internal: np.ndarray, external: np.ndarray, held: np.ndarray, free: Rows, n: int
) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Return external less internal force r (k, 3) [N], Tᵀ r (n,), its norm and the forces' `size_of`."""
    out = external - internal
    reduced = transposed_product(free, out.ravel(), n)
    total = 0.0
    for value in reduced:
        total += value * value
    return out, reduced, np.sqrt(total), size_of(internal, external, held)


@njit(cache=True, nogil=True)
def size_of(internal: np.ndarray, external: np.ndarray, held: np.ndarray) -> float:
    """Return the norm of the external forces plus that of the supports' [N]; held: (k, 3) bool."""
    loads = supports = 0.0
    for i in range(len(internal)):
        for q in range(3):
            loads += external[i, q] ** 2
            if held[i, q]:
                supports += internal[i, q] ** 2
    return np.sqrt(loads) + np.sqrt(supports)

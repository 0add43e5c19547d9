"""What a sample of a motion holds, in one compiled call: energies, probes and reactions of a state.

For systems without chains in double precision; `lumped.dynamics.runs.sampling` does the others call by call.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from lumped.dynamics.drag import Drag, add_drag
from lumped.springs.all_forces import add_forces
from lumped.springs.packing import Packing, Scratch
from lumped.springs.tiles import NUMBA_TRUE
from sheetbench.numerics.maps import Rows


class Observed(NamedTuple):
    """Springs and dampers; M; mass-proportional damping (n,) [kg/s]; the air's drag; loads with a potential
    (n, 3) [N]; what takes a displacement to the probes', (3 p, 3 n), and forces on masses to those of each
    support, (3 s, 3 n)."""

    packing: Packing
    scratch: Scratch
    mass: Rows
    rate: np.ndarray
    drag: Drag
    dead: np.ndarray
    probes: Rows
    supports: Rows


@njit(cache=True)
def observe(
    u: np.ndarray,
    v: np.ndarray,
    a: np.ndarray,
    external: np.ndarray,
    observed: Observed,
    probes: np.ndarray,
    supports: np.ndarray,
) -> tuple[float, float, float]:
    """Kinetic, elastic and potential energy [J] of a state under these loads (n, 3) [N]; fills the probes'
    displacements (3 p,) [m] and the forces of the supports (3 s,) [N]."""
    exerted = np.zeros_like(u)
    damped = observed.packing.damped
    elastic, _ = add_forces(u, v, NUMBA_TRUE, damped, observed.packing, observed.scratch, exerted)
    add_drag(observed.drag, u, v, exerted)
    for i in range(len(observed.rate)):
        for q in range(3):
            exerted[i, q] += observed.rate[i] * v[i, q]
    forces, speed, gained = exerted.ravel(), v.ravel(), a.ravel()
    place, acting, dead = u.ravel(), external.ravel(), observed.dead.ravel()
    mass = observed.mass
    kinetic = potential = 0.0
    for row in range(len(forces)):
        forces[row] -= acting[row]
        potential -= dead[row] * place[row]
        for e in range(mass.pointers[row], mass.pointers[row + 1]):
            forces[row] += mass.values[e] * gained[mass.columns[e]]
            kinetic += 0.5 * speed[row] * mass.values[e] * speed[mass.columns[e]]
    _take(observed.probes, place, probes)
    _take(observed.supports, forces, supports)
    return kinetic, elastic, potential


@njit(cache=True)
def _take(matrix: Rows, x: np.ndarray, out: np.ndarray) -> None:
    for row in range(len(out)):
        out[row] = 0.0
        for e in range(matrix.pointers[row], matrix.pointers[row + 1]):
            out[row] += matrix.values[e] * x[matrix.columns[e]]

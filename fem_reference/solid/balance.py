"""What a solid's forces leave over, those of the loads being the scene's own (see `surface.balance`).

Strains are made of scalar products of positions and of the rods' directors, so that forces on all of them
cancel, and so do their moments, whatever the shape: what is left over is the residual of the free unknowns,
which the solver has brought below its tolerance or to where rounding stops it, and the rounding of the sums.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fem_reference.solid.rods import DIRECTORS
from fem_reference.solid.structure import Forces, SolidStructure, State
from fem_reference.solid.supports import from_forces, into_forces
from fem_reference.surface.actuator_forces import OnEdge
from fem_reference.surface.balance import Surface, left_over
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.continuation.path import Path
from sheetbench.scenes import Balance, Scene


def balance(
    scene: Scene,
    structure: SolidStructure,
    path: Path[State, Forces],
    forces: Forces,
    edges: Sequence[OnEdge],
    own: bool,
) -> Balance:
    """The balance at the end of a path, where the rods on the sheet's edges exert `edges`; own: whether the
    mesh has an outline of its own."""
    columns, rods = structure.columns, structure.rods
    state, share = path.state, path.load_factor
    position = columns.positions + state.displacement
    mean, director = np.einsum("pl,nlc->pnc", columns.averages, position)
    surface = Surface(columns.plan, mean, director, own)
    reactions = structure.supports.reactions(forces.residual, share)
    held = np.where(structure.free, 0.0, into_forces(forces.bases, forces.residual))
    at = [
        (position, from_forces(forces.bases, held)),
        (rods.own + state.aside, np.where(rods.held[:, None], forces.aside, 0.0)),
    ]
    # a sum of n numbers is at most √n times their norm, in which residuals are measured
    left = np.sqrt(structure.unknowns) * max(
        Limits.tolerance * forces.size, structure.imbalance(state, forces)
    )
    allowed = float(left + np.finfo(float).eps * _summed(structure, forces))
    return left_over(scene, surface, edges, reactions, at, forces.size, allowed, share)


def _summed(structure: SolidStructure, forces: Forces) -> float:
    """Σ |B| |s| [N], what forces are sums of, those on directors over the sheet's size."""
    of_bricks = np.einsum("ekic,ek->", np.abs(forces.gradient), np.abs(forces.stress))
    of_rods = np.einsum("ekic,ek->i", np.abs(forces.rods.gradient), np.abs(forces.rods.stress))
    of_rods[-DIRECTORS:] /= structure.lever
    return float(of_bricks + of_rods.sum())

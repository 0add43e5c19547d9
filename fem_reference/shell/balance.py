"""What a shell's forces leave over, those of the loads being the scene's own (see `surface.balance`).

Strains are made of scalar products of the vectors φ, d and m, so that internal forces on all of them cancel,
Σ f_φ = 0, and so do their moments, Σ φ × f_φ + d × f_d + m × f_m = 0, whatever the shape: what is left over
is the residual of the free unknowns, which the solver has brought below its tolerance or to where rounding
stops it, and the rounding of the sums.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fem_reference.shell.element import magnitudes
from fem_reference.shell.state import Forces, State
from fem_reference.shell.structure import ShellStructure
from fem_reference.surface.actuator_forces import OnEdge
from fem_reference.surface.balance import Surface, left_over
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.continuation.path import Path
from sheetbench.scenes import Balance, Scene


def balance(
    scene: Scene,
    structure: ShellStructure,
    path: Path[State, Forces],
    forces: Forces,
    surface: Surface,
    edges: Sequence[OnEdge],
) -> Balance:
    """The balance at the end of a path, where the sheet lies as `surface` and the rods on its edges exert
    `edges`."""
    reactions = structure.supports.reactions(forces.residual[0])
    on_nodes, on_directors = _held(structure, forces)
    held = [(surface.position, on_nodes), (forces.directors, on_directors)]
    left = max(Limits.tolerance * forces.size, structure.imbalance(path.state, forces))
    allowed = left + float(np.finfo(float).eps) * _summed(structure, forces)
    return left_over(scene, surface, edges, reactions, held, forces.size, allowed, path.load_factor)


def _held(structure: ShellStructure, forces: Forces) -> tuple[np.ndarray, np.ndarray]:
    """What holds the nodes (n, 3) [N], and the directors (n + q, 3) [N·m], across themselves."""
    couple = np.where(structure.turns < 0, forces.couple, 0.0)
    on_directors = np.einsum("nck,nk->nc", forces.frames, couple)
    return np.where(structure.supports.position, forces.residual[0], 0.0), on_directors


def _summed(structure: ShellStructure, forces: Forces) -> float:
    """Σ |B| |s| [N], what forces are sums of, those on directors over the sheet's size."""
    of_sheet = magnitudes(forces.vectors, forces.stress)
    of_rods = np.einsum("ekic,ek->i", np.abs(forces.rods.gradient), np.abs(forces.rods.stress))
    on_nodes, on_directors = of_sheet[:9].sum() + of_rods[:3].sum(), of_sheet[9:].sum() + of_rods[3:].sum()
    return float(on_nodes + on_directors / structure.lever)

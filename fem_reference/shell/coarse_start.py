"""Where a fine shell's path may begin: at the equilibrium of a coarse one, and not at the flat sheet.

The interpolated shape is some 1e-4 of the sheet's size away from the equilibrium, but its membrane stresses
are nothing but the error of the interpolation: the first tangent is that of the material alone. Three
corrections lead from there to the end, where the path from the flat sheet takes five.
"""

from __future__ import annotations

import numpy as np
from skfem import MeshQuad

from fem_reference.shell.state import State
from fem_reference.shell.structure import UP, ShellStructure
from fem_reference.solving.equilibrium import Start
from fem_reference.solving.path import Path
from fem_reference.surface.location import interpolate
from sheetbench.scenes import Scene, Status

COARSER = 4  # times as many elements along a side
FINE = 16  # elements along the shorter side, from which on a coarse one saves more than it takes


def coarse(counts: tuple[int, int], scene: Scene) -> tuple[int, int] | None:
    """The elements along x and y of the mesh to begin with, if there is one; rods have unknowns of their
    own."""
    if min(counts) < FINE or scene.actuators:
        return None
    return counts[0] // COARSER, counts[1] // COARSER


def plain(path: Path[State]) -> bool:
    """Whether a path has led straight to the only stable equilibrium in sight."""
    straight = all(entry.load_factor == 1.0 for entry in path.history)
    return path.status is Status.CONVERGED and straight and not path.snaps and not path.notes


def start(
    mesh: MeshQuad, element_nodes: np.ndarray, state: State, structure: ShellStructure, nodes: np.ndarray
) -> Start[State]:
    """The state on a mesh with elements (m, 9), on the nodes (n, 2) [m] of another structure."""
    both = np.concatenate(list(state.change), axis=1)
    displacement, turn = np.split(interpolate(mesh, element_nodes, both, nodes), 2, axis=1)
    director = turn + UP
    director /= np.linalg.norm(director, axis=1, keepdims=True)
    rest = structure.rest()
    change, unstressed = (
        np.array([displacement, director - UP]),
        np.zeros(structure.element.stiffness.shape[:2]),
    )
    found = State(change, rest.aside, unstressed, np.zeros_like(structure.rods.elements.stiffness))
    return Start(found, 1.0, structure.length(rest, found), structure.potential(found, 1.0)[1])

"""Where a fine shell's path may begin: at the equilibrium of a coarse one, and not at the flat sheet.

The interpolated shape is some 1e-4 to 1e-3 of the sheet's size away from the equilibrium, but its membrane
stresses are nothing but the error of the interpolation: the first tangent is formed with those of the coarse
mesh, and neither with bending nor with shear. Three corrections lead from there to the end, where the path
from the flat sheet takes five.

Between the two meshes stand Cartesian membrane strains at nodes, what the samples of the elements around
extrapolate to on average. Samples are along an element's own coordinates ξ (see `element`): with J = ∂x/∂ξ

    e_αβ = J_xα E_xy J_yβ.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from skfem import ElementQuad2

from fem_reference.discrete.static import Forces, Static, StaticState
from fem_reference.shell.discrete import UP, DiscreteShell
from fem_reference.shell.element import AT_SITES, GRIDS, MEMBRANE
from fem_reference.shell.natural import sampled
from fem_reference.surface.biquadratic import interpolation, jacobians, shape
from fem_reference.surface.location import interpolate
from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.continuation.newton import Start
from sheetbench.numerics.continuation.path import Path
from sheetbench.scenes import Scene

Shape = Callable[[np.ndarray], np.ndarray]

COARSER = 4  # times as many elements along a side
FINE = 8  # elements along the shorter side, from which on a coarse one saves more than it takes
LIMITS = Limits(factorisations=10)  # of a coarse path that leads straight; others are given up

NODES = 2.0 * ElementQuad2.doflocs.T - 1.0
_TO_NODES = {name: interpolation(*grid, NODES) for name, grid in GRIDS.items()}
_AT_NODES = shape(*NODES)[1]
_ENDS = np.cumsum([len(points.T) for points in _TO_NODES.values()])


def coarse(counts: tuple[int, int], scene: Scene) -> tuple[int, int] | None:
    """The elements along x and y of the mesh to begin with, if there is one; rods have unknowns of their
    own, and a sheet that is not flat at rest may buckle otherwise on a coarse mesh."""
    if min(counts) < FINE or scene.actuators or scene.natural_by or scene.obstacles:
        return None
    return counts[0] // COARSER, counts[1] // COARSER


def plain(path: Path[StaticState, Forces]) -> bool:
    """Whether a path has led straight to the only stable equilibrium in sight."""
    straight = all(entry.load_factor == 1.0 for entry in path.history)
    return path.status is Status.CONVERGED and straight and not path.snaps and not path.notes


def start(coarser: DiscreteShell, q: np.ndarray, sheet: DiscreteShell) -> Start[StaticState]:
    """The state of a shell from the coordinates (N,) of another."""
    plan, finer = coarser.plan, sheet.element
    strain = at_nodes(plan.corners, plan.elements, coarser.shape(q, 1.0).strain[:, MEMBRANE])
    changes = q[: 6 * coarser.nodes].reshape(2, -1, 3)
    every = np.concatenate([*changes, strain.reshape(-1, 4)], axis=1)
    found = interpolate(plan.mesh, plan.elements, every, sheet.plan.nodes)
    displacement, turn, flat = np.split(found, (3, 6), axis=1)
    stretched = np.zeros(finer.stiffness.shape[:2])
    at_sites = (AT_SITES @ flat[sheet.plan.elements]).reshape(-1, len(AT_SITES), 2, 2)
    stretched[:, MEMBRANE] = sampled(sheet.plan.corners, at_sites)
    return _start(sheet, displacement, turn, stretched)


def shaped(shape: Shape, sheet: DiscreteShell) -> Start[StaticState]:
    """The state of a shell without membrane stress in a shape: the displacement (k, 3) [m] of what lies at
    (k, 3) [m] in the flat sheet, on its normals."""
    nodes = sheet.plan.nodes
    flat, over = (np.column_stack([nodes, np.full(len(nodes), height)]) for height in (0.0, 1.0))
    displacement = shape(flat)
    no_strain = np.zeros(sheet.element.stiffness.shape[:2])
    return _start(sheet, displacement, shape(over) - displacement, no_strain)


def _start(
    sheet: DiscreteShell, displacement: np.ndarray, turn: np.ndarray, strain: np.ndarray
) -> Start[StaticState]:
    """That of displacements and changes of directors (n, 3), which do not tilt where edges hold the tilt, its
    stresses those of strains (m, 54)."""
    director = np.where(np.pad(sheet.supports.tilt, ((0, 0), (0, 1))), 0.0, turn + UP)
    director /= np.linalg.norm(director, axis=1, keepdims=True)
    q, static = sheet.of_vectors(displacement, director - UP), Static(sheet)
    no_rods = tuple(np.zeros_like(body.elements.stiffness) for body in sheet.bodies)
    found = StaticState(q, sheet.element.stress(strain), on_rods=no_rods)
    return Start(found, 1.0, static.length(static.rest(), found), static.potential(found, 1.0)[1])


def at_nodes(nodes: np.ndarray, element_nodes: np.ndarray, strain: np.ndarray) -> np.ndarray:
    """E (n, 2, 2) at the nodes of elements at (m, 9, 2) [m] with samples (m, 21); element_nodes: (m, 9)."""
    along = zip(_TO_NODES.values(), np.split(strain, _ENDS[:-1], axis=1), strict=True)
    rr, ss, rs = (samples @ to_nodes.T for to_nodes, samples in along)
    tensor = np.moveaxis(np.array([[rr, rs], [rs, ss]]), (0, 1), (2, 3))
    inverse = np.linalg.inv(jacobians(nodes, _AT_NODES))  # ∂ξ_a/∂x_b
    sums = np.zeros((element_nodes.max() + 1, 2, 2))
    np.add.at(sums, element_nodes, inverse.swapaxes(2, 3) @ tensor @ inverse)
    return sums / np.bincount(element_nodes.ravel())[:, None, None]

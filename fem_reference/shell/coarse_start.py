"""Start of a fine shell's path at the equilibrium of a coarse one instead of the flat sheet.

The interpolated shape is some 1e-4 to 1e-3 of the sheet's size away from the equilibrium, but its membrane
stresses are nothing but the error of the interpolation: the first tangent is formed with the membrane
stresses of the coarse mesh, without bending and shear. Three corrections lead from there to the end; the path
from the flat sheet takes five.

The meshes exchange Cartesian membrane strains at nodes, the average of the extrapolated samples of the
elements around a node. Samples are along an element's own coordinates ξ (see `element`): with J = ∂x/∂ξ

    e_αβ = J_xα E_xy J_yβ.
"""

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
COARSE_START_FROM = 8  # elements along the shorter side, from which on a coarse mesh saves more than it takes
LIMITS = Limits(factorisations=10)  # of a coarse path that leads straight; other paths are abandoned

NODES = 2.0 * ElementQuad2.doflocs.T - 1.0
_TO_NODES = {name: interpolation(*grid, NODES) for name, grid in GRIDS.items()}
_AT_NODES = shape(*NODES)[1]
_ENDS = np.cumsum([len(points.T) for points in _TO_NODES.values()])


def coarse(counts: tuple[int, int], scene: Scene) -> tuple[int, int] | None:
    """Return the elements along x and y of the coarse mesh to begin with, if there is one. Rods have unknowns
    of their own, and a sheet that is not flat at rest may buckle otherwise on a coarse mesh."""
    if min(counts) < COARSE_START_FROM or scene.actuators or scene.natural_by or scene.obstacles:
        return None
    return counts[0] // COARSER, counts[1] // COARSER


def is_direct(path: Path[StaticState, Forces]) -> bool:
    """Return whether a path has led straight to an equilibrium, without snaps or notes."""
    straight = all(entry.load_factor == 1.0 for entry in path.history)
    return path.status is Status.CONVERGED and straight and not path.snaps and not path.notes


def start(coarser: DiscreteShell, q: np.ndarray, sheet: DiscreteShell) -> Start[StaticState]:
    """Return the state of a shell interpolated from the coordinates (N,) of a coarser one."""
    plan, finer = coarser.plan, sheet.element
    strain = at_nodes(plan.corners, plan.elements, coarser.shape(q, 1.0).strain[:, MEMBRANE])
    changes = q[: 6 * coarser.nodes].reshape(2, -1, 3)
    fields = np.concatenate([*changes, strain.reshape(-1, 4)], axis=1)
    interpolated = interpolate(plan.mesh, plan.elements, fields, sheet.plan.nodes)
    displacement, turn, flat = np.split(interpolated, (3, 6), axis=1)
    stretched = np.zeros(finer.stiffness.shape[:2])
    at_sites = (AT_SITES @ flat[sheet.plan.elements]).reshape(-1, len(AT_SITES), 2, 2)
    stretched[:, MEMBRANE] = sampled(sheet.plan.corners, at_sites)
    return _start(sheet, displacement, turn, stretched)


def in_shape(shape: Shape, sheet: DiscreteShell) -> Start[StaticState]:
    """Return the state, without membrane stress, of a shell in a given shape. shape: a function from points
    (k, 3) [m] of the flat sheet, on its normals, to their displacement (k, 3) [m]."""
    nodes = sheet.plan.nodes
    flat, above = (np.column_stack([nodes, np.full(len(nodes), height)]) for height in (0.0, 1.0))
    displacement = shape(flat)
    no_strain = np.zeros(sheet.element.stiffness.shape[:2])
    return _start(sheet, displacement, shape(above) - displacement, no_strain)


def _start(
    sheet: DiscreteShell, displacement: np.ndarray, turn: np.ndarray, strain: np.ndarray
) -> Start[StaticState]:
    """Return the state of displacements, directors (n, 3), upright along held tilts, and strains (m, 54)."""
    director = np.where(np.pad(sheet.supports.tilt, ((0, 0), (0, 1))), 0.0, turn + UP)
    director /= np.linalg.norm(director, axis=1, keepdims=True)
    q, static = sheet.of_vectors(displacement, director - UP), Static(sheet)
    no_rods = tuple(np.zeros_like(body.elements.stiffness) for body in sheet.bodies)
    state = StaticState(q, sheet.element.stress(strain), on_rods=no_rods)
    return Start(state, 1.0, static.length(static.rest(), state), static.potential(state, 1.0)[1])


def at_nodes(nodes: np.ndarray, element_nodes: np.ndarray, strain: np.ndarray) -> np.ndarray:
    """Return E (n, 2, 2) at the nodes, from elements' positions (m, 9, 2) [m] and samples (m, 21)."""
    along = zip(_TO_NODES.values(), np.split(strain, _ENDS[:-1], axis=1), strict=True)
    rr, ss, rs = (samples @ to_nodes.T for to_nodes, samples in along)
    tensor = np.moveaxis(np.array([[rr, rs], [rs, ss]]), (0, 1), (2, 3))
    inverse = np.linalg.inv(jacobians(nodes, _AT_NODES))  # ∂ξ_a/∂x_b
    sums = np.zeros((element_nodes.max() + 1, 2, 2))
    np.add.at(sums, element_nodes, inverse.swapaxes(2, 3) @ tensor @ inverse)
    return sums / np.bincount(element_nodes.ravel())[:, None, None]

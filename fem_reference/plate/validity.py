"""Where the linear plate's theory ends: strains, turns and in-plane forces beyond what it knows of.

strained  the mid-surface stretched, or the sheet too heavy, for a linear law (`scenes.outside_model`).
turned    the director e_z + β, the slope ∇w, or the turn ω = ½ (v,x − u,y) in the plane is more than 1: by as
          much as a director is long no rotation turns it, whatever its angle.
buckled   the in-plane forces N, which the plate's bending does not know of, take its stability at a share λ
          of the load: with K the stiffness, K_N that of N on the slopes of w,

              K φ = −λ K_N φ,      φ·K_N φ = ∫ ∇w·N ∇w dA

          (e.g. Bathe, Finite Element Procedures, 6.8). Checked where N presses somewhere and a² |N|/D > 1, a
          the longer side: a square sheet held along one edge buckles at π²/4. Beside chains, whose own forces
          take part, it is not checked.

The answer is linear in the load, so all of them tell the share of the load at which the theory ends.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from fem_reference.plate.element import UX, UY, PlateElements, W
from fem_reference.surface.biquadratic import NODES
from fem_reference.surface.materials import Section
from sheetbench.answers.solution import Status
from sheetbench.numerics.direct import DirectSolver
from sheetbench.numerics.sparsity import Pattern
from sheetbench.scenes import Scene, outside_model

TURN_LIMIT = 1.0
SLIGHT = 1.0  # a² |N|/D, below which in-plane forces do not buckle a sheet


def judge(
    scene: Scene,
    elements: PlateElements,
    section: Section,
    solution: np.ndarray,
    system: csr_matrix,
    free: np.ndarray,
    own: np.ndarray | float = 0.0,
) -> tuple[Status, tuple[str, ...]]:
    """Status and notes of the unknowns (5 n,), or with those of rods behind, of a stiffness and its free
    unknowns; own: strains (m, q, 3) of the membrane without stress."""
    strain = _nodal(elements, elements.membrane, solution) - own
    if outside := outside_model(scene, _mean_stretch(elements, strain)):
        return Status.STRAIN_OUTSIDE_MODEL, (outside,)
    if (turn := largest_turn(elements, solution)) > TURN_LIMIT:
        ends = f"linear theory ends at {100.0 * TURN_LIMIT / turn:.3g} % of the load or before"
        return Status.STRAIN_OUTSIDE_MODEL, (f"slopes or turns of {turn:.3g}, beyond 1: {ends}",)
    share = buckling_load(
        scene, elements, (section.membrane @ strain[..., None])[..., 0], section, system, free
    )
    if share is not None and share < 1.0:
        return Status.UNSTABLE, (f"its in-plane forces buckle it at {100.0 * share:.3g} % of the load",)
    return Status.CONVERGED, ()


def strained(elements: PlateElements, solution: np.ndarray) -> float:
    """The largest slope, turn, or double the strain along x or y, of the unknowns (5 n,): linear theory ends
    at 1 of each."""
    stretch = _mean_stretch(elements, _nodal(elements, elements.membrane, solution))
    return max(largest_turn(elements, solution), 2.0 * stretch)


def largest_turn(elements: PlateElements, solution: np.ndarray) -> float:
    """The largest of directors' changes, slopes and turns in the plane."""
    fields = solution[elements.unknowns].reshape(len(elements.nodes), NODES, 5)
    gradient = _gradient(elements)
    inplane = 0.5 * (
        np.einsum("mqi,mi->mq", gradient[:, :, 0], fields[:, :, UY])
        - np.einsum("mqi,mi->mq", gradient[:, :, 1], fields[:, :, UX])
    )
    tilt = np.linalg.norm(fields[:, :, W + 1 :], axis=2)
    slope = np.linalg.norm(np.einsum("mqai,mi->mqa", gradient, fields[:, :, W]), axis=2)
    return float(max(tilt.max(), slope.max(), np.abs(inplane).max()))


def buckling_load(
    scene: Scene,
    elements: PlateElements,
    force: np.ndarray,
    section: Section,
    system: csr_matrix,
    free: np.ndarray,
) -> float | None:
    """The lowest positive share of the load at which in-plane forces (m, q, 3) [N/m] buckle the plate; None
    where they cannot, or nearly not."""
    xx, yy, xy = np.moveaxis(force, 2, 0)
    pressing = -(0.5 * (xx + yy) - np.hypot(0.5 * (xx - yy), xy)).min()
    if scene.chains() or pressing * max(scene.sheet.lengths) ** 2 < SLIGHT * section.bending[..., 0, 0].max():
        return None
    gradient, tensor = _gradient(elements), np.stack([xx, xy, xy, yy], axis=2).reshape(*xx.shape, 2, 2)
    blocks = np.zeros((len(elements.nodes), NODES, 5, NODES, 5))
    blocks[:, :, W, :, W] = np.einsum("mq,mqai,mqab,mqbj->mij", elements.areas, gradient, tensor, gradient)
    pattern = Pattern(elements.unknowns, size=system.shape[0])
    geometric = pattern.matrix(blocks.reshape(-1, 5 * NODES, 5 * NODES))[free][:, free]
    stiffness = system[free][:, free]
    inverse = LinearOperator(stiffness.shape, matvec=DirectSolver().factor(stiffness).solve, dtype=float)
    start = np.random.default_rng(0).uniform(-1.0, 1.0, len(free))
    try:
        largest = eigsh(
            -geometric, 1, stiffness, Minv=inverse, which="LA", v0=start, tol=1e-6, return_eigenvectors=False
        )
    except ArpackNoConvergence:
        return None
    return 1.0 / float(largest[0]) if largest[0] > 0.0 else None


def _gradient(elements: PlateElements) -> np.ndarray:
    """∇N of the shape functions, (m, q, 2, 9), as the membrane strains have it."""
    operator = elements.membrane.reshape(*elements.membrane.shape[:3], NODES, 5)
    return np.stack([operator[:, :, 0, :, UX], operator[:, :, 1, :, UY]], axis=2)


def _nodal(elements: PlateElements, operator: np.ndarray, solution: np.ndarray) -> np.ndarray:
    strain: np.ndarray = np.einsum("mqic,mc->mqi", operator, solution[elements.unknowns])
    return strain


def _mean_stretch(elements: PlateElements, strain: np.ndarray) -> float:
    """The largest strain along x or y, the mean over an element."""
    mean = np.einsum("mq,mqi->mi", elements.areas, strain[:, :, :2])
    return float(np.abs(mean / elements.areas.sum(axis=1, keepdims=True)).max())

"""Linear buckling: the load factors at which a structure's straight state becomes unstable.

The full loads cause the stress σ of linear theory. The tangents of the undisplaced structure with stresses ±σ
are K(±σ), without stress K₀. The loads change the tangent by K₁ = ½ (K(σ) − K(−σ)), and (K₀ + λ K₁) φ = 0 is
the generalised eigenproblem −K₁ φ = (1/λ) K₀ φ (e.g. Bathe, Finite Element Procedures, 6.8). Displacements
before buckling are ignored, as in the closed forms: a tangent of the displaced structure, linear in λ, would
contain the spurious stretch of a rotation to first order (a strip on edge buckled at half its load).
"""

from collections.abc import Callable

import numpy as np
from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh

from sheetbench.errors import BadInput
from sheetbench.numerics.continuation.structure import Forces, Solver, State, Structure
from sheetbench.numerics.direct import SingularMatrixError
from sheetbench.numerics.threads import one_blas_thread

BENDS = 1e-6  # displacement across the sheet over the largest, beyond which it does not stay flat
STIFFENS = 1e-12  # 1/λ below which a softening is rounding


def buckling_modes(
    structure: Structure[State, Forces],
    solver: Solver,
    surface: Callable[[State], np.ndarray],
    count: int,
    still_within: float = 0.0,
) -> tuple[np.ndarray, list[State]]:
    """Return the lowest positive load factors (count,), rising, and their shapes as states of any scale.

    surface: displacement of points of the mid-surface (n, 3) [m] at a state. still_within: displacement [m]
    below which the sheet does not move. Raises BadInput if the loads bend the sheet at once or do not soften
    it, and if there are fewer modes than `count`.
    """
    rest, sides = structure.rest(), []
    still = structure.forces(rest, 0.0)
    with one_blas_thread():
        try:
            factor = solver.factor(structure.linearised(rest, still, 0.0)[0])
            for share in (1.0, -1.0):
                forces = structure.forces(rest, share)
                step = factor.solve(structure.linearised(rest, forces, share)[1])
                loaded = structure.advance(rest, forces, share, step)
                moved = np.abs(surface(loaded))
                if moved[:, 2].max() > BENDS * max(moved.max(), still_within):
                    raise BadInput("buckling: the loads bend the sheet at once; those in its plane buckle it")
                stressed = structure.with_stresses(rest, loaded)
                tangent, _ = structure.linearised(stressed, structure.forces(stressed, share), share)
                sides.append(structure.sparse(tangent))
        except SingularMatrixError as error:
            raise BadInput(f"buckling: the flat sheet's tangent is singular: {error}") from None
        n, softening = factor.matrix.shape[0], 0.5 * (sides[1] - sides[0])
        if not 1 <= count < n:
            raise BadInput(f"count = {count}: 1 to {n - 1} on this mesh")
        inverse = LinearOperator((n, n), matvec=factor.solve, dtype=float)
        start = np.random.default_rng(0).standard_normal(n)
        per_load, steps = np.zeros(count), np.zeros((n, count))
        if abs(softening).max() > 0.0:
            try:
                per_load, steps = eigsh(softening, count, factor.matrix, Minv=inverse, which="LA", v0=start)
            except ArpackError as error:
                raise BadInput(f"buckling: count = {count}: no such modes were found: {error}") from None
    order, positive = np.argsort(-per_load), int(np.sum(per_load > STIFFENS))
    if positive < count:
        fault = f"count = {count}: there are {positive}" if positive else "the loads do not soften the sheet"
        raise BadInput(f"buckling: {fault}")
    states = [structure.advance(rest, still, 0.0, steps[:, mode]) for mode in order]
    return 1.0 / per_load[order], states

"""Linear buckling: the load factors at which a lattice's straight state stops being stable.

K(λ) ≈ K0 + λ K1 with K1 the change of the tangent per unit of load at λ = 0; K(λ) φ = 0 is the generalised
eigenproblem −K1 φ = (1/λ) K0 φ (e.g. Bathe, Finite Element Procedures, 6.8).
"""

from __future__ import annotations

import numpy as np
from scipy.sparse.linalg import LinearOperator, eigsh

from lumped.calibration import Calibration
from lumped.statics.equilibrium import at_rest, follow
from lumped.statics.solver import build_problem
from sheetbench.errors import BadInput
from sheetbench.scenes import AnyScene, SceneError, require_static, scene_of

SMALL_LOAD = 1e-4  # share of the full load that the change of the tangent is taken over, first


def buckling_loads(scene: AnyScene, calibration: Calibration, count: int = 1) -> np.ndarray:
    """The `count` lowest positive buckling load factors of a scene's loads, (count,).

    Meant for loads that leave the sheet flat. The state of small load is refined once, to a hundredth of
    the first estimate. Raises SceneError when nothing stops a rigid motion or no load factor is positive,
    BadInput for what has no energy: loads that follow the sheet, springs per direction.

    >>> import lumped
    >>> from sheetbench.scenes import load
    >>> scene = load("one-edge-clamped")
    >>> lumped.buckling_loads(scene, lumped.calibrate(scene.sheet, scene.material, grid=5)).shape
    (1,)
    """
    scene = scene_of(scene)
    require_static(scene)
    problem = build_problem(scene, calibration)
    if problem.loads.follow or not problem.conservative or scene.actuators:
        raise BadInput(
            f"scene '{scene.name}': buckling loads are of dead loads and central springs: pressure and edge "
            "moments follow the sheet, and actuators and springs of a per-direction law have no energy"
        )
    rest = at_rest(problem)
    n = problem.system.unknowns
    stiffness = problem.system.matrix(rest.blocks)
    inverse = LinearOperator((n, n), matvec=rest.factor.solve, dtype=float)
    small = SMALL_LOAD
    for _ in range(2):
        tangents = []
        for share in (small, -small):
            loaded, why = follow(problem, rest, share)
            if why:
                raise SceneError(f"scene '{scene.name}': no equilibrium at {share:g} of the load: {why}")
            tangents.append(problem.system.matrix(loaded.blocks))
        softening = -(tangents[0] - tangents[1]) / (2.0 * small)
        start = np.random.default_rng(0).standard_normal(n)
        per_load = eigsh(
            softening, k=count, M=stiffness, Minv=inverse, which="LA", v0=start, return_eigenvectors=False
        )
        per_load = np.sort(per_load)[::-1]
        if per_load[0] <= 0.0:
            raise SceneError(f"scene '{scene.name}': the loads do not soften the sheet; it does not buckle")
        small = 0.01 / float(per_load[0])
    factors: np.ndarray = 1.0 / per_load
    return factors

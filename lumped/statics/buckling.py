"""Linear buckling of a lattice (`sheetbench.numerics.continuation.buckling`)."""

import numpy as np

from lumped.calibration import Calibration, default
from lumped.mid_surface import MidSurface
from lumped.statics.solver import build_problem
from sheetbench.answers.modes import STILL, Buckling, require_flat_and_dead
from sheetbench.clock import now
from sheetbench.numerics.continuation.buckling import buckling_modes
from sheetbench.scenes import AnyScene, require_static, scene_of


def buckling(scene: AnyScene, calibration: Calibration | None = None, count: int = 1) -> Buckling:
    """Return the lowest factors of a scene's dead loads at which its flat lattice buckles, and their shapes.

    Parameters
    ----------
    scene : Scene, str or Path
        Scene, the name of one in the catalogue, or the path of its file.
    calibration : Calibration, optional
        Springs; by default the scene's, or consistent ones on nine masses along the shorter side.
    count : int, default 1
        Number of factors.

    Returns
    -------
    Buckling
        Load factors (count,) [-], rising, and shapes.

    Raises
    ------
    SceneError
        If no support stops a rigid motion.
    BadInput
        If loads follow the sheet, bend it at once or do not soften it, or actuators or supports bend it.

    Notes
    -----
    Linear buckling about the flat sheet (`sheetbench.numerics.continuation.buckling`).

    Examples
    --------
    >>> import lumped
    >>> from sheetbench.scenes import load
    >>> on_edge = load("one-edge-clamped").replace(gravity={"acceleration": (0.0, -9.81, 0.0)})
    >>> lumped.buckling(on_edge, lumped.calibrate(on_edge.sheet, on_edge.material, grid=5)).load_factors.shape
    (1,)
    """
    require_static(scene := scene_of(scene), "buckling")
    require_flat_and_dead(scene)
    calibration = calibration or default(scene)
    begin = now()
    problem = build_problem(scene, calibration)
    lattice = problem.assembly.lattice
    middle = MidSurface(lattice, lattice.positions[lattice.columns()[:, :, 0].ravel(), :2])
    still = STILL * problem.size
    factors, states = buckling_modes(problem, problem, lambda state: middle.of(state.u), count, still)

    def displacement(points: np.ndarray) -> np.ndarray:
        at = MidSurface(lattice, points)
        return np.stack([at.of(state.u) for state in states])

    return Buckling(
        model="lumped",
        label=f"lumped {calibration.title}",
        settings=calibration.settings,
        load_factors=factors,
        unknowns=problem.system.unknowns,
        seconds=now() - begin,
        displacement=displacement,
    )

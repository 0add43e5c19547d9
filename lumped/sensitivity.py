"""How the displacements depend on the parameters: derivatives of a static equilibrium.

At equilibrium the residual R(q, θ) = Tᵀ (f − f_int)(T q + g(θ), θ) is zero for every θ, so that with the
tangent K = −∂R/∂q at hand dq/dθ = K⁻¹ ∂R/∂θ and du/dθ = T dq/dθ + dg/dθ, one solve a parameter.

∂R/∂θ is a central difference of the residual at fixed q. The residual is linear in every spring constant and
in E, where that is exact to rounding; in the thickness, ν, a layer distance, a curvature or a tilt its
relative error is of order 1e-8.

Parameters: the spring constants of `scenes.SpringSet` by name (axial_x, axial_y, … where a direction has its
own), layer_distance; young, poisson, density, thickness (springs calibrated again by the same method);
curvature_EDGE, of the curved support or the actuator on that edge; tilt_EDGE, of the clamp on it;
patchN.young, … obstacleN.z, … (`scenes.parameters`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lumped.calibration import MAKERS, Calibration
from lumped.mid_surface import MidSurface
from lumped.pretension import calibrated_at_rest
from lumped.sections import sections_of
from lumped.statics.problem import Problem
from lumped.statics.solver import build_problem, stable_equilibrium
from sheetbench.errors import BadInput
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import Scene, require_static
from sheetbench.scenes.meaning.parameters import FIBRES, parameter, put

STEP = 1e-4  # of a parameter, for the difference of residuals
CALIBRATED_FROM = ("young", "poisson", "thickness", *FIBRES)  # what springs are found from
STEP_OF = {"curvature_": 1e-4, "tilt_": 1e-5, "angle": 1e-5}  # 1/m and rad, of parameters that may be zero
STEP_OF |= {"natural.k": 1e-3, "natural.e": 1e-6, "obstacle": 1e-11}  # m, of what presses in by 1e-8 m
PATCH, PAYLOAD = "patch", "mass"  # with which names of a patch's constants begin, and those of payloads


@dataclass(frozen=True)
class Sensitivity:
    """displacement: (n, 3) [m] at the points; derivatives: parameter → (n, 3) [m per unit of the
    parameter]."""

    displacement: np.ndarray
    derivatives: dict[str, np.ndarray]


Calibrate = Callable[[Scene], Calibration]


def sensitivity(
    scene: Scene,
    calibration: Calibration,
    parameters: Sequence[str],
    points: np.ndarray | None = None,
    calibrate: Calibrate | None = None,
) -> Sensitivity:
    """d(displacement at plan points (n, 2) [m])/d(parameter); the scene's probes unless points are given.

    calibrate: how springs of a changed scene are found; by the same method without options unless given.

    Raises BadInput for an unknown parameter, NoEquilibrium where there is no stable one on these springs.
    """
    with one_blas_thread():
        require_static(scene)
        problem = build_problem(scene, calibration)
        state = stable_equilibrium(problem)
        factor = problem.system.factor(problem.tangent(state.u, 1.0))  # that of the path's end may be older
        at = MidSurface(problem.assembly.lattice, scene.probe_points() if points is None else points)
        derivatives = {}
        for name in parameters:
            rate, moved = rates(calibration, problem, state.u, name, calibrate)
            step = problem.expand(factor.solve(problem.reduce(rate))) + moved
            derivatives[name] = at.of(step)
        return Sensitivity(at.of(state.u), derivatives)


def rates(
    calibration: Calibration, problem: Problem, u: np.ndarray, name: str, calibrate: Calibrate | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """The derivative of the unbalanced force by a parameter at free unknowns that stay as at u (n, 3),
    supports' movement included, and dg/dθ (n, 3)."""
    scene = problem.scene
    if of_scene := name in (*CALIBRATED_FROM, "density") or name.startswith((*STEP_OF, PATCH, PAYLOAD)):
        found = parameter(scene, name)
        value, low, high = found.value, found.low, found.high
    else:
        value, low, high = calibration.constants.value(name), -np.inf, np.inf
    own = name.partition(".")[2] if name.startswith(PATCH) else name
    step = next((h for kind, h in STEP_OF.items() if own.startswith(kind)), STEP * abs(value))
    if step == 0.0:
        raise BadInput(f"parameter {name!r} is zero here: it has no scale to differentiate on")
    sides = []
    placed, ends = problem.prescribed(1.0), np.clip([value + step, value - step], low, high)
    for end in ends.tolist():
        if of_scene:
            changed = build_problem(*_changed(scene, calibration, name, end, calibrate))
        else:
            changed = build_problem(scene, calibration.with_constant(name, end), same=problem)
        moved = changed.prescribed(1.0) - placed
        sides.append(np.stack([changed.residual(u + moved, 1.0).force, moved]))
    rate, moved = (sides[0] - sides[1]) / (ends[0] - ends[1])
    return rate, moved


def _changed(
    scene: Scene, calibration: Calibration, name: str, value: float, calibrate: Calibrate | None
) -> tuple[Scene, Calibration]:
    """The scene with another value, and its springs: by the same method where what they are found from has
    changed, unless `calibrate` finds them."""
    changed = put(scene, name, value)
    if name not in CALIBRATED_FROM and not name.startswith(PATCH):
        return changed, calibration
    if calibrate is not None:
        return changed, calibrate(changed)
    if calibration.method not in MAKERS:
        raise BadInput(
            f"springs of calibration '{calibration.method}' do not follow from the sheet and its material"
        )
    own: dict[str, Any] = {"grading": calibration.grading} if calibration.grading else {}
    if (cells := sections_of(changed, calibration.grid, calibration.grading)) is not None:
        own["cells"] = cells
    make = MAKERS[calibration.method]
    grid, material = calibration.grid, changed.material
    return changed, calibrated_at_rest(changed, lambda sheet: make(sheet, material, grid, **own))

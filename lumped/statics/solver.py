"""Static solutions of a scene on a lattice of calibrated springs."""

from collections.abc import Callable
from functools import cache, partial
from typing import Literal

import numpy as np

from lumped.calibration import Calibration, default
from lumped.calibration.consistent import consistent
from lumped.gradient import Equilibrium
from lumped.lattice import Weights
from lumped.statics import validity
from lumped.statics.answer import solution
from lumped.statics.build import build_problem
from lumped.statics.coarse_start import FROM, coarser_springs, interpolated_displacement
from lumped.statics.energy_descent import descend
from lumped.statics.fields import SMALL
from lumped.statics.problem import STRETCH, LatticePath, LatticeState, Problem
from sheetbench.answers.solution import Iteration, Solution, Status
from sheetbench.clock import now
from sheetbench.errors import BadInput, require_effect
from sheetbench.numerics.continuation.path import Path, Progress
from sheetbench.numerics.continuation.stability import require_stable
from sheetbench.numerics.continuation.trace import trace_path
from sheetbench.numerics.reduced_system import SingularMatrixError
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import (
    AnyScene,
    Clamped,
    Gravity,
    Material,
    Scene,
    Sheet,
    outside_model,
    require_static,
    scene_of,
)
from sheetbench.scenes.objects.material import limit_note

Branch = Literal["path", "stable"]


def solve(
    scene: AnyScene,
    calibration: Calibration | None = None,
    *,
    branch: Branch = "path",
    weights: Weights = "tributary",
    linear: bool = False,
    near: np.ndarray | None = None,
    progress: Callable[[Iteration], None] | None = None,
) -> Solution:
    """Return the static equilibrium of a scene on a lattice, traced from the flat sheet to full load.

    Parameters
    ----------
    scene : Scene, str or Path
        Scene, the name of one in the catalogue, or the path of its file.
    calibration : Calibration, optional
        Springs from `calibrate`; by default the scene's, or consistent ones on nine masses along the shorter
        side.
    branch : {"path", "stable"}, default "path"
        The equilibrium on the load path, stable or not; or, if it is unstable, a stable one by descent in
        energy along a direction of negative curvature.
    weights : {"tributary", "full"}, default "tributary"
        Shares of boundary links and masses: by tributary area, or full ones (Habibi et al.).
    linear : bool, default False
        Whether to solve for small displacements, one step with the flat sheet's tangent.
    near : ndarray of shape (n, 3), optional
        Displacement [m] of the masses in the equilibrium of a similar scene on an equal grid, used as a first
        start; with actuators, and if it leads to no stable equilibrium, the path starts from the flat sheet.
    progress : callable, optional
        Function of an `Iteration`, called at each.

    Returns
    -------
    Solution
        Displacements [m], reactions [N], energies [J] and status. A path that ends before the full load
        keeps the last converged state, with its `load_factor`.

    Raises
    ------
    SceneError
        If no support stops a rigid motion.
    BadInput
        If `linear` is set for a scene with actuators, `near` is of another grid, or an option has no effect
        with `linear` or `near`.

    Notes
    -----
    Newton's method with adaptive load steps (`sheetbench.numerics.continuation`); the lattice is described in
    `docs/theory.md`.

    Examples
    --------
    >>> import lumped
    >>> solution = lumped.solve("two-edges-clamped")
    >>> solution.status, solution.displacement([[0.188, 0.188]]).round(5)
    (<Status.CONVERGED: 'converged'>, array([[-0.0004 , -0.0004 , -0.01345]]))
    """
    require_static(scene := scene_of(scene), "a linear solve" if linear else "")
    if linear and scene.actuators:
        raise BadInput("linear = True: actuators turn with the sheet; solve without")
    if linear:
        require_effect("with linear = True", {"branch": branch != "path", "near": near})
    elif branch != "path" or weights != "tributary":
        require_effect("with another branch than path or other weights than tributary", {"near": near})
    start_time = now()
    compile_kernels()
    calibration = calibration or default(scene)
    problem = build_problem(scene, calibration, weights)
    ready_time = now()
    if linear:
        path = flat_step(problem)
    elif weights == "tributary" and branch == "path":
        path = solve_from_best_start(problem, calibration, near, progress)
    else:
        path = solve_path(problem, branch, progress=progress)
    seconds = ready_time - start_time, now() - ready_time
    options = {"branch": (branch, "path"), "weights": (weights, "tributary"), "linear": (linear, False)}
    requested = {name: value for name, (value, default_value) in options.items() if value != default_value}
    derivatives = partial(Equilibrium.of, scene, calibration, path.state.u)
    differentiable = not linear and weights == "tributary"
    return solution(problem, path, calibration, seconds, requested, derivatives if differentiable else None)


@cache
def compile_kernels() -> None:
    """Solve a small sheet once a process, so that no solve's time includes the loading of compiled
    kernels."""
    sheet = Sheet(length_x=1.0, length_y=1.0, thickness=0.05)
    material = Material(young=1e6, poisson=0.3, density=1e3)
    gravity = Gravity(acceleration=(0.0, 0.0, -1.0))
    held = (Clamped(edge="x0"),)
    scene = Scene(name="small", sheet=sheet, material=material, gravity=gravity, supports=held)
    solve_path(build_problem(scene, consistent(sheet, material, (3, 7, 2))))


def flat_step(problem: Problem) -> LatticePath:
    """Return the equilibrium of small displacements: K u = f with the flat sheet's tangent K."""
    path = Path(problem, problem, problem.rest(), factorisations=1)
    try:
        with one_blas_thread():
            blocks, rows = problem.linearised(path.state, problem.forces(path.state, 1.0), 1.0)
            u = problem.expand(problem.factor(blocks).solve(rows)) + problem.prescribed(1.0)
    except SingularMatrixError as error:
        path.status, path.notes = Status.SINGULAR, [f"the flat sheet's tangent is singular: {error}"]
        return path
    path.state, path.status = LatticeState(u, 1.0), Status.CONVERGED
    strain = problem.assembly.at(SMALL).links.largest_strain(SMALL * u) / SMALL
    if outside := outside_model(problem.scene, strain, STRETCH):
        path.status, path.notes = Status.STRAIN_OUTSIDE_MODEL, [outside]
    return path


def solve_path(
    problem: Problem,
    branch: Branch = "path",
    near: np.ndarray | None = None,
    progress: Progress | None = None,
) -> LatticePath:
    """Return the path to the equilibrium at full load, or to the last converged load; near: displacement (n,
    3) [m] to begin at."""
    path = trace_path(
        problem,
        problem,
        problem.inspect,
        descend if problem.descends else None,
        progress,
        None if near is None else problem.start(near),
        problem.scene.sheet.thickness / problem.size,
        problem.limits,
        branch == "stable",
    )
    classify(problem, path)
    return path


def stable_equilibrium(problem: Problem) -> LatticeState:
    """Return the stable equilibrium on the load path at full load. Raises NoEquilibrium without one."""
    path = solve_path(problem)
    require_stable("lumped", path.status, path.notes)
    return path.state


def solve_from_best_start(
    problem: Problem,
    calibration: Calibration,
    near: np.ndarray | None = None,
    progress: Progress | None = None,
) -> LatticePath:
    """Return the path to the equilibrium at full load, started from `near` (n, 3) [m] or, for a large
    lattice, from the equilibrium of the lattice with half as many cells a side."""
    if near is not None and near.shape != problem.loads.dead.shape:
        raise BadInput(f"near: shape {near.shape}; the lattice needs {problem.loads.dead.shape}")
    if problem.assembly.coupling is not None:  # its unknowns depend on the grid
        return solve_path(problem, progress=progress)
    may_start_coarser = near is None and not problem.contacts  # contact points differ on another grid
    large = may_start_coarser and problem.descends and problem.system.unknowns > FROM
    springs = coarser_springs(problem.scene, calibration) if large else None
    if springs is None:
        return solve_path(problem, "path", near, progress)
    smaller = build_problem(problem.scene, springs)
    path = solve_from_best_start(smaller, springs, progress=progress)
    factorisations, history = path.factorisations, path.history
    if path.status is Status.CONVERGED and not path.snaps and not path.notes:
        near = interpolated_displacement(smaller.assembly.lattice, path.state.u, problem.assembly.lattice)
    del smaller, path  # and the memory of their factors
    path = solve_path(problem, "path", near, progress)
    path.factorisations += factorisations
    path.history[:0] = history
    return path


def classify(problem: Problem, path: LatticePath) -> None:
    """Set a path's status and notes by the validity of its last state: strain beyond the model, and reasons
    for doubt."""
    scene, state, notes = problem.scene, path.state, path.notes
    if path.fault is not None:
        if scene.material.limit and any(support.motion is not None for support in scene.supports):
            notes.append(limit_note(scene.material))
        return
    survey = problem.survey(state.u, state.load_factor)
    path.state = state._replace(energies=survey.energies)
    rounded = validity.lost_digits(problem, state, path.factor)
    outside = outside_model(scene, survey.strain, STRETCH)
    if outside and not problem.assembly.any_strain:
        path.status = Status.STRAIN_OUTSIDE_MODEL
        notes.insert(0, outside)
    elif rounded is not None and path.status is Status.CONVERGED:
        path.status = rounded.status
    cautions = [validity.thin_layers(problem, state, survey), rounded.message if rounded is not None else ""]
    cautions.append(
        validity.slender_cells(problem.assembly.lattice) if path.status is Status.UNSTABLE else ""
    )
    if not problem.assembly.conservative:
        cautions.append(
            "per-direction springs: not central, they have no energy and keep no moments; solved with an "
            "unsymmetric tangent"
        )
    elif not problem.conservative:
        cautions.append("follower loads: solved with an unsymmetric tangent")
    notes.extend(filter(None, cautions))

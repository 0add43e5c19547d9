"""Statics of a lattice: a scene and springs in, a `scenes.Solution` out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache, partial
from typing import Any, Literal

import numpy as np

from lumped.actuators import Coupling
from lumped.assembly import Assembly, Precision
from lumped.calibration import Calibration, default
from lumped.calibration.consistent import consistent
from lumped.lattice import Weights
from lumped.loads import Loads
from lumped.sections import require_alike
from lumped.springs.families import Links
from lumped.statics import validity
from lumped.statics.answer import Outcome, solution
from lumped.statics.arc import limit_point
from lumped.statics.coarse_start import FROM, halved, refined
from lumped.statics.energy_descent import descend, disturbed
from lumped.statics.equilibrium import (
    HELD_TO_NOTHING,
    State,
    StepFailed,
    at_rest,
    follow,
    newton_at_load,
    predictor,
    refine,
)
from lumped.statics.faults import broken
from lumped.statics.fields import SMALL
from lumped.statics.limits import DEARER, DOUBTFUL, FACTORISATIONS
from lumped.statics.polygon import polygons
from lumped.statics.problem import Problem
from lumped.supports import constrain
from sheetbench.clock import now
from sheetbench.errors import BadInput, NoEquilibrium, require_effect
from sheetbench.numerics.reduced import SingularMatrixError
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import (
    AnyScene,
    Clamped,
    Gravity,
    Iteration,
    Material,
    Scene,
    Sheet,
    Solution,
    Status,
    outside_model,
    require_static,
    scene_of,
)
from sheetbench.scenes.material import limit_note
from sheetbench.scenes.orthotropy import FIBRES

STRETCH = "largest in-plane link strain"
UNKNOWN = "stability not known: the tangent's factors do not tell how many eigenvalues are negative"
SNAPS = 12  # of one load path
SNAP_STEP = 0.02  # in load factor, past the point where the path ended

Branch = Literal["path", "stable"]


def solve(
    scene: AnyScene,
    calibration: Calibration | None = None,
    *,
    branch: Branch = "path",
    weights: Weights = "tributary",
    linear: bool = False,
    precision: Precision = "double",
    near: np.ndarray | None = None,
    progress: Callable[[Iteration], None] | None = None,
) -> Solution:
    """Static equilibrium of the scene on a lattice with these springs, from flat to full load.

    scene: or a name of the catalogue, or a path. calibration: from `calibrate`; without it the scene's own
    [springs], or else `consistent` on nine masses along the shorter side.
    branch: "path" reports the equilibrium on the load path, stable or not; "stable" leaves an unstable one
    along a direction of negative curvature and descends to a stable equilibrium. weights: "full" gives
    boundary links and masses full shares, as Habibi et al. have them. linear: the answer for small
    displacements, one step with the flat sheet's tangent. precision: of the internal force
    (`lumped.assembly`). near: the masses' displacement (n, 3) [m] in an equilibrium of a scene much like
    this one on this grid, to be sought from first; where that leads to no stable one, and with actuators,
    from flat. progress: called once an iteration.

    Raises scenes.SceneError when nothing stops a rigid motion, BadInput for linear with actuators, for `near`
    of another grid, and for options that have no effect beside linear or near. Every other outcome is a
    status; where the full load was not reached, the last converged load is kept and `load_factor` says which.

    >>> import lumped
    >>> solution = lumped.solve("two-edges-clamped")
    >>> solution.status, solution.displacement([[0.188, 0.188]]).round(5)
    (<Status.CONVERGED: 'converged'>, array([[-0.0004 , -0.0004 , -0.01345]]))
    """
    require_static(scene := scene_of(scene))
    if linear and scene.actuators:
        raise BadInput("linear = True: actuators turn with the sheet; solve without")
    if linear:
        others = {"branch": branch != "path", "near": near, "precision": precision != "double"}
        require_effect("with linear = True", others)
    elif branch != "path" or weights != "tributary":
        require_effect("with another branch than path or other weights than tributary", {"near": near})
    began = now()
    compile_kernels()
    calibration = calibration or default(scene)
    problem = build_problem(scene, calibration, weights, precision)
    problem.progress = progress
    ready = now()
    with one_blas_thread():
        if linear:
            outcome = flat_step(scene, problem)
        elif weights == "tributary" and branch == "path":
            outcome = equilibrium(scene, problem, calibration, near)
        else:
            outcome = solve_path(scene, problem, branch)
    done = now()
    usual = {"branch": "path", "weights": "tributary", "precision": "double", "linear": False}
    options = {"branch": branch, "weights": weights, "precision": precision, "linear": linear}
    requested = {name: value for name, value in options.items() if value != usual[name]}
    return solution(scene, calibration, problem, outcome, (ready - began, done - ready), requested)


@cache
def compile_kernels() -> None:
    """Solve a small sheet once a process, so that no solve's time holds the loading of compiled kernels."""
    sheet = Sheet(length_x=1.0, length_y=1.0, thickness=0.05)
    material = Material(young=1e6, poisson=0.3, density=1e3)
    gravity = Gravity(acceleration=(0.0, 0.0, -1.0))
    scene = Scene(
        name="small", sheet=sheet, material=material, gravity=gravity, supports=(Clamped(edge="x0"),)
    )
    with one_blas_thread():
        solve_path(scene, build_problem(scene, consistent(sheet, material, (3, 7, 2))), "path")


def build_problem(
    scene: Scene,
    calibration: Calibration,
    weights: Weights = "tributary",
    precision: Precision = "double",
    same: Problem | None = None,
) -> Problem:
    """The lattice of a scene under its supports and loads. same: of this scene with other springs, whose
    supports and loads serve again where they are on the same lattice. Raises BadInput if no mass is left to
    move, and for springs of cells that are all alike where the scene's are not."""
    fibres_alone = calibration.of_material and scene.drawn_by == FIBRES
    if (calibration.cells is None or calibration.of_material) and not fibres_alone:
        instead = "calibrate with cells=lumped.sections_of(scene, grid)"
        require_alike(scene, f"the calibration {calibration.method}", instead)
    couple = partial(Coupling, scene) if scene.actuators else None
    assembly = Assembly(scene.sheet, calibration, weights, couple, precision, scene.twisting_edges())
    size = max(scene.sheet.lengths)
    if same is not None and same.assembly.lattice is assembly.lattice and couple is None:
        return Problem(assembly, same.constraints, same.loads, size)
    constraints = constrain(scene, assembly.lattice, assembly.coupling)
    if not constraints.transform.shape[1]:
        grid = "×".join(str(n) for n in assembly.lattice.grid)
        raise BadInput(f"grid = {grid}: the supports hold every mass; take a finer one")
    return Problem(assembly, constraints, Loads(scene, assembly), size)


def flat_step(scene: Scene, problem: Problem) -> Outcome:
    """The equilibrium of small displacements: K u = f with the flat sheet's tangent K."""
    try:
        start = at_rest(problem)
    except SingularMatrixError as error:
        return _singular(problem, error)
    u = predictor(problem, start, 1.0)
    state = replace(start, u=u, load_factor=1.0)
    links = problem.assembly.links
    if outside := outside_model(scene, link_stretch(links, links.elongations(SMALL * u)) / SMALL, STRETCH):
        return Outcome(Status.STRAIN_OUTSIDE_MODEL, state, notes=(outside,))
    return Outcome(Status.CONVERGED, state)


def _singular(problem: Problem, error: SingularMatrixError) -> Outcome:
    blocks = np.zeros((problem.assembly.pattern.blocks, 3, 3))
    none: Any = None
    rest = State(np.zeros_like(problem.loads.dead), 0.0, blocks, none, none)
    return Outcome(Status.SINGULAR, rest, notes=(f"the flat sheet's tangent is singular: {error}",))


def solve_path(scene: Scene, problem: Problem, branch: Branch) -> Outcome:
    """The equilibrium at full load, or how far the load path went and why."""
    try:
        state, why = follow(problem, at_rest(problem))
    except SingularMatrixError as error:
        return _singular(problem, error)
    snaps: list[float] = []
    notes: list[str] = []
    more = worth(scene, problem, state) if problem.fault is None else 0
    careful = more > 0
    if careful:
        reached, limit = None if why else state.u, problem.factorisations + more
        state, why = follow(problem, at_rest(problem), careful=True, limit=limit)
        unheld = why == HELD_TO_NOTHING
        spent = problem.factorisations > limit
        if why and (spent or unheld) and reached is not None and problem.fault is None:
            here = f"small load steps end at load factor {state.load_factor:.4g}, after {more} factorisations"
            notes.append(
                f"{why if unheld else here}: this equilibrium, which large ones led to, may be on another "
                "branch"
            )
            state, why = refine(problem, reached, 1.0), ""
    while why and problem.fault is None and problem.descends and len(snaps) < SNAPS:
        if problem.factorisations > FACTORISATIONS:
            break
        beyond = min(1.0, state.load_factor + SNAP_STEP)
        try:
            landed = descend(problem, state.u, beyond)
        except (StepFailed, SingularMatrixError) as error:
            why = f"{why}; then {error}"
            break
        snaps.append(state.load_factor)
        state, why = follow(problem, landed, careful=careful)
    if not why and branch == "stable" and state.negative and problem.descends:
        try:
            state = descend(problem, disturbed(problem, state), 1.0)
            notes.append("left an unstable equilibrium by descent in energy")
        except (StepFailed, SingularMatrixError) as error:
            notes.append(f"no stable equilibrium found nearby: {error}")
    if why:
        status = Status.DIVERGED if problem.factorisations <= FACTORISATIONS else Status.STEP_LIMIT
        if problem.fault is not None:
            status = problem.fault.status
        notes = [f"load factor {state.load_factor:.4g} of 1 reached: {why}"]
        if problem.fault is None and (ends := limit_point(problem, state)) is not None:
            notes.append(
                f"a limit point between load factors {ends[0]:.5g} and {ends[1]:.5g}: from there on the load "
                "falls as the sheet gives way"
            )
        elif scene.material.limit and any(support.motion is not None for support in scene.supports):
            notes.append(limit_note(scene.material))
        return Outcome(status, state, tuple(snaps), tuple(notes))
    return classify(scene, problem, state, snaps, notes)


def stable_equilibrium(scene: Scene, problem: Problem) -> State:
    """The stable equilibrium on the load path at full load. Raises NoEquilibrium where there is none."""
    with one_blas_thread():
        outcome = solve_path(scene, problem, "path")
    if outcome.status is not Status.CONVERGED:
        raise NoEquilibrium(f"lumped: {outcome.status}: {'; '.join([*outcome.notes, outcome.status.advice])}")
    return outcome.state


def worth(scene: Scene, problem: Problem, state: State) -> int:
    """Factorisations that it is worth to look for another branch, which large load steps may have left: where
    the equilibrium is unstable or took long to find. Up to DEARER times those before, or all that there are
    for an unstable one that the springs mean something at."""
    taken, links = problem.factorisations, problem.assembly.links
    if not problem.conservative or not (state.negative or taken > DOUBTFUL):
        return 0
    outside = outside_model(scene, link_stretch(links, links.elongations(state.u)), STRETCH)
    return FACTORISATIONS if state.negative and not outside else DEARER * taken


def equilibrium(
    scene: Scene, problem: Problem, springs: Calibration, near: np.ndarray | None = None
) -> Outcome:
    """The equilibrium on the load path at full load, from one nearby or a smaller lattice's if that does."""
    found = None if near is None else _from_near(scene, problem, near)
    return found or _from_coarser(scene, problem, springs) or solve_path(scene, problem, "path")


def _from_coarser(scene: Scene, problem: Problem, calibration: Calibration) -> Outcome | None:
    """The equilibrium of a large lattice from that of a smaller one; None where it must go the whole path."""
    springs = halved(scene, calibration) if problem.iterates and problem.system.unknowns > FROM else None
    if springs is None:
        return None
    smaller = build_problem(scene, springs, precision=problem.assembly.precision)
    smaller.progress = problem.progress
    outcome = equilibrium(scene, smaller, springs)
    problem.factorisations += smaller.factorisations
    problem.history.extend(smaller.history)
    if outcome.status is not Status.CONVERGED or outcome.snaps or outcome.notes:
        return None
    u = refined(smaller.assembly.lattice, outcome.state.u, problem.assembly.lattice)
    del smaller, outcome  # and the memory of their factors
    return _from_near(scene, problem, u)


def _from_near(scene: Scene, problem: Problem, u: np.ndarray) -> Outcome | None:
    """The stable equilibrium that corrections lead to from u, or None."""
    if problem.assembly.coupling is not None:
        return None
    if u.shape != problem.loads.dead.shape:
        raise BadInput(f"near: of shape {u.shape}, and the lattice's {problem.loads.dead.shape}")
    u = problem.project_to_supports(u, 1.0)
    try:
        began = problem.advance(u, np.zeros_like(u), 1.0, True)._replace(length=float(np.abs(u).max()))
        state = newton_at_load(problem, began, 1.0)
    except (StepFailed, SingularMatrixError):
        return None
    if state.negative != 0 or broken(problem.assembly, state.u[None])[1] is not None:
        return None
    return classify(scene, problem, state)


def classify(
    scene: Scene, problem: Problem, state: State, snaps: Sequence[float] = (), known: Sequence[str] = ()
) -> Outcome:
    """The outcome of an equilibrium at full load: whether the springs mean anything at this strain, and
    whether it is stable. snaps, known: on the way there, and what there was to say."""
    notes = list(known)
    status = Status.CONVERGED
    links = problem.assembly.links
    elongations = links.elongations(state.u)
    outside = outside_model(scene, link_stretch(links, elongations), STRETCH)
    if outside and not problem.assembly.any_strain:
        status = Status.STRAIN_OUTSIDE_MODEL
        notes.append(outside)
    elif state.negative:
        status = Status.UNSTABLE
        notes.append(f"{state.negative} directions of negative curvature")
    elif state.negative is None:
        notes.append(UNKNOWN)
    energies = problem.assembly.energies(state.u)
    doubts = validity.layers(scene, problem.assembly, state.u, elongations, sum(energies.values()))
    rounded = validity.digits(problem, state)
    if rounded is not None and status is Status.CONVERGED:
        status = rounded.status
    notes.extend(
        filter(
            None,
            [
                doubts,
                polygons(scene),
                rounded.message if rounded is not None else "",
            ],
        )
    )
    if not problem.assembly.conservative:
        notes.append(
            "per-direction springs: not central, they have no energy and keep no moments; solved with an "
            "unsymmetric tangent"
        )
    elif not problem.conservative:
        notes.append("follower loads: solved with an unsymmetric tangent")
    return Outcome(status, state, tuple(snaps), tuple(notes), energies)


def link_stretch(links: Links, elongations: np.ndarray) -> float:
    """Return the largest relative change of length of the in-plane links, from their elongations (m,) [m]."""
    at = links.in_plane
    return float(np.abs(elongations[at] / links.rest_length[at]).max(initial=0.0))

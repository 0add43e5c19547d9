"""Solution of a discrete sheet: displacements, reactions, energies, wrenches of actuators, balance.

Strains are made of scalar products of positions and directors, so that internal forces on all of them cancel,
and so do their moments, in any shape. The remaining imbalance is the residual of the free unknowns, which the
solver has brought below its tolerance or to its rounding error, and the rounding of the sums; the loads are
the scene's own (see `surface.balance`).
"""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple, cast

import numpy as np
from skfem import MeshQuad

from fem_reference.discrete import tangent_planes
from fem_reference.discrete.elements import DiscreteElements
from fem_reference.discrete.shape import SheetShape
from fem_reference.discrete.sheet import Discrete
from fem_reference.discrete.static import Forces, Static, StaticState
from fem_reference.surface.balance import load_balance
from fem_reference.surface.location import interpolate
from sheetbench.answers.solution import Solution, Status
from sheetbench.clock import now
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.continuation.newton import Start
from sheetbench.numerics.continuation.path import Fault, Inspect, Path
from sheetbench.numerics.continuation.pseudo_transient import relax
from sheetbench.numerics.continuation.trace import trace_path
from sheetbench.scenes import Scene
from sheetbench.scenes.objects.material import limit_note

EPSILON = float(np.finfo(float).eps)
EXACT = Limits(first_reach=np.inf, farthest=np.inf, smallest_step=1.0)  # of linear sheets: one step


def shape_of(path: Path[StaticState, Forces]) -> SheetShape:
    """Return a sheet's shape at the last equilibrium of a path."""
    return cast(Static, path.structure).shape(path.state, path.load_factor)


class TracedPath(NamedTuple):
    """A path of a sheet at rest to its full load, with the seconds that setting up and solving took."""

    sheet: DiscreteElements
    path: Path[StaticState, Forces]
    setup_seconds: float
    solve_seconds: float


def last_fault(path: Path[StaticState, Forces]) -> Fault | None:
    """Return the fault of a path's last equilibrium, None if it is valid."""
    shape = shape_of(path)
    return shape.sheet.fault(shape)


def trace_sheet(
    make: Callable[[], DiscreteElements],
    inspect: Inspect[StaticState, Forces] = last_fault,
    near: Callable[[Any], Start[StaticState]] | None = None,
    **options: Any,
) -> TracedPath:
    """Build a sheet by `make`, and return the path to its full load with the times taken. near: a function of
    the sheet that returns the path's start; options: of `trace_path`."""
    started = now()
    sheet = make()
    ready = now()
    start, slenderness = near and near(sheet), sheet.scene.sheet.thickness / sheet.longer_side
    settle = relax if sheet.creeps else None
    options = ({"limits": EXACT} if sheet.linear else {}) | options
    options |= {"near": start, "slenderness": slenderness}
    path = trace_path(Static(sheet), sheet.solver(), inspect, settle, **options)
    path.factor = None  # not kept with the run
    return TracedPath(sheet, path, ready - started, now() - ready)


def equilibrium(sheet: DiscreteElements) -> tuple[np.ndarray, Status, list[str]]:
    """Return the coordinates q (N,) of a sheet's equilibrium under full load, the status of its path, and
    notes."""
    path = trace_sheet(lambda: sheet).path
    return path.state.q, *path_status(path)


def path_status(path: Path[StaticState, Forces]) -> tuple[Status, list[str]]:
    """Return the status and notes of a path that has ended; a strain beyond the law's range changes both."""
    shape = shape_of(path)
    outside = shape.sheet.beyond(shape.stretch)
    if not outside or path.status is Status.NON_FINITE:
        return path.status, path.notes
    return Status.STRAIN_OUTSIDE_MODEL, [outside, *path.notes]


def solve_on(model: type[Discrete], mesh: MeshQuad, scene: Scene) -> Solution:
    """Return the equilibrium on any flat mesh of quadrilaterals [m], of the shell also biquadratic ones.
    Supports and loads act on the mesh's boundaries named like their edges ("x0", …), which may lie anywhere;
    the scene's sheet contributes only its thickness, and the lengths of edges with actuators."""
    kind: Any = model
    run = trace_sheet(lambda: kind(mesh, scene))
    run.sheet.own_outline = True
    return solution_of(run, elements=mesh.nelements)


def _sample(sample: Any, mesh: MeshQuad, vectors: np.ndarray, points: np.ndarray) -> np.ndarray:
    return np.asarray(sample(points) + tangent_planes.change_at(mesh, vectors, points)[1])


def solution_of(*runs: TracedPath, fallback: str = "", **settings: Any) -> Solution:
    """Return the solution of the first of several runs; the others prepared its start, the latest first.
    settings: added to the settings of the sheet."""
    path = runs[0].path
    shape, share = shape_of(path), path.load_factor
    sheet, forces = shape.sheet, path.structure.forces(path.state, share)
    imbalance = max(Limits.tolerance * forces.size, path.structure.imbalance(path.state, forces))
    if sheet.norm == 2:  # a sum of n numbers is at most √n times their norm
        imbalance *= np.sqrt(sheet.unknowns)
    allowed = float(imbalance + EPSILON * sheet.summed(shape))
    status, notes = path_status(path)
    if status is Status.NON_FINITE and sheet.settings.get("law") == "gent":  # beyond its limit
        notes = [*notes, limit_note(sheet.scene.material)]
    residual, q = forces.residual, shape.q
    scene, surface, rods, plan = sheet.scene, sheet.surface(q), sheet.rods, sheet.plan
    edges, wrenches, line = sheet.wrenches(shape, residual)
    reactions, energies = sheet.reactions(residual, share), sheet.element.energies(shape.strain)
    holding_forces = sheet.holding(q, residual, share)
    by_items = sheet.item_support_forces(shape)
    reactions |= {name: forces.sum(axis=0) for name, (_, forces) in by_items.items()}
    holding_forces += by_items.values()
    mesh = sheet.drawn(q, line if scene.actuators else None)
    sample: Any = partial(interpolate, plan.mesh, plan.elements, sheet.middles(sheet.displacement(q)))
    if sheet.touched_without_kinks(shape):
        sample = partial(_sample, sample, plan.mesh, shape.vectors)
    contacts = {run.name: run.report(shape) for run in sheet.contacts}
    if contacts:
        energies |= {"contact": sum(run.potential(shape) for run in sheet.contacts)}
        pressure = np.sum([pressure for _, pressure in contacts.values()], axis=0)
        mesh.point_data["contact_pressure"] = np.repeat(pressure, len(mesh.points) // len(pressure))
    return Solution(
        model=sheet.model,
        unknowns=sheet.unknowns,
        sample=sample,
        reactions=reactions,
        energies=energies | ({"rod": rods.energy(q, share)} if scene.actuators else {}),
        mesh=mesh,
        contacts={name: state for name, (state, _) in contacts.items()},
        actuators=wrenches,
        balance=load_balance(scene, surface, edges, reactions, holding_forces, forces.size, allowed, share),
        label=sheet.label,
        settings=sheet.settings | settings,
        status=status,
        iterations=sum(run.path.factorisations for run in runs),
        setup_seconds=sum(run.setup_seconds for run in runs),
        solve_seconds=sum(run.solve_seconds for run in runs),
        history=tuple(entry for run in runs[::-1] for entry in run.path.history),
        load_factor=share,
        snaps=tuple(path.snaps),
        fallback=fallback,
        remarks=tuple(notes),
        stretch=shape.stretch,
    )

"""What a discrete sheet answers with: displacements, reactions, energies, wrenches of actuators, balance.

Strains are made of scalar products of positions and directors, so that internal forces on all of them cancel,
and so do their moments, whatever the shape. What is left over is the residual of the free unknowns, which the
solver has brought below its tolerance or to where rounding stops it, and the rounding of the sums; the loads
are the scene's own (see `surface.balance`).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple, cast

import numpy as np
from skfem import MeshQuad

from fem_reference.discrete.elements import DiscreteElements
from fem_reference.discrete.shape import SheetShape
from fem_reference.discrete.sheet import Discrete
from fem_reference.discrete.static import Forces, Static, StaticState
from fem_reference.surface.balance import left_over
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
EXACT = Limits(first_reach=np.inf, farthest=np.inf, smallest_step=1.0)  # of linear sheets: one step is all


def shape_of(path: Path[StaticState, Forces]) -> SheetShape:
    """Return the shape of a sheet at the last equilibrium of a path."""
    return cast(Static, path.structure).shape(path.state, path.load_factor)


class Traced(NamedTuple):
    """A path of a sheet at rest to its full load, with the seconds that setting up and solving took."""

    sheet: DiscreteElements
    path: Path[StaticState, Forces]
    setup_seconds: float
    solve_seconds: float


def inspected(path: Path[StaticState, Forces]) -> Fault | None:
    """Return why a step of a path is given up."""
    found: Fault | None = (shape := shape_of(path)).sheet.fault(shape)
    return found


def traced(
    make: Callable[[], DiscreteElements],
    inspect: Inspect[StaticState, Forces] = inspected,
    near: Callable[[Any], Start[StaticState]] | None = None,
    **options: Any,
) -> Traced:
    """Return the run of a sheet that is made here. near: where it is to begin; options: of `trace_path`."""
    begin = now()
    sheet = make()
    ready = now()
    start, slenderness = near and near(sheet), sheet.scene.sheet.thickness / sheet.lever
    settle = relax if sheet.creeps else None
    options = ({"limits": EXACT} if sheet.linear else {}) | options
    options |= {"near": start, "slenderness": slenderness}
    path = trace_path(Static(sheet), sheet.solver(), inspect, settle, **options)
    path.factor = None  # a run is kept longer than that
    return Traced(sheet, path, ready - begin, now() - ready)


def equilibrium(sheet: DiscreteElements) -> tuple[np.ndarray, Status, list[str]]:
    """Return q (N,) under the full load of a sheet at rest, how the path to it ended, and notes."""
    path = traced(lambda: sheet).path
    return path.state.q, *judge(path)


def judge(path: Path[StaticState, Forces]) -> tuple[Status, list[str]]:
    """Return status and notes of a path that has ended, strains beyond the law among them."""
    shape = shape_of(path)
    outside = shape.sheet.beyond(shape.stretch)
    if not outside or path.status is Status.NON_FINITE:
        return path.status, path.notes
    return Status.STRAIN_OUTSIDE_MODEL, [outside, *path.notes]


def solve_on(model: type[Discrete], mesh: MeshQuad, scene: Scene) -> Solution:
    """Return the equilibrium on any flat mesh of quadrilaterals [m], of the shell also biquadratic ones.

    Supports and loads act on the mesh's boundaries of their edges' names ("x0", …), which may lie
    anywhere; of the scene's sheet only the thickness is used, and the lengths of edges with actuators.
    """
    kind: Any = model
    found = traced(lambda: kind(mesh, scene))
    found.sheet.own = True
    return answered(found, elements=mesh.nelements)


def answered(*runs: Traced, fallback: str = "", **settings: Any) -> Solution:
    """Return the answer of the first of these runs, which took the others too, the last of them first.
    settings: beside those of the sheet."""
    path = runs[0].path
    shape, share = shape_of(path), path.load_factor
    sheet, forces = shape.sheet, path.structure.forces(path.state, share)
    left = max(Limits.tolerance * forces.size, path.structure.imbalance(path.state, forces))
    if sheet.norm == 2:  # a sum of n numbers is at most √n times their norm
        left *= np.sqrt(sheet.unknowns)
    allowed = float(left + EPSILON * sheet.summed(shape))
    status, notes = judge(path)
    if status is Status.NON_FINITE and sheet.settings.get("law") == "gent":  # beyond its limit
        notes = [*notes, limit_note(sheet.scene.material)]
    residual, q = forces.residual, shape.q
    scene, surface, rods, plan = sheet.scene, sheet.surface(q), sheet.rods, sheet.plan
    edges, wrenches, line = sheet.wrenches(shape, residual)
    reactions, energies = sheet.reactions(residual, share), sheet.element.energies(shape.strain)
    held = sheet.holding(q, residual, share)
    by_items = sheet.held_by_items(shape)
    reactions |= {name: forces.sum(axis=0) for name, (_, forces) in by_items.items()}
    held += by_items.values()
    mesh = sheet.drawn(q, line if scene.actuators else None)
    contacts = {one.name: one.report(shape) for one in sheet.contacts}
    if contacts:
        energies |= {"contact": sum(one.potential(shape) for one in sheet.contacts)}
        pressure = np.sum([pressure for _, pressure in contacts.values()], axis=0)
        mesh.point_data["contact_pressure"] = np.repeat(pressure, len(mesh.points) // len(pressure))
    return Solution(
        model=sheet.model,
        unknowns=sheet.unknowns,
        sample=partial(interpolate, plan.mesh, plan.elements, sheet.middles(sheet.displacement(q))),
        reactions=reactions,
        energies=energies | ({"rod": rods.energy(q, share)} if scene.actuators else {}),
        mesh=mesh,
        contacts={name: state for name, (state, _) in contacts.items()},
        actuators=wrenches,
        balance=left_over(scene, surface, edges, reactions, held, forces.size, allowed, share),
        label=sheet.label,
        settings=sheet.settings | settings,
        status=status,
        iterations=sum(one.path.factorisations for one in runs),
        setup_seconds=sum(one.setup_seconds for one in runs),
        solve_seconds=sum(one.solve_seconds for one in runs),
        history=tuple(entry for one in runs[::-1] for entry in one.path.history),
        load_factor=share,
        snaps=tuple(path.snaps),
        fallback=fallback,
        remarks=tuple(notes),
        stretch=shape.stretch,
    )

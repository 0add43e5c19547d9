"""A cell of statics: the lattice's equilibrium against the shell's, and why they differ where they do.

A converged lattice that is off by more than 5 % is tested, until one test tells:

    resolution   half the cell size (or a reference of twice as many elements) takes a third of the error
                 away, or more
    branch       the same lattice, loaded by half as much again and brought back, ends elsewhere, or one of
                 the two has snapped: several equilibria, and the models found different ones
    wrong limit  the refined lattice keeps its error against the refined shell, and has no other branch: the
                 springs, or the law of strain where strains are large, stand for another sheet
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import fem_reference
import lumped
from comparisons.comparison.comparison import error as probe_error
from comparisons.models.resolve import resolve
from comparisons.models.spec import GradingLike, Lattice
from comparisons.stability.rows import LARGE, Row, percent
from sheetbench.scenes import Clamped, Gravity, Material, Scene, Sheet, Solution, Status
from sheetbench.scenes.sheet import EdgeName

SIDE, GRAVITY = 0.188, 9.81  # of Habibi et al.'s sheet, of the Earth
POISSON = 0.48
EDGES: dict[int, tuple[EdgeName, ...]] = {1: ("x0",), 2: ("x0", "y0")}
NAMES = {1: "one edge clamped", 2: "two edges clamped"}
ELEMENTS = 12
FALLEN = 2.0 / 3.0  # of the error, that refining must leave at most to be the reason
FINEST = 65  # masses a side
BACK_FROM, BACK_BY = 1.5, (1.3, 1.15, 1.0)  # load from which the lattice is brought back, and by which

Grid = tuple[int, int]
Springs = Callable[[Grid], lumped.Calibration]  # of a scene, on any grid


def sheet(
    slenderness: float,
    load_number: float,
    edges: tuple[EdgeName, ...] = ("x0",),
    young: float = 1e7,
    poisson: float = POISSON,
    **more: Any,
) -> Scene:
    """A square sheet clamped at `edges` under its own weight: thickness/side and ρ g h a³/D as given."""
    thickness = slenderness * SIDE
    rigidity = young * thickness**3 / 12.0 / (1.0 - poisson**2)
    density = abs(load_number) * rigidity / (GRAVITY * thickness * SIDE**3)
    return Scene(
        name="-and-".join(edges) + "-clamped",
        sheet=Sheet(length_x=SIDE, length_y=SIDE, thickness=thickness),
        material=Material(young=young, poisson=poisson, density=density or 1.0),
        gravity=Gravity(acceleration=(0.0, 0.0, -np.sign(load_number) * GRAVITY)),
        **{"supports": tuple(Clamped(edge=edge) for edge in edges), **more},
    )


def consistent(scene: Scene, grading: GradingLike = None) -> Springs:
    """Consistent springs of a scene, on grids of this grading."""
    return lambda grid: resolve(scene, Lattice(grid, "consistent", grading=grading), "springs").springs


def shell(scene: Scene, elements: int = ELEMENTS) -> Solution:
    """The reference's answer."""
    return fem_reference.solve(scene, model="shell", elements=elements)


def compare(
    scene: Scene,
    grid: Grid,
    *,
    elements: int = ELEMENTS,
    springs: Springs | None = None,
    single: bool = False,
    explain: bool = True,
) -> Row:
    """The row of a lattice against the shell; springs: consistent ones unless given; single: the lattice in
    single precision too, how it ended and its distance from double."""
    springs = springs or consistent(scene)
    ours, truth = lumped.solve(scene, springs(grid)), shell(scene, elements)
    row = {**outcome(ours), "error": distance(scene, ours, truth), "reference": outcome(truth)}
    if single:
        rounded = lumped.solve(scene, springs(grid), precision="single")
        row["single_error"] = distance(scene, rounded, ours)
        row["single_status"], row["single_message"] = str(rounded.status), rounded.message
    if explain and ours.status is Status.CONVERGED and (row["error"] or 0.0) > LARGE:
        row |= mechanism(scene, grid, elements, ours, truth, springs)
    return row


def outcome(solution: Solution) -> Row:
    """How a solve ended; `non-finite` where an answer that calls itself converged is not."""
    finite = np.isfinite(solution.mesh.point_data["displacement"]).all()
    return {
        "status": str(solution.status if finite else Status.NON_FINITE),
        "load_factor": solution.load_factor,
        "iterations": solution.iterations,
        "seconds": solution.solve_seconds,
        "message": solution.message,
        "snaps": list(solution.snaps),
    }


def distance(scene: Scene, ours: Solution, truth: Solution) -> float | None:
    """The error at the probes where both reached the full load with numbers that mean something."""
    if not (ours.comparable and truth.comparable):
        return None
    points = scene.probe_points()
    return probe_error(ours.displacement(points), truth.displacement(points))


def mechanism(
    scene: Scene, grid: Grid, elements: int, ours: Solution, truth: Solution, springs: Springs
) -> Row:
    """What makes a converged lattice differ, by the tests that the module names, and what they gave."""
    allowed = FALLEN * (distance(scene, ours, truth) or 0.0)
    fine = (min(2 * grid[0] - 1, FINEST), min(2 * grid[1] - 1, FINEST))
    finer = lumped.solve(scene, springs(fine))
    masses = f"{fine[0]}×{fine[1]} masses"
    left = distance(scene, finer, truth)
    if finer.status is ours.status and left is not None and left < allowed:
        return {"mechanism": "resolution", "evidence": f"{masses} leave {percent(left)} %"}
    sharper = shell(scene, 2 * elements)
    beside_sharper = distance(scene, ours, sharper)
    if beside_sharper is not None and beside_sharper < allowed:
        evidence = f"of the reference: {2 * elements} elements a side leave {percent(beside_sharper)} %"
        return {"mechanism": "resolution", "evidence": evidence}
    moved = _there_and_back(scene, springs(grid), ours)
    if moved is not None and moved > LARGE:
        evidence = f"back from {BACK_FROM:g} times the load it stands {percent(moved)} % away"
        return {"mechanism": "branch", "evidence": evidence}
    if ours.snaps or truth.snaps:
        evidence = f"snapped at load factors {_listed(ours.snaps)}, the reference at {_listed(truth.snaps)}"
        return {"mechanism": "branch", "evidence": evidence}
    both_finer = distance(scene, finer, sharper)
    if left is not None and both_finer is not None and moved is not None:
        evidence = f"{masses} keep {percent(left)} %, {percent(both_finer)} % of a finer shell's"
        return {"mechanism": "wrong limit", "evidence": evidence}
    return {"mechanism": "unknown", "evidence": f"{masses}: {finer.status}"}


def _listed(snaps: tuple[float, ...]) -> str:
    return ", ".join(f"{load_factor:.4g}" for load_factor in snaps) or "none"


def _there_and_back(scene: Scene, springs: lumped.Calibration, ours: Solution) -> float | None:
    """How far from `ours`, in its largest probe displacement, the lattice ends after a larger load."""
    u = None
    for load_factor in (BACK_FROM, *BACK_BY):
        history = {"time": (0.0,), "factor": (load_factor,)}
        gravity = scene.gravity and scene.gravity.replace(history=history)
        loads = tuple(load.replace(history=history) for load in scene.loads)
        found = lumped.solve(scene.replace(gravity=gravity, loads=loads), springs, near=u)
        if not found.comparable:
            return None
        u = found.mesh.point_data["displacement"]
    points = scene.probe_points()
    return probe_error(found.displacement(points), ours.displacement(points))

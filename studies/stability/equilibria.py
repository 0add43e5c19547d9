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

from dataclasses import replace
from typing import Any

import numpy as np

from comparisons.comparison.comparison import error as probe_error
from comparisons.models.resolve import resolve
from comparisons.models.spec import GradingLike, Lattice
from comparisons.stability.rows import LARGE, Row, percent
from sheetbench.choices import CALIBRATION
from sheetbench.scenes import Clamped, Gravity, Load, Material, Scene, Sheet, Solution, Status
from sheetbench.scenes.sheet import EdgeName

SIDE, GRAVITY = 0.188, 9.81  # of the seed's sheet, of the Earth
ELEMENTS = 12
FALLEN = 2.0 / 3.0  # of the error, that refining must leave at most to be the reason
FINEST = 65  # masses a side
BACK_FROM = 1.5  # load from which the lattice is brought back


def sheet(
    slenderness: float,
    load_number: float,
    edges: tuple[EdgeName, ...] = ("x0",),
    young: float = 1e7,
    poisson: float = 0.48,
    **more: Any,
) -> Scene:
    """A square sheet clamped at `edges` under its own weight: thickness/side and ρ g h a³/D as asked."""
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


def lattice(scene: Scene, grid: tuple[int, int], **options: Any) -> Solution:
    """The lattice's answer; springs: instead of consistent ones; grading: of these."""
    import lumped

    springs, grading = options.pop("springs", None), options.pop("grading", None)
    return lumped.solve(scene, springs or _consistent(scene, grid, grading), **options)


def _consistent(scene: Scene, grid: tuple[int, int], grading: GradingLike) -> Any:
    return resolve(scene, Lattice(grid, CALIBRATION, grading=grading), "springs").springs


def shell(scene: Scene, elements: int = ELEMENTS) -> Solution:
    """The reference's answer."""
    import fem_reference

    return fem_reference.solve(scene, model="shell", elements=elements)


def compare(
    scene: Scene,
    grid: tuple[int, int],
    *,
    elements: int = ELEMENTS,
    springs: Any = None,
    grading: GradingLike = None,
    single: bool = False,
    explain: bool = True,
) -> Row:
    """The row of a lattice against the shell; springs: instead of consistent ones; grading: of these; single:
    the lattice in single precision too, how it ended and its distance from double."""
    own = {"springs": springs, "grading": grading}
    ours, truth = lattice(scene, grid, **own), shell(scene, elements)
    row = {**outcome(ours), "error": distance(scene, ours, truth), "reference": outcome(truth)}
    if single:
        rounded = lattice(scene, grid, **own, precision="single")
        row["single_error"] = distance(scene, rounded, ours)
        row["single_status"], row["single_message"] = str(rounded.status), rounded.message
    if explain and ours.status is Status.CONVERGED and (row["error"] or 0.0) > LARGE:
        row |= mechanism(scene, grid, elements, ours, truth, springs, grading)
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
    scene: Scene,
    grid: tuple[int, int],
    elements: int,
    ours: Solution,
    truth: Solution,
    springs: Any = None,
    grading: GradingLike = None,
) -> Row:
    """What makes a converged lattice differ, by the tests that the module names, and what they gave."""
    off = distance(scene, ours, truth) or 0.0
    fine = (min(2 * grid[0] - 1, FINEST), min(2 * grid[1] - 1, FINEST))
    finer = lattice(scene, fine, springs=_refined(springs, fine), grading=grading)
    left = distance(scene, finer, truth)
    if finer.status is ours.status and left is not None and left < FALLEN * off:
        evidence = f"{fine[0]}×{fine[1]} masses leave {percent(left)} %"
        return {"mechanism": "resolution", "evidence": evidence}
    sharper = shell(scene, 2 * elements)
    left = distance(scene, ours, sharper)
    if left is not None and left < FALLEN * off:
        return {
            "mechanism": "resolution",
            "evidence": f"of the reference: {2 * elements} elements a side leave {percent(left)} %",
        }
    moved = _there_and_back(scene, springs or _consistent(scene, grid, grading), ours)
    if moved is not None and moved > LARGE:
        evidence = f"back from {BACK_FROM:g} times the load it stands {percent(moved)} % away"
        return {"mechanism": "branch", "evidence": evidence}
    if ours.snaps or truth.snaps:
        evidence = f"snapped at load factors {_listed(ours.snaps)}, the reference at {_listed(truth.snaps)}"
        return {"mechanism": "branch", "evidence": evidence}
    kept, left = distance(scene, finer, truth), distance(scene, finer, sharper)
    if kept is not None and left is not None and moved is not None:
        evidence = f"{fine[0]}×{fine[1]} masses keep {percent(kept)} %, {percent(left)} % of a finer shell's"
        return {"mechanism": "wrong limit", "evidence": evidence}
    return {"mechanism": "unknown", "evidence": f"{fine[0]}×{fine[1]} masses: {finer.status}"}


def _listed(snaps: tuple[float, ...]) -> str:
    return ", ".join(f"{load_factor:.4g}" for load_factor in snaps) or "none"


def _refined(springs: Any, grid: tuple[int, int]) -> Any:
    """Given springs on a finer grid; calibrated ones are calibrated anew."""
    return None if springs is None else replace(springs, grid=(*grid, springs.grid[2]))


def _there_and_back(scene: Scene, springs: Any, ours: Solution) -> float | None:
    """How far from `ours`, in its largest probe displacement, the lattice ends after a larger load."""
    import lumped
    from lumped import at_rest, follow

    problem = lumped.build_problem(scene, springs)
    beyond, why = follow(problem, at_rest(problem), BACK_FROM)
    if why:
        return None
    back, why = follow(problem, beyond, 1.0)
    if why:
        return None
    there = lumped.MidSurface(problem.assembly.lattice, scene.probe_points()).of(back.u)
    return probe_error(there, ours.displacement(scene.probe_points()))


def loaded(scene: Scene, *loads: Load) -> Scene:
    """The scene with these loads instead of its own."""
    return scene.replace(loads=loads)

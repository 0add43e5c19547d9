"""Reference set computed anew: `sheetbench study reference-set`, or `make suite`.

statics   the shell on n, ¾ n and ½ n elements: the finest answer, its bar by the grid convergence index
          (`fem_reference.uncertainty`), and where it is cheap enough the solid
motion    the moving shell; the bar of a component of a probe is the largest change over time by a mesh half
          as fine, plus the largest one by steps twice as long; also the lattice
modes     the shell as in statics, and the solid
curves    the shell as in statics
natural   the shell as in statics, and the lattice; contact too

The file has the scenes: a new case is a row of name, suite, why and scene, for a motion also its duration.
Errors of models on the set are another study (`studies.codes.models`); their rows stay unchanged.
"""

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

import fem_reference
import lumped
from comparisons.comparison.measures import largest
from comparisons.comparison.motion import LONGER
from comparisons.models.spec import Lattice
from comparisons.scoring.reference import AT_REST, LICENCE, VERSION, document
from comparisons.sweep import task
from comparisons.sweep.differences import error
from comparisons.sweep.manifest import machine
from comparisons.sweep.solved import Request, Solved
from fem_reference.surface.mesh import Elements
from fem_reference.uncertainty import coarser, of_answers, solve_with_bar
from sheetbench.answers.files import plain
from sheetbench.answers.history import History
from sheetbench.answers.solution import Status
from sheetbench.scenes import Scene
from sheetbench.sources import version

ELEMENTS, ACROSS = 24, 8  # of the shell along the shorter side; of strips four times as long as wide
CURVES = 20  # of the shell on curves, where the layer along edges decides when a strip buckles
ROUNDED = 1e-6  # rounding of seven digits, over the largest displacement
SOLID = 6  # elements
SAMPLES = 60  # of a motion, after the start


class MovingMesh(NamedTuple):
    """Elements of a moving shell along the shorter side (half as many of strips), and error of a step."""

    elements: int
    error: float


MOVING = MovingMesh(12, 3e-6)
OTHERS = {  # for short waves, and for a motion with many bends, which needs many steps
    "corner-struck": MovingMesh(16, 2e-6),
    "pressure-step": MovingMesh(16, 2e-6),
    "harmonic-base": MovingMesh(8, 1e-5),
}
SHELLS: dict[
    str, Elements
] = {  # of strips that bend along x alone, and of a patch with elements along its sides
    "bimetal-strip": (40, 8),
    "muscle-band": (36, 12),
    "quarter-turn": (24, 8),
    "laid-0.05": (160, 2),
    "laid-0.2": (160, 2),
    "over-cylinder": (240, 2),
    "pressed": (160, 2),
}
GRID = 17  # masses of the lattice along the shorter side
FREQUENCIES = 6


@dataclass(frozen=True)
class Case:
    """Scene of a suite; why: reason that it is in the set; duration: of a motion [s]."""

    name: str
    suite: str
    why: str
    scene: Scene
    duration: float | None = None


def cases() -> list[Case]:
    """Return the cases of the file, with or without values."""
    return [
        Case(
            entry["name"],
            entry["suite"],
            entry["why"],
            Scene.model_validate(entry["scene"]),
            entry.get("duration"),
        )
        for entry in document()["cases"]
    ]


def regenerate(progress: Callable[[str], None] = print, suite: str | None = None) -> dict[str, Any]:
    """Return the reference set as plain data; with a suite's name the other suites' values stay."""
    makers = {"motion": motion, "modes": modes} | dict.fromkeys(AT_REST, statics)
    kept = {case["name"]: case for case in document()["cases"] if suite and case["suite"] != suite}
    computed = []
    for case in cases():
        if case.name in kept:
            computed.append(kept[case.name])
            continue
        started = perf_counter()
        computed.append(
            {
                "name": case.name,
                "suite": case.suite,
                "why": case.why,
                "scene": case.scene.document(),
                **({"duration": case.duration} if case.duration else {}),
                **makers[case.suite](case),
            }
        )
        progress(f"{case.name}: {perf_counter() - started:.1f} s")
    made_with = document()["made_with"] if suite else {"sheetbench": version(), "machine": machine()}
    head = {"version": VERSION, "licence": LICENCE, "made_with": made_with}
    rounded: dict[str, Any] = plain({**head, "cases": computed, "standing": document()["standing"]})
    return rounded


def statics(case: Case) -> dict[str, Any]:
    """Return displacements [m] of the probes with their bars, and the codes that were used."""
    elements = CURVES if case.suite == "curves" else SHELLS.get(case.name, _elements(case.scene))
    points = case.scene.probe_points()
    solution, bar = solve_with_bar(case.scene, points, "shell", elements)
    assert bar is not None and solution.comparable, case.name
    least = ROUNDED * np.abs(bar.answer).max()
    judges = [{"model": "shell", "elements": coarser(elements), "error": 0.0, "bar": bar.error}]
    if case.suite in ("natural", "contact"):
        judges.append(_lattice_at_rest(case, bar.answer))
    elif not case.scene.actuators and elements == ELEMENTS:
        solid = fem_reference.solve(case.scene, "solid", elements=SOLID)
        off = error(solid.displacement(points), bar.answer) if solid.comparable else None
        judges.append({"model": "solid", "elements": [SOLID], "error": off, "status": str(solid.status)})
    return {
        "probes": {
            name: {"u": _digits(u), "bar": _digits(np.maximum(probe_bar, least))}
            for name, u, probe_bar in zip(case.scene.probes, bar.answer, bar.bar, strict=True)
        },
        "bar": max(bar.error, ROUNDED),
        "judges": judges,
    }


def motion(case: Case) -> dict[str, Any]:
    """Return displacements [m] of the probes over time [s] with their bars."""
    assert case.duration is not None
    duration, every = case.duration, case.duration / SAMPLES
    elements, step_error = OTHERS.get(case.name, MOVING)
    if max(case.scene.sheet.lengths) > 2.0 * min(case.scene.sheet.lengths):
        elements //= 2

    def run(elements: int, error: float = step_error) -> History:
        history = fem_reference.simulate(
            case.scene, "shell", duration, elements=elements, every=every, error=error
        )
        assert history.status is Status.CONVERGED, (case.name, history.message)
        return history

    fine = run(elements)
    others = {"mesh": run(elements // 2), "step": run(elements, LONGER * step_error)}
    changes = {
        change_by: {name: np.abs(u - other.probes[name]).max(axis=0) for name, u in fine.probes.items()}
        for change_by, other in others.items()
    }
    bars = {change_by: largest(other, fine) for change_by, other in others.items()}
    return {
        "time": _digits(fine.time),
        "probes": {
            name: {"u": _digits(u), "bar": _digits(sum(change[name] for change in changes.values()))}
            for name, u in fine.probes.items()
        },
        "bar": sum(bars.values()),
        "bars": bars,
        "judges": [
            {"model": "shell", "elements": [elements, elements // 2], "error": 0.0},
            _lattice(case, fine),
        ],
    }


def _lattice(case: Case, reference: History) -> dict[str, Any]:
    """Return the lattice's error on a motion."""
    assert case.duration is not None
    springs = lumped.calibrate(case.scene.sheet, case.scene.material, grid=GRID)
    history = lumped.simulate(case.scene, springs, case.duration, every=case.duration / SAMPLES)
    off = largest(history, reference) if history.status is Status.CONVERGED else None
    return {"model": "lumped", "grid": [GRID], "error": off, "status": str(history.status)}


def _lattice_at_rest(case: Case, reference: np.ndarray) -> dict[str, Any]:
    """Return the lattice's error against displacements (n, 3) [m] of the probes."""
    request = Request(case.scene, Lattice(GRID, "consistent"))
    row = task.solve(**request.task.arguments)
    solved = Solved(request, row["status"], row=row)
    off = error(solved.u, reference) if solved.usable else None
    return {"model": "lumped", "grid": [GRID], "error": off, "status": solved.status}


def modes(case: Case) -> dict[str, Any]:
    """Return natural frequencies [Hz] with their bars."""
    meshes = coarser(ELEMENTS)
    answers = [_frequencies(case.scene, "shell", n) for n in meshes]
    bar = of_answers(case.scene, [a[:, None] for a in answers], meshes)
    solid = _frequencies(case.scene, "solid", SOLID)
    off = float(np.max(np.abs(solid / answers[0] - 1.0)))
    return {
        "frequencies_hz": {"f": _digits(answers[0]), "bar": _digits(bar.bar[:, 0])},
        "bar": float(np.max(bar.bar[:, 0] / answers[0])),
        "judges": [
            {"model": "shell", "elements": meshes, "error": 0.0},
            {"model": "solid", "elements": [SOLID], "error": off},
        ],
    }


def _frequencies(scene: Scene, model: str, elements: Any) -> np.ndarray:
    return fem_reference.modes(scene, model=model, elements=elements, count=FREQUENCIES).frequencies


def _elements(scene: Scene) -> int:
    return ACROSS if max(scene.sheet.lengths) > 4.0 * min(scene.sheet.lengths) else ELEMENTS


def _digits(values: np.ndarray) -> Any:
    """Return values rounded to seven digits, more than any bar leaves certain."""
    return np.vectorize(lambda value: float(f"{value:.6e}"))(values).tolist()

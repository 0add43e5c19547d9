"""Validation of the advisor on scenes drawn at random: is the tolerance met, and is the choice the cheapest?

Drawn (seeded): shorter side 0.05 to 0.5 m, the other up to 2.5 times that, h/a 0.003 to 0.05, ν 0 to 0.49,
load number ρ g h a³/D 0.03 to 100 (as far as ρ g a/E ≤ 0.03), ten arrangements of supports with clamped,
hinged and curved edges, and a point load of up to the sheet's weight on every fourth scene. A scene whose
fine shell finds no stable equilibrium is outside the range and replaced by the next.

The truth is a shell with 32 elements along the shorter side. Cost is compared with timed rows of the same
scene: the choice as advised beside `ROWS`, whole sheets all of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Annotated, Any, Unpack

import numpy as np

from comparisons.advice.advisor import advise
from comparisons.comparison.comparison import error
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Spec, lattices, references, spec_of
from comparisons.runs.campaign import CampaignKeywords, Run, carry_out
from comparisons.runs.manifest import record
from comparisons.runs.store import Finished, Store
from comparisons.sweep.solved import Ask, sweep
from sheetbench.answers.answer import Answer
from sheetbench.answers.table import NUMBER, PERCENT, Table
from sheetbench.scenes import Clamped, Curved, Gravity, Hinged, PointLoad, Scene, Status
from sheetbench.scenes.supports import AnySupport
from studies.coverage.scenes import GRAVITY, sheet_at_random

SEED = 7
TOLERANCES = (0.005, 0.01, 0.02, 0.05)
TRUTH = 32  # elements along the shorter side
WITHIN = 2.0  # times the cheapest adequate row's time


def scenes_at_random(seed: int = SEED) -> Iterator[Scene]:
    """Scenes without end, the same for the same seed."""
    random = np.random.default_rng(seed)
    number = 0
    while True:
        sheet, material = sheet_at_random(random, 2.5, 100.0)
        sides = sheet.lengths
        curvature = random.choice([-1.0, 1.0]) * random.uniform(0.1, 0.75) / sides[1]
        supports = _arrangements(curvature)[random.integers(10)]
        at = tuple(float(random.uniform(0.2, 0.9) * side) for side in sides)
        weight = material.density * GRAVITY * sheet.thickness * sides[0] * sides[1]
        pull = (0.0, 0.0, float(random.uniform(-1.0, 1.0) * weight))
        loads = (PointLoad(at=(at[0], at[1]), force=pull),) if number % 4 == 3 else ()
        yield Scene(
            name=f"random-{number}",
            sheet=sheet,
            material=material,
            gravity=Gravity(acceleration=(0.0, 0.0, -GRAVITY)),
            supports=supports,
            loads=loads,
        )
        number += 1


def _arrangements(curvature: float) -> list[tuple[AnySupport, ...]]:
    one, other, left, right = (Clamped(edge=edge) for edge in ("x0", "x1", "y0", "y1"))
    return [
        (one,),
        (left,),
        (one, left),
        (one, other),
        (left, right),
        (one, left, other),
        (one, other, left, right),
        tuple(Hinged(edge=edge) for edge in ("x0", "x1", "y0", "y1")),
        (one, Hinged(edge="x1")),
        (Curved(edge="x0", curvature=float(curvature)),),
    ]


def rows(scene: Scene) -> list[Spec]:
    """The dozen rows that the choice is to stand up to."""
    lattice_rows = lattices(scene, ["3", "5", "9", "17"], ["consistent"])
    lattice_rows += lattices(scene, ["5"], ["uniform"])
    return [*lattice_rows, *references("plate", ["4"]), *references("shell", ["2", "3", "4", "6", "8", "12"])]


def advice(scene: dict[str, Any], tolerance: float) -> dict[str, Any]:
    """Task: the advice, and what its choice says at the probes."""
    parsed = Scene.model_validate(scene)
    given = advise(parsed, tolerance)
    if given.choice is None:
        return {"status": "none", "message": given.message}
    solution = solve(resolve(parsed, given.choice))
    document = given.document()
    return {
        "status": str(solution.status),
        "displacement": solution.displacement(parsed.probe_points()),
        **{key: document[key] for key in ("choice", "predicted", "probing_seconds", "message")},
    }


@dataclass(frozen=True)
class Kept:
    """What became of the cases with one tolerance."""

    tolerance: Annotated[float, PERCENT(".3g")]
    cases: Annotated[int, NUMBER("d")]
    met: Annotated[float, PERCENT(".1f")]
    largest: Annotated[float, PERCENT(".3g", "largest error")]
    median: Annotated[float, PERCENT(".3g", "median error")]
    within: Annotated[float, PERCENT(".1f", "within twice the cheapest")]
    cost: Annotated[float | None, NUMBER(".2f", "median of time over the cheapest")]


@dataclass(frozen=True, repr=False)
class Study(Answer):
    """cases: one dictionary per scene and tolerance; skipped: scenes outside the range, and why."""

    file_name = "advisor"

    cases: tuple[dict[str, Any], ...]
    skipped: dict[str, str]

    @property
    def met(self) -> float:
        """Share of the cases in which the choice is within the tolerance of the truth."""
        return float(np.mean([case["actual_error"] <= case["tolerance"] for case in self.cases]))

    @property
    def within(self) -> float:
        """Share, among cases with an adequate row, that cost at most `WITHIN` times the cheapest one."""
        ratios = [case["cost_ratio"] for case in self.cases if case.get("cost_ratio") is not None]
        return float(np.mean([ratio <= WITHIN for ratio in ratios])) if ratios else float("nan")

    def heading(self) -> tuple[str, str, str]:
        return "The advisor on random scenes", "", ""

    def document(self) -> dict[str, Any]:
        ratios = [case["cost_ratio"] for case in self.cases if case.get("cost_ratio") is not None]
        return {
            **record(["advisor_study"]),
            "met": self.met,
            "within_factor_2": self.within,
            "cases": list(self.cases),
            "compared": len(ratios),
            "skipped": self.skipped,
        }

    def notes(self) -> tuple[str, ...]:
        return (f"met {100 * self.met:.1f} %; within twice the cheapest row {100 * self.within:.1f} %",)

    def tables(self) -> tuple[Table, ...]:
        rows = []
        for tolerance in sorted({case["tolerance"] for case in self.cases}):
            part = Study(tuple(c for c in self.cases if c["tolerance"] == tolerance), {})
            off = [c["actual_error"] for c in part.cases]
            ratios = [c["cost_ratio"] for c in part.cases if c.get("cost_ratio") is not None]
            typical = float(np.median(ratios)) if ratios else None
            rows.append(
                Kept(tolerance, len(off), part.met, max(off), float(np.median(off)), part.within, typical)
            )
        return (Table.of(Kept, rows, "Tolerances requested and met", "advisor"),)


def study(
    store: Store,
    count: int = 60,
    compared: int = 20,
    tolerances: tuple[float, ...] = TOLERANCES,
    seed: int = SEED,
    elements: int = TRUTH,
    **how: Unpack[CampaignKeywords],
) -> Study:
    """The advisor on `count` scenes; on the first `compared` of them its cost beside that of `rows`."""

    def runs(task: str, inputs: list[tuple[Scene, dict[str, Any]]], timed: bool = False) -> list[Finished]:
        wanted = [
            Run(f"studies.{task}", {"scene": scene.document(), **rest}, f"{task} {scene.name}", timed)
            for scene, rest in inputs
        ]
        return carry_out(wanted, store, **how)

    endless, inside, skipped = scenes_at_random(seed), list[tuple[Scene, Finished]](), dict[str, str]()
    fine_shell = {"model": "shell", "elements": elements}
    while len(inside) < count:
        drawn = list(islice(endless, count - len(inside)))
        outcomes = runs("coverage.study:answer", [(scene, fine_shell) for scene in drawn])
        for scene, outcome in zip(drawn, outcomes, strict=True):
            if outcome.status == Status.CONVERGED:
                inside.append((scene, outcome))
            else:
                skipped[scene.name] = f"{outcome.status}: {outcome.message}"
    inputs = [(scene, {"tolerance": tolerance}) for scene, _ in inside for tolerance in tolerances]
    given = runs("advisor.study:advice", inputs, timed=True)
    fine = {scene.name: outcome for scene, outcome in inside}
    cases = [_case(scene, rest, fine, outcome) for (scene, rest), outcome in zip(inputs, given, strict=True)]
    for scene, outcome in inside[:compared]:
        mine = [case for case in cases if case["scene"] == scene.name and case["choice"] is not None]
        _compare_costs(scene, outcome, mine, store, **how)
    return Study(tuple(cases), skipped)


def _case(scene: Scene, rest: dict[str, Any], fine: dict[str, Finished], outcome: Finished) -> dict[str, Any]:
    row = outcome.row
    off = None
    if "displacement" in row:
        off = error(np.array(row["displacement"]), np.array(fine[scene.name].row["displacement"]))
    return {
        "scene": scene.name,
        **rest,
        "choice": row.get("choice"),
        "predicted": row.get("predicted"),
        "actual_error": float("inf") if off is None else off,
        "probing_seconds": row.get("probing_seconds"),
        "message": outcome.message or row.get("message", ""),
    }


def _compare_costs(
    scene: Scene,
    outcome: Finished,
    cases: list[dict[str, Any]],
    store: Store,
    **how: Unpack[CampaignKeywords],
) -> None:
    """Adds "cost_ratio" to the cases of a scene: the choice's time over that of the cheapest adequate row."""
    chosen = [spec_of(case["choice"]["model"], case["choice"]["settings"]) for case in cases]
    solved = sweep([Ask(scene, spec, repeats=5) for spec in [*rows(scene), *chosen]], store, **how)
    dozen, mine = solved[: -len(chosen)], solved[-len(chosen) :]
    truth_displacement = np.array(outcome.row["displacement"])
    for case, own in zip(cases, mine, strict=True):
        adequate = [
            run.seconds
            for run in dozen
            if run.seconds and run.stable and (error(run.u, truth_displacement) or 1.0) <= case["tolerance"]
        ]
        case["actual_seconds"] = own.seconds
        case["cost_ratio"] = own.seconds / min(adequate) if adequate and own.seconds else None

"""Displacements of a lattice beside those of a reference: the answer of `sheetbench compare`.

With u the displacement of a model and u_ref that of the reference at the same plan points,

    error     largest |component of (u − u_ref)| over the probes / largest |component of u_ref| over them
    relative  |u − u_ref| / |u_ref| at one probe

Both are fractions, and None where they have no meaning: the reference does not move there by more than
round-off, a number is not finite, or one of the two models did not reach the full load.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import asdict, dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.comparison import branches
from comparisons.comparison.error_bar import ErrorBar
from comparisons.comparison.notes import notes
from comparisons.comparison.rows import CostRow, Difference, ProbeRow, ReactionRow
from comparisons.models.expected_error import ExpectedError, NoEstimate
from comparisons.pictures.plan import plan_mesh
from comparisons.pictures.vtk import write_mesh
from comparisons.sweep.differences import error, relative
from comparisons.sweep.model_error import ModelError, model_error
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import RASTER, Picture, Write
from sheetbench.answers.table import Table
from sheetbench.scenes import Scene, Solution, Status
from sheetbench.scenes.summary import few
from sheetbench.scenes.supports import named
from sheetbench.scenes.words import sheet_in_words

ROUND_OFF = 1e-9  # of the largest displacement at a probe


@dataclass(frozen=True, repr=False)
class Comparison(Answer):
    """Solutions of one scene: the chosen lattice first, the reference second, then what is shown alongside.

    Every solution has its own `model` name, by which `differences` and `errors` speak of it. bar: what the
    reference's mesh leaves uncertain, where that was requested; laws: a sentence where lattice and reference
    have laws of strain that differ by more. disagreement: a sentence where both are at rest and far apart.
    expected: the error to expect of the chosen lattice's grid, or why none is told. several: whether more
    than one equilibrium is known; other_branch: whether the first two are known to be different ones. busy:
    sentences on times taken on a busy machine. law_chosen: the reference's law of strain, by the user.
    """

    file_name, page_name = "comparison", "table"
    scene: Scene
    solutions: tuple[Solution, ...]
    bar: ErrorBar | None = None
    laws: str = ""
    disagreement: str = ""
    expected: ExpectedError | NoEstimate | None = None
    several: bool = False
    other_branch: bool = False
    busy: tuple[str, ...] = ()
    law_chosen: bool = False

    @property
    def reference(self) -> Solution:
        """The solution that the others are measured against."""
        return self.solutions[1]

    @property
    def succeeded(self) -> bool:
        """Whether the chosen lattice and the reference both reached a stable equilibrium."""
        return all(solution.status is Status.CONVERGED for solution in self.solutions[:2])

    def probes(self, solution: Solution) -> dict[str, np.ndarray]:
        """Displacement (3,) [m] at each probe."""
        values = solution.displacement(self.scene.probe_points())
        return dict(zip(self.scene.probes, values, strict=True))

    @property
    def least(self) -> float:
        """The displacement [m] of the reference at a probe up to which it is rounding, as at a support."""
        return ROUND_OFF * max(float(np.linalg.norm(u)) for u in self.probes(self.reference).values())

    def measurable(self, solution: Solution) -> bool:
        """Return whether a solution and the reference are both stable, and not known to be on different
        branches."""
        pair = (solution, self.reference)
        stable = all(one.comparable and one.status is not Status.UNSTABLE for one in pair)
        if not stable or not self.several or (solution in self.solutions[:2] and not self.other_branch):
            return stable
        return not branches.far(*(one.displacement(self.scene.probe_points()) for one in pair))

    def error(self, solution: Solution) -> float | None:
        """Return the solution's error against the reference."""
        if solution is self.reference or not self.measurable(solution):
            return None
        points = self.scene.probe_points()
        return error(solution.displacement(points), self.reference.displacement(points))

    @property
    def differences(self) -> tuple[Difference, ...]:
        """The relative difference of every other model from the reference at every probe."""
        truth, least = self.probes(self.reference), self.least
        found = []
        for solution in (one for one in self.solutions if one is not self.reference):
            both = self.measurable(solution)
            for name, value in self.probes(solution).items():
                off = relative(value, truth[name], least) if both else None
                beyond_bar = None
                if self.bar is not None and off is not None:
                    beyond_bar = bool(np.linalg.norm(value - truth[name]) > self.bar.at(name))
                found.append(Difference(name, solution.model, self.reference.model, off, beyond_bar))
        return tuple(found)

    @property
    def bars(self) -> dict[str, np.ndarray]:
        """Half a length (n, 3) [m] of the bar at the probes, of the models that have one."""
        points = self.scene.probe_points()
        known = {} if self.bar is None else {self.reference.model: self.bar.uncertainty.bar}
        return {s.model: s.bar(points) for s in self.solutions if s.bar is not None} | known

    def bar_of(self, solution: Solution) -> float | None:
        """By how much a solution says that it may be off: its largest bar over its largest displacement."""
        if solution is self.reference and self.bar is not None:
            return self.bar.error
        if solution.model not in self.bars or solution.status is Status.UNSTABLE:
            return None
        u = solution.displacement(self.scene.probe_points())
        return error(u + self.bars[solution.model], u)

    @cached_property
    def model_error(self) -> ModelError | None:
        """What the reference leaves out of the sheet on every mesh, where that is known."""
        return model_error(self.scene, self.reference, self.law_chosen)

    def distinguishable(self, solution: Solution) -> bool | None:
        """Return whether a solution's error is above the reference's own; None where either is not known."""
        off = self.error(solution)
        return None if self.bar is None or off is None else off > self.bar.error

    def branch(self, solution: Solution) -> str:
        """Return which equilibrium, where several are known: "path", "buckled", "of" the model in whose shape
        it was begun, or "own", where lattice and reference are on different branches."""
        if "begun" in solution.settings:
            return f"of {solution.settings['begun']}"
        if self.other_branch and solution in self.solutions[:2]:
            return "own"
        several = solution.snaps or solution.status is Status.UNSTABLE or self.several
        return str(solution.settings.get("branch", "path" if several else ""))

    def document(self) -> dict[str, Any]:
        """Return the JSON document of `sheetbench compare`: metres, newtons, seconds."""
        return {
            "scene": self.scene.document(),
            "solutions": [self._solution_document(solution) for solution in self.solutions],
            "laws": self.laws,
            "apart": self.disagreement,
            "differences": [asdict(difference) for difference in self.differences],
            "errors": [
                {
                    "of": solution.model,
                    "against": self.reference.model,
                    "error": self.error(solution),
                    "distinguishable": self.distinguishable(solution),
                }
                for solution in self.solutions
                if solution is not self.reference
            ],
        }

    def _solution_document(self, solution: Solution) -> dict[str, Any]:
        bar: dict[str, Any] = {}
        if solution is self.reference and self.bar is not None:
            bar = self.bar.as_dict() | (self.model_error.as_dict() if self.model_error else {"model": None})
        elif (own := self.bars.get(solution.model)) is not None:
            named = dict(zip(self.scene.probes, own, strict=True))
            bar = {"error": (off := self.bar_of(solution)), "mesh": off, "probes": named}
        expected = self.expected if solution is self.solutions[0] else None
        return {
            **solution.document(self.scene),
            **({"branch": branch} if (branch := self.branch(solution)) else {}),
            **({"uncertainty": bar} if bar else {}),
            **({"expected_error": expected.as_dict()} if isinstance(expected, ExpectedError) else {}),
            **({"no_estimate": expected.reason} if isinstance(expected, NoEstimate) else {}),
        }

    def result(self) -> str:
        """Return how far each model is from the reference, or how it ended."""
        return "; ".join(map(self._result, (one for one in self.solutions if one is not self.reference)))

    def _result(self, solution: Solution) -> str:
        if (off := self.error(solution)) is None:
            ended = [one for one in (solution, self.reference) if one.status is not Status.CONVERGED]
            return ", ".join([f"{solution.label}: not comparable", *(f"{s.model} {s.status}" for s in ended)])
        expected = self._expected(solution)
        own = "" if expected is None else f", expected {few(100 * expected)} %"
        bar = "" if self.bar is None else f" ± {few(100 * self.bar.error)} %"
        return f"{solution.label}: {few(100 * off)} % off {self.reference.label}{bar}{own}"

    def heading(self) -> tuple[str, str, str]:
        """Return the scene, and its sheet."""
        return self.scene.name, self.scene.title, sheet_in_words(self.scene.sheet, self.scene.material)

    def tables(self) -> tuple[Table, ...]:
        """Displacement at the probes, the reference first; cost and error; forces of the supports."""
        return self._displacements(), self._costs(), self._reactions()

    def printed(self) -> tuple[Table, ...]:
        """Return all tables, of supports' forces those of supports that are moved: the pull of the sheet."""
        moved = {name for name, support in named(self.scene.supports).items() if support.motion is not None}
        moved |= {motion.held_as for motion in self.scene.motions().values()}
        return self._displacements(), self._costs(), *([self._reactions(moved)] if moved else [])

    def _displacements(self) -> Table:
        off = {(d.probe, d.of): d.relative for d in self.differences}
        ordered = sorted(self.solutions, key=lambda solution: solution is not self.reference)
        models = [(s.model, self.probes(s), self.relative_bars(s)) for s in ordered]
        rows = (
            ProbeRow(probe, x, y, model, _named("u", moved[probe]), off.get((probe, model)), bars.get(probe))
            for probe, (x, y) in self.scene.probes.items()
            for model, moved, bars in models
        )
        return Table.of(ProbeRow, rows, "Displacement of the mid-surface", "table", grouped=True)

    def relative_bars(self, solution: Solution) -> dict[str, float]:
        """Return the bar of a model that has one over its displacement, at the probes where it moves."""
        lengths, moved = self.bars.get(solution.model, ()), self.probes(solution)
        both = zip(moved.items(), map(np.linalg.norm, lengths), strict=False)
        sizes = ((probe, float(np.linalg.norm(u)), float(length)) for (probe, u), length in both)
        return {probe: length / size for probe, size, length in sizes if size > self.least}

    def _costs(self) -> Table:
        rows = (
            CostRow(
                s.model, s.label, s.unknowns, s.iterations, s.setup_seconds, s.solve_seconds, self.error(s),
                self._expected(s), s.status_text,
            )
            for s in self.solutions
        )  # fmt: skip
        return Table.of(CostRow, rows, "Cost and error of each model", "models", text="; ".join(self.busy))

    def _expected(self, solution: Solution) -> float | None:
        """Return the grid error expected of the chosen lattice; where there is none a note says why."""
        if solution is self.solutions[0] and isinstance(self.expected, ExpectedError):
            return self.expected.value
        return None

    def _reactions(self, of: Collection[str] | None = None) -> Table:
        """Of all supports, or of those named."""
        found = sorted(
            (edge, s.model, force)
            for s in self.solutions
            for edge, force in s.reactions.items()
            if of is None or edge in of
        )
        rows = (ReactionRow(edge, model, _named("F", force)) for edge, model, force in found)
        return Table.of(ReactionRow, rows, "Force of each support on the sheet", "reactions")

    def figures(self) -> tuple[Picture, ...]:
        """Return the deformed sheets, and what every model is off by at the probes."""
        lattice, reference = self.solutions[:2]
        off = self.error(lattice)
        error_text = "" if off is None else f": error at the probes {100 * off:.2f} %"
        described = f"{self.scene.name}: {lattice.label} against {reference.label}{error_text}"
        return (
            Picture("comparison", "comparisons.comparison.figure:compose", (self,), described, RASTER),
            Picture("probes", "comparisons.comparison.probes_figure:compose", (self,)),
        )

    def files(self) -> dict[str, Write]:
        """Return the solutions as VTU, each on its own mesh and all on one."""
        own: dict[str, Write] = {f"{s.model}.vtu": partial(write_mesh, mesh=s.mesh) for s in self.solutions}
        return {**own, "comparison.vtu": self.write_plan}

    def write_plan(self, path: Path) -> None:
        """Write all solutions on one plan grid, `displacement_MODEL` each, and what they differ by.

        `displacement` is the reference's; `difference` is the chosen lattice's from it, `difference_MODEL`
        any other model's.
        """
        plan = plan_mesh(self.scene)
        fields = {s.model: s.displacement(plan.points[:, :2]) for s in self.solutions}
        truth = fields[self.reference.model]
        plan.point_data["displacement"] = truth
        plan.point_data["difference"] = fields[self.solutions[0].model] - truth
        for solution in self.solutions:
            plan.point_data[f"displacement_{solution.model}"] = fields[solution.model]
        for solution in self.solutions[2:]:
            plan.point_data[f"difference_{solution.model}"] = fields[solution.model] - truth
        write_mesh(path, plan)

    def choices(self) -> dict[str, Any]:
        """Return the settings of every model."""
        return {solution.model: solution.settings for solution in self.solutions}

    def complaints(self) -> list[str]:
        """Return a sentence for every model that did not converge: what happened and what can be done; and
        why lattice and reference are far apart though both did."""
        return [*([self.disagreement] if self.disagreement else [])] + [
            ": ".join(part for part in (s.model, s.status_text, s.message, s.status.advice) if part)
            for s in self.solutions
            if s.status is not Status.CONVERGED
        ]

    def notes(self) -> list[str]:
        """Return what to know of the errors first, then the models and what was chosen for them, and what the
        percentages mean."""
        return notes(self)


def _named(letter: str, vector: np.ndarray) -> dict[str, float]:
    """Return the components of a vector (3,) by name."""
    return {f"{letter}{axis}": float(part) for axis, part in zip("xyz", vector, strict=True)}

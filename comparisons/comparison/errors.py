"""Displacements of a lattice beside those of a reference: errors, error bars and branches.

With u the displacement of a model and u_ref that of the reference at the same plan points,

    error        largest |component of (u − u_ref)| over the probes / largest |component of u_ref| over them
    field_error  likewise, over points all over the sheet in place of the probes
    relative     |u − u_ref| / |u_ref| at one probe

Both are fractions, and None where they have no meaning: the reference does not move there by more than
round-off, a number is not finite, or one of the two models did not reach the full load.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np

from comparisons.comparison import branches
from comparisons.comparison.error_bar import ErrorBar
from comparisons.models.expected_error import ExpectedError, NoEstimate
from comparisons.sweep.differences import error, field_points, relative
from comparisons.sweep.model_error import ModelError, model_error
from fem_reference.uncertainty import ROUNDING
from sheetbench.answers.solution import Solution, Status
from sheetbench.errors import require_choice
from sheetbench.scenes import Scene

Answered = TypeVar("Answered")
ROUND_OFF = 1e-9  # of the largest displacement at a probe


def one_of(answers: Mapping[str, Answered], model: str) -> Answered:
    """Return the answer of a model. Raises BadInput, naming those that there are."""
    require_choice("model", model, answers)
    return answers[model]


@dataclass(frozen=True)
class Difference:
    """How far one model is from another at one probe, as a fraction of the other's displacement there.

    distinguishable: whether that is more than the other's own error bar; None where there is no bar.
    """

    probe: str
    of: str
    against: str
    relative: float | None
    distinguishable: bool | None = None


@dataclass(frozen=True, repr=False)
class Compared:
    """Solutions of one scene: the chosen lattice first, the reference second, then what is shown alongside.

    Every solution has its own `model` name, by which `differences` and `errors` speak of it. bar: what the
    reference's mesh leaves uncertain, where that was requested. disagreement: a sentence where both are at
    rest and far apart. expected: the error to expect of the chosen lattice's grid, or why there is none.
    several: whether more than one equilibrium is known; other_branch: whether the first two are known to be
    different ones. busy: sentences on times taken on a busy machine. law_chosen: the reference's law of
    strain, by the user.
    """

    scene: Scene
    solutions: tuple[Solution, ...]
    bar: ErrorBar | None = None
    disagreement: str = ""
    expected: ExpectedError | NoEstimate | None = None
    several: bool = False
    other_branch: bool = False
    busy: tuple[str, ...] = ()
    law_chosen: bool = False

    @property
    def lattice(self) -> Solution:
        """The chosen lattice's solution."""
        return self.solutions[0]

    @property
    def reference(self) -> Solution:
        """The solution that the others are measured against."""
        return self.solutions[1]

    def __getitem__(self, model: str) -> Solution:
        """Return the solution of a model by its name. Raises BadInput where there is none."""
        return one_of({solution.model: solution for solution in self.solutions}, model)

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

    @cached_property
    def field_errors(self) -> dict[str, float | None]:
        """The error over the sheet of every other model that has one, by name."""
        points = field_points(self.scene)
        moved = {s.model: s.displacement(points) for s in self.solutions if self.measurable(s)}
        truth = moved.pop(self.reference.model, None)
        return {} if truth is None else {model: error(u, truth) for model, u in moved.items()}

    def error_in_words(self, solution: Solution) -> str:
        """Return the error at the probes and over the sheet, nothing where there is none."""
        at, over = self.error(solution), self.field_errors.get(solution.model)
        sheet = "" if over is None else f", over the sheet {100 * over:.2f} %"
        return "" if at is None else f"error at the probes {100 * at:.2f} %{sheet}"

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

    @property
    def relative_bars(self) -> dict[str, float]:
        """The reference's bar over its displacement, at the probes where it moves; 0 where it is rounding."""
        if self.bar is None:
            return {}
        sizes = {probe: float(np.linalg.norm(u)) for probe, u in self.probes(self.reference).items()}
        bars = {probe: self.bar.at(probe) / size for probe, size in sizes.items() if size > self.least}
        return {probe: bar if bar > ROUNDING else 0.0 for probe, bar in bars.items()}

"""Errors of models against a reference (`comparisons.sweep.differences`), with error bars and branches.

Errors are None too if one of the models did not reach the full load, relative ones also at probes where the
reference moves by no more than round-off.
"""

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
    """Return the answer of a model. Raises BadInput with the valid names."""
    require_choice("model", model, answers)
    return answers[model]


@dataclass(frozen=True)
class Difference:
    """Difference of a model from another at a probe, as a fraction of the other's displacement there.
    distinguishable: whether it exceeds the other's error bar, None without a bar."""

    probe: str
    of: str
    against: str
    relative: float | None
    distinguishable: bool | None = None


@dataclass(frozen=True, repr=False)
class SceneSolutions:
    """Solutions of one scene: the chosen lattice first, the reference second, then further models.

    Every solution has a unique `model` name, used in `differences` and `errors`. bar: the reference's error
    bar, if requested; disagreement: a sentence if both are at rest and differ much; expected: expected grid
    error of the chosen lattice, or the reason for no estimate; several: whether more than one equilibrium is
    known; other_branch: whether the first two solutions are on different branches; busy: warnings about times
    on a busy machine; law_chosen: whether the user chose the reference's law of strain.
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
        """The reference's solution."""
        return self.solutions[1]

    def __getitem__(self, model: str) -> Solution:
        """Return the solution of a model by its name. Raises BadInput for an unknown name."""
        return one_of({solution.model: solution for solution in self.solutions}, model)

    def probes(self, solution: Solution) -> dict[str, np.ndarray]:
        """Return the displacement (3,) [m] at each probe."""
        values = solution.displacement(self.scene.probe_points())
        return dict(zip(self.scene.probes, values, strict=True))

    @property
    def least(self) -> float:
        """Displacement of the reference at a probe [m] below which it counts as rounding, as at a support."""
        return ROUND_OFF * max(float(np.linalg.norm(u)) for u in self.probes(self.reference).values())

    def measurable(self, solution: Solution) -> bool:
        """Return whether a solution and the reference are stable and may lie on one branch."""
        pair = (solution, self.reference)
        stable = all(one.comparable and one.status is not Status.UNSTABLE for one in pair)
        if not stable or not self.several or (solution in self.solutions[:2] and not self.other_branch):
            return stable
        return not branches.may_differ(*(one.displacement(self.scene.probe_points()) for one in pair))

    def error(self, solution: Solution) -> float | None:
        """Return the solution's error against the reference."""
        if solution is self.reference or not self.measurable(solution):
            return None
        points = self.scene.probe_points()
        return error(solution.displacement(points), self.reference.displacement(points))

    @cached_property
    def field_errors(self) -> dict[str, float | None]:
        """Errors over the sheet of the measurable models, by name, without the reference."""
        points = field_points(self.scene)
        fields = {s.model: s.displacement(points) for s in self.solutions if self.measurable(s)}
        truth = fields.pop(self.reference.model, None)
        return {} if truth is None else {model: error(u, truth) for model, u in fields.items()}

    def error_in_words(self, solution: Solution) -> str:
        """Return the errors at the probes and over the sheet in words, "" without errors."""
        at_probes, field_error = self.error(solution), self.field_errors.get(solution.model)
        sheet = "" if field_error is None else f", over the sheet {100 * field_error:.2f} %"
        return "" if at_probes is None else f"error at the probes {100 * at_probes:.2f} %{sheet}"

    @property
    def differences(self) -> tuple[Difference, ...]:
        """Relative differences of all other models from the reference at every probe."""
        truth, least, out = self.probes(self.reference), self.least, []
        for solution in (s for s in self.solutions if s is not self.reference):
            measurable = self.measurable(solution)
            for name, value in self.probes(solution).items():
                difference = relative(value, truth[name], least) if measurable else None
                beyond_bar = None
                if self.bar is not None and difference is not None:
                    beyond_bar = bool(np.linalg.norm(value - truth[name]) > self.bar.at(name))
                out.append(Difference(name, solution.model, self.reference.model, difference, beyond_bar))
        return tuple(out)

    @cached_property
    def model_error(self) -> ModelError | None:
        """Model error of the reference, independent of its mesh, if known."""
        return model_error(self.scene, self.reference, self.law_chosen)

    def distinguishable(self, solution: Solution) -> bool | None:
        """Return whether a solution's error exceeds the reference's error bar, None if either is unknown."""
        value = self.error(solution)
        return None if self.bar is None or value is None else value > self.bar.error

    def branch(self, solution: Solution) -> str:
        """Return a solution's branch if several equilibria are known, else "". Values are "path", "buckled",
        "of MODEL" for a solve that started in another model's shape, and "own" if lattice and reference are
        on different branches."""
        if "begun" in solution.settings:
            return f"of {solution.settings['begun']}"
        if self.other_branch and solution in self.solutions[:2]:
            return "own"
        several = solution.snaps or solution.status is Status.UNSTABLE or self.several
        return str(solution.settings.get("branch", "path" if several else ""))

    @property
    def relative_bars(self) -> dict[str, float]:
        """The reference's error bar over its displacement, at probes that move; rounding counts as 0."""
        if self.bar is None:
            return {}
        sizes = {probe: float(np.linalg.norm(u)) for probe, u in self.probes(self.reference).items()}
        bars = {probe: self.bar.at(probe) / size for probe, size in sizes.items() if size > self.least}
        return {probe: bar if bar > ROUNDING else 0.0 for probe, bar in bars.items()}

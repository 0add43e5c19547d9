"""Displacements of a lattice beside those of a reference.

With u the displacement of a model and u_ref that of the reference at the same plan points,

    error     largest |component of (u − u_ref)| over the probes / largest |component of u_ref| over them
    relative  |u − u_ref| / |u_ref| at one probe

Both are fractions, and None where they have no meaning: the reference does not move there by more than
round-off, a number is not finite, or one of the two models did not reach the full load.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.comparison import branches, far_apart, strain_law, tables
from comparisons.comparison.differences import error, relative
from comparisons.comparison.error_bar import CHEAP, ErrorBar, error_bar
from comparisons.comparison.model_error import ModelError, model_error
from comparisons.models.candidate import Candidate
from comparisons.models.expected_error import ExpectedError, expected_error
from comparisons.models.grading import Grading
from comparisons.models.grids import Elements, GridLike
from comparisons.models.plugins import shown_name
from comparisons.models.registry import answer, check, check_reference
from comparisons.models.sizes import has_room
from comparisons.models.springs import LatticeSpec, resolve
from comparisons.report.work import Progress, silent
from comparisons.runs.load import average
from comparisons.runs.load import warnings as doubts
from sheetbench.answers.report import Report
from sheetbench.choices import ELEMENTS, REFERENCE
from sheetbench.scenes import Scene, SceneError, Solution, Status, load, require_static, summary
from sheetbench.scenes.summary import few

COMPANION = "lumped-uniform"
ROUND_OFF = 1e-9  # of the largest displacement at a probe


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
class Comparison(summary.Summarised):
    """Solutions of one scene: the chosen lattice first, the reference second, then what is shown alongside.

    Every solution has its own `model` name, by which `differences` and `errors` speak of it. bar: what the
    reference's mesh leaves uncertain, where that was asked for; laws: a sentence where lattice and reference
    have laws of strain that differ by more. apart: a sentence where both are at rest and far apart.
    expected: the error to expect of the chosen lattice's grid, where an estimate holds. several: whether more
    than one equilibrium is known; other_branch: whether the first two are known to be different ones. busy:
    sentences on times taken on a busy machine. law_chosen: the reference's law of strain, by the user.
    """

    scene: Scene
    solutions: tuple[Solution, ...]
    bar: ErrorBar | None = None
    laws: str = ""
    apart: str = ""
    expected: ExpectedError | None = None
    several: bool = False
    other_branch: bool = False
    busy: tuple[str, ...] = ()
    law_chosen: bool = False

    @property
    def reference(self) -> Solution:
        """The solution that the others are measured against."""
        return self.solutions[1]

    @property
    def converged(self) -> bool:
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
        """Whether a solution and the reference are both stable, and not known to be on different branches."""
        pair = (solution, self.reference)
        stable = all(one.comparable and one.status is not Status.UNSTABLE for one in pair)
        if not stable or not self.several or (solution in self.solutions[:2] and not self.other_branch):
            return stable
        return not branches.far(*(one.displacement(self.scene.probe_points()) for one in pair))

    def error(self, solution: Solution) -> float | None:
        """The solution's error against the reference."""
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
                told_apart = None
                if self.bar is not None and off is not None:
                    told_apart = bool(np.linalg.norm(value - truth[name]) > self.bar.at(name))
                found.append(Difference(name, solution.model, self.reference.model, off, told_apart))
        return tuple(found)

    def own_bar(self, solution: Solution) -> dict[str, np.ndarray] | None:
        """Half a length (3,) [m] of the bar at each probe that a solution brings with it, None of most."""
        if solution.bar is None:
            return None
        return dict(zip(self.scene.probes, solution.bar(self.scene.probe_points()), strict=True))

    def bar_of(self, solution: Solution) -> float | None:
        """By how much a solution says that it may be off: its largest bar over its largest displacement."""
        if solution is self.reference and self.bar is not None:
            return self.bar.error
        if solution.bar is None or solution.status is Status.UNSTABLE:
            return None
        points = self.scene.probe_points()
        u = solution.displacement(points)
        return error(u + solution.bar(points), u)

    @property
    def model_error(self) -> ModelError | None:
        """What the reference leaves out of the sheet on every mesh, where that is known."""
        return model_error(self.scene, self.reference, self.law_chosen)

    def distinguishable(self, solution: Solution) -> bool | None:
        """Whether a solution's error is above the reference's own; None where either is not known."""
        off = self.error(solution)
        return None if self.bar is None or off is None else off > self.bar.error

    def branch(self, solution: Solution) -> str:
        """Which equilibrium, where several are known: "path", "buckled", "of" the model in whose shape it was
        begun, or "own", where lattice and reference are on different branches."""
        if "begun" in solution.settings:
            return f"of {solution.settings['begun']}"
        if self.other_branch and solution in self.solutions[:2]:
            return "own"
        several = solution.snaps or solution.status is Status.UNSTABLE or self.several
        return str(solution.settings.get("branch", "path" if several else ""))

    def as_dict(self) -> dict[str, Any]:
        """The JSON document of `sheetbench compare`: metres, newtons, seconds."""
        return {
            "scene": self.scene.document(),
            "solutions": [self._solution_as_dict(solution) for solution in self.solutions],
            "laws": self.laws,
            "apart": self.apart,
            "differences": [vars(difference) for difference in self.differences],
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

    def report(self) -> Report:
        """What is shown of it."""
        return tables.report(self)

    def _summary(self) -> tuple[str, summary.Facts]:
        facts = []
        for solution in self.solutions:
            off, time = self.error(solution), summary.milliseconds(solution.solve_seconds)
            said = (
                "the reference" if solution is self.reference else f"error {100 * off:.3g} %" if off else ""
            )
            facts.append((solution.model, ", ".join(filter(None, [str(solution.status), said, time]))))
        bar = "" if self.bar is None else f"±{few(100 * self.bar.error)} %"
        return f"Comparison of {self.scene.name}; .report() has tables, pictures and files", [
            *facts,
            ("reference's own error", bar),
        ]

    def _solution_as_dict(self, solution: Solution) -> dict[str, Any]:
        bar: dict[str, Any] = {}
        if solution is self.reference and self.bar is not None:
            bar = self.bar.as_dict() | (self.model_error.as_dict() if self.model_error else {"model": None})
        if (own := self.own_bar(solution)) is not None:
            bar = {"error": (off := self.bar_of(solution)), "mesh": off, "probes": own}
        expected = self.expected if solution is self.solutions[0] else None
        return {
            "model": solution.model,
            "label": solution.label,
            "settings": solution.settings,
            "status": str(solution.status),
            "advice": solution.status.advice,
            **({"branch": branch} if (branch := self.branch(solution)) else {}),
            "message": solution.message,
            "stretch": solution.stretch,
            "snaps": list(solution.snaps),
            "load_factor": solution.load_factor,
            "unknowns": solution.unknowns,
            "iterations": solution.iterations,
            "solve_seconds": solution.solve_seconds,
            "setup_seconds": solution.setup_seconds,
            "probes": self.probes(solution),
            "reactions": solution.reactions,
            "energies": solution.energies,
            "balance": solution.balance.document() if solution.balance is not None else None,
            **({"uncertainty": bar} if bar else {}),
            **({"expected_error": expected.as_dict()} if expected else {}),
        }


def compare(
    scene: Scene | str | Path,
    *,
    grid: GridLike = None,
    calibration: str | None = None,
    k: float | None = None,
    layer_distance: float | None = None,
    grading: Grading = None,
    reference: str = REFERENCE,
    elements: Elements = ELEMENTS,
    law: str | None = None,
    uncertainty: bool | None = None,
    symmetry: bool = False,
    branch: str = "path",
    companion: bool = True,
    others: Sequence[Candidate] = (),
    large: bool = False,
    progress: Progress = silent,
    starting: Callable[[str], None] = silent,
    finished: Callable[[Solution], None] = silent,
) -> Comparison:
    """Solve a scene with the lattice and with a reference, and put the answers side by side.

    grid: masses, 9 by default: a number is along the shorter side, with near-square cells; (nx, ny) or "9x13"
    along x and y; (nx, ny, layers). calibration: by default `consistent`, and then the uniform calibration is
    solved too and shown alongside as `lumped-uniform`; where `k` [N/m] is given the default is `uniform`, and
    where the scene brings its own [springs] they are used alone; companion = False leaves it out.
    layer_distance [m]. grading: 0, cells of one size, to 1, finest at the edges, or "auto", as the scene's
    layers need (`comparisons.models.grading`); the companion's cells are of one size. elements: along the
    shorter side, or (nx, ny). law: of strain, where the reference is a shell or solid
    (`sheetbench.choices.STRAIN_LAWS`). uncertainty: find the reference's error bar on coarser meshes too; for
    plate and shell it is unless False, for others if True. symmetry: solve a half or a quarter where scene
    and grid mirror themselves; solids are solved whole. branch: "path", or "buckled", which leaves unstable
    equilibria along their buckling mode; of lattice and shell.
    others: models that stand in the table too, plug-ins or our own. A name that is taken is changed. large:
    even where a model takes more memory than there is. progress: told what is being done, and of every
    iteration (`comparisons.report.work`). `starting` and `finished` are called before and after each model,
    so that a caller can keep what is done.

    Raises SceneError for a scene without a static answer, BadInput for choices that do not exist, and the
    solvers' own errors for settings they cannot use. A solve that fails is data: see each solution's status.
    """
    if not isinstance(scene, Scene):
        scene = load_static(scene)
    require_static(scene)
    own_law = {} if law is None else {"law": law}
    check_reference(reference, elements, own_law)
    mirrored: dict[str, Any] = {"symmetry": True} if symmetry else {}
    cut = mirrored if reference != "solid" else {}
    judge = Candidate(reference, {"elements": elements, **own_law, **cut})
    lattice = LatticeSpec(grid, calibration, k, layer_distance, grading)
    if branch != "path":
        mirrored["branch"] = branch
        check_reference(reference, elements, {**own_law, "branch": branch})
        judge = judge.but(branch=branch)
    first = lattice.candidate.but(**mirrored)
    for candidate in (first, judge, *others):
        check(scene, candidate, large)
    named = {first.model: first, reference: judge}
    left_open = calibration is None and k is None and resolve(scene, lattice).calibration is not None
    if companion and left_open:
        named[COMPANION] = first.but(calibration="uniform", grading=None)
    for other in others:
        named[_unlike(shown_name(other.model), named)] = other
    solutions = []
    for name, candidate in named.items():
        starting(name)
        solutions.append(answer(scene, candidate, name, progress=progress))
        finished(solutions[-1])
    laws = apart = ""
    several = begun = other_branch = False
    one_branch = branches.joined(scene, first, judge, *solutions[:2])
    if one_branch is not None:
        several, begun = True, one_branch[1] is not solutions[1]
        solutions[0], solutions[1], apart = one_branch

    def also(other: Candidate) -> Solution | None:
        fits = large or has_room(scene, other)
        return answer(scene, other, "lumped on a finer grid", progress=progress) if fits else None

    expected = expected_error(scene, first, solutions[0], also)
    bar = None
    alone = begun or solutions[1].status is Status.UNSTABLE  # coarser meshes may be on another branch
    asked = reference in CHEAP if uncertainty is None else uncertainty
    if asked and solutions[1].comparable and not alone:
        starting(f"{reference} on coarser meshes")

        def coarser(n: Elements) -> Solution:
            return answer(scene, judge.but(elements=n), progress=progress)

        bar = error_bar(scene, solutions[1], elements, coarser)
    answers, within = tuple(solutions), None if bar is None else bar.error
    if first.model == "lumped":
        laws = strain_law.said(scene, first, answers, within)
        if not apart:
            apart, other_branch = far_apart.said(scene, first, answers, error, within, also)
    known, busy = several or other_branch, tuple(doubts([average()]))
    return Comparison(scene, answers, bar, laws, apart, expected, known, other_branch, busy, law is not None)


def _unlike(name: str, taken: Collection[str]) -> str:
    """The name, or with the first number after it that makes it a new one."""
    return next(n for n in (name, *(f"{name}-{i}" for i in range(2, len(taken) + 3))) if n not in taken)


def load_static(scene: str | Path) -> Scene:
    """The scene of a catalogue name or file, refused by that name if its supports leave it free to move."""
    loaded = load(scene)
    try:
        require_static(loaded)
    except SceneError as error:
        raise SceneError(f"{scene}: {error}") from None
    return loaded

"""The answer of `sheetbench compare`: document, tables, figures and files of a comparison."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cached_property, partial
from math import hypot
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from comparisons.comparison.errors import ROUND_OFF, SceneSolutions
from comparisons.models.expected_error import ExpectedError, NoEstimate
from comparisons.models.grading import choice_notes
from comparisons.pictures.array_files import write_mesh
from comparisons.pictures.plan import plan_mesh
from comparisons.sweep.differences import far, unseen
from comparisons.sweep.model_error import few_percent
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import RASTER, Picture, Write
from sheetbench.answers.solution import Solution, Status
from sheetbench.answers.table import (
    MILLIMETRES,
    MILLISECONDS,
    NEWTONS,
    NUMBER,
    PERCENT,
    SECONDS,
    Column,
    Table,
)
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.parameters import parameter
from sheetbench.scenes.meaning.words import sheet_in_words
from sheetbench.scenes.objects.supports import named

DEFAULT_RATE, AT_REST = 2.0, 10.0  # 1/s, damping rate for a scene without one; end of motion, of 1/rate
BUCKLED = (
    "branch buckled: a model whose equilibrium under the whole load is unstable leaves it along its lowest "
    "mode; the stable equilibrium shown is one of several."
)
COMPONENTS = tuple(MILLIMETRES("z.3f", f"u{axis}") for axis in "xyz")
FORCES = ("edge", "model", *(NEWTONS("z.4f", f"F{axis}") for axis in "xyz"))


@dataclass(frozen=True)
class ProbeRow:
    """Displacement of a probe by a model [m], its difference from the reference, the
    reference's bar, and relative changes by 1 % of parameters."""

    probe: str
    x: Annotated[float, MILLIMETRES(".4g", detail=True)]
    y: Annotated[float, MILLIMETRES(".4g", detail=True)]
    model: str
    displacement: dict[Column, float]
    difference: Annotated[float | None, PERCENT("z.2f")]
    bar: Annotated[float | None, PERCENT(".2g", "±")]
    sensitivity: dict[Column, float | None]


@dataclass(frozen=True)
class CostRow:
    """Cost and errors of a model; forces: of some supports and obstacles [N]."""

    model: str
    label: Annotated[str, Column("what it is", prose=True, detail=True)]
    unknowns: Annotated[int, NUMBER("d")]
    factorisations: Annotated[int, NUMBER("d", detail=True)]
    set_up: Annotated[float, SECONDS("z.2f", "set-up")]
    solve: Annotated[float, MILLISECONDS(".1f")]
    error: Annotated[float | None, PERCENT("z.2f")]
    field_error: Annotated[float | None, PERCENT("z.2f")]
    expected: Annotated[float | None, PERCENT("z.2f", "est.")]
    forces: dict[Column, float | None]
    status: Annotated[str, Column(prose=True)]


def settling(scene: Scene) -> str:
    """Return advice to try a damped motion, which may settle where the static solve fails."""
    material = scene.material
    damped = material.damping_rate or material.dashpot_time or material.branches.times or scene.dampers
    until = AT_REST / (material.damping_rate or DEFAULT_RATE)
    command = f"; to watch it: sheetbench simulate SCENE --duration {until:.2g}"
    return "--settle starts from the end of its damped motion" + command * bool(damped or scene.air)


@dataclass(frozen=True, repr=False)
class Comparison(SceneSolutions, Answer):
    """A comparison of solutions with its document, tables, figures, files and notes; sensitive_to: names of
    parameters by which the probes' derivatives are shown."""

    sensitive_to: tuple[str, ...] = ()
    file_name, page_name, notes_shown = "comparison", "table", 1

    @property
    def succeeded(self) -> bool:
        """Whether the chosen lattice and the reference both reached a stable equilibrium."""
        return all(solution.status is Status.CONVERGED for solution in self.solutions[:2])

    def document(self) -> dict[str, Any]:
        return {
            "scene": self.scene.document(),
            "solutions": [self._solution_document(solution) for solution in self.solutions],
            "apart": self.disagreement,
            "sentence": self.sentence,
            "differences": [asdict(difference) for difference in self.differences],
            **({"sensitivities": self.sensitivities} if self.sensitive_to else {}),
            "errors": [
                {
                    "of": solution.model,
                    "against": self.reference.model,
                    "error": self.error(solution),
                    "field_error": self.field_errors.get(solution.model),
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
        expected = self.expected if solution is self.solutions[0] else None
        return {
            **solution.document(self.scene),
            **({"branch": branch} if (branch := self.branch(solution)) else {}),
            **({"uncertainty": bar} if bar else {}),
            **({"expected_error": expected.as_dict()} if isinstance(expected, ExpectedError) else {}),
            **({"no_estimate": expected.reason} if isinstance(expected, NoEstimate) else {}),
        }

    def result(self) -> str:
        statuses = ", ".join(f"{s.model} {s.status}" for s in self.solutions[:2])
        return self.sentence or f"not comparable: {statuses}"

    @cached_property
    def sentence(self) -> str:
        """Errors of the lattice and of the reference in a sentence, "" if they cannot be compared."""
        lattice, reference = self.solutions[:2]
        error, field_error = self.error(lattice), self.field_errors.get(lattice.model)
        if error is None:
            return ""
        bar, where = None if self.bar is None else self.bar.error, ""
        if field_error and far(error, field_error, bar):
            where = f" at the probes and {few_percent(field_error)} over the sheet"
        sentence = f"The lattice is {few_percent(error)} off the {reference.model}{where}"
        material = self.scene.material
        one_modulus = material.kind == "isotropic" and material.law in (None, "neo-hookean")
        if (model_error := self.model_error) is None:
            return f"{sentence}; the {reference.model}'s own error from the sheet as described is not known."
        total = model_error.value + (bar or 0.0)
        conditions = {
            "the clamp also holds the thickness": model_error.clamp,
            "hinges also hold the twist": model_error.hinge,
        }
        exceptions = "; ".join(
            f"{few_percent(total + e)} if {text}" for text, e in conditions.items() if e > 0.0
        )
        mesh = "" if self.bar else " but for the error of its mesh"
        return (
            f"{sentence}, and the {reference.model} within {few_percent(total)} of the sheet as described"
            f"{mesh}{f' ({exceptions})' * bool(exceptions)}; "
            f"errors of {'E' if one_modulus else 'its constants'} are not included."
        )

    def heading(self) -> tuple[str, str, str]:
        return self.scene.name, self.scene.title, sheet_in_words(self.scene.sheet, self.scene.material)

    def tables(self) -> tuple[Table, ...]:
        """Return displacements at the probes, the reference first; cost and error; forces of the supports."""
        return self._displacements(), self._costs(), self._reactions()

    def printed(self) -> tuple[Table, ...]:
        """Return displacements, and costs with the forces of moved supports and of obstacles."""
        moved = {name for name, support in named(self.scene.supports).items() if support.motion is not None}
        moved |= {motion.held_as for motion in self.scene.motions().values()}
        moved |= {name for solution in self.solutions for name in solution.contacts}
        return self._displacements(), self._costs(sorted(moved))

    @cached_property
    def sensitivities(self) -> dict[str, dict[str, dict[str, float | None]]]:
        """Relative change of each probe's |u| by 1 % of a parameter (d|u|/dθ · θ/100|u|), by model, parameter
        and probe, for models with derivatives. Raises BadInput for unknown parameters."""
        result: dict[str, dict[str, dict[str, float | None]]] = {}
        values = {name: parameter(self.scene, name).value for name in self.sensitive_to}
        for solution in self.solutions:
            if solution.sensitivity is None or solution.status is not Status.CONVERGED:
                continue
            sensitivity, points = solution.sensitivity(), self.scene.probe_points()
            u = solution.displacement(points)
            square = np.sum(u**2, axis=1)
            at_rest = square <= (ROUND_OFF * np.abs(u).max()) ** 2
            result[solution.model] = {}
            for name, value in values.items():
                change = 0.01 * value * np.sum(u * sensitivity.displacement_rate(points, name), axis=1)
                shares = zip(self.scene.probes, change / np.where(at_rest, 1.0, square), at_rest, strict=True)
                result[solution.model][name] = {n: None if rest else float(s) for n, s, rest in shares}
        return result

    def _displacements(self) -> Table:
        differences = {(d.probe, d.of): d.relative for d in self.differences}
        ordered = sorted(self.solutions, key=lambda solution: solution is not self.reference)
        models = [(s.model, self.probes(s)) for s in ordered]
        bars = {(probe, self.reference.model): bar for probe, bar in self.relative_bars.items()}
        columns = {name: PERCENT("z.2f", f"by 1 % of {name}") for name in self.sensitive_to}
        of = {model: self.sensitivities.get(model, {}) for model, _ in models} if columns else {}
        rows = (
            ProbeRow(
                *(probe, x, y, name, dict(zip(COMPONENTS, u[probe].tolist(), strict=True))),
                *(differences.get((probe, name)), bars.get((probe, name))),
                {column: of[name].get(key, {}).get(probe) for key, column in columns.items()},
            )
            for probe, (x, y) in self.scene.probes.items()
            for name, u in models
        )
        return Table.of(ProbeRow, rows, "Displacement of the mid-surface", "table", grouped=True)

    def _costs(self, supports: Sequence[str] = ()) -> Table:
        """Return cost and error of each model; supports: names of bodies whose forces are included."""
        columns = {name: NEWTONS(".4g", f"force of {name}") for name in supports}
        rows = (
            CostRow(
                *(s.model, s.label, s.unknowns, s.iterations, s.setup_seconds, s.solve_seconds),
                *(self.error(s), self.field_errors.get(s.model), self._expected(s)),
                {c: hypot(*s.reactions[n]) if n in s.reactions else None for n, c in columns.items()},
                s.status_text,
            )
            for s in self.solutions
        )
        return Table.of(CostRow, rows, "Cost and error of each model", "models", text="; ".join(self.busy))

    def _expected(self, solution: Solution) -> float | None:
        """Return the expected grid error of the chosen lattice, None without one and for other models."""
        if solution is self.solutions[0] and isinstance(self.expected, ExpectedError):
            return self.expected.value
        return None

    def _reactions(self) -> Table:
        rows = sorted((edge, s.model, *force) for s in self.solutions for edge, force in s.reactions.items())
        return Table.listed("Force of each support on the sheet", FORCES, rows, "reactions")

    def figures(self) -> tuple[Picture, ...]:
        lattice, reference = self.solutions[:2]
        models = f"{self.scene.name}: {lattice.label} against {reference.label}"
        text = ": ".join(filter(None, [models, self.error_in_words(lattice)]))
        return (Picture("comparison", "comparisons.comparison.figure:compose", (self,), text, RASTER),)

    def files(self) -> dict[str, Write]:
        """Return the solutions as VTU, each on its own mesh and all on one."""
        files: dict[str, Write] = {f"{s.model}.vtu": partial(write_mesh, mesh=s.mesh) for s in self.solutions}
        return {**files, "comparison.vtu": self.write_plan}

    def write_plan(self, path: Path) -> None:
        """Write all solutions on one plan grid as `displacement_MODEL`, and their differences. `displacement`
        is the reference's; `difference` is the chosen lattice's difference from it, `difference_MODEL`
        another model's."""
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
        return {solution.model: solution.settings for solution in self.solutions}

    def complaints(self) -> list[str]:
        """Return advice for every model that did not converge, and the reason of a large disagreement."""
        unsettled = (Status.STEP_LIMIT, Status.DIVERGED)
        return [*([self.disagreement] if self.disagreement else [])] + [
            ": ".join(part for part in (s.model, s.status_text, s.message, s.status.advice) if part)
            + f"; {settling(self.scene)}" * (s.status in unsettled and "begun" not in s.settings)
            for s in self.solutions
            if s.status is not Status.CONVERGED
        ]

    def notes(self) -> list[str]:
        ref, first = f"u_{self.reference.model}", self.solutions[0].model
        return [
            *([self.sentence] if self.sentence else []),
            *([BUCKLED] if self.reference.settings.get("branch") == "buckled" else []),
            *([f"{first}: {self.expected}"] if self.expected else []),
            *self._bar_notes(),
            *unseen(
                ((s.model, self.error(s), self.field_errors.get(s.model)) for s in self.solutions),
                None if self.bar is None else self.bar.error,
            ),
            *dict.fromkeys(note for s in self.solutions for note in choice_notes(s.settings)),
            " · ".join(solution.label for solution in self.solutions),
            f"difference: |u − {ref}| / |{ref}| at the probe. "
            f"error: largest component of u − {ref} over the probes / largest component of {ref}; "
            "field error: likewise over the whole sheet."
            + " ±: mesh error of the reference at the probe."
            * (self.bar is not None),
        ]

    def _bar_notes(self) -> list[str]:
        """Return the reference's error bar in words, and the models within it."""
        notes, model = list[str](), self.reference.model
        if self.bar is None:
            return notes
        notes.append(self.bar.note(model))
        notes += [f"{model}: {text}."] if (text := str(self.model_error or "")) else []
        for solution in self.solutions:
            within = [
                d.probe for d in self.differences if d.of == solution.model and d.distinguishable is False
            ]
            if self.distinguishable(solution) is False:
                notes.append(f"{solution.model}: not distinguishable from {model}.")
            elif within:
                notes.append(f"{solution.model}: not distinguishable from {model} at {', '.join(within)}.")
        return notes

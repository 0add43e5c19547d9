"""The answer of `sheetbench compare`: document, tables, pictures and files of a comparison."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cached_property, partial
from math import hypot
from pathlib import Path
from typing import Any

from comparisons.comparison.errors import Compared
from comparisons.models.expected_error import ExpectedError, NoEstimate
from comparisons.models.grading import choice_notes
from comparisons.pictures.array_files import write_mesh
from comparisons.pictures.plan import plan_mesh
from comparisons.sweep.differences import far, unseen
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
from sheetbench.scenes.language.summary import few
from sheetbench.scenes.meaning.words import sheet_in_words
from sheetbench.scenes.objects.supports import named

SLOW, AT_REST = 2.0, 10.0  # 1/s, a rate where there is none; of 1/rate, after which motion has died down
BUCKLED = (
    "branch buckled: a model whose equilibrium under the whole load is unstable leaves it along its lowest "
    "mode; what is shown is the stable equilibrium that it comes to, one of several."
)
MOVED = (
    *("probe", MILLIMETRES(".4g", "x", detail=True), MILLIMETRES(".4g", "y", detail=True), "model"),
    *(MILLIMETRES("z.3f", f"u{axis}") for axis in "xyz"),
    *(PERCENT("z.2f", "difference"), PERCENT(".2g", "±")),
)
COSTS = (
    *("model", Column("what it is", prose=True, detail=True), NUMBER("d", "unknowns")),
    *(NUMBER("d", "factorisations", detail=True), SECONDS("z.2f", "set-up"), MILLISECONDS(".1f", "solve")),
    *(PERCENT("z.2f", "error"), PERCENT("z.2f", "field error"), PERCENT("z.2f", "est.")),
    Column("status", prose=True),
)
FORCES = ("edge", "model", *(NEWTONS("z.4f", f"F{axis}") for axis in "xyz"))


def settling(scene: Scene) -> str:
    """Return advice for a sheet without an answer from statics: its motion may come to rest."""
    material = scene.material
    damped = material.damping_rate or material.dashpot_time or material.branches.times or scene.dampers
    until = AT_REST / (material.damping_rate or SLOW)
    watched = f"; to watch it: sheetbench simulate SCENE --duration {until:.2g}"
    return "--settle begins where its motion comes to rest" + watched * bool(damped or scene.air)


@dataclass(frozen=True, repr=False)
class Comparison(Compared, Answer):
    """Document, tables, pictures, files and notes of solutions that are compared."""

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
        ended = ", ".join(f"{s.model} {s.status}" for s in self.solutions[:2])
        return self.sentence or f"not comparable: {ended}"

    @cached_property
    def sentence(self) -> str:
        """How far the lattice is from the reference, and that from the sheet, in a sentence; nothing where
        they cannot be compared."""
        lattice, reference = self.solutions[:2]
        off, over = self.error(lattice), self.field_errors.get(lattice.model)
        if off is None:
            return ""
        bar = None if self.bar is None else self.bar.error
        where = f" at the probes and {_percent(over)} over the sheet" if over and far(off, over, bar) else ""
        said = f"The lattice is {_percent(off)} off the {reference.model}{where}"
        of = self.scene.material
        alone = of.kind == "isotropic" and of.law in (None, "neo-hookean")
        if (left := self.model_error) is None:
            return f"{said}; how far that is from the sheet as described is not known."
        within = left.value + (bar or 0.0)
        held = {"the clamp also holds the thickness": left.clamp, "hinges also hold the twist": left.hinge}
        changed = "; ".join(f"{_percent(within + by)} if {what}" for what, by in held.items() if by > 0.0)
        mesh = "" if self.bar else " but for the error of its mesh"
        return (
            f"{said}, and the {reference.model} within {_percent(within)} of the sheet as described{mesh}"
            f"{f' ({changed})' * bool(changed)}; {'E is' if alone else 'its constants are'} not in this."
        )

    def heading(self) -> tuple[str, str, str]:
        return self.scene.name, self.scene.title, sheet_in_words(self.scene.sheet, self.scene.material)

    def tables(self) -> tuple[Table, ...]:
        """Displacement at the probes, the reference first; cost and error; forces of the supports."""
        return self._displacements(), self._costs(), self._reactions()

    def printed(self) -> tuple[Table, ...]:
        """Return displacements and costs, and beside these the forces of moved supports and of obstacles."""
        moved = {name for name, support in named(self.scene.supports).items() if support.motion is not None}
        moved |= {motion.held_as for motion in self.scene.motions().values()}
        moved |= {name for solution in self.solutions for name in solution.contacts}
        return self._displacements(), self._costs(sorted(moved))

    def _displacements(self) -> Table:
        off = {(d.probe, d.of): d.relative for d in self.differences}
        ordered = sorted(self.solutions, key=lambda solution: solution is not self.reference)
        models = [(s.model, self.probes(s)) for s in ordered]
        bars = {(probe, self.reference.model): bar for probe, bar in self.relative_bars.items()}
        rows = (
            (probe, x, y, model, *moved[probe], off.get((probe, model)), bars.get((probe, model)))
            for probe, (x, y) in self.scene.probes.items()
            for model, moved in models
        )
        return Table.listed("Displacement of the mid-surface", MOVED, rows, "table", grouped=True)

    def _costs(self, exerting: Sequence[str] = ()) -> Table:
        """Return cost and error of each model; exerting: names of what it gives the size of the force of."""
        rows = (
            (
                *(s.model, s.label, s.unknowns, s.iterations, s.setup_seconds, s.solve_seconds),
                *(self.error(s), self.field_errors.get(s.model), self._expected(s)),
                *(hypot(*s.reactions[name]) if name in s.reactions else None for name in exerting),
                s.status_text,
            )
            for s in self.solutions
        )
        costs = (*COSTS[:-1], *(NEWTONS(".4g", f"force of {name}") for name in exerting), COSTS[-1])
        return Table.listed("Cost and error of each model", costs, rows, "models", text="; ".join(self.busy))

    def _expected(self, solution: Solution) -> float | None:
        """Return the grid error expected of the chosen lattice; where there is none a note says why."""
        if solution is self.solutions[0] and isinstance(self.expected, ExpectedError):
            return self.expected.value
        return None

    def _reactions(self) -> Table:
        rows = sorted((edge, s.model, *force) for s in self.solutions for edge, force in s.reactions.items())
        return Table.listed("Force of each support on the sheet", FORCES, rows, "reactions")

    def figures(self) -> tuple[Picture, ...]:
        lattice, reference = self.solutions[:2]
        both = f"{self.scene.name}: {lattice.label} against {reference.label}"
        described = ": ".join(filter(None, [both, self.error_in_words(lattice)]))
        return (Picture("comparison", "comparisons.comparison.figure:compose", (self,), described, RASTER),)

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
        return {solution.model: solution.settings for solution in self.solutions}

    def complaints(self) -> list[str]:
        """Return a sentence for every model that did not converge: what happened and what can be done; and
        why lattice and reference are far apart though both did."""
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
            "field error: likewise over the sheet."
            + " ±: mesh error of the reference at the probe."
            * (self.bar is not None),
        ]

    def _bar_notes(self) -> list[str]:
        """Return the reference's error bar in words, and the models that differ from it by less."""
        found, model = list[str](), self.reference.model
        if self.bar is None:
            return found
        found.append(self.bar.note(model))
        found += [f"{model}: {left_out}."] if (left_out := str(self.model_error or "")) else []
        for solution in self.solutions:
            close = [
                d.probe for d in self.differences if d.of == solution.model and d.distinguishable is False
            ]
            if self.distinguishable(solution) is False:
                found.append(f"{solution.model}: not distinguishable from {model}.")
            elif close:
                found.append(f"{solution.model}: not distinguishable from {model} at {', '.join(close)}.")
        return found


def _percent(share: float) -> str:
    return f"{few(100.0 * share)} %"

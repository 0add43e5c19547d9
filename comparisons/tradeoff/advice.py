"""Advice on the model for a scene, with its reasons: the answer of `sheetbench tradeoff --tolerance`."""

from dataclasses import dataclass
from functools import cached_property
from math import isfinite
from shlex import join
from typing import Annotated, Any

from comparisons.models.grading import parse_grading
from comparisons.models.spec import Elements, Lattice, Spec, counted
from comparisons.sweep import load
from comparisons.sweep.differences import unseen
from comparisons.sweep.in_process import LocalSolve
from comparisons.sweep.model_error import ModelError, share_of_tolerance
from comparisons.tradeoff.trials import TrialSolves
from sheetbench.answers.answer import Answer
from sheetbench.answers.table import MILLISECONDS, PERCENT, Column, Table, number, quantity
from sheetbench.choices import CALIBRATION
from sheetbench.scenes import Scene
from sheetbench.scenes.language.summary import few


@dataclass(frozen=True)
class TrialRow:
    """A trial solve: its model, time and errors, whether it is the choice, and its status."""

    model: Annotated[str, Column(prose=True)]
    size: str
    solve: Annotated[float, MILLISECONDS(".2f")]
    error: Annotated[float | None, PERCENT(".3g")]
    field_error: Annotated[float | None, PERCENT(".3g")]
    total: Annotated[float | None, PERCENT(".3g", "in all")]
    choice: Annotated[bool, Column(words=("yes", ""))]
    status: Annotated[str, Column(prose=True)]


@dataclass(frozen=True, repr=False)
class Advice(Answer):
    """The advised model of a scene, with its reasons. chosen: the advised solve; without one `message` has
    the reason; reasons: sentences on an automatic choice of springs and grading; called: the scene's name or
    path for commands."""

    file_name = "advice"
    trials: TrialSolves
    tolerance: float | None
    budget: float | None
    chosen: LocalSolve | None
    message: str
    needs: tuple[str, ...]
    left_out: tuple[str, ...]
    reasons: tuple[str, ...]
    called: str = ""

    @property
    def scene(self) -> Scene:
        """The scene to solve."""
        return self.trials.scene

    @property
    def choice(self) -> Spec | None:
        """The advised model, None without one."""
        return None if self.chosen is None else self.chosen.request.spec

    @property
    def error(self) -> float | None:
        """Predicted error of the choice, a fraction."""
        return None if self.chosen is None else self.trials.error(self.chosen)

    @cached_property
    def bar(self) -> float:
        """Error bar of the reference due to its mesh, a fraction."""
        return self.trials.uncertainty

    @property
    def model(self) -> ModelError | None:
        """Model error of the reference, independent of its mesh."""
        return self.trials.model_error

    @property
    def warnings(self) -> list[str]:
        """Warnings about times measured on a busy machine and about models left out."""
        rows, refused = self.trials.rows.values(), self.trials.refused.items()
        unreliable = load.warnings([row.conditions for row in rows], [row.samples for row in rows])
        return [*unreliable, *(f"{spec.model} {spec.size} left out: {reason}" for spec, reason in refused)]

    def errors(self, row: LocalSolve) -> tuple[float | None, float | None, float | None]:
        """Return a row's error at the probes, its error over the sheet, and its total error, unknown as None.
        The total, for comparison with a tolerance, is the error at the probes plus the reference's error bar
        and model error."""
        error = self.trials.error(row) if row.stable else None
        total = None if error is None else error + self.bar + (self.model.value if self.model else 0.0)
        return error, self.trials.field_error(row), total if total is not None and isfinite(total) else None

    @property
    def reason(self) -> str:
        """The predicted error and time of the choice and its message, in a sentence."""
        if self.error is None or self.chosen is None:
            return self.message
        size = f"{few(100 * self.error, 3)} % ± {few(100 * self.bar)} %"
        text = f"predicted error {size} in {_time(self.chosen.seconds)}"
        text += f", {self.model}" if self.model else ""
        return f"{text}; {self.message}" if self.message else text

    @property
    def succeeded(self) -> bool:
        """Whether a model meets the tolerance, within the budget if there is one."""
        if self.chosen is None:
            return False
        *_, total = self.errors(self.chosen)
        accurate = self.tolerance is None or (total is not None and total <= self.tolerance)
        return accurate and (self.budget is None or self.chosen.seconds <= self.budget)

    def document(self) -> dict[str, Any]:
        tried = []
        for row in self.trials.rows.values():
            trial = _named(row.request.spec) | {"status": row.status}
            trial |= dict(zip(("error", "field_error", "total"), self.errors(row), strict=True))
            tried.append(trial | {"solve_seconds": row.seconds})
        return {
            "scene": self.scene.name,
            "tolerance": self.tolerance,
            "budget": self.budget,
            "choice": None if self.choice is None else _named(self.choice),
            "predicted": {
                "error": self.error,
                "field_error": None if self.chosen is None else self.trials.field_error(self.chosen),
                "uncertainty": self.bar,
                **(self.model.as_dict() if self.model else {"model": None}),
                "solve_seconds": None if self.chosen is None else self.chosen.seconds,
            },
            "met": self.succeeded,
            "needs": list(self.needs),
            "left_out": list(self.left_out),
            "scales": self.trials.scales.as_dict(),
            "probing_seconds": self.trials.seconds,
            "tried": tried,
            "message": self.message,
            **({"reasons": self.reasons} if self.reasons else {}),
            "warnings": self.warnings,
            "command": self.command,
        }

    def tables(self) -> tuple[Table, ...]:
        """Return a table of the trial solves, the quickest first; statuses if not all converged."""
        rows = []
        for row in sorted(self.trials.rows.values(), key=lambda row: row.seconds):
            spec, errors = row.request.spec, self.errors(row)
            rows.append(
                TrialRow(spec.series, spec.size, row.seconds, *errors, row is self.chosen, row.status)
            )
        caption = (
            "Trial solves; error: from the finest mesh; in all: plus that mesh's bar and the model error"
        )
        details = ("status",) if all(row.status == "converged" for row in rows) else ()
        text = ""
        if self.tolerance is not None and isfinite(self.bar):
            model = self.model.value if self.model else None
            text = share_of_tolerance(self.tolerance, model, self.bar, "shell")
        return (Table.of(TrialRow, rows, caption, "tried", details=details, text=text),)

    def notes(self) -> list[str]:
        scales, command = self.trials.scales, self.command
        return [
            f"{self.reason} ({few(self.trials.seconds)} s of trial solves)",
            *([] if command is None else [f"Solve it with:\n{command}"]),
            *([] if self.chosen is None else self._unseen(self.chosen)),
            f"the scene needs {', '.join(self.needs)}",
            *self.warnings,
            *self.reasons,
            *(f"left out: {left}" for left in self.left_out),
            f"load number q L³/D = {number(scales.span_load_number, '.3g')}, "
            f"L = {quantity(scales.span, 'm', '.4g')} from the held edges; "
            f"slenderness h/a = {number(scales.slenderness, '.3g')}; "
            f"membrane strain q a/(E h) = {number(scales.strain, '.2g')}; a: shorter side",
        ]

    def _unseen(self, chosen: LocalSolve) -> list[str]:
        return unseen([(chosen.request.spec.label, *self.errors(chosen)[:2])], self.bar)

    def result(self) -> str:
        return self.reason if self.choice is None else f"{self.choice.label}: {self.reason}"

    def complaints(self) -> list[str]:
        return [] if self.succeeded else [self.reason]

    @property
    def command(self) -> str | None:
        """The command line for a solve of the choice, None without one."""
        spec = self.choice
        if spec is None:
            return None
        options = ["--model", str(spec)]
        if isinstance(spec, Lattice) and not spec.linear:
            options = ["--lumped", counted(spec.grid).replace("×", "x")]
            options += [] if spec.calibration == CALIBRATION else ["--calibration", str(spec.calibration)]
            for name in ("k", "layer_distance"):
                if name in spec.settings:
                    options += [f"--{name.replace('_', '-')}", f"{spec.settings[name]:g}"]
            options += ["--grading", f"{parse_grading(spec.grading):g}"] if spec.grading else []
        elif isinstance(spec, Elements):
            options = ["--reference", spec.kind, "--elements", spec.size.replace("×", "x")]
        return join(["sheetbench", "compare", self.called or self.scene.name, *options])


def _named(spec: Spec) -> dict[str, Any]:
    return {"model": spec.model, "settings": spec.settings}


def _time(seconds: float) -> str:
    return f"{few(1e3 * seconds)} ms" if seconds < 1.0 else f"{few(seconds)} s"

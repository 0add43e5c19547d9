"""What to solve, and why: the answer of `sheetbench tradeoff --tolerance`."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isfinite
from shlex import join
from typing import Any

from comparisons.models.grading import parse_grading
from comparisons.models.scales import Scales
from comparisons.models.spec import Elements, Lattice, Spec, counted
from comparisons.sweep.model_error import ModelError, share_of_tolerance
from sheetbench.answers.answer import Answer
from sheetbench.answers.table import MILLISECONDS, PERCENT, Column, Table, number, quantity
from sheetbench.choices import CALIBRATION
from sheetbench.scenes import Scene
from sheetbench.scenes.language.summary import few

TRIED = (
    *(Column("model", prose=True), "size", MILLISECONDS(".2f", "solve"), PERCENT(".3g", "error")),
    *(PERCENT(".3g", "in all"), Column("choice", words=("yes", ""))),
)


@dataclass(frozen=True)
class TrialRow:
    """A quick solve: its error is the distance from the finest one, None where it has no answer; total: with
    the finest one's bar and model error, what a tolerance is held against."""

    spec: Spec
    status: str
    error: float | None
    total: float | None
    solve_seconds: float
    choice: bool = False

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        own = {name: getattr(self, name) for name in ("status", "error", "total", "solve_seconds")}
        return {"model": self.spec.model, "settings": self.spec.settings, **own}


@dataclass(frozen=True, repr=False)
class Advice(Answer):
    """What to solve, and why. error, seconds: predicted for the choice; bar: of the reference, by its mesh;
    model: what the reference leaves out on every mesh.

    choice is None, with `message` saying why, where no model converges or none in `budget` is known. reasons:
    why the lattices have their springs and grading, where that was chosen. warnings: of times
    that are doubtful, taken on a busy machine. called: how the scene was requested, its name unless given.
    """

    file_name = "advice"
    scene: Scene
    tolerance: float | None
    budget: float | None
    choice: Spec | None
    error: float | None
    bar: float
    seconds: float | None
    needs: tuple[str, ...]
    left_out: tuple[str, ...]
    scales: Scales
    probing_seconds: float
    tried: tuple[TrialRow, ...] = field(repr=False)
    message: str = ""
    reasons: tuple[str, ...] = ()
    model: ModelError | None = None
    warnings: tuple[str, ...] = ()
    called: str = ""

    @property
    def reason(self) -> str:
        """The advice in a sentence."""
        if self.error is None or self.seconds is None:
            return self.message
        size = f"{few(100 * self.error, 3)} % ± {few(100 * self.bar)} %"
        text = f"predicted error {size} in {_time(self.seconds)}"
        text += f", {self.model}" if self.model else ""
        return f"{text}; {self.message}" if self.message else text

    @property
    def succeeded(self) -> bool:
        """Whether a model meets the tolerance, within the budget if there is one."""
        if self.choice is None or self.error is None or self.seconds is None:
            return False
        model = self.model.value if self.model else 0.0
        accurate = self.tolerance is None or self.error + self.bar + model <= self.tolerance
        return accurate and (self.budget is None or self.seconds <= self.budget)

    def document(self) -> dict[str, Any]:
        choice = None
        if self.choice is not None:
            choice = {"model": self.choice.model, "settings": self.choice.settings}
        return {
            "scene": self.scene.name,
            "tolerance": self.tolerance,
            "budget": self.budget,
            "choice": choice,
            "predicted": {
                "error": self.error,
                "uncertainty": self.bar,
                **(self.model.as_dict() if self.model else {"model": None}),
                "solve_seconds": self.seconds,
            },
            "met": self.succeeded,
            "needs": list(self.needs),
            "left_out": list(self.left_out),
            "scales": self.scales.as_dict(),
            "probing_seconds": self.probing_seconds,
            "tried": [one.as_dict() for one in self.tried],
            "message": self.message,
            **({"reasons": self.reasons} if self.reasons else {}),
            "warnings": list(self.warnings),
            "command": self.command,
        }

    def tables(self) -> tuple[Table, ...]:
        """Return a row per probing solve, the quickest first; the choice is marked. Statuses that are all
        "converged" are for the files alone."""
        rows = [
            (one.spec.series, one.spec.size, one.solve_seconds, one.error, one.total, one.choice, one.status)
            for one in sorted(self.tried, key=lambda one: one.solve_seconds)
        ]
        caption = "Quick solves; error: from the finest; in all: plus the finest's mesh and model errors"
        status = Column("status", prose=True, detail=all(row[-1] == "converged" for row in rows))
        text = ""
        if self.tolerance is not None and isfinite(self.bar):
            model = self.model.value if self.model else None
            text = share_of_tolerance(self.tolerance, model, self.bar, "shell")
        return (Table.listed(caption, (*TRIED, status), rows, "tried", text=text),)

    def notes(self) -> list[str]:
        scales, command = self.scales, self.command
        return [
            f"{self.reason} ({few(self.probing_seconds)} s of trial solves)",
            *([] if command is None else [f"Solve it with:\n{command}"]),
            f"the scene needs {', '.join(self.needs)}",
            *self.warnings,
            *self.reasons,
            *(f"left out: {left}" for left in self.left_out),
            f"load number q L³/D = {number(scales.span_load_number, '.3g')}, "
            f"L = {quantity(scales.span, 'm', '.4g')} from the held edges; "
            f"slenderness h/a = {number(scales.slenderness, '.3g')}; "
            f"membrane strain q a/(E h) = {number(scales.strain, '.2g')}; a: shorter side",
        ]

    def result(self) -> str:
        return self.reason if self.choice is None else f"{self.choice.label}: {self.reason}"

    def complaints(self) -> list[str]:
        return [] if self.succeeded else [self.reason]

    @property
    def command(self) -> str | None:
        """The command line that solves the choice; None without one."""
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


def _time(seconds: float) -> str:
    return f"{few(1e3 * seconds)} ms" if seconds < 1.0 else f"{few(seconds)} s"

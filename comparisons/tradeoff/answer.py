"""Models of a scene with errors and costs, at rest and in motion: the answers of `sheetbench tradeoff`."""

from dataclasses import dataclass, field, replace
from math import inf
from typing import Annotated, Any

from comparisons.sweep import load
from comparisons.sweep.differences import unseen
from comparisons.sweep.front import cheapest, error_order, front, grouped, order
from comparisons.tradeoff.row import MOVED, TRADED
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture
from sheetbench.answers.solution import Status, comparable
from sheetbench.answers.table import NUMBER, Column, Table, percent
from sheetbench.scenes import Scene
from sheetbench.scenes.language.summary import few


@dataclass(frozen=True, repr=False)
class TradeoffAnswer(Answer):
    """Base class of trade-offs: rows with an error and a cost each, and the reference of the errors.
    uncertainty: of the reference, a fraction, None if unknown; reasons: sentences on automatic choices."""

    PER = ""  # unit of work that a cost refers to, in words
    COST, SIZE = ("solve time [ms], one thread", 1e3), "size of a cell or element [mm]"  # axes of the figure
    SIZED_ERROR = ""  # label of the right panel's error, if it differs from the left panel's
    scene: Scene
    rows: tuple[Any, ...]
    reference: Any
    uncertainty: float | None
    reasons: tuple[str, ...] = ()

    @property
    def front(self) -> list[int]:
        """Indices of the rows on the Pareto front of error and cost, the quickest first."""
        costs = [inf if row.cost is None else row.cost for row in self.rows]
        return front([row.error for row in self.rows], costs, self.uncertainty or 0.0)

    @property
    def warnings(self) -> list[str]:
        """Warnings about unreliable times."""
        return load.warnings([row.conditions for row in self.rows], [row.samples for row in self.rows])

    @property
    def uncertainty_text(self) -> str:
        """The reference's uncertainty in words."""
        return "unknown" if self.uncertainty is None else f"{few(100 * self.uncertainty)} %"

    def figures(self) -> tuple[Picture, ...]:
        drawn = Picture(self.file_name, "comparisons.tradeoff.figure:compose", (self,))
        return (drawn,) if any(row.error for row in self.rows) else ()

    def result(self) -> str:
        """Return the quickest rows within the tolerances, or the reason why there is none."""
        return " ".join(self.cheapest()) or super().result()

    def cheapest(self) -> list[str]:
        """Return a sentence for every tolerance that a row meets."""
        return cheapest(
            [row.name for row in self.rows],
            [row.error for row in self.rows],
            [row.cost for row in self.rows],
            self.PER,
            inf if self.uncertainty is None else self.uncertainty,
            self.reference.model_error,
        )


@dataclass(frozen=True)
class OrderRow:
    """Observed orders of a series of models: of its error in the cell size, of its time in the unknowns."""

    series: Annotated[str, Column("model", prose=True)]
    rows: Annotated[int, NUMBER("d")]
    error_order: Annotated[float | None, NUMBER("z.2f")]
    time_order: Annotated[float | None, NUMBER("z.2f")]


@dataclass(frozen=True, repr=False)
class Tradeoff(TradeoffAnswer):
    """The `TradeoffRow`s of a scene; uncertainty: needs a reference that converged on two meshes."""

    file_name = "tradeoff"

    @property
    def orders(self) -> list[OrderRow]:
        """Observed orders of every series, from its rows with an error."""
        out = []
        for name, numbers in grouped([row.request.spec.series for row in self.rows]).items():
            rows = [self.rows[i] for i in numbers if self.rows[i].error is not None]
            errors, unknowns = [row.error for row in rows], [row.known.get("unknowns") or 0 for row in rows]
            in_size = error_order([row.cell_size for row in rows], errors, self.uncertainty)
            in_unknowns = order(unknowns, [row.seconds or 0.0 for row in rows])
            out.append(OrderRow(name, len(rows), in_size, in_unknowns))
        return out

    @property
    def curves(self) -> dict[str, tuple[list[int], float | None]]:
        """Row numbers and observed order of the errors, by series."""
        numbers = grouped([row.request.spec.series for row in self.rows])
        return {row.series: (numbers[row.series], row.error_order) for row in self.orders}

    def document(self) -> dict[str, Any]:
        return {
            "warnings": self.warnings,
            "scene": self.scene.document(),
            "rows": [row.as_dict() for row in self.rows],
            "front": self.front,
            "orders": [vars(row) for row in self.orders],
            "reference": {
                **self.reference.as_dict(),
                "uncertainty": self.uncertainty,
                "model_error": self.reference.model_error,
            },
        }

    def tables(self) -> tuple[Table, ...]:
        front, costs = self.front, "Cost and error; solve: median of the repeats"
        orders = "Observed orders: of errors in the cell size, of time in the unknowns"
        rows = ((i, *row.cells(), i in front, row.status) for i, row in enumerate(self.rows))
        return (
            Table.listed(costs, TRADED, rows, "tradeoff"),
            Table.of(OrderRow, self.orders, orders, "orders"),
        )

    def notes(self) -> list[str]:
        truth, model_error = self.reference, self.reference.model_error
        model_text = "" if model_error is None else f", its model error {percent(model_error)}"
        explanation = (
            f"errors against {truth.label} ({truth.known.get('unknowns')} unknowns), whose own "
            f"uncertainty is {self.uncertainty_text} (grid convergence index of n, ¾ n and ½ n elements)"
            f"{model_text}. error: at the probes; field error: over the sheet. One thread; times on warm "
            "code; memory: growth of the process."
        )
        larger = unseen(((row.name, row.error, row.field_error) for row in self.rows), self.uncertainty)
        return [*self.reasons, *self.cheapest(), *larger, explanation, *self.warnings]

    def complaints(self) -> list[str]:
        failed = [row for row in self.rows if row.status != Status.CONVERGED]
        unmeasured = (
            f"the reference, {self.reference.label}, has no known uncertainty: {self.reference.status}, and "
            "fewer than two of its meshes differ and have an answer"
        )
        return [*(f"{r.label}: {r.status}: {r.message}" for r in failed)] + [unmeasured] * (
            not self.succeeded
        )

    def choices(self) -> dict[str, Any]:
        return {"reference": self.reference.request.spec.settings}

    @property
    def succeeded(self) -> bool:
        return self.uncertainty is not None


@dataclass(frozen=True, repr=False)
class DynamicTradeoff(TradeoffAnswer):
    """A `MotionRow` per model, size, integrator and step. lowest_period [s]: the lattice's about the flat
    sheet or its equilibrium, the shorter; uncertainty: of the reference due to its mesh and its steps;
    lattices: titles of the lattices; step_uncertainty: of the reference runs of step errors."""

    file_name, PER = "motion", " per simulated second"
    COST, SIZE = ("solve time of a simulated second [s]", 1.0), "step [ms]"
    SIZED_ERROR = "error of the steps alone [%]"
    duration: float = field(kw_only=True)
    lowest_period: float = field(kw_only=True)
    lattices: tuple[str, ...] = ()
    step_uncertainty: float = 0.0

    @property
    def series(self) -> dict[str, list[int]]:
        """Row numbers by lattice and integrator, or by model."""
        return grouped([row.run if row.step_error is not None else row.model for row in self.rows])

    @property
    def orders(self) -> dict[str, float | None]:
        """Observed order of the step error in the step, by series."""
        out = {}
        for name, numbers in self.series.items():
            rows = [self.rows[i] for i in numbers if self.rows[i].step_error is not None]
            if rows:
                errors = [row.step_error for row in rows]
                out[name] = error_order([row.step for row in rows], errors, self.step_uncertainty)
        return out

    @property
    def curves(self) -> dict[str, tuple[list[int], float | None]]:
        """Row numbers and observed order in the step, by series."""
        return {name: (numbers, self.orders.get(name)) for name, numbers in self.series.items()}

    def document(self) -> dict[str, Any]:
        return {
            "scene": self.scene.document(),
            "duration": self.duration,
            "lowest_period": self.lowest_period,
            "lattices": self.lattices,
            "warnings": self.warnings,
            "rows": [row.as_dict() for row in self.rows],
            "front": self.front,
            "orders": [{"series": name, "step_error_order": slope} for name, slope in self.orders.items()],
            "reference": {**self.reference.as_dict(), "uncertainty": self.uncertainty},
            "step_uncertainty": self.step_uncertainty,
        }

    def tables(self) -> tuple[Table, ...]:
        caption = (
            f"Motion over {self.duration:g} s. cost: time per simulated second; step error: the part by "
            "the lattice's steps; period: its error; damping: damping ratio"
        )
        front = self.front
        rows = ({**row.as_dict(), "front": i in front} for i, row in enumerate(self.rows))
        columns = (
            replace(column, name=column.name or key.replace("_", " ")) for key, column in MOVED.items()
        )
        return (Table.listed(caption, columns, ([row[key] for key in MOVED] for row in rows), "motion"),)

    def notes(self) -> list[str]:
        lattices = " · ".join(self.lattices)
        reference = f"{self.reference.model} with {self.reference.request.spec.size} elements"
        return [
            f"errors: at the probes, against the {reference}; its uncertainty: {self.uncertainty_text}",
            *([f"{lattices}; lowest period {self.lowest_period:.4g} s"] if lattices else []),
            *self.reasons,
            *self.cheapest(),
            *self.warnings,
        ]

    def complaints(self) -> list[str]:
        failed = [row for row in (*self.rows, self.reference) if row.status != Status.CONVERGED]
        return [f"{row.name}: {row.status}: {row.message}" for row in failed]

    def choices(self) -> dict[str, Any]:
        return {"duration": self.duration}

    @property
    def succeeded(self) -> bool:
        """Whether the reference has an answer for comparisons."""
        return comparable(self.reference.status, 1.0)

"""Models of one scene with their errors and costs, at rest and in motion: the answers of `sheetbench
tradeoff`."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import inf
from typing import Any

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
class Priced(Answer):
    """What both trades are: rows with an error and a cost each, and the reference they are measured against.

    uncertainty: of the reference, a fraction, None where it is not known; reasons: sentences on what was
    chosen.
    """

    PER = ""  # what a cost is for, in words
    COST, SIZE = ("solve time [ms], one thread", 1e3), "size of a cell or element [mm]"  # of the picture
    SIZED_ERROR = ""  # of the picture's right side, where it is not the error at the left
    scene: Scene
    rows: tuple[Any, ...]
    reference: Any
    uncertainty: float | None
    reasons: tuple[str, ...] = ()

    @property
    def front(self) -> list[int]:
        """Numbers of the rows on the Pareto front of error and cost, the quickest first."""
        costs = [inf if row.cost is None else row.cost for row in self.rows]
        return front([row.error for row in self.rows], costs, self.uncertainty or 0.0)

    @property
    def warnings(self) -> list[str]:
        """What to hold against the times."""
        return load.warnings([row.conditions for row in self.rows], [row.samples for row in self.rows])

    @property
    def known(self) -> str:
        """The reference's uncertainty in words."""
        return "unknown" if self.uncertainty is None else f"{few(100 * self.uncertainty)} %"

    def figures(self) -> tuple[Picture, ...]:
        drawn = Picture(self.file_name, "comparisons.tradeoff.figure:compose", (self,))
        return (drawn,) if any(row.error for row in self.rows) else ()

    def result(self) -> str:
        """The quickest rows within the tolerances, or why there is none."""
        return " ".join(self.cheapest()) or super().result()

    def cheapest(self) -> list[str]:
        """A sentence for every tolerance that a row meets."""
        return cheapest(
            [row.name for row in self.rows],
            [row.error for row in self.rows],
            [row.cost for row in self.rows],
            self.PER,
            inf if self.uncertainty is None else self.uncertainty,
            self.reference.model_error,
        )


ORDERS = (
    *(Column("model", prose=True), NUMBER("d", "rows"), NUMBER("z.2f", "error order")),
    NUMBER("z.2f", "time order"),
)


@dataclass(frozen=True, repr=False)
class Tradeoff(Priced):
    """The `TradeoffRow`s of a scene; uncertainty: None where the reference did not converge on two meshes."""

    file_name = "tradeoff"

    @property
    def orders(self) -> list[dict[str, Any]]:
        """Of every family: the rows that have errors, the orders of both errors in h, of the time in the
        unknowns."""
        found = []
        for name, numbers in grouped([row.ask.spec.series for row in self.rows]).items():
            rows = [self.rows[i] for i in numbers if self.rows[i].error is not None]
            sizes = [row.cell_size for row in rows]
            unknowns = [row.known.get("unknowns") or 0 for row in rows]
            orders = {
                "error_order": error_order(sizes, [row.error for row in rows], self.uncertainty),
                "time_order": order(unknowns, [row.seconds or 0.0 for row in rows]),
            }
            found.append({"series": name, "rows": len(rows), **orders})
        return found

    @property
    def curves(self) -> dict[str, tuple[list[int], float | None]]:
        """Row numbers and observed order of the errors, by family."""
        numbers = grouped([row.ask.spec.series for row in self.rows])
        return {one["series"]: (numbers[one["series"]], one["error_order"]) for one in self.orders}

    def document(self) -> dict[str, Any]:
        return {
            "warnings": self.warnings,
            "scene": self.scene.document(),
            "rows": [row.as_dict() for row in self.rows],
            "front": self.front,
            "orders": self.orders,
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
        families = (one.values() for one in self.orders)
        return (
            Table.listed(costs, TRADED, rows, "tradeoff"),
            Table.listed(orders, ORDERS, families, "orders"),
        )

    def notes(self) -> list[str]:
        truth, left = self.reference, self.reference.model_error
        left_out = "" if left is None else f", its model error {percent(left)}"
        explained = (
            f"errors against {truth.label} ({truth.known.get('unknowns')} unknowns), whose own "
            f"uncertainty is {self.known} (grid convergence index of n, ¾ n and ½ n elements){left_out}. "
            "error: at the probes; field error: over the sheet. One thread; times on warm code; memory: "
            "growth of the process."
        )
        seen = unseen(((row.name, row.error, row.field_error) for row in self.rows), self.uncertainty)
        return [*self.reasons, *self.cheapest(), *seen, explained, *self.warnings]

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
        return {"reference": self.reference.ask.spec.settings}

    @property
    def succeeded(self) -> bool:
        return self.uncertainty is not None


@dataclass(frozen=True, repr=False)
class DynamicTradeoff(Priced):
    """A `MotionRow` per model, size, integrator and step.

    lowest_period [s]: the lattice's about the flat sheet or its equilibrium, the shorter; uncertainty: of the
    reference by its mesh and its steps; lattices: what their runs are of; step_uncertainty: of the runs that
    errors of steps are measured against.
    """

    file_name, PER = "motion", " per simulated second"
    COST, SIZE = ("solve time of a simulated second [s]", 1.0), "step [ms]"
    SIZED_ERROR = "error of the steps alone [%]"
    duration: float = field(kw_only=True)
    lowest_period: float = field(kw_only=True)
    lattices: tuple[str, ...] = ()
    step_uncertainty: float = 0.0

    @property
    def series(self) -> dict[str, list[int]]:
        """Row numbers by lattice and integrator, and by other model."""
        return grouped([row.run if row.step_error is not None else row.model for row in self.rows])

    @property
    def orders(self) -> dict[str, float | None]:
        """Observed order in the step of what the steps of a lattice miss, by series."""
        found = {}
        for name, numbers in self.series.items():
            rows = [self.rows[i] for i in numbers if self.rows[i].step_error is not None]
            if rows:
                errors = [row.step_error for row in rows]
                found[name] = error_order([row.step for row in rows], errors, self.step_uncertainty)
        return found

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
        columns = (replace(one, name=one.name or key.replace("_", " ")) for key, one in MOVED.items())
        return (Table.listed(caption, columns, ([row[key] for key in MOVED] for row in rows), "motion"),)

    def notes(self) -> list[str]:
        lattices = " · ".join(self.lattices)
        of = f"{self.reference.model} with {self.reference.ask.spec.size} elements"
        return [
            f"errors: at the probes, against the {of}; uncertainty of that reference: {self.known}",
            *([f"{lattices}; lowest period {self.lowest_period:.4g} s"] if lattices else []),
            *self.reasons,
            *self.cheapest(),
            *self.warnings,
        ]

    def complaints(self) -> list[str]:
        ended = [row for row in (*self.rows, self.reference) if row.status != Status.CONVERGED]
        return [f"{row.name}: {row.status}: {row.message}" for row in ended]

    def choices(self) -> dict[str, Any]:
        return {"duration": self.duration}

    @property
    def succeeded(self) -> bool:
        """Whether there is a reference to measure against."""
        return comparable(self.reference.status, 1.0)

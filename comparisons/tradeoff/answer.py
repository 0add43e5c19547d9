"""Models of one scene with their errors and costs: the answer of `sheetbench tradeoff`."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import inf
from typing import Annotated, Any

from comparisons.runs import load
from comparisons.sweep.front import cheapest, error_order, front, grouped, order
from comparisons.sweep.model_error import share_of_tolerance
from comparisons.tradeoff.row import TradeoffRow
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture
from sheetbench.answers.table import MILLISECONDS, NUMBER, PERCENT, Column, Table, Unit
from sheetbench.scenes import Scene, Status
from sheetbench.scenes.summary import few

STATED = 0.01  # the tolerance whose parts are said


@dataclass(frozen=True)
class CostRow:
    """What a row of a trade-off shows: times of the solve are the median, the quickest and the slowest."""

    row: Annotated[int, NUMBER("d")]
    model: Annotated[str, Column(prose=True)]
    size: str
    unknowns: Annotated[int | None, NUMBER("d")]
    iterations: Annotated[int | None, NUMBER("d", "factorisations", detail=True)]
    setup: Annotated[float | None, MILLISECONDS(".1f", "set-up", detail=True)]
    solve: Annotated[float | None, MILLISECONDS(".2f")]
    quickest: Annotated[float | None, MILLISECONDS(".2f", "from", detail=True)]
    slowest: Annotated[float | None, MILLISECONDS(".2f", "to", detail=True)]
    memory: Annotated[float | None, Unit("B", "MB", 1e-6)(".1f")]
    error: Annotated[float | None, PERCENT(".3g")]
    own_bar: Annotated[float | None, PERCENT(".2g", detail=True)]
    field_error: Annotated[float | None, PERCENT(".3g")]
    front: Annotated[bool, Column(words=("yes", ""))]
    status: Annotated[str, Column(detail=True)]


@dataclass(frozen=True)
class Orders:
    """Of a family: the rows that have errors, the orders of both errors in h, of the time in the unknowns."""

    series: Annotated[str, Column("model", prose=True)]
    rows: Annotated[int, NUMBER("d")]
    error_order: Annotated[float | None, NUMBER("z.2f")]
    field_error_order: Annotated[float | None, NUMBER("z.2f")]
    time_order: Annotated[float | None, NUMBER("z.2f")]


@dataclass(frozen=True, repr=False)
class Tradeoff(Answer):
    """The rows of a scene with their errors, and the reference they are measured against.

    uncertainty, field_uncertainty: of the reference, fractions, None where it did not converge on both
    meshes.
    """

    file_name = "tradeoff"
    scene: Scene
    rows: tuple[TradeoffRow, ...]
    reference: TradeoffRow
    uncertainty: float | None
    field_uncertainty: float | None
    reasons: tuple[str, ...] = ()

    @property
    def front(self) -> list[int]:
        """Numbers of the rows on the Pareto front of error and time, the quickest first."""
        seconds = [inf if row.seconds is None else row.seconds for row in self.rows]
        return front([row.error for row in self.rows], seconds, self.uncertainty or 0.0)

    @property
    def orders(self) -> list[Orders]:
        """The orders of every family."""
        families = grouped([row.series for row in self.rows])
        return [self._orders(name, [self.rows[i] for i in numbers]) for name, numbers in families.items()]

    def _orders(self, name: str, family: list[TradeoffRow]) -> Orders:
        rows = [row for row in family if row.error is not None]
        sizes = [row.cell_size for row in rows]
        return Orders(
            series=name,
            rows=len(rows),
            error_order=error_order(sizes, [row.error for row in rows], self.uncertainty),
            field_error_order=error_order(sizes, [row.field_error for row in rows], self.field_uncertainty),
            time_order=order([row.unknowns or 0 for row in rows], [row.seconds or 0.0 for row in rows]),
        )

    @property
    def warnings(self) -> list[str]:
        """What to hold against the times."""
        return load.warnings(
            [row.load_average for row in self.rows], [row.solve_seconds for row in self.rows]
        )

    def document(self) -> dict[str, Any]:
        """The JSON document of `sheetbench tradeoff`."""
        return {
            "warnings": self.warnings,
            "scene": self.scene.document(),
            "rows": [row.as_dict() for row in self.rows],
            "front": self.front,
            "orders": [asdict(orders) for orders in self.orders],
            "reference": {
                **self.reference.as_dict(),
                "uncertainty": self.uncertainty,
                "model_error": self.reference.model_error,
                "field_uncertainty": self.field_uncertainty,
            },
        }

    def tables(self) -> tuple[Table, ...]:
        front = self.front
        rows = (
            CostRow(
                i, r.series, r.size, r.unknowns, r.iterations, r.setup_seconds, r.seconds,
                min(r.solve_seconds, default=None), max(r.solve_seconds, default=None), r.peak_memory_bytes,
                r.error, r.bar, r.field_error, i in front, r.status,
            )
            for i, r in enumerate(self.rows)
        )  # fmt: skip
        costs = "Cost and error; solve: median of the repeats"
        orders = "Observed orders: of errors in the cell size, of time in the unknowns"
        return Table.of(CostRow, rows, costs, "tradeoff"), Table.of(Orders, self.orders, orders, "orders")

    def figures(self) -> tuple[Picture, ...]:
        drawn = Picture("tradeoff", "comparisons.tradeoff.figure:compose", (self,))
        return (drawn,) if any(row.error for row in self.rows) else ()

    def notes(self) -> list[str]:
        """What the errors are measured against."""
        known = "unknown" if self.uncertainty is None else f"{few(100 * self.uncertainty)} %"
        explained = (
            f"errors against {self.reference.label} ({self.reference.unknowns} unknowns), whose own "
            f"uncertainty is {known}: the grid convergence index of n, ¾ n and ½ n elements. error: at the "
            "probes; field error: root mean square over the sheet. One thread; times on warm code; memory: "
            "growth of the process."
        )
        taken = share_of_tolerance(STATED, self.reference.model_error, self.uncertainty, self.reference.model)
        return [*self.reasons, *self._cheapest(), *filter(None, [taken]), explained, *self.warnings]

    def result(self) -> str:
        """The quickest rows within the tolerances, or why there is none."""
        return " ".join(self._cheapest()) or super().result()

    def _cheapest(self) -> list[str]:
        return cheapest(
            [r.label for r in self.rows],
            [r.error for r in self.rows],
            [r.seconds for r in self.rows],
            bar=inf if self.uncertainty is None else self.uncertainty,
            model_error=self.reference.model_error,
        )

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
        return {"reference": self.reference.settings}

    @property
    def succeeded(self) -> bool:
        return self.uncertainty is not None

"""Answer of the transfer study: its rows by part, and their tables, methods across and scenes down."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np

from sheetbench.answers.answer import Answer
from sheetbench.answers.table import NUMBER, PERCENT, Column, Table
from studies.transfer.drawn import Drawn

_ERROR, _MODE = PERCENT("z.2f"), NUMBER("d", "mode")
_LIMITS = {
    "finest": "error at {}",
    "predicted_finest": "predicted there",
    "lattice_less_plate": "apart",
    "extrapolated": "extrapolated",
    "predicted_limit": "predicted for cells → 0",
}


@dataclass(frozen=True)
class Line:
    """Line of a table: words and numbers by their columns' names, and errors by theirs."""

    words: Mapping[str | Column, Any]
    errors: Annotated[Mapping[str, float | None], _ERROR]
    worst: Mapping[str, str | None] = field(default_factory=dict)


@dataclass(frozen=True)
class Ratio:
    """Grid whose cells are longer than wide."""

    scene: str
    masses: str
    aspect: Annotated[float, NUMBER(".2f")]
    error: Annotated[float | None, _ERROR]


@dataclass(frozen=True)
class GradedScene:
    """Grading of a scene's lattices, and its reason."""

    scene: str
    grading: str
    why: Annotated[str, Column(prose=True)]


@dataclass(frozen=True, repr=False)
class Transfer(Answer):
    """Rows of the study by part; `failed`: a sentence for every run without an answer."""

    file_name = "transfer"

    methods: tuple[str, ...]
    grids: tuple[int, ...]
    elements: int
    static: list[dict[str, Any]] = field(default_factory=list)
    limits: list[dict[str, Any]] = field(default_factory=list)
    modal: list[dict[str, Any]] = field(default_factory=list)
    aspect: list[dict[str, Any]] = field(default_factory=list)
    left_out: list[dict[str, Any]] = field(default_factory=list)
    drawn: list[dict[str, Any]] = field(default_factory=list)
    failed: list[str] = field(default_factory=list)

    def heading(self) -> tuple[str, str, str]:
        return "transfer", "calibrations tested on scenes that they were not made on", ""

    def document(self) -> dict[str, Any]:
        return dict(vars(self))  # errors and misses are fractions

    def tables(self) -> list[Table]:
        tables = []
        if self.static:
            tables += [self._over_scenes(), *map(self._static, range(len(self.grids)))]
            tables += [self._static(None)] if len(self.grids) > 1 else []
            tables += [self._gradings()] if "gradings" in self.static[0] else []
        tables += [self._limits()] if self.limits else []
        tables += map(self._modal, range(len(self.grids))) if self.modal else []
        tables += [self._aspect()] if self.aspect else []
        tables += [self._left_out()] if self.left_out else []
        tables += [self._drawn()] if self.drawn else []
        return tables

    def _over_scenes(self) -> Table:
        """Return a row per method: median and worst error, and the worst scene on the finest grid."""
        lines = []
        for method in self.methods:
            of_method = [row for row in self.static if row["method"] == method]
            errors: dict[str, float | None] = {}
            for i, n in enumerate(self.grids):
                numbers = [row["errors"][i] for row in of_method if row["errors"][i] is not None]
                errors[f"median at {n}"] = float(np.median(numbers)) if numbers else None
                errors[f"worst at {n}"] = max(numbers, default=None)
            limits = [row["extrapolated"] for row in of_method if row["extrapolated"] is not None]
            errors["worst limit"] = max(limits, default=None)
            answered = [row for row in of_method if row["errors"][-1] is not None]
            worst = max(answered, key=lambda row: row["errors"][-1], default={"scene": None})["scene"]
            lines.append(Line({"method": method}, errors, {f"worst at {self.grids[-1]} is": worst}))
        scenes = len({row["scene"] for row in self.static})
        return Table.of(Line, lines, f"Errors over {scenes} scenes, by masses a side", "methods")

    def _by_method(self, entries: Iterable[tuple[Mapping[str | Column, Any], str, Any]]) -> list[Line]:
        """Return a line per combination of words, the methods across."""
        lines: dict[tuple[Any, ...], Line] = {}
        for words, method, value in entries:
            line = lines.setdefault(tuple(words.values()), Line(words, dict.fromkeys(self.methods)))
            line.errors[method] = value  # type: ignore[index]
        return list(lines.values())

    def _static(self, grid: int | None) -> Table:
        """Return errors of a grid by its index, or of the extrapolated limit."""
        caption, name = "Error of the limit extrapolated from the two finest grids", "static-extrapolated"
        if grid is not None:
            n = self.grids[grid]
            caption, name = f"Error at {n} × {n} × 2 masses, of the largest displacement", f"static-{n}"
        lines = self._by_method(
            ({"scene": r["scene"]}, r["method"], r["extrapolated"] if grid is None else r["errors"][grid])
            for r in self.static
        )
        return Table.of(Line, lines, caption, name, grouped=True)

    def _gradings(self) -> Table:
        """Return a row per scene, of a method with a grading where one has it."""
        rows: dict[str, GradedScene] = {}
        for row in self.static:
            if any(row["gradings"]) or row["scene"] not in rows:
                gradings = ", ".join(f"{g:g}" if isinstance(g, float) else g for g in row["gradings"])
                rows[row["scene"]] = GradedScene(row["scene"], gradings, "; ".join(row["reasons"]))
        grids = ", ".join(map(str, self.grids))
        return Table.of(GradedScene, rows.values(), f"Grading at {grids} masses a side", "gradings")

    def _limits(self) -> Table:
        lines = [
            Line(
                {"scene": row["scene"], "method": row["method"]},
                {name.format(self.grids[-1]): row[key] for key, name in _LIMITS.items()},
            )
            for row in self.limits
        ]
        caption = "Where refinement leads, measured and predicted from the moduli report"
        return Table.of(Line, lines, caption, "limits", grouped=True)

    def _modal(self, grid: int) -> Table:
        """Return misses of the first frequencies by scene, distribution of the mass, and frequency."""
        entries: list[tuple[dict[str | Column, Any], str, float]] = [
            ({"scene": row["scene"], "masses": row["masses"], _MODE: i}, row["method"], float(miss))
            for row in self.modal
            if row["misses"][grid] is not None
            for i, miss in enumerate(row["misses"][grid], 1)
        ]
        entries.sort(key=lambda entry: tuple(entry[0].values()))
        n = self.grids[grid]
        caption = f"Natural frequencies less the shell's at {n} × {n} × 2 masses"
        return Table.of(Line, self._by_method(entries), caption, f"modal-{n}", grouped=True)

    def _aspect(self) -> Table:
        rows = (
            Ratio(row["scene"], f"{row['grid'][0]} × {row['grid'][1]} × 2", row["aspect"], row["error"])
            for row in self.aspect
        )
        return Table.of(Ratio, rows, "Cells longer than wide, calibrated by `moduli`", "aspect", grouped=True)

    def _left_out(self) -> Table:
        lines = []
        for row in self.left_out:
            misses = [None] * 3 if row["misses"] is None else map(float, row["misses"])
            errors = {"error": row["error"], **{f"frequency {i}": miss for i, miss in enumerate(misses, 1)}}
            lines.append(Line({"method": row["method"], "left out": row["left_out"]}, errors))
        n = self.grids[0]
        caption = f"Fitted to the other scenes of four, tested on the one left out, {n} × {n} × 2"
        return Table.of(Line, lines, caption, "left-out", grouped=True)

    def _drawn(self) -> Table:
        rows = [Drawn.of(**row) for row in self.drawn]
        return Table.of(Drawn, rows, "Drawn sheets: errors by masses along the shorter side", "drawn")

    def notes(self) -> tuple[str, ...]:
        return (
            "error: the largest component of u − u_shell over 5 × 5 points of the sheet, of the largest "
            f"component of u_shell there; shell of {self.elements} elements a side. fit-static and "
            "fit-modal are trained on the sheet under its own weight with one edge and with two adjacent "
            "edges clamped, again for every thickness and E; all other methods see no scene. extrapolated: "
            "Richardson's limit, error ~ h². predicted: the shell whose stiffness is the lattice's by its "
            "moduli report; apart: the lattice from that shell. Frequencies: f/f_shell − 1.",
        )

    def complaints(self) -> list[str]:
        return self.failed

    def choices(self) -> dict[str, Any]:
        return {"methods": self.methods, "grids": self.grids, "elements": self.elements}

    @property
    def succeeded(self) -> bool:
        return not self.failed

"""The tables of the transfer study: methods across, scenes down."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from sheetbench.answers.table import Column, Table

if TYPE_CHECKING:
    from studies.transfer.study import Transfer

_PER_CENT = ("", "%", 100.0, "z.2f")


def tables(transfer: Transfer) -> list[Table]:
    """Every table of the study that has rows."""
    made = [
        *([_methods(transfer)] if transfer.static else []),
        *(_static(transfer, i) for i in range(len(transfer.grids)) if transfer.static),
        *([_static(transfer, None)] if transfer.static and len(transfer.grids) > 1 else []),
        *([_gradings(transfer)] if any("gradings" in row for row in transfer.static) else []),
        *([_limits(transfer)] if transfer.limits else []),
        *(_modal(transfer, i) for i in range(len(transfer.grids)) if transfer.modal),
        *([_aspect(transfer)] if transfer.aspect else []),
        *([_left_out(transfer)] if transfer.left_out else []),
    ]
    return made


def _methods(transfer: Transfer) -> Table:
    """A row per method: median and worst error over the scenes; where the finest grid errs most."""
    rows = []
    for method in transfer.methods:
        mine = [row for row in transfer.static if row["method"] == method]
        cells: list[Any] = []
        for i in range(len(transfer.grids)):
            errors = [row["errors"][i] for row in mine if row["errors"][i] is not None]
            cells += [float(np.median(errors)), max(errors)] if errors else [None, None]
        limits = [row["extrapolated"] for row in mine if row["extrapolated"] is not None]
        answered = [row for row in mine if row["errors"][-1] is not None]
        worst = max(answered, key=lambda row: row["errors"][-1], default={"scene": None})["scene"]
        rows.append((method, *cells, max(limits, default=None), worst))
    columns = [Column("method")]
    for n in transfer.grids:
        columns += [Column(f"median at {n}", *_PER_CENT), Column(f"worst at {n}", *_PER_CENT)]
    columns += [Column("worst limit", *_PER_CENT), Column(f"worst at {transfer.grids[-1]} is")]
    scenes = len({row["scene"] for row in transfer.static})
    return Table(f"Errors over {scenes} scenes, by masses a side", tuple(columns), tuple(rows), "methods")


def _static(transfer: Transfer, grid: int | None) -> Table:
    """Errors of a grid by its place among the grids, or of the extrapolated limit."""
    caption, name = "Error of the limit extrapolated from the two finest grids", "static-extrapolated"
    if grid is not None:
        n = transfer.grids[grid]
        caption, name = f"Error at {n} × {n} × 2 masses, of the largest displacement", f"static-{n}"
    return Table(
        caption,
        (Column("scene"), *(Column(method, *_PER_CENT) for method in transfer.methods)),
        _by_scene(
            transfer.methods,
            [
                (r["scene"], r["method"], r["extrapolated"] if grid is None else r["errors"][grid])
                for r in transfer.static
            ],
        ),
        name,
        grouped=True,
    )


def _gradings(transfer: Transfer) -> Table:
    """A row per scene: how its lattices are graded, and why."""
    rows = {}
    for row in transfer.static:
        if any(row["gradings"]) or row["scene"] not in rows:
            rows[row["scene"]] = (
                row["scene"],
                ", ".join(f"{g:g}" if isinstance(g, float) else g for g in row["gradings"]),
                "; ".join(row["reasons"]),
            )
    grids = ", ".join(str(n) for n in transfer.grids)
    columns = (Column("scene"), Column("grading"), Column("why", prose=True))
    return Table(f"Grading at {grids} masses a side", columns, tuple(rows.values()), "gradings")


def _by_scene(methods: tuple[str, ...], entries: list[tuple[str, str, Any]]) -> tuple[tuple[Any, ...], ...]:
    values = {(scene, method): value for scene, method, value in entries}
    names = dict.fromkeys(scene for scene, _, _ in entries)
    return tuple((name, *(values.get((name, method)) for method in methods)) for name in names)


def _limits(transfer: Transfer) -> Table:
    n = transfer.grids[-1]
    columns = (
        Column("scene"),
        Column("method"),
        Column(f"error at {n}", *_PER_CENT),
        Column("predicted there", *_PER_CENT),
        Column("apart", *_PER_CENT),
        Column("extrapolated", *_PER_CENT),
        Column("predicted for cells → 0", *_PER_CENT),
    )
    keys = ("finest", "predicted_finest", "lattice_less_plate", "extrapolated", "predicted_limit")
    rows = tuple((r["scene"], r["method"], *(r[key] for key in keys)) for r in transfer.limits)
    caption = "Where refinement leads, measured and predicted from the moduli report"
    return Table(caption, columns, rows, "limits", grouped=True)


def _modal(transfer: Transfer, grid: int) -> Table:
    """Misses of the first frequencies: a row per scene, frequency and way to share out the mass."""
    values: dict[tuple[str, str, int], dict[str, float]] = {}
    for row in transfer.modal:
        misses = row["misses"][grid]
        for i, miss in enumerate([] if misses is None else misses):
            values.setdefault((row["scene"], row["masses"], i + 1), {})[row["method"]] = float(miss)
    columns = (
        Column("scene"),
        Column("masses"),
        Column("mode", form="d"),
        *(Column(method, *_PER_CENT) for method in transfer.methods),
    )
    rows = tuple(
        (*key, *(of.get(method) for method in transfer.methods)) for key, of in sorted(values.items())
    )
    n = transfer.grids[grid]
    caption = f"Natural frequencies less the shell's at {n} × {n} × 2 masses"
    return Table(caption, columns, rows, f"modal-{n}", grouped=True)


def _aspect(transfer: Transfer) -> Table:
    columns = (Column("scene"), Column("masses"), Column("aspect", form=".2f"), Column("error", *_PER_CENT))
    rows = tuple(
        (r["scene"], f"{r['grid'][0]} × {r['grid'][1]} × 2", r["aspect"], r["error"]) for r in transfer.aspect
    )
    return Table("Cells longer than wide, calibrated by `moduli`", columns, rows, "aspect", grouped=True)


def _left_out(transfer: Transfer) -> Table:
    columns = (
        Column("method"),
        Column("left out"),
        Column("error", *_PER_CENT),
        *(Column(f"frequency {i}", *_PER_CENT) for i in (1, 2, 3)),
    )
    rows = tuple(
        (r["method"], r["left_out"], r["error"], *_misses(r["misses"], 3)) for r in transfer.left_out
    )
    n = transfer.grids[0]
    caption = f"Fitted to the other scenes of four, judged on the one left out, {n} × {n} × 2"
    return Table(caption, columns, rows, "left-out", grouped=True)


def _misses(values: np.ndarray | None, count: int) -> list[float | None]:
    return [None] * count if values is None else [float(value) for value in values]


def explanation(transfer: Transfer) -> str:
    """What the numbers mean."""
    return (
        "error: the largest component of u − u_shell over 5 × 5 points of the sheet, of the largest "
        f"component of u_shell there; shell of {transfer.elements} elements a side. fit-static and fit-modal "
        "are trained on the sheet under its own weight with one edge and with two adjacent edges clamped, "
        "again for every thickness and E; all other methods see no scene. extrapolated: Richardson's limit, "
        "error ~ h². predicted: the shell whose stiffness is the lattice's by its moduli report; apart: the "
        "lattice from that shell. Frequencies: f/f_shell − 1."
    )

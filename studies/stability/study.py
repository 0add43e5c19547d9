"""Maps of the verb `stability` on the study's scenes, and three further variations.

mass       neighbouring masses in a ratio r, like a chess board, their sum kept: the explicit limit falls like
           1/√r as it is computed, the conserving midpoint rule at twenty times that limit keeps the energy
stiffness  E and all loads times a factor: only the units change, and the answer must not
family     one family of springs out of proportion: another sheet, but an answer or a status
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, Unpack

import matplotlib
import numpy as np
from matplotlib.figure import Figure

import lumped
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements, Lattice
from comparisons.stability import tiles
from comparisons.stability.answer import Stability, limits, summary
from comparisons.stability.extremes import scaled, stability
from comparisons.stability.rows import Row, fault_sentences, percent
from comparisons.sweep.campaign import CampaignKeywords, Run, carry_out
from comparisons.sweep.differences import error
from comparisons.sweep.store import Store
from sheetbench.answers.answer import Answer
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.report import Picture
from sheetbench.answers.table import NUMBER, PERCENT, Column, Table
from sheetbench.scenes import Scene, load
from studies.stability.limit import energy, measured_limit, noise, start, system
from studies.stability.scenes import TURNS, bent, pressed, published

PARTS = ("published", "pressed", "bent", "mass", "stiffness", "family")
RATIOS, SIDES = (1.0, 1e2, 1e4, 1e6), (5, 9, 17)
FACTORS = (1e-7, 1e-4, 1e-2, 1e2, 1e4, 1e6)
FAMILIES = ("axial", "diagonal", "vertical", "cross", "cross_diagonal")
CONTRASTS = (1e-6, 1e-4, 1e-2, 1e-1, 10.0, 1e2, 1e4, 1e6)
STEPS, PER_LIMIT = 50, 20.0  # of the midpoint rule; its step over the explicit limit
GRID, ELEMENTS = 9, 12


def chess_masses(masses: int, ratio: float) -> Row:
    """Return Verlet's limit, its distance from the measured one, and midpoint's loss of energy; a task."""
    scene = load("one-edge-clamped").replace(gravity=None)
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(masses, masses))

    def chess(shares: np.ndarray) -> np.ndarray:
        j, i, _ = np.unravel_index(np.arange(len(shares)), (masses, masses, 2))
        uneven = shares * np.where((i + j) % 2, np.sqrt(ratio), 1.0 / np.sqrt(ratio))
        changed: np.ndarray = uneven * shares.sum() / uneven.sum()
        return changed

    equations = system(scene, springs, mass=chess)
    limit = lumped.step_limit(equations, np.zeros_like(equations.problem.loads.dead)).step
    state = start(equations, noise(equations))
    method, first = lumped.INTEGRATORS["midpoint"](equations, PER_LIMIT * limit), energy(equations, state)
    for _ in range(STEPS):
        state = method.advance(state, PER_LIMIT * limit).state
    drift = energy(equations, state) / first - 1.0
    off = abs(measured_limit(equations, limit) / limit - 1.0)
    return {"status": "converged", "error": off, "limit": limit, "energy_drift": drift}


def stiffer(factor: float, model: str) -> Row:
    """Return the change of a model's answer by a factor on E and all loads; a task."""
    scene = load("two-edges-clamped")
    other = scaled(scaled(scene, "young", factor), "load", factor)
    spec = Lattice(GRID) if model == "lumped" else Elements(model, ELEMENTS)
    return _compared(other, *(solve(resolve(one, spec)) for one in (other, scene)))


def out_of_proportion(family: str, contrast: float) -> Row:
    """Return the error of a lattice with one family of springs stiffer; a task."""
    scene = load("one-edge-clamped")
    springs = lumped.calibrate(scene.sheet, scene.material, grid=GRID)
    uneven = springs.springs.replace(**{family: contrast * getattr(springs.springs, family)})
    ours = lumped.solve(scene, replace(springs, springs=uneven))
    return _compared(scene, ours, solve(resolve(scene, Elements("shell", ELEMENTS))))


def _compared(scene: Scene, ours: Any, truth: Any) -> Row:
    points, comparable = scene.probe_points(), ours.comparable and truth.comparable
    off = error(ours.displacement(points), truth.displacement(points)) if comparable else None
    return {"status": str(ours.status), "message": ours.message, "error": off}


TASKS: dict[str, tuple[Callable[..., Row], list[dict[str, Any]]]] = {
    "mass": (chess_masses, [{"masses": n, "ratio": r} for n in SIDES for r in RATIOS]),
    "stiffness": (
        stiffer,
        [{"factor": f, "model": m} for m in ("lumped", "plate", "shell") for f in FACTORS],
    ),
    "family": (out_of_proportion, [{"family": f, "contrast": c} for f in FAMILIES for c in CONTRASTS]),
}


def maps(
    store: Store,
    parts: Sequence[str] = PARTS,
    turns: Sequence[float] = TURNS,
    **how: Unpack[CampaignKeywords],
) -> StabilityMaps:
    """Return the maps of the given parts, through a campaign's store."""
    plans: list[tuple[Scene, dict[str, Any]]] = (
        [(scene, {}) for scene in published()] if "published" in parts else []
    )
    further = [pressed()] if "pressed" in parts else []
    further += map(bent, turns) if "bent" in parts else []
    plans += [(scene, {"varied": ["load"], "lattice": Lattice(17)}) for scene in further]
    results = tuple(stability(scene, store, **options, **how) for scene, options in plans)
    cells = [(name, task, cell) for name, (task, grid) in TASKS.items() if name in parts for cell in grid]
    runs = [Run(f"{__name__}:{task.__name__}", cell, f"{name} {cell}") for name, task, cell in cells]
    done = carry_out(runs, store, **how)
    fixed = [{"status": one.status, "message": one.message, "seconds": one.seconds} for one in done]
    rows = [
        {"error": None, **end.row, "study": name, "cell": cell, **common}
        for (name, _, cell), end, common in zip(cells, done, fixed, strict=True)
    ]
    return StabilityMaps(results, tuple(rows))


@dataclass(frozen=True)
class CellRow:
    """Cell of a variation beyond the verb's, and its status."""

    varied: str
    what: str
    at: Annotated[float, NUMBER("g")]
    status: str
    error: Annotated[float | None, PERCENT(".2g")]
    energy_drift: Annotated[float | None, NUMBER(".1e")]


@dataclass(frozen=True, repr=False)
class StabilityMaps(Answer):
    """Maps of scenes, by the verb; rows: of mass, stiffness and families."""

    maps: tuple[Stability, ...]
    rows: tuple[Row, ...]

    file_name = "stability"

    def heading(self) -> tuple[str, str, str]:
        return "Where each model holds", "published scenes, a pressed strip, bent clamps, uneven lattices", ""

    def document(self) -> dict[str, Any]:
        return {"scenes": [one.document() for one in self.maps], "rows": list(self.rows)}

    def tables(self) -> list[Table]:
        tables = []
        for name, table in (("holds", summary), ("steps", limits)):
            pairs = [(scene_map.scene.name, table(scene_map)) for scene_map in self.maps]
            rows = tuple((scene, *row) for scene, table_of_scene in pairs for row in table_of_scene.rows)
            if rows:
                columns = (Column("scene"), *pairs[0][1].columns)
                tables.append(Table(pairs[0][1].caption, columns, rows, name, grouped=True))
        return [
            *tables,
            Table.of(CellRow, self._cells(), "Uneven masses and springs, other units", "cells", grouped=True),
        ]

    def _cells(self) -> Iterator[CellRow]:
        for row in self.rows:
            what, at = sorted(row["cell"].items(), key=lambda key: key[0] in ("ratio", "factor", "contrast"))
            drift = row.get("energy_drift")
            yield CellRow(
                row["study"],
                f"{what[1]} {what[0]}" if what[0] == "masses" else what[1],
                at[1],
                row["status"],
                row["error"],
                drift,
            )

    def figures(self) -> list[Picture]:
        varied = [of for of in self.maps if len({row["study"] for row in of.rows}) > 1]
        verb = "comparisons.stability.figure:compose"
        drawn = [Picture(f"stability-{of.scene.name}", verb, (of,), of.result()) for of in varied]
        clamps = {t: of for of in self.maps for t in TURNS if of.scene.name == bent(t).name}
        caption = "; ".join(f"{turns:g} of a circle: {of.result()}" for turns, of in clamps.items())
        bends = [Picture("bent-clamps", f"{__name__}:of_clamps", (clamps,), caption)] if clamps else []
        return [*drawn, *bends]

    def complaints(self) -> list[str]:
        return [
            *(complaint for scene_map in self.maps for complaint in scene_map.complaints()),
            *fault_sentences(self.rows),
        ]

    @property
    def succeeded(self) -> bool:
        return not self.complaints()


def of_clamps(clamps: dict[float, Stability], style: FigureStyle = PLAIN) -> Figure:
    """Return the lattice's errors over the clamp's turn and the load number, with a tape spring's fold."""
    rows = [
        {**row, "cell": {"turn": turn, "load_number": 0.1 * row["cell"]["factor"]}}
        for turn, scene_map in clamps.items()
        for row in scene_map.rows
        if row["cell"]["model"] == "lumped"
    ]
    ticks = np.array(list(clamps))

    def root(turn: Any) -> Any:
        """Return the coordinate of a turn in the figure, wider for small turns."""
        return np.copysign(np.sqrt(np.abs(turn)), turn)

    with matplotlib.rc_context(tiles.MAP_STYLE):
        figure = Figure(figsize=(style.width, 3.6), layout="constrained")
        axis = figure.subplots()
        tiles.tiles(
            axis, rows, lambda row: root(row["cell"]["turn"]), "load_number",
            text=lambda row: percent(row["error"]), scale=("linear", "log"),
        )  # fmt: skip
        turns = np.linspace(-1.2, 1.2, 400)
        fold = 2.0 * np.where(turns > 0.0, 0.52, 1.48) * 2.0 * np.pi * np.abs(turns)  # 1 ∓ ν
        axis.plot(root(turns), np.maximum(fold, 1e-4), **tiles.THEORY)
        axis.set_xticks(root(ticks), [f"{turn:g}" for turn in ticks])
        axis.set(xlabel="turn of the clamp: κ a/2π", ylabel="load number ρ g h a³/D")
        axis.set_title("Lattice 17×17×2 on a bent clamp: error [%]")
        tiles.legend(figure, rows, tiles.theory("weight carries a tape spring's fold"))
    return figure

"""How good the expected error of a lattice's grid is: a hundred scenes, their true errors and the estimates.

`sheetbench study expected-errors` solves every scene on the shell (16 elements along the shorter side) and on
the lattices of 5, 9 and 17 masses and the finer ones that the estimate takes, writes the displacements at the
probes to `STORED` and prints the table of docs/theory.md. The tests read that file. Scenes: some that the
rule before this one got wrong, the catalogue, the transfer study's and fifty drawn as the advisor's are.
"""

from __future__ import annotations

from itertools import islice
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

import fem_reference
import lumped
from comparisons.comparison.comparison import error
from comparisons.models.expected_error import estimate, finer_grid, largest_stretch, resolves
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from sheetbench.scenes import Scene, catalogue, load
from sheetbench.scenes.grid import grid_of
from studies.advisor.study import scenes_at_random
from studies.transfer.scenes import transfer_scenes

STORED = Path(__file__).with_name("answers.json")
GRIDS = (5, 9, 17)
SEED, DRAWN = 41, 50
Row = dict[str, Any]


def _scene(
    name: str,
    size: tuple[float, float, float],
    material: tuple[float, float, float],
    edges: str,
    *loads: dict[str, Any],
    gravity: tuple[float, float, float] | None = None,
    tilt: float = 0.0,
    curvature: float = 0.0,
) -> Scene:
    """edges: "clamped x0 y0"; gravity: downwards unless there are loads or it is given."""
    kind, *names = edges.split()
    own = {"clamped": {"tilt": tilt} if tilt else {}, "curved": {"curvature": curvature}}.get(kind, {})
    down = None if loads else (0.0, 0.0, -9.81)
    pull = gravity or down
    return Scene.model_validate(
        {
            "name": name,
            "sheet": dict(zip(("length_x", "length_y", "thickness"), size, strict=True)),
            "material": dict(zip(("young", "poisson", "density"), material, strict=True)),
            "support": [{"edge": edge, "kind": kind, **own} for edge in names],
            "load": list(loads),
            **({"gravity": {"acceleration": pull}} if pull else {}),
        }
    )


def _edge(x: float, y: float, z: float, moment: float = 0.0) -> dict[str, Any]:
    return {"kind": "edge", "edge": "x1", "force_per_length": [x, y, z], "moment_per_length": moment}


def _point(x: float, y: float, force: float) -> dict[str, Any]:
    return {"kind": "point", "at": [x, y], "force": [0.0, 0.0, force]}


def _pressure(value: float) -> dict[str, Any]:
    return {"kind": "pressure", "value": value}


def hard_scenes() -> list[Scene]:
    """Scenes that a rule by layers' widths got wrong, and others like them."""
    strip, thin = (0.2, 0.05, 0.001), (5e6, 0.3, 1100.0)
    square, soft = (0.16, 0.16, 0.0025), (3e6, 0.3, 1100.0)
    tape, rubber = (0.15, 0.15, 0.002), (1e7, 0.45, 1200.0)
    broad, auxetic = (0.2, 0.1, 0.002), (3e6, -0.5, 1100.0)
    ribbon, silicone = (0.12, 0.04, 0.002), (6e5, 0.45, 1070.0)
    fold, gel = (0.188, 0.188, 0.001), (1e6, 0.48, 1200.0)
    moment = 5e6 * 0.001**3 / 12.0 / (1.0 - 0.3**2) / 0.2  # bends the strip by one radian
    every = "clamped x0 x1 y0 y1"
    return [
        _scene("tilts-up-heavy", strip, (8e6, 0.3, 1100.0), "clamped x0 x1", tilt=-0.5),
        _scene("tilts-up-light", strip, (8e7, 0.3, 1100.0), "clamped x0 x1", tilt=-0.5),
        _scene("tilts-down", strip, (8e6, 0.3, 1100.0), "clamped x0 x1", tilt=0.4),
        _scene("tilted-clamp", (0.16, 0.16, 0.002), rubber, "clamped x0", tilt=-0.8),
        _scene("tilted-two", (0.16, 0.16, 0.002), rubber, "clamped x0 x1", tilt=0.3),
        _scene("thick-three", (0.1, 0.1, 0.015), (1e6, 0.45, 1100.0), "clamped x0 y0 y1"),
        _scene("thick-cantilever", (0.1, 0.1, 0.012), (1e6, 0.45, 1100.0), "clamped x0"),
        _scene("near-snap-down", tape, rubber, "curved x0", curvature=-8.0),
        _scene("near-snap-up", tape, rubber, "curved x0", curvature=8.0),
        _scene("near-snap-less", tape, rubber, "curved x0", curvature=-6.0),
        _scene("hinged-corner", square, soft, "hinged x0 y0"),
        _scene("hinged-three", square, soft, "hinged x0 y0 x1"),
        _scene("auxetic-two", square, auxetic, "clamped x0 y0"),
        _scene("auxetic-one", square, auxetic, "clamped x0"),
        _scene("auxetic-less", square, (3e6, -0.2, 1100.0), "clamped x0 y0"),
        _scene("shear-in-plane", square, soft, "clamped x0", _edge(0.0, 0.5, 0.0)),
        _scene("pull-weak", ribbon, silicone, "clamped x0", _edge(1.0, 0.0, 0.0)),
        _scene("pull-hard", ribbon, silicone, "clamped x0", _edge(120.0, 0.0, 0.0)),
        _scene("pull-two-edges", square, soft, "clamped x0 y0", _edge(200.0, 0.0, 0.0)),
        _scene("pull-and-weight", broad, thin, "clamped x0", _edge(20.0, 0.0, 0.0), gravity=(0, 0, -9.81)),
        _scene("hanging", broad, (1e6, 0.3, 1100.0), "clamped x0", gravity=(9.81, 0.0, 0.0)),
        _scene("roll-up-90", strip, thin, "clamped x0", _edge(0.0, 0.0, 0.0, 1.57 * moment)),
        _scene("roll-up-270", strip, thin, "clamped x0", _edge(0.0, 0.0, 0.0, 4.71 * moment)),
        _scene("follower-45", strip, thin, "clamped x0", _pressure(0.25)),
        _scene("follower-more", strip, thin, "clamped x0", _pressure(0.35)),
        _scene("soft-fold-one", fold, gel, "clamped x0"),
        _scene("soft-fold-two", fold, gel, "clamped x0 y0"),
        _scene("soft-strip", (0.2, 0.04, 0.0005), (1e6, 0.3, 1100.0), "clamped x0"),
        _scene("blown", square, silicone, every, _pressure(200.0)),
        _scene("blown-strip", (0.15, 0.05, 0.001), (2e7, 0.3, 1100.0), "clamped x0 x1", _pressure(60.0)),
        _scene("bridge-point", broad, thin, "clamped x0 x1", _point(0.1, 0.05, -0.3)),
        _scene(
            "twist", (0.2, 0.05, 0.002), thin, "clamped x0", _point(0.2, 0, 0.05), _point(0.2, 0.05, -0.05)
        ),
        _scene("edge-normal", broad, thin, "clamped x0", _edge(0.0, 0.0, 0.3)),
    ]


def scenes() -> dict[str, tuple[str, Scene]]:
    """Every scene by its name, with the group that it belongs to."""
    by_name = {s.name: ("hard", s) for s in hard_scenes()}
    by_name |= {name: ("catalogue", load(name)) for name in catalogue() if name != "two-edges-settling"}
    by_name |= {n: ("transfer", s) for n, s in transfer_scenes().items() if n not in by_name}
    return by_name | {s.name: ("drawn", s) for s in islice(scenes_at_random(SEED), DRAWN)}


def lattice(scene: Scene, grid: tuple[int, int, int]) -> Row:
    """A lattice's displacement at the probes, and how its solve ended."""
    springs = resolve(scene, Lattice(grid, "consistent"), "springs").springs
    solution = lumped.solve(scene, springs)
    return {
        "grid": list(grid),
        "status": str(solution.status) if solution.comparable else "no equilibrium",
        "snaps": len(solution.snaps),
        "stretch": float(f"{largest_stretch(scene, solution, grid):.4g}"),
        "probes": _rounded(solution.displacement(scene.probe_points())),
    }


def measure(group: str, scene: Scene) -> Row:
    """What is stored of a scene."""
    shell = fem_reference.solve(scene, model="shell", elements=16)
    row: Row = {"group": group}
    row["shell"] = {
        "status": str(shell.status) if shell.comparable else "no equilibrium",
        "probes": _rounded(shell.displacement(scene.probe_points())),
    }
    grids = [grid_of(scene.sheet, n) for n in GRIDS]
    wanted = sorted({*grids, *(finer_grid(grid) for grid in grids)})
    row["lattices"] = [lattice(scene, grid) for grid in wanted]
    row["grids"] = [list(grid) for grid in grids]
    return row


def _rounded(u: np.ndarray) -> list[list[float]]:
    return [[float(f"{x:.7g}") for x in point] for point in u]


def pairs(row: Row, scene: Scene) -> list[tuple[float, float | None]]:
    """True error and estimate, None where there is none, of every grid on which there is a true one."""
    of = {tuple(one["grid"]): one for one in row["lattices"]}
    both = []
    for grid in row["grids"]:
        coarse, fine = of[tuple(grid)], of[finer_grid(tuple(grid))]
        if row["shell"]["status"] != "converged" or coarse["status"] != "converged":
            continue
        true = error(np.array(coarse["probes"]), np.array(row["shell"]["probes"]))
        expected = None
        alike = fine["status"] == "converged" and fine["snaps"] == coarse["snaps"]
        if alike and resolves(scene, finer_grid(tuple(grid))):
            ratio = prod(n - 1 for n in fine["grid"][:2]) / prod(n - 1 for n in grid[:2])
            expected = estimate(np.array(coarse["probes"]), np.array(fine["probes"]), ratio, fine["stretch"])
        if true is not None:
            both.append((true, expected))
    return both


def shares(both: list[tuple[float, float | None]]) -> tuple[int, int, float, float]:
    """How many there are, how many have an estimate, the share of those within a factor of two, the largest
    true error in units of the estimate."""
    ratios = np.array([true / expected for true, expected in both if expected])
    within = float(np.mean((ratios < 2.0) & (ratios > 0.5))) if len(ratios) else np.nan
    return len(both), len(ratios), within, float(ratios.max(initial=0.0))


def table(rows: dict[str, Row]) -> str:
    """Markdown: a line per group, and per number of masses."""
    lines = ["| scenes | masses | cases | estimated | within a factor of 2 [%] | largest true / estimate |"]
    lines += ["| --- | --- | ---: | ---: | ---: | ---: |"]
    groups = list(dict.fromkeys(row["group"] for row in rows.values()))
    for group, masses in [*((group, None) for group in groups), *(("all", n) for n in (*GRIDS, None))]:
        count, expected, within, worst = shares(error_pairs(rows, group, masses))
        numbers = f"{count} | {expected} | {100 * within:.0f} | {worst:.2f}"
        lines.append(f"| {group} | {masses or 'all'} | {numbers} |")
    return "\n".join(lines)


def error_pairs(
    rows: dict[str, Row], group: str, masses: int | None = None
) -> list[tuple[float, float | None]]:
    """The pairs of a group's rows, or of all, on grids with so many masses along the shorter side, or any."""
    named = scenes()
    pairs_of = []
    for name, row in rows.items():
        grids = [grid for grid in row["grids"] if masses in (None, min(grid[:2]))]
        if group in (row["group"], "all"):
            pairs_of += pairs(row | {"grids": grids}, named[name][1])
    return pairs_of

"""Expected error of a lattice's grid on a hundred stored scenes, beside the true one.

`results/promises.json` has every scene (some on which an earlier rule by the layers' widths failed, eight by
another author, the catalogue, the transfer study's and fifty drawn at random), and the displacements [m] of
its probes: by the shell of 16 elements along the shorter side, and by the lattices of 5, 9 and 17 masses and
the finer ones that the estimate takes. The estimates are computed from the displacements by the present rule.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import lumped
from comparisons.models.expected_error import finer_grid, grid_error, largest_stretch, ratio_of, resolves
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements, Lattice
from comparisons.sweep.differences import error
from sheetbench.answers.files import write_text
from sheetbench.answers.solution import Solution
from sheetbench.scenes import Scene
from sheetbench.scenes.objects.grid import grid_of
from studies.pages import RESULTS
from studies.promises.answer import Promise

STORED = RESULTS / "promises.json"
GRIDS, ELEMENTS = (5, 9, 17), 16
Row = dict[str, Any]


def stored() -> dict[str, Row]:
    """Return the stored rows by scene name: group, scene, the shell's and the lattices' answers."""
    rows: dict[str, Row] = json.loads(STORED.read_text(encoding="utf-8"))
    return {name: {**row, "scene": Scene.model_validate(row["scene"])} for name, row in rows.items()}


def solve_again(progress: Callable[[str], None]) -> None:
    """Solve every stored scene again, and store the answers."""
    rows = []
    for name, row in stored().items():
        progress(name)
        scene = row["scene"]
        grids = [grid_of(scene.sheet, n) for n in GRIDS]
        needed_grids = sorted({*grids, *(finer_grid(grid, scene) for grid in grids)})
        shell = _answer(scene, solve(resolve(scene, Elements("shell", ELEMENTS))))
        answers = {"shell": shell, "lattices": [lattice(scene, grid) for grid in needed_grids]}
        rows.append({name: {"group": row["group"], "scene": scene.document(), **answers}})
    write_text(STORED, "{\n" + ",\n".join(json.dumps(row)[1:-1] for row in rows) + "\n}\n")


def lattice(scene: Scene, grid: tuple[int, int, int]) -> Row:
    """Return a lattice's answer as it is stored."""
    springs = resolve(scene, Lattice(grid, "consistent"), "springs").springs
    solution = lumped.solve(scene, springs)
    stretch = float(f"{largest_stretch(scene, solution, grid):.4g}")
    return {"grid": list(grid), "snaps": len(solution.snaps), "stretch": stretch, **_answer(scene, solution)}


def _answer(scene: Scene, solution: Solution) -> Row:
    u = solution.displacement(scene.probe_points())
    status = str(solution.status) if solution.comparable else "no equilibrium"
    return {"status": status, "probes": [[float(f"{x:.7g}") for x in point] for point in u]}


def expected_errors() -> Iterator[Promise]:
    """Yield a row for every grid of a scene with a true error; promised is None without an estimate."""
    for name, row in stored().items():
        by_grid = {tuple(answer["grid"]): answer for answer in row["lattices"]}
        for masses in GRIDS:
            grid = grid_of(row["scene"].sheet, masses)
            coarse, fine = by_grid[grid], by_grid[finer_grid(grid, row["scene"])]
            if not row["shell"]["status"] == coarse["status"] == "converged":
                continue
            u, finer, truth = (np.array(answer["probes"]) for answer in (coarse, fine, row["shell"]))
            promised = None
            same_branch = fine["status"] == "converged" and fine["snaps"] == coarse["snaps"]
            if same_branch and resolves(row["scene"], tuple(fine["grid"])):
                ratio = ratio_of(row["scene"], grid, tuple(fine["grid"]))
                estimate = grid_error(u, finer, ratio, fine["stretch"])
                promised = None if isinstance(estimate, str) else estimate
            if (actual := error(u, truth)) is not None:
                yield Promise("expected error", f"{masses} masses", name, row["group"], promised, actual)

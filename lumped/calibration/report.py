"""Report of the moduli of the sheet and of a lattice's cells, with notes on moduli that the lattice
misses."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from lumped import moduli
from lumped.calibration.calibration import Calibration
from lumped.calibration.cell_by_cell import GridCells
from lumped.spring_constants import COUPLINGS, MID_COUPLINGS, Springs
from sheetbench.answers.table import number
from sheetbench.errors import BadInput

EQUAL = 1e-9  # relative difference up to which two numbers are equal


def report(
    method: str,
    grid_cells: GridCells,
    springs: Springs,
    more: Sequence[str] = (),
    cell_moduli: moduli.Moduli | None = None,
) -> Calibration:
    """Return the calibration with its moduli report, notes on moduli that it misses and the notes `more`.

    For unequal cells each modulus is reported for the cell with the largest miss, the stiffest among equal
    misses. cell_moduli: of the springs, if computed before. Raises BadInput where area springs leave a
    cell without positive energy.
    """
    (sides, section), sheet = grid_cells.present, grid_cells.target
    if cell_moduli is None:
        cell_moduli = moduli.of_cells(springs, grid_cells.sides, grid_cells.grid[2])
    covered = np.broadcast_to(grid_cells.covered, cell_moduli.shear.shape[:2])
    got = moduli.Moduli(*(part[covered] for part in vars(cell_moduli).values()))
    rigidity, rigidity_y = sheet.bending[:, 0, 0], sheet.bending[:, 1, 1]
    square = np.abs(sides[:, 0] - sides[:, 1]) < EQUAL * sides[:, 0]
    oblique, mixed = bool(sheet.oblique.any()), bool(sheet.mixed.any())
    square &= (np.abs(rigidity - rigidity_y) < EQUAL * rigidity) & (not mixed)
    selected = not oblique and bool(np.all(square)), oblique, mixed
    names = sheet.named(*selected)
    targets, results = (np.array([*of.values()]) for of in (names, got.named(*selected)))
    both = np.sqrt(names["A11"] * names["D11"])  # the size of B
    sizes = np.array([both if name[0] == "B" else np.abs(names[_reference(name)]) for name in names])
    misses = (results - targets) / np.where(targets == 0.0, sizes, targets)
    off_most = np.abs(misses) >= np.abs(misses).max(axis=1, keepdims=True) - EQUAL
    rows: dict[str, dict[str, Any]] = {}
    worst = np.where(off_most, rigidity, 0.0).argmax(axis=1)
    for name, at, *values in zip(names, worst, targets, results, misses, strict=True):
        target_got_miss = (float(of_cells[at]) for of_cells in values)
        rows[name] = {"name": name, **dict(zip(("asked", "got", "miss"), target_got_miss, strict=True))}
        if name.startswith("S"):
            axes = {"Sy": (1, 1), "Sxy": (0, 1)}.get(name, (0, 0))
            rows[name]["kappa_G_h"] = float(section.shear[at, *axes])
    areas = springs["area"], springs["mid_area"]
    ends = [sorted({of_cells.min(), of_cells.max()}) for of_cells in areas]
    ranges = (" … ".join(f"{end:.4g}" for end in both) for both in ends)
    constants = "area = {}, mid_area = {} N/m".format(*ranges)
    negative = min(map(np.min, areas)) < 0.0
    coupled = springs.of.keys() & {*COUPLINGS, *MID_COUPLINGS}
    forms = (got.membrane, got.free_bending) if negative or coupled or mixed else ()
    if any(np.linalg.eigvalsh(form).min() <= 0.0 for form in forms):
        raise BadInput(f"{constants}: the cell's energy is not positive")
    sized = [(row, size[at]) for row, at, size in zip(rows.values(), worst, sizes, strict=True)]
    missed = [row for row, size in sized if abs(row["got"] - row["asked"]) > 0.01 * size]
    off = [f"{row['name']} by {number(100.0 * row['miss'], '+.1f')} %" for row in missed]
    notes = [f"these springs miss {', '.join(off)}"] if off else []
    if off and not springs.of.keys() & {"area", "shear"}:
        notes.append("central links alone obey Cauchy's relation C12 = C66: no k meets D12 and D66 both")
    if negative:  # ν < 1/3
        notes.append(f"{constants}: negative area springs are admissible here, the cell's energy is positive")
    settings: dict[str, Any] = {"grading": grid_cells.grading, "cells": grid_cells.cells}
    reported, remarks = tuple(rows.values()), (*notes, *more)
    return Calibration(method, grid_cells.grid, springs.table(), reported, remarks, **settings)


def _reference(name: str) -> str:
    """Return the modulus that gives the scale of another: D11 for D12, D16 and D26, Sx for Sxy."""
    return f"{name[0]}11" if name[1:] in ("12", "16", "26") else name.replace("Sxy", "Sx")

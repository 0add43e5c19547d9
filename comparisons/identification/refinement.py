"""How fine a lattice's cells must be for the unknowns: until the grid moves them less than the noise does.

A Gauss–Newton step on cells half as large says by how much those would move an unknown. The grid's error is
of second order inside the sheet and nearer to first at held edges (E of the shell's own data: 0.94 % low on
9 masses a side, 0.44 % on 17), so that GRID_ERROR times the step bounds what the grid does to the value;
half-widths of intervals contain it. Where cells are not given, the fit is made again on cells half as large
until the step, or half of the last one, is below SHARE of the noise's half-width, or below NEGLIGIBLE. The
budget is a size, not a time, so that the answer does not depend on the machine: FITTED and CHECKED unknowns
take a second or two a solve. Where it ends the search, the next step is taken to be half the last.
"""

from __future__ import annotations

from dataclasses import replace
from math import prod

import numpy as np

from comparisons.identification.fit import Fit, Nearest
from comparisons.identification.model import NotReached, lattice_model, reference_model
from comparisons.models.context import context
from comparisons.models.resolve import resolve
from comparisons.models.sizes import has_room
from comparisons.models.spec import Elements, Lattice
from lumped import Identifiability, identifiability
from sheetbench.scenes import Scene
from sheetbench.scenes.objects.grading import of_settings

SHARE = 1.0 / 3.0
NEGLIGIBLE = 2e-3  # of x
GRID_ERROR = 2.0
FITTED, CHECKED = 20_000, 30_000  # unknowns of a lattice that is fitted, and of one that gives a step


def refined(
    scene: Scene, lattice: Lattice, fit: Fit, best: Nearest, free: bool
) -> tuple[Fit, Nearest, np.ndarray, list[tuple[int, ...]]]:
    """Return the fit on cells that are small enough where the grid is free, else on those given, the best of
    its searches, by how much x changes on cells half as large, nan where that is not known, and all grids
    that were fitted, (nx, ny, layers) each.

    lattice: as it was requested; fit, best: on the first grid.
    """
    names = [u.name for u in fit.unknowns]
    grids = [tuple(fit.model.settings["grid"])]
    step = np.full(len(names), np.nan)
    while True:
        nx, ny, layers = grids[-1]
        finer = (2 * nx - 1, 2 * ny - 1, layers)
        room = has_room(scene, Lattice(finer))
        unknowns = 3 * finer[0] * finer[1] * layers
        widths = np.array([*identifiability(names, best.slopes, best.residuals).half_widths.values()])
        enough = np.maximum(SHARE * widths, NEGLIGIBLE)
        foretold = step / 2.0  # nan on the first grid
        if not room or (len(grids) > 1 and (unknowns > CHECKED or (np.abs(foretold) <= enough).all())):
            return fit, best, foretold, grids
        settings = fit.model.settings
        chosen = {"calibration": settings["calibration"], "grading": of_settings(settings)}
        halved = lattice_model(scene, replace(lattice, grid=finer, **chosen))
        context().progress(f"looking at cells half as large, {finer[0]} × {finer[1]} masses")
        on_halved = replace(fit, model=replace(halved, settings={**settings, "grid": list(finer)}))
        step = _step(on_halved, best.x)
        small = (np.abs(step) <= enough).all()
        if not free or unknowns > FITTED or not np.isfinite(step).all() or small:
            return fit, best, step, grids
        try:
            fit, best = on_halved, on_halved.search(best.x + step)
        except NotReached:
            return fit, best, step, grids
        grids.append(finer)


def mesh_error(scene: Scene, reference: Elements, fit: Fit, best: Nearest) -> np.ndarray:
    """Return what a reference's elements do to x at most, by a step on elements twice as large: the error is
    taken to fall in first order, the least that it does; nan where these have no answer."""
    elements = reference.counts(scene)[:2]
    coarse = (elements[0] + 1) // 2, (elements[1] + 1) // 2
    longer = (prod(elements) / prod(coarse)) ** 0.5
    if longer == 1.0:
        return np.full(len(best.x), np.nan)
    context().progress(f"looking at larger elements, {coarse[0]} × {coarse[1]}")
    other = reference_model(resolve(scene, reference.but(count=coarse)))
    step = _step(replace(fit, model=replace(fit.model, predict=other.predict)), best.x)
    return np.abs(step) / (longer - 1.0)


def _step(fit: Fit, x: np.ndarray) -> np.ndarray:
    """Return the Gauss–Newton step of x, of what the data see; nan where the model has no answer."""
    try:
        residuals, slopes = fit.at(x)
    except NotReached:
        return np.full(len(x), np.nan)
    step, *_ = np.linalg.lstsq(slopes, -residuals, rcond=Identifiability.threshold)
    found: np.ndarray = step
    return found

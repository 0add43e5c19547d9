"""Identification: parameters of a scene from measurements of its sheet.

Least squares in the unknowns' x (`comparisons.identification.unknowns`),

    min Σ r²,   r = u_model − u_measured at every measured component, or
                r = n · (φ_model − P) + offset, the distance along the surface's normal, at every cloud point,

by a trust region (SciPy's `least_squares`), from the values that the scene gives. The noise is taken to be
independent and equally large in all measured components, which have equal weights. Then x ± t s √C_ii, with
s² = r·r/(m − n), C = (Jᵀ J)⁻¹ and Student's t, is a 95 % interval. If standard deviations σ are given,
residuals are weighted by their inverse, and the interval is x ± 1.96 max(s, σ) √C_ii, which exists for as
many unknowns as numbers too. The interval contains the error of the grid or mesh, and no other error of the
model.

The search is made from several starts, and over growing parts of a motion (`fit`); its residuals are tested
for being noise and for rows that do not fit (`residuals`).

A pull of PULL towards the scene's own values fixes combinations of unknowns without influence on the data (E
and ρ in a sheet under its own weight, where only E/ρ shows), which rounding would change at random; it moves
others by PULL², 1e-12. Source: Bates and Watts, Nonlinear Regression Analysis (1988), chapters 1–2.

A lattice's cells must be so fine that the grid moves the unknowns less than the noise does. A Gauss–Newton
step on cells half as large estimates the grid's effect. The grid's error is of second order inside the sheet
and nearer to first at held edges (E of the shell's own data: 0.94 % low on 9 masses a side, 0.44 % on 17), so
that GRID_ERROR times the step is a bound of the grid's error; half-widths of intervals contain it. If cells
are not given, the fit is made again on cells half as large until the step, or half of the last one, is below
SHARE of the noise's half-width, or below NEGLIGIBLE. The budget is a size, not a time, so that the answer
does not depend on the machine: FITTED and CHECKED unknowns take a second or two a solve. When it ends the
search, the next step is taken to be half the last.
"""

from collections.abc import Sequence
from dataclasses import replace
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.identification import residuals as remarks
from comparisons.identification.answer import Identification
from comparisons.identification.field import SUFFIX, FieldIdentification, identify_field
from comparisons.identification.fit import Fit, Minimum, best_search
from comparisons.identification.measurements import Displacements, Measured, Surface, read
from comparisons.identification.model import NoAnswer, lattice_model, reference_model
from comparisons.identification.residuals import Outlier, explained, outliers, runs
from comparisons.identification.unknowns import DAMPING, VISCOUS, Estimate, Unknown
from comparisons.identification.unknowns import unknown as unknown_of
from comparisons.models.context import context
from comparisons.models.grids import Elements as Count
from comparisons.models.resolve import resolve
from comparisons.models.sizes import has_room
from comparisons.models.spec import Elements, Lattice, items
from lumped import Identifiability, identifiability
from sheetbench.choices import REFERENCES
from sheetbench.errors import BadInput, require_choice, require_effect
from sheetbench.scenes import AnyScene, Scene, require_static, scene_of
from sheetbench.scenes.meaning.region import nearest_on_sheet
from sheetbench.scenes.objects.grading import of_settings

SHARE = 1.0 / 3.0
NEGLIGIBLE = 2e-3  # of x
GRID_ERROR = 2.0
ON_EDGE = 1e-4  # of the longer side
FITTED, CHECKED = 20_000, 30_000  # unknowns of a lattice that is fitted, and of one that gives a step


def refined(
    scene: Scene, lattice: Lattice, fit: Fit, best: Minimum, free: bool
) -> tuple[Fit, Minimum, np.ndarray, list[tuple[int, ...]]]:
    """Return the fit on the final grid, its best search, the change of x on cells half as large, nan if
    unknown, and all grids that were fitted, (nx, ny, layers) each. Cells are halved until they are small
    enough if the grid is free.

    lattice: as it was requested; fit, best: on the first grid."""
    names = [u.name for u in fit.unknowns]
    grids = [tuple(fit.model.settings["grid"])]
    step = np.full(len(names), np.nan)
    while True:
        nx, ny, layers = grids[-1]
        finer = (2 * nx - 1, 2 * ny - 1, layers)
        room = has_room(scene, Lattice(finer))
        unknowns = 3 * finer[0] * finer[1] * layers
        intervals = identifiability(names, best.slopes, best.residuals, fit.deviation)
        limits = np.fmax(SHARE * np.array([*intervals.half_widths.values()]), NEGLIGIBLE)
        expected = step / 2.0  # nan on the first grid
        if not room or (len(grids) > 1 and (unknowns > CHECKED or (np.abs(expected) <= limits).all())):
            return fit, best, expected, grids
        settings, grading = fit.model.settings, of_settings(fit.model.settings, scene.sheet.lengths)
        spec = replace(lattice, grid=finer, calibration=settings["calibration"], grading=grading)
        finer_model = lattice_model(scene, spec)
        context().progress(f"looking at cells half as large, {finer[0]} × {finer[1]} masses")
        finer_fit = replace(fit, model=replace(finer_model, settings={**settings, "grid": list(finer)}))
        step = _solve_step(finer_fit, best.x)
        is_small = (np.abs(step) <= limits).all()
        if not free or unknowns > FITTED or not np.isfinite(step).all() or is_small:
            return fit, best, step, grids
        try:
            fit, best = finer_fit, finer_fit.search(best.x + step)
        except NoAnswer:
            return fit, best, step, grids
        grids.append(finer)


def mesh_error(scene: Scene, reference: Elements, fit: Fit, best: Minimum) -> np.ndarray:
    """Return a bound of the error of x by a reference's mesh, from a step on elements twice as large. The
    error is taken to fall in first order, the slowest possible. Returns nan without an equilibrium on larger
    elements."""
    elements = reference.counts(scene)[:2]
    coarse = (elements[0] + 1) // 2, (elements[1] + 1) // 2
    side_ratio = (prod(elements) / prod(coarse)) ** 0.5
    if side_ratio == 1.0:
        return np.full(len(best.x), np.nan)
    context().progress(f"looking at larger elements, {coarse[0]} × {coarse[1]}")
    coarse_model = reference_model(resolve(scene, reference.but(count=coarse)))
    step = _solve_step(replace(fit, model=replace(fit.model, predict=coarse_model.predict)), best.x)
    return np.abs(step) / (side_ratio - 1.0)


def _solve_step(fit: Fit, x: np.ndarray) -> np.ndarray:
    """Return the Gauss–Newton step of x in determined directions; nan if the model has no equilibrium."""
    try:
        residuals, slopes = fit.at(x)
    except NoAnswer:
        return np.full(len(x), np.nan)
    step, *_ = np.linalg.lstsq(slopes, -residuals, rcond=Identifiability.threshold)
    return np.asarray(step)


__all__ = ["NoAnswer", "identify"]
MODELS = ("lumped", *(name for name in REFERENCES if name != "plate"))  # whose large displacements hold


def identify(
    scene: AnyScene,
    measured: Measured | Path | str,
    unknown: Sequence[str] | str = "young",
    lattice: Lattice = Lattice(),  # noqa: B008  # frozen
    *,
    model: str | Elements = Lattice.NAME,
    elements: Count | None = None,
    law: str | None = None,
    offset: float = 0.0,
    uncertainty: float | None = None,
    refine: bool = True,
) -> Identification | FieldIdentification:
    """Return values and intervals of unknowns of a scene, from measurements or a file of them
    (`measurements.read`); of young=field, thickness=field or density=field the values of all cells (`field`).

    Unless the lattice has a grid, cells become smaller until the grid moves the unknowns less than the noise
    does; its grading may be "auto", by the scene's own values. elements: of a reference; law: its law of
    strain (`sheetbench.choices.STRAIN_LAWS`); offset [m]: distance of a cloud from the mid-surface along the
    normal; uncertainty [m]: standard deviation of every measured number. refine: whether to estimate the
    error of the grid or mesh on other cells or elements (not for motions).

    Raises BadInput for names, models and data that contradict each other, and NoAnswer where the model has
    no stable answer with the scene's own values."""
    scene = scene_of(scene)
    require_static(scene)
    measured = read(Path(measured), scene) if isinstance(measured, str | Path) else measured
    measured = _snap_to_sheet(_add_deviation(measured, uncertainty), scene)
    names = items(unknown) if isinstance(unknown, str) else unknown
    if field_names := [name for name in names if name.endswith(SUFFIX)]:
        if model != Lattice.NAME or len(names) > 1:
            raise BadInput(f"unknown = '{field_names[0]}': a field is the only unknown, and of the lattice")
        resolved = resolve(scene, lattice, scene_springs=False)
        return identify_field(resolved, measured, field_names[0].removesuffix(SUFFIX))
    unknowns = tuple(unknown_of(scene, name) for name in names)
    reference = None
    reference_settings = {"elements": elements, "law": law}
    if model != Lattice.NAME:
        reference = Elements.given(model, reference_settings)
        require_choice("model", reference.kind, MODELS)
        require_effect(f"with the model {reference.kind}", lattice.settings)
        fitted_model = reference_model(resolve(scene, reference))
    else:
        require_effect("with the model lumped", reference_settings)
        _require_springs(scene, lattice, [u.name for u in unknowns])
        fitted_model = lattice_model(scene, lattice)
    fit = Fit(measured, unknowns, fitted_model, offset)
    _require_determinable(fit)
    return _assemble_answer(scene, fit, lattice if reference is None else reference, refine)


def _assemble_answer(scene: Scene, fit: Fit, spec: Lattice | Elements, refine: bool) -> Identification:
    """Return the identification of a fit; spec: the model as it was requested."""
    unknowns, measured = fit.unknowns, fit.measured
    refine = refine and measured.time is None
    outlying: tuple[Outlier, ...] = ()

    def suffices(result: Minimum) -> bool:
        nonlocal outlying
        outlying = outliers(fit, result)
        signs = runs(measured, fit.per_point(result.residuals))
        return bool(outlying) or explained(result.noise, signs, fit.deviation)

    best, starts = best_search(fit, suffices)
    step = model_error = np.full(len(unknowns), np.nan)
    grids: list[Any] = [fit.model.settings.get("grid")]
    free = isinstance(spec, Lattice) and spec.grid is None and not (scene.springs and scene.springs.grid)
    if refine and isinstance(spec, Lattice):
        fit, best, step, grids = refined(scene, spec, fit, best, free)
        model_error = GRID_ERROR * np.abs(step)
    elif refine and isinstance(spec, Elements):
        model_error = mesh_error(scene, spec, fit, best)
    intervals = identifiability([u.name for u in unknowns], best.slopes, best.residuals, fit.deviation)
    estimates = {
        u.name: _make_estimate(u, x, intervals.half_widths[u.name], *steps)
        for u, x, *steps in zip(unknowns, best.x, model_error.tolist(), step.tolist(), strict=True)
    }
    residuals = fit.per_point(best.residuals)
    signs = runs(measured, residuals)
    warnings = [
        *remarks.start_notes(fit, best, estimates),
        *(f"{row}. Is it a mistake? Empty its cells for the values without it" for row in outlying),
        *intervals.warnings,
        *([] if outlying else remarks.residual_notes(fit, best, signs, starts)),
        *remarks.ties_notes(fit, best),
        *remarks.bounds_notes(fit, best),
        *remarks.grid_notes(estimates, spec.model, refine, fit.model.settings.get("grid") if free else None),
    ]
    return Identification(
        scene=scene,
        measured=measured,
        model=spec.model,
        settings=fit.model.settings,
        unknowns=estimates,
        residuals=residuals,
        noise=measured.scale * best.noise,
        relative=float(np.nanmax(np.abs(residuals))) / measured.scale,
        evaluations=best.evaluations,
        converged=best.converged,
        warnings=tuple(warnings),
        runs=signs,
        explained=not outlying and explained(best.noise, signs, fit.deviation),
        starts=starts,
        grids=tuple(tuple(grid) for grid in grids if grid),
        outliers=outlying,
    )


def _make_estimate(u: Unknown, x: float, half_width: float, model_error: float, step: float) -> Estimate:
    """Return an unknown's value at x; half_width: of its interval by noise; model_error: bound of the
    error of x by the grid or mesh; step: of x on cells half as large; nan where they are not known."""
    has_interval = not np.isnan(half_width)
    return Estimate(
        value=u.value(x),
        interval=u.interval(x, half_width + float(np.nan_to_num(model_error))) if has_interval else None,
        start=u.start,
        unit=u.unit,
        refined=u.value(float(np.clip(x + step, *u.bounds()))) if np.isfinite(step) else None,
        noise_interval=u.interval(x, half_width) if has_interval else None,
        determined=not np.isinf(half_width),
    )


def _require_springs(scene: Scene, lattice: Lattice, names: Sequence[str]) -> None:
    """Raise BadInput for springs that do not depend on the unknowns."""
    if resolve(scene, lattice, scene_springs=False).fitted:
        raise BadInput(f"calibration = '{lattice.calibration}': its springs do not depend on the unknowns")
    if lattice.k is not None and (fixed := [name for name in names if name in ("young", "poisson")]):
        raise BadInput(
            f"unknown = '{fixed[0]}': with k = {lattice.k:g} N/m given the springs do not depend on it; "
            "leave k out"
        )


def _require_determinable(fit: Fit) -> None:
    """Raise BadInput for unknowns that the measurements cannot determine, and an offset of displacements."""
    names, measured = [u.name for u in fit.unknowns], fit.measured
    repeated = {name for name in names if names.count(name) > 1}
    if not names or repeated:
        raise BadInput(f"unknown = '{','.join(names)}': name each once, and at least one")
    dynamic = [name for name in names if name in DAMPING or name.startswith(VISCOUS)]
    if dynamic and measured.time is None:
        raise BadInput(
            f"unknown = '{dynamic[0]}': an equilibrium does not depend on it; measure a motion, "
            "a CSV with a column time [s]"
        )
    if fit.offset and not isinstance(measured, Surface):
        raise BadInput(
            f"offset = {fit.offset:g} m: of a cloud's points from the mid-surface; displacements are "
            "the mid-surface's"
        )
    count = int(measured.measured.sum()) if isinstance(measured, Displacements) else len(measured.points)
    if count < len(names):
        numbers = "1 measured number" if count == 1 else f"{count} measured numbers"
        raise BadInput(f"{numbers} cannot determine {len(names)} unknowns")


def _add_deviation(measured: Measured, uncertainty: float | None) -> Measured:
    """Return the measurements with one standard deviation [m] of every number, if it is given. Raises
    BadInput unless it is above 0, and if the file has a column of standard deviations."""
    if uncertainty is None:
        return measured
    if not uncertainty > 0.0:
        raise BadInput(f"uncertainty = {uncertainty:g} m: must be greater than 0")
    if measured.deviation is not None:
        raise BadInput(f"uncertainty = {uncertainty:g} m: {measured.source} has a column sd; leave one out")
    return replace(measured, deviation=np.full(len(measured.points), uncertainty))


def _snap_to_sheet(measured: Measured, scene: Scene) -> Measured:
    """Return the measurements, with points that are off the sheet by rounding alone, within ON_EDGE of its
    longer side, moved to its edge. Raises BadInput for others, and for a cloud of a sheet that is no
    rectangle."""
    if isinstance(measured, Surface):
        if scene.pierced:
            raise BadInput(
                f"{measured.source}: points of the surface are fitted to a whole rectangle; for a "
                "sheet with an outline or cutouts give displacements of marked points, x,y,ux,uy,uz"
            )
        return measured
    points = nearest_on_sheet(scene, measured.points)
    outside = np.hypot(*(points - measured.points).T) > ON_EDGE * max(scene.sheet.lengths)
    if outside.any():
        row = int(np.argmax(outside))
        x, y = measured.points[row].tolist()
        raise BadInput(
            f"{measured.name_of(row)}: x, y = {x:g}, {y:g} is off the sheet: 0 ≤ x ≤ "
            f"{scene.sheet.length_x:g} m, 0 ≤ y ≤ {scene.sheet.length_y:g} m, in its outline, not in a "
            "cutout"
        )
    return replace(measured, points=points)

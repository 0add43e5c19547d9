"""The inverse question: parameters of a scene from what was measured of its sheet.

Least squares in the unknowns' x (`comparisons.identification.unknowns`),

    min Σ r²,   r = u_model − u_measured at every measured component, or
                r = n · (φ_model − P) + offset, the distance along the surface's normal, at every cloud point,

by a trust region (SciPy's `least_squares`), from the values that the scene gives. Every measured component
weighs the same: the noise is taken to be independent and equally large in all of them. Then x ± t s √C_ii,
with s² = r·r/(m − n), C = (Jᵀ J)⁻¹ and Student's t, is a 95 % interval. It does not know of the model's own
errors; of a lattice's, one Gauss–Newton step on cells half as large gives the measure (`refined`).

A pull of PULL towards the scene's own values holds what the data do not see at all (only E/ρ shows in a sheet
under its own weight), or rounding would walk off with it; what they see it moves by PULL², 1e-12.
Source: Bates and Watts, Nonlinear Regression Analysis (1988), chapters 1–2.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import inf
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.identification import law as strain_law
from comparisons.identification import surface
from comparisons.identification.found import Found, Identification
from comparisons.identification.measurements import Displacements, Measured, Surface, read
from comparisons.identification.misfit import Misfit, require_same_way
from comparisons.identification.prediction import (
    NotReached,
    Prediction,
    Predictor,
    lattice,
    motion,
    reference,
    set_in,
)
from comparisons.identification.search import search
from comparisons.identification.unknowns import DAMPING, Unknown, unknown
from comparisons.models.candidate import Candidate
from comparisons.models.grading import Grading
from comparisons.models.grids import Asked, Elements
from comparisons.models.registry import check, check_reference, solve_reference
from comparisons.models.sizes import has_room
from comparisons.models.springs import LatticeSpec, resolve
from comparisons.report.table import quantity
from comparisons.report.work import Progress, Work, silent
from lumped import CALIBRATIONS, Identifiability, identifiability
from sheetbench.choices import ELEMENTS, REFERENCES, method_of
from sheetbench.scenes import AnyScene, Scene, require_static, scene_of
from sheetbench.scenes.errors import BadInput
from sheetbench.scenes.grading import as_settings, of_settings
from sheetbench.scenes.grid import near_square

MODELS = ("lumped", *(name for name in REFERENCES if name != "plate"))  # whose large displacements hold
POOR = 0.05  # standard deviation of the residuals, of the largest measurement: more than noise usually is


def identify(
    scene: AnyScene,
    measured: Measured | Path | str,
    names: Sequence[str] | str = "young",
    *,
    model: str = "lumped",
    grid: Asked = None,
    calibration: str | None = None,
    k: float | None = None,
    layer_distance: float | None = None,
    grading: Grading = None,
    elements: Elements = ELEMENTS,
    law: str | None = None,
    offset: float = 0.0,
    refine: bool = True,
    large: bool = False,
    progress: Callable[[str | Work], None] = lambda what: None,
) -> Identification:
    """The unknowns of these names, from measurements or a file of them (`measurements.read`).

    grid (as `comparisons.models.grids` reads it), calibration, grading (a number, or "auto" by the scene's
    own values, see `comparisons.models.grading`): of the lattice; elements: of a reference;
    law: its law of strain (`sheetbench.choices.STRAIN_LAWS`); offset [m]: where a cloud was taken along the
    surface's normal, 0 on the mid-surface. refine: whether to look at a finer lattice too (not for motions).
    large: even where a model takes more memory than there is.
    progress: told of every evaluation, and of a reference's solves.

    Raises BadInput for names, models and data that do not go together, and NotReached where the model has no
    stable answer with the scene's own values.
    """
    scene = scene_of(scene)
    require_static(scene)
    measured = read(Path(measured), scene) if isinstance(measured, str | Path) else measured
    names = [names] if isinstance(names, str) else names
    unknowns = tuple(unknown(scene, name) for name in names)
    lattice = LatticeSpec(grid, calibration, k, layer_distance, grading)
    _check(measured, unknowns, model, lattice, elements, law)
    check(scene, lattice.candidate if model == "lumped" else Candidate(model, {"elements": elements}), large)
    if offset and not isinstance(measured, Surface):
        raise BadInput(
            f"offset = {offset:g} m: of the points of a cloud from the mid-surface; displacements are its own"
        )
    predict, settings, axes = _predictor(scene, measured, model, lattice, elements, law, progress)
    misfit = Misfit(measured, axes, offset)

    def first(predicted: Prediction) -> None:
        if not any(u.turns for u in unknowns):
            require_same_way(measured, predicted, axes)
        count = len(misfit.of(predicted)[0])
        if count <= len(unknowns):
            raise BadInput(f"{count} measured numbers cannot give intervals of {len(unknowns)} unknowns")

    best = search(predict, unknowns, misfit, first=first, progress=progress)
    final, slopes = best.residuals, best.slopes
    known = identifiability([u.name for u in unknowns], slopes, final)
    steps: Sequence[float | None] = [None] * len(unknowns)
    unseen = []
    if refine and model == "lumped" and not _moving(measured):
        nx, ny, layers = settings["grid"]
        finer = (2 * nx - 1, 2 * ny - 1, layers)
        if large or has_room(scene, Candidate(model, {"grid": finer})):
            progress("looking at cells half as large")
            finer_lattice = replace(
                lattice, grid=finer, calibration=settings["calibration"], grading=of_settings(settings)
            )
            steps = _refinement(scene, measured, unknowns, best.x, finer_lattice, offset)
        else:
            unseen = ["cells half as large take more memory than is free: the grid's error is not known"]
    found = {
        u.name: Found(
            u.value(x),
            u.interval(x, known.half_widths[u.name]),
            u.start,
            u.unit,
            None if step is None else u.value(float(np.clip(x + step, *u.bounds()))),
        )
        for u, x, step in zip(unknowns, best.x, steps, strict=True)
    }
    noise = float(np.sqrt(final @ final / (len(final) - len(unknowns))))
    warnings = [
        *known.warnings,
        *unseen,
        *(
            f"{u.name} ended at {quantity(u.value(x), u.unit)}, as far from the scene's own value as the "
            "search goes: the data pull it further"
            for u, x, active in zip(unknowns, best.x, best.against_bounds, strict=True)
            if active
        ),
    ]
    warnings += [
        f"{u.name} would be {quantity(refined, u.unit)} on cells half as large: the grid's error is not "
        "small beside the interval"
        for u, step in zip(unknowns, steps, strict=True)
        if step is not None
        and (refined := found[u.name].refined) is not None
        and known.half_widths[u.name] < inf
        and abs(step) > known.half_widths[u.name] / 3.0
    ]
    if noise > POOR:
        turned = " and ".join(misfit.turned(final))
        warnings.append(
            f"a poor fit, off by {100 * noise:.2g} % of the largest measurement: no value of "
            f"{', '.join(names)} explains these data; look at frame, supports and model"
            + (turned and f": the measured {turned} point the other way than the model's")
        )
    if model != "lumped":
        last = set_in(scene, unknowns, best.x)
        solved = solve_reference(last, model=model, elements=elements, large=True, **_of_law(law))
        warnings += strain_law.said(last, law, solved.stretch)
    return Identification(
        scene=scene,
        measured=measured,
        model=model,
        settings=settings,
        unknowns=found,
        residuals=misfit.per_point(final),
        noise=measured.scale * noise,
        relative=float(np.abs(final).max()),
        evaluations=best.evaluations,
        converged=best.converged,
        warnings=tuple(warnings),
    )


def _refinement(
    scene: Scene,
    measured: Measured,
    unknowns: tuple[Unknown, ...],
    x: np.ndarray,
    finer: LatticeSpec,
    offset: float,
) -> list[float | None]:
    """The Gauss–Newton step of x on a finer lattice, of what the data see; None where that lattice has no
    answer."""
    predict, _, axes = _predictor(scene, measured, "lumped", finer, 0)
    misfit = Misfit(measured, axes, offset)
    try:
        residuals, slopes = misfit.of(predict(unknowns, x, misfit.asked))
    except NotReached:
        return [None] * len(unknowns)
    step, *_ = np.linalg.lstsq(slopes, -residuals, rcond=Identifiability.threshold)
    return list(step.tolist())


def _moving(measured: Measured) -> bool:
    return isinstance(measured, Displacements) and measured.time is not None


def _check(
    measured: Measured,
    unknowns: tuple[Unknown, ...],
    model: str,
    lattice: LatticeSpec,
    elements: Elements,
    law: str | None,
) -> None:
    names = [u.name for u in unknowns]
    repeated = {name for name in names if names.count(name) > 1}
    if not names or repeated:
        raise BadInput(f"unknown = '{','.join(names)}': name each once, and at least one")
    if model not in MODELS:
        raise BadInput(f"model = '{model}': unknown, choose one of {', '.join(MODELS)}")
    if model == "lumped":
        if law is not None:
            raise BadInput(f"law = '{law}': of a shell or solid; the lattice's is that of its springs")
        if CALIBRATIONS[method_of(lattice.calibration, lattice.k)].fitted:
            raise BadInput(
                f"calibration = '{lattice.calibration}': its springs do not follow from what is sought"
            )
        if lattice.k is not None and (fixed := [name for name in names if name in ("young", "poisson")]):
            raise BadInput(
                f"unknown = '{fixed[0]}': with k = {lattice.k:g} N/m given the springs do not depend on it; "
                "leave k out"
            )
    else:
        check_reference(model, elements, _of_law(law))
    moving = _moving(measured)
    still = [name for name in names if name in DAMPING]
    if still and not moving:
        raise BadInput(
            f"unknown = '{still[0]}': an equilibrium does not depend on it; it takes a measured motion, "
            "a CSV with a column time [s]"
        )
    if moving and model != "lumped":
        raise BadInput(f"model = '{model}': a measured motion (column time) is followed by the lattice only")


def _predictor(
    scene: Scene,
    measured: Measured,
    model: str,
    asked: LatticeSpec,
    elements: Elements,
    law: str | None = None,
    progress: Progress = silent,
) -> tuple[Predictor, dict[str, Any], tuple[np.ndarray, np.ndarray]]:
    """The predictor, its settings, and the plan grid on which it gives a whole surface."""
    if model == "lumped":
        chosen = resolve(scene, asked, own=False)
        settings = {"grid": list(chosen.grid), "calibration": chosen.calibration, **chosen.options}
        settings |= {**as_settings(chosen.grading or 0.0), **chosen.reasons}
        axes = surface.plan_grid(scene.sheet.lengths, chosen.grid[:2])
        if isinstance(measured, Displacements) and measured.time is not None:
            return motion(scene, chosen.springs, measured.time), settings, axes
        return lattice(scene, chosen.springs), settings, axes
    along_x, along_y = near_square(scene.sheet, elements) if isinstance(elements, int) else elements
    axes = surface.plan_grid(scene.sheet.lengths, (2 * along_x + 1, 2 * along_y + 1))
    settings = {"elements": [along_x, along_y], **_of_law(law)}
    return reference(scene, model, elements, progress, **_of_law(law)), settings, axes


def _of_law(law: str | None) -> dict[str, Any]:
    return {} if law is None else {"law": law}

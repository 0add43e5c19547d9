"""The cheapest model that is accurate enough for a scene, or the most accurate one in a given time.

Dimensionless numbers (`comparisons.models.scales`) exclude some models; quick trial solves
(`comparisons.tradeoff.trials`) decide among the others. A model is adequate if its error from the reference,
the reference's error bar and the reference's model error (`comparisons.sweep.model_error`) together are
within the tolerance; if the bar leaves this open, the reference is refined. A model error above the tolerance
is reported, and the choice then meets the tolerance against a converged shell only. The predicted error is
the error from the reference, the predicted time is measured here.

The advice lists effects that the scene needs and effects left out: "bending" is always needed; "transverse
shear" and "membrane stiffening" if they have a share of the energy; "large displacements" if the linear
answer is inaccurate; and "actuators" if the scene has some. A static answer needs no dynamics.
"""

from collections.abc import Sequence

from comparisons.comparison.comparison import load_static
from comparisons.models.spec import Lattice, Spec
from comparisons.sweep.in_process import LocalSolve
from comparisons.sweep.model_error import left_for_grid
from comparisons.tradeoff.advice import Advice
from comparisons.tradeoff.trials import TrialSolves
from sheetbench.choices import REFERENCE
from sheetbench.errors import BadInput
from sheetbench.scenes import AnyScene
from sheetbench.scenes.objects.grid import DEFAULT_MASSES

NEGLIGIBLE = 0.25  # of the tolerance: smaller effects are left out
LINEAR_LOAD_NUMBER = 2.0  # linear models are not tried above it
FINEST_BAR = 0.1  # of the tolerance: the reference is not refined for a smaller error bar


def advise(
    scene: AnyScene,
    tolerance: float | None = None,
    budget: float | None = None,
    lattice: Lattice = Lattice(),  # noqa: B008  # frozen
    *,
    models: Sequence[str] | None = None,
) -> Advice:
    """Return advice on the cheapest model within `tolerance`, or on the most accurate one within `budget`
    [s].

    tolerance: a fraction, by default 0.01 unless a budget is given. If both limits are given and the cheapest
    model within the tolerance exceeds the budget, the most accurate one within the budget is chosen, and
    `succeeded` is false. lattice: springs and grading of the lattices; models: a selection of "lumped",
    "plate", "shell". Models that need more memory than is free are left out. Raises SceneError for a scene
    without a static answer; BadInput if not even the coarsest reference fits into memory, for a grid, and for
    contradictory springs and grading.
    """
    scene = load_static(scene)
    if budget is not None and not budget > 0.0:
        raise BadInput(f"budget = {budget:g}: seconds, more than 0")
    if tolerance is None and budget is None:
        tolerance = 0.01
    if tolerance is not None and not 0.0 < tolerance < 1.0:
        raise BadInput(f"tolerance = {tolerance:g}: a fraction between 0 and 1, as 0.01 for one percent")
    trials = TrialSolves(scene, lattice, models)
    for _ in range(3):
        trials.refine()
    while not trials.reference.stable and trials.refine():
        pass
    if not trials.reference.stable:
        answer = trials.reference.answer
        reason = f"the shell finds no stable equilibrium: {answer.status}: {answer.message}"
        return _advice(trials, tolerance, budget, None, reason)
    linear = not (scene.actuators or scene.obstacles) and trials.scales.span_load_number <= LINEAR_LOAD_NUMBER
    candidates = trials.candidates(linear)
    for candidate in candidates[:3]:
        trials.try_row(candidate)
    if linear:  # for the predicted times of both linear models
        trials.try_row(trials.lattice(4, linear=True))
        trials.row(trials.elements("plate", 4))
    model = trials.model_error.value if trials.model_error else 0.0
    chosen, message = None, ""
    if tolerance is not None:
        chosen = _cheapest(trials, candidates, left_for_grid(tolerance, model))
        if chosen is None:
            message = (
                f"no model here is within {100 * tolerance:g} % for certain; this is the most accurate one"
            )
        elif model >= tolerance:
            message = f"within {100 * tolerance:g} % of a converged shell, whose own model error is larger"
    if budget is not None and (chosen is None or chosen.seconds > budget):
        chosen = _most_accurate(trials, candidates, budget)
        message = f"no model solves this in {budget:g} s" if chosen is None else ""
        if tolerance is not None and chosen is not None:
            message = (
                f"{100 * tolerance:g} % takes longer than {budget:g} s; this is the most accurate in time"
            )
    elif chosen is None:
        chosen = _nearest(trials, candidates)
    return _advice(trials, tolerance, budget, chosen, message)


def _cheapest(trials: TrialSolves, candidates: list[Spec], tolerance: float) -> LocalSolve | None:
    """Return the quickest candidate that is certainly within the tolerance."""
    best: LocalSolve | None = None
    remaining = list(candidates)
    while remaining:
        remaining.sort(key=trials.predicted_seconds)
        candidate = remaining.pop(0)
        if best is not None and trials.predicted_seconds(candidate) > 1.3 * best.seconds:
            return best
        trial = trials.try_row(candidate)
        if trial is None or not _adequate(trials, trial, tolerance):
            continue
        if best is None or trial.seconds < best.seconds:
            best = trial
    return best


def _adequate(trials: TrialSolves, trial: LocalSolve, tolerance: float) -> bool:
    """Return whether a trial is within the tolerance; refine the reference until this is certain."""
    while True:
        error, bar = trials.error(trial), trials.uncertainty
        if error + bar <= tolerance:
            return True
        if error - bar > tolerance or bar <= FINEST_BAR * tolerance or not trial.stable:
            return False
        if not trials.refine():
            return False


def _most_accurate(trials: TrialSolves, candidates: list[Spec], budget: float) -> LocalSolve | None:
    """Return the candidate of least error within the budget [s], None if all take longer."""
    best: LocalSolve | None = None
    for candidate in candidates:
        if trials.predicted_seconds(candidate) > 1.5 * budget:
            continue
        trial = trials.try_row(candidate)
        if trial is None or not trial.stable or trial.seconds > budget:
            continue
        if best is None or trials.error(trial) < trials.error(best):
            best = trial
    return best


def _nearest(trials: TrialSolves, candidates: list[Spec]) -> LocalSolve | None:
    """Return the trial of least error, the reference itself if it may be chosen."""
    if trials.models is None or REFERENCE in trials.models:
        return trials.reference
    rows = [trials.rows[spec] for spec in candidates if spec in trials.rows]
    return min((row for row in rows if row.stable), key=trials.error, default=None)


def _advice(
    trials: TrialSolves,
    tolerance: float | None,
    budget: float | None,
    chosen: LocalSolve | None,
    message: str,
) -> Advice:
    needs, left_out = _effects(trials, chosen, tolerance or 0.01)
    spec = None if chosen is None else chosen.request.spec
    grid = (spec if isinstance(spec, Lattice) else trials.lattice(DEFAULT_MASSES - 1)).grid
    lattice = trials.resolved(trials.springs.but(grid=grid))
    reasons = tuple(f"{name.removesuffix('_reason')}: {text}" for name, text in lattice.reasons.items())
    return Advice(trials, tolerance, budget, chosen, message, needs, left_out, reasons)


def _effects(
    trials: TrialSolves, chosen: LocalSolve | None, tolerance: float
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the effects that the scene needs, and the effects left out of the chosen model."""
    needs, left_out = ["bending"], ["dynamics: the question is static"]
    small = NEGLIGIBLE * tolerance
    energies = trials.reference.answer.energies
    total = sum(energies.values()) or 1.0
    for name, part in (("transverse shear", "shear"), ("membrane stiffening", "membrane")):
        share = energies.get(part, 0.0) / total
        if share > small:
            needs.append(name)
        else:
            left_out.append(f"{name}: {100 * share:.1g} % of the energy")
    linear = not trials.scene.obstacles  # linear models have no contact
    error = trials.error(trials.row(trials.elements("plate", 4))) if linear else float("inf")
    if error > tolerance:
        needs.append("large displacements")
    elif chosen is not None and (
        getattr(chosen.request.spec, "linear", False) or chosen.request.spec.model == "plate"
    ):
        left_out.append(f"nonlinearity: the linear answer is {100 * error:.1g} % off")
    if trials.scene.actuators:
        needs.append("actuators")
    return tuple(needs), tuple(left_out)

"""The cheapest model that is accurate enough for a scene, or the most accurate one in a given time.

Scales (`comparisons.models.scales`) decide what may be left out; a few quick solves
(`comparisons.tradeoff.trials`) decide the rest. A model is adequate if its distance from the reference, the
reference's error bar and what the reference leaves out on every mesh (`comparisons.sweep.model_error`)
are together within the tolerance; where the bar leaves that open the reference is refined. Where the last
alone is above the tolerance, the choice meets it against a converged shell only, and the advice says so.
Predicted error: the distance; predicted time: as measured here.

What is left out is reported, and what the scene needs: "bending" always; "transverse shear" and "membrane
stiffening" where they hold a share of the energy; "large displacements" where the linear answer is off; and
"actuators" where there are some. A static question needs no dynamics.
"""

from __future__ import annotations

from collections.abc import Sequence

from comparisons.comparison.comparison import load_static
from comparisons.models.spec import Lattice, Spec
from comparisons.sweep.here import SolvedHere
from comparisons.sweep.model_error import left_for_grid
from comparisons.tradeoff.advice import Advice
from comparisons.tradeoff.trials import TrialSolves
from sheetbench.choices import REFERENCE
from sheetbench.errors import BadInput
from sheetbench.scenes import AnyScene
from sheetbench.scenes.objects.grid import MASSES

NEGLIGIBLE = 0.25  # of the tolerance: an effect smaller than that is left out
LINEAR_LOAD_NUMBER = 2.0  # beyond which no linear model is worth trying
STEEP = 0.1  # of the tolerance: the finest error bar a decision may hang on


def advise(
    scene: AnyScene,
    tolerance: float | None = None,
    budget: float | None = None,
    lattice: Lattice = Lattice(),  # noqa: B008  # frozen
    *,
    models: Sequence[str] | None = None,
) -> Advice:
    """Return the cheapest model predicted to meet `tolerance` (a fraction; 0.01 unless a budget
    alone is given), or the most accurate in `budget` [s].

    models: only these, of "lumped", "plate", "shell". With both limits: the cheapest model that meets the
    tolerance; where it takes longer than the budget, the most accurate one in time, and `succeeded` is false.
    lattice: springs and grading of the lattices that may be chosen. Models that take more memory
    than there is are left out. Raises SceneError for a scene without a static answer; BadInput where not even
    the coarsest reference fits into memory, for a grid, and for springs and grading that contradict each
    other.
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
        failed = trials.reference.answer
        reason = f"the shell finds no stable equilibrium: {failed.status}: {failed.message}"
        return _advice(trials, tolerance, budget, None, reason)
    linear = not (scene.actuators or scene.obstacles) and trials.scales.span_load_number <= LINEAR_LOAD_NUMBER
    candidates = trials.candidates(linear)
    for candidate in candidates[:3]:
        trials.tried(candidate)
    if linear:  # each family's rate
        trials.tried(trials.lattice(4, linear=True))
        trials.row(trials.elements("plate", 4))
    model = trials.model_error.value if trials.model_error else 0.0
    chosen, message = None, ""
    if tolerance is not None:
        beyond = model >= tolerance
        chosen = _cheapest(trials, candidates, left_for_grid(tolerance, model))
        if chosen is None:
            message = (
                f"no model here is within {100 * tolerance:g} % for certain; this is the most accurate one"
            )
        elif beyond:
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


def _cheapest(trials: TrialSolves, candidates: list[Spec], tolerance: float) -> SolvedHere | None:
    """Return the quickest candidate that is certainly within the tolerance."""
    found: SolvedHere | None = None
    left = list(candidates)
    while left:
        left.sort(key=trials.predicted_seconds)
        candidate = left.pop(0)
        if found is not None and trials.predicted_seconds(candidate) > 1.3 * found.seconds:
            return found
        trial = trials.tried(candidate)
        if trial is None or not _adequate(trials, trial, tolerance):
            continue
        if found is None or trial.seconds < found.seconds:
            found = trial
    return found


def _adequate(trials: TrialSolves, trial: SolvedHere, tolerance: float) -> bool:
    """Return whether a trial is within the tolerance; the reference is refined until that is certain."""
    while True:
        error, bar = trials.error(trial), trials.uncertainty
        if error + bar <= tolerance:
            return True
        if error - bar > tolerance or bar <= STEEP * tolerance or not trial.stable:
            return False
        if not trials.refine():
            return False


def _most_accurate(trials: TrialSolves, candidates: list[Spec], budget: float) -> SolvedHere | None:
    """Return the candidate of least error among those that take no longer than the budget [s]."""
    found: SolvedHere | None = None
    for candidate in candidates:
        if trials.predicted_seconds(candidate) > 1.5 * budget:
            continue
        trial = trials.tried(candidate)
        if trial is None or not trial.stable or trial.seconds > budget:
            continue
        if found is None or trials.error(trial) < trials.error(found):
            found = trial
    return found


def _nearest(trials: TrialSolves, candidates: list[Spec]) -> SolvedHere | None:
    """Return the trial of least error: the reference, but where that is no candidate."""
    if trials.models is None or REFERENCE in trials.models:
        return trials.reference
    tried = [trials.rows[one] for one in candidates if one in trials.rows]
    return min((one for one in tried if one.stable), key=trials.error, default=None)


def _advice(
    trials: TrialSolves,
    tolerance: float | None,
    budget: float | None,
    chosen: SolvedHere | None,
    message: str,
) -> Advice:
    needs, left_out = _effects(trials, chosen, tolerance or 0.01)
    spec = None if chosen is None else chosen.ask.spec
    grid = (spec if isinstance(spec, Lattice) else trials.lattice(MASSES - 1)).grid
    lattice = trials.resolved(trials.springs.but(grid=grid))
    reasons = tuple(f"{name.removesuffix('_reason')}: {why}" for name, why in lattice.reasons.items())
    return Advice(trials, tolerance, budget, chosen, message, needs, left_out, reasons)


def _effects(
    trials: TrialSolves, chosen: SolvedHere | None, tolerance: float
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return what the scene needs of a model, and what is left out of the chosen one."""
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
    linear = not trials.scene.obstacles  # which no linear model knows
    off = trials.error(trials.row(trials.elements("plate", 4))) if linear else float("inf")
    if off > tolerance:
        needs.append("large displacements")
    elif chosen is not None and (
        getattr(chosen.ask.spec, "linear", False) or chosen.ask.spec.model == "plate"
    ):
        left_out.append(f"nonlinearity: the linear answer is {100 * off:.1g} % off")
    if trials.scene.actuators:
        needs.append("actuators")
    return tuple(needs), tuple(left_out)

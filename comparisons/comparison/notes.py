"""Notes of a comparison: error bars, models and choices, in sentences."""

from __future__ import annotations

from comparisons.comparison.errors import Compared
from comparisons.models.grading import choice_notes
from sheetbench.scenes.language.summary import few

BUCKLED = (
    "branch buckled: a model whose equilibrium under the whole load is unstable leaves it along its lowest "
    "mode; what is shown is the stable equilibrium that it comes to, one of several."
)


def notes(of: Compared) -> list[str]:
    """Return what to know of the errors first, then the models and what was chosen for them, and what the
    percentages mean."""
    ref, first = f"u_{of.reference.model}", of.solutions[0].model
    return [
        *([BUCKLED] if of.reference.settings.get("branch") == "buckled" else []),
        *([f"{first}: {of.expected}"] if of.expected else []),
        *_bar_notes(of),
        *dict.fromkeys(note for s in of.solutions for note in choice_notes(s.settings)),
        " · ".join(solution.label for solution in of.solutions),
        f"difference: |u − {ref}| / |{ref}| at the probe. "
        f"error: largest component of u − {ref} over the probes / largest component of {ref}."
        + " ±: mesh or grid error of the model at the probe."
        * bool(of.bars),
    ]


def _bar_notes(of: Compared) -> list[str]:
    """Return the reference's error bar in words, the models that differ from it by less, and what is due to
    laws of strain."""
    found, model = [of.laws] if of.laws else [], of.reference.model
    for solution in of.solutions:
        if solution.bar is not None:
            own = few(100.0 * (of.bar_of(solution) or 0.0))
            found.append(f"{solution.model}: grid error ± {own} %, from its two grids.")
    if of.bar is None:
        return found
    found.append(of.bar.note(model))
    found += [f"{model}: {left_out}."] if (left_out := str(of.model_error or "")) else []
    for solution in of.solutions:
        close = [d.probe for d in of.differences if d.of == solution.model and d.distinguishable is False]
        if of.distinguishable(solution) is False:
            found.append(f"{solution.model}: not distinguishable from {model}.")
        elif close:
            found.append(f"{solution.model}: not distinguishable from {model} at {', '.join(close)}.")
    return found

"""A score's verdict in a sentence: likely mistakes, a wrong stiffness in most cases, or the number of correct
cases.

The ratio of an answer to the reference is r = (u · u_ref) / (u_ref · u_ref). Displacements under a given load
are proportional to 1/E, frequencies to √E, so the stiffness is wrong by 1/r − 1, or r² − 1. This is reported
if at least four fifths of the cases deviate to one side by more than the reference's bar (cases with
prescribed displacements do not depend on E).
"""

from collections.abc import Sequence
from statistics import median

import numpy as np

from comparisons.scoring.answers import Answer
from sheetbench.answers.table import percent

SHARE, LEAST = 0.8, 0.005  # of the cases; relative deviation of the stiffness


def verdict(answers: Sequence[Answer], errors: Sequence[float], faults: Sequence[str]) -> str:
    """Return the verdict; errors: of the answers; faults: sentences on likely mistakes."""
    if faults:
        return f"Verdict: {'; '.join(faults)}."
    cases = len(answers)
    within = sum(error <= answer.reference.bar for answer, error in zip(answers, errors, strict=True))
    if within == cases:
        return f"Verdict: not distinguishable from the reference in {_all(cases)}."
    worst, error = max(zip(answers, errors, strict=True), key=lambda pair: pair[1])
    sentence = f"{within} of {cases} cases within the reference's bar"
    stiffer = stiffness(answers)
    if stiffer is not None:
        side = "stiff" if stiffer > 0.0 else "soft"
        which = _all(cases) if within == 0 else "most cases"
        sentence = f"{which} too {side} by about {percent(abs(stiffer))}; {sentence}"
    return f"Verdict: {sentence}; worst {worst.reference.name}, {percent(error)} off."


def stiffness(answers: Sequence[Answer]) -> float | None:
    """Return the relative excess stiffness common to most answers, None if there is none."""
    if answers[0].reference.suite == "motion":
        return None
    deviations = [_stiffer(answer) for answer in answers]
    for side in (1.0, -1.0):
        pairs = zip(deviations, answers, strict=True)
        beyond = [value for value, answer in pairs if side * value > answer.reference.bar]
        if len(beyond) >= SHARE * len(deviations) and abs(median(beyond)) > LEAST:
            return float(median(beyond))
    return None


def _stiffer(answer: Answer) -> float:
    values, truth = answer.values.ravel(), answer.reference.values.ravel()
    ratio = float(values @ truth) / float(np.sum(truth**2))
    if ratio <= 0.0:
        return 0.0
    return ratio**2 - 1.0 if answer.reference.suite == "modes" else 1.0 / ratio - 1.0


def _all(cases: int) -> str:
    return "the one case" if cases == 1 else f"all {cases} cases"

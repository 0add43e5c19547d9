"""What a score comes to, in a sentence: a slip, a stiffness that is off throughout, or how many cases are
met.

The ratio of an answer to the reference is r = (u · u_ref) / (u_ref · u_ref). Under a given load a
displacement goes as 1/E, a frequency as √E: the stiffness is off by 1/r − 1, or r² − 1. It is reported where
all but a fifth of the cases are off to the same side by more than the reference's bar (a case whose
displacements are prescribed knows nothing of E).
"""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median

import numpy as np

from comparisons.scoring.answers import Answer
from sheetbench.answers.table import percent

SHARE, LEAST = 0.8, 0.005  # of the cases; of the stiffness


def verdict(answers: Sequence[Answer], errors: Sequence[float], faults: Sequence[str]) -> str:
    """The sentence; errors: of the answers, faults: sentences."""
    if faults:
        return f"Verdict: {'; '.join(faults)}."
    cases = len(answers)
    within = sum(error <= answer.reference.bar for answer, error in zip(answers, errors, strict=True))
    if within == cases:
        return f"Verdict: not distinguishable from the reference in {_all(cases)}."
    worst, off = max(zip(answers, errors, strict=True), key=lambda both: both[1])
    sentence = f"{within} of {cases} cases within the reference's bar"
    stiffer = stiffness(answers)
    if stiffer is not None:
        side = "stiff" if stiffer > 0.0 else "soft"
        which = _all(cases) if within == 0 else "most cases"
        sentence = f"{which} too {side} by about {percent(abs(stiffer))}; {sentence}"
    return f"Verdict: {sentence}; worst {worst.reference.name}, {percent(off)} off."


def stiffness(answers: Sequence[Answer]) -> float | None:
    """How much stiffer than the reference the answers are throughout, a fraction; None where they are not."""
    if answers[0].reference.suite == "motion":
        return None
    off = [_stiffer(answer) for answer in answers]
    for side in (1.0, -1.0):
        both = zip(off, answers, strict=True)
        beyond = [one for one, answer in both if side * one > answer.reference.bar]
        if len(beyond) >= SHARE * len(off) and abs(median(beyond)) > LEAST:
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

"""Likely mistakes in answers, detected by comparison with the reference: units, signs, swapped probes.

Detected mistakes are corrected before the next test, so several at once are reported:

    unit    a case a thousand times too large or small, within a factor of 3; frequencies 2π times too large:
            rad/s
    sign    a component whose correlation with the reference's is below −0.9
    swap    two probes whose exchange reduces a large error to less than a quarter
"""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from comparisons.scoring.answers import Answer
from sheetbench.choices import listed

FACTOR, RATIO = 1000.0, 3.0
OPPOSITE = -0.9
SIGNIFICANT = 0.01  # of the largest displacement: smaller components and errors are ignored
REDUCTION = 0.25
AXES = ("ux", "uy", "uz")


def faults(answers: Sequence[Answer]) -> list[str]:
    """Return a sentence per mistake, with the names of its cases."""
    cases: dict[str, list[str]] = {}
    for answer in answers:
        values, of_modes = answer.values, answer.reference.suite == "modes"
        for correct in (_frequency,) if of_modes else (_unit, _sign, _swap):
            sentences, values = correct(answer, values)
            for sentence in sentences:
                cases.setdefault(sentence, []).append(answer.reference.name)
    return [f"{sentence} in {_listed(names, len(answers))}" for sentence, names in cases.items()]


def _listed(names: list[str], total: int) -> str:
    if len(names) == total and total > 1:
        return f"all {total} cases"
    return f"{', '.join(names[:3])}{f' and {len(names) - 3} more' if len(names) > 3 else ''}"


Corrected = tuple[list[str], np.ndarray]  # sentences on mistakes, and the values without them


def _frequency(answer: Answer, values: np.ndarray) -> Corrected:
    ratio = float(np.linalg.norm(values) / np.linalg.norm(answer.reference.values)) / (2.0 * np.pi)
    if abs(ratio - 1.0) >= 0.1:
        return [], values
    return ["frequencies are 2π times too large, as in rad/s for Hz,"], values / (2.0 * np.pi)


def _unit(answer: Answer, values: np.ndarray) -> Corrected:
    ratio = float(np.linalg.norm(values) / np.linalg.norm(answer.reference.values))
    for factor, size in ((FACTOR, "large, as in mm for m,"), (1.0 / FACTOR, "small")):
        if 1.0 / RATIO < ratio / factor < RATIO:
            return [f"displacements are 1000 times too {size}"], values / factor
    return [], values


def _sign(answer: Answer, values: np.ndarray) -> Corrected:
    truth = answer.reference.values
    largest = np.abs(truth).max()
    flipped = [
        axis
        for axis in range(3)
        if np.abs(truth[..., axis]).max() > SIGNIFICANT * largest
        and _correlation(values, truth, axis) < OPPOSITE
    ]
    if not flipped:
        return [], values
    corrected = values.copy()
    corrected[..., flipped] *= -1.0
    names = listed([AXES[axis] for axis in flipped], "and")
    return [f"{names} {'have' if len(flipped) > 1 else 'has'} the opposite sign"], corrected


def _correlation(values: np.ndarray, truth: np.ndarray, axis: int) -> float:
    a, b = values[..., axis].ravel(), truth[..., axis].ravel()
    size = float(np.linalg.norm(a) * np.linalg.norm(b))
    return float(a @ b) / size if size > 0.0 else 0.0


def _swap(answer: Answer, values: np.ndarray) -> Corrected:
    truth, names = answer.reference.values, list(answer.reference.scene.probes)
    error = _error(values, truth)
    if len(names) < 2 or error <= max(SIGNIFICANT, 3.0 * answer.reference.bar):
        return [], values

    def swapped(pair: tuple[int, int]) -> np.ndarray:
        out = values.copy()
        out[list(pair)] = values[list(pair[::-1])]
        return out

    best = min(combinations(range(len(names)), 2), key=lambda pair: _error(swapped(pair), truth))
    if _error(swapped(best), truth) > REDUCTION * error:
        return [], values
    return [f"probes {names[best[0]]} and {names[best[1]]} look swapped"], swapped(best)


def _error(values: np.ndarray, truth: np.ndarray) -> float:
    return float(np.abs(values - truth).max() / np.abs(truth).max())

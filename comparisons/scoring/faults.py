"""What is wrong with answers, as far as the reference tells: units, signs, times, swapped probes.

Each is looked for in what is left when those before it are mended, so that several at once are named:

    unit    a case a thousand times too large or small, within a factor of 3; of frequencies 2π: rad/s
    sign    a component that correlates with the reference's by less than −0.9
    time    a motion that is the reference's earlier or later, u(t) = u_ref(t − s), where moving it back by s
            leaves less than a quarter of an error that is no small one
    start   a motion whose first sample is not the flat sheet's
    swap    two probes, where exchanging them leaves less than a quarter of an error that is no small one
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from scipy.interpolate import CubicSpline

from comparisons.scoring.answers import Answer

FACTOR, NEAR = 1000.0, 3.0
OPPOSITE = -0.9
SEEN = 0.01  # of the largest displacement: components and errors that mean something
MENDED = 0.25
LONGEST, PER_SAMPLE = 0.25, 4  # share of a motion that times are looked for within; lags tried a sample
AXES = ("ux", "uy", "uz")


def faults(answers: Sequence[Answer]) -> list[str]:
    """Sentences, one a fault, that name the cases."""
    cases: dict[str, list[str]] = {}
    for answer in answers:
        values, of_modes = answer.values, answer.reference.suite == "modes"
        for mend in (_frequency,) if of_modes else (_unit, _sign, _time, _start, _swap):
            sentences, values = mend(answer, values)
            for sentence in sentences:
                cases.setdefault(sentence, []).append(answer.reference.name)
    return [f"{sentence} in {_named(names, len(answers))}" for sentence, names in cases.items()]


def _named(names: list[str], of: int) -> str:
    if len(names) == of and of > 1:
        return f"all {of} cases"
    return f"{', '.join(names[:3])}{f' and {len(names) - 3} more' if len(names) > 3 else ''}"


Mended = tuple[list[str], np.ndarray]


def _frequency(answer: Answer, values: np.ndarray) -> Mended:
    ratio = float(np.linalg.norm(values) / np.linalg.norm(answer.reference.values)) / (2.0 * np.pi)
    if abs(ratio - 1.0) >= 0.1:
        return [], values
    return ["frequencies are 2π times too large, as in rad/s for Hz,"], values / (2.0 * np.pi)


def _unit(answer: Answer, values: np.ndarray) -> Mended:
    ratio = float(np.linalg.norm(values) / np.linalg.norm(answer.reference.values))
    for factor, size in ((FACTOR, "large, as in mm for m,"), (1.0 / FACTOR, "small")):
        if 1.0 / NEAR < ratio / factor < NEAR:
            return [f"displacements are 1000 times too {size}"], values / factor
    return [], values


def _sign(answer: Answer, values: np.ndarray) -> Mended:
    truth = answer.reference.values
    largest = np.abs(truth).max()
    flipped = [
        axis
        for axis in range(3)
        if np.abs(truth[..., axis]).max() > SEEN * largest and _correlation(values, truth, axis) < OPPOSITE
    ]
    if not flipped:
        return [], values
    mended = values.copy()
    mended[..., flipped] *= -1.0
    names = _listed([AXES[axis] for axis in flipped])
    return [f"{names} {'have' if len(flipped) > 1 else 'has'} the opposite sign"], mended


def _listed(names: list[str]) -> str:
    """The names as a sentence has them: ux, uy and uz."""
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


def _correlation(values: np.ndarray, truth: np.ndarray, axis: int) -> float:
    a, b = values[..., axis].ravel(), truth[..., axis].ravel()
    size = float(np.linalg.norm(a) * np.linalg.norm(b))
    return float(a @ b) / size if size > 0.0 else 0.0


def _time(answer: Answer, values: np.ndarray) -> Mended:
    truth, time = answer.reference.values, answer.reference.time
    if time is None or not _matters(answer, values):
        return [], values
    motion, every = CubicSpline(time, values, axis=1), time[-1] / (len(time) - 1)
    most = int(LONGEST * (len(time) - 1) * PER_SAMPLE)

    def back(lag: float) -> np.ndarray:
        """What it would be without the lag, and the reference where that is beyond what is given."""
        there = (time + lag >= 0.0) & (time + lag <= time[-1])
        return np.where(there[:, None], motion(time + lag), truth)

    lags = every / PER_SAMPLE * np.arange(-most, most + 1)
    lag = min(lags, key=lambda lag: _error(back(lag), truth))
    if _error(back(lag), truth) > MENDED * _error(values, truth):
        return [], values
    side = "late" if lag > 0.0 else "early"
    return [f"motion is {1e3 * abs(lag):.3g} ms too {side}, for t = 0 is when loads are put on,"], back(lag)


def _start(answer: Answer, values: np.ndarray) -> Mended:
    truth = answer.reference.values
    if answer.reference.time is None or np.abs(values[:, 0]).max() < SEEN * np.abs(truth).max():
        return [], values
    return ["displacements at t = 0 are not zero, as of the flat sheet,"], values - values[:, :1]


def _swap(answer: Answer, values: np.ndarray) -> Mended:
    truth, names = answer.reference.values, list(answer.reference.scene.probes)
    if len(names) < 2 or not _matters(answer, values):
        return [], values

    def swapped(pair: tuple[int, int]) -> np.ndarray:
        found = values.copy()
        found[list(pair)] = values[list(pair[::-1])]
        return found

    best = min(combinations(range(len(names)), 2), key=lambda pair: _error(swapped(pair), truth))
    if _error(swapped(best), truth) > MENDED * _error(values, truth):
        return [], values
    return [f"probes {names[best[0]]} and {names[best[1]]} look swapped"], swapped(best)


def _matters(answer: Answer, values: np.ndarray) -> bool:
    """Whether an error is no small one."""
    return _error(values, answer.reference.values) > max(SEEN, 3.0 * answer.reference.bar)


def _error(values: np.ndarray, truth: np.ndarray) -> float:
    return float(np.abs(values - truth).max() / np.abs(truth).max())

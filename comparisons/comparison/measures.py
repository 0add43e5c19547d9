"""Measures of a motion: peak, period and decay, and differences between motions.

Measures are taken of one component of one probe, the one with the reference's largest displacement. Extrema
with a prominence of at least a twentieth of its range count; their place between samples is a parabola's:

    peak     first extremum [m], with its time
    period   twice the mean time between consecutive extrema
    decay    logarithmic decrement per period, 2 ln(D_first/D_last)/(n − 1), of the n differences D between
             consecutive extrema, which does not need the position at rest

Two motions are compared by their first extrema that match: both maxima or both minima, and closer in time
than half the reference's distance from its previous extremum. Several motions are compared by the number of
extrema that all have. Differences are over the reference's largest component.
"""

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from sheetbench.answers.history import History
from sheetbench.answers.table import MILLIMETRES, MILLISECONDS, NUMBER

PROMINENCE = 0.05  # of the range of a component


@dataclass(frozen=True)
class Measures:
    """Measures of a model's motion, each None with too few extrema; peak [m] at peak_time [s]; period [s];
    decay: logarithmic decrement per period; last: time of the last matching extremum [s]."""

    peak: Annotated[float | None, MILLIMETRES("z.3f", "first peak")] = None
    peak_time: Annotated[float | None, MILLISECONDS("z.2f", "at")] = None
    period: Annotated[float | None, MILLISECONDS("z.2f")] = None
    decay: Annotated[float | None, NUMBER("z.4f", "log decrement")] = None
    last: float | None = None
    model: str = ""

    @property
    def damping(self) -> Annotated[float | None, NUMBER("z.4f", "damping ratio")]:
        """Damping ratio that belongs to the decrement."""
        return None if self.decay is None else float(self.decay / np.hypot(2.0 * np.pi, self.decay))

    def as_dict(self) -> dict[str, float | None]:
        """Return the measures as JSON data."""
        return {key: value for key, value in vars(self).items() if key not in ("last", "model")}


def leading(history: History) -> tuple[str, int]:
    """Return the probe and the component of largest displacement."""
    probe = max(history.probes, key=lambda name: float(np.abs(history.probes[name]).max()))
    return probe, int(np.abs(history.probes[probe]).max(axis=0).argmax())


def extrema(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return times [s], values and second differences (n, 3) of the prominent extrema."""
    from scipy.signal import find_peaks

    least = PROMINENCE * float(np.ptp(values))
    if least == 0.0:
        return np.zeros((0, 3))
    at = np.sort(np.concatenate([find_peaks(sign * values, prominence=least)[0] for sign in (1.0, -1.0)]))
    previous, value, following = values[at - 1], values[at], values[at + 1]
    bend, slope = previous - 2.0 * value + following, 0.5 * (following - previous)
    shift = np.divide(-slope, bend, out=np.zeros(len(at)), where=bend != 0.0)
    step = float(time[1] - time[0])
    return np.column_stack([time[at] + shift * step, value + 0.5 * slope * shift, bend])


def measures(extrema: np.ndarray, count: int) -> Measures:
    """Return the measures of the first `count` extrema (n, 3)."""
    first = extrema[:count]
    if count == 0:
        return Measures()
    period = 2.0 * float(np.diff(first[:, 0]).mean()) if count > 1 else None
    distances = np.abs(np.diff(first[:, 1]))
    decay = 2.0 * float(np.log(distances[0] / distances[-1])) / (len(distances) - 1) if count > 2 else None
    return Measures(float(first[0, 1]), float(first[0, 0]), period, decay, float(first[-1, 0]))


def matching_measures(*motions: History) -> tuple[Measures, ...]:
    """Return the measures of motions, the reference's last, by an equal number of matching extrema."""
    reference = motions[-1]
    probe, component = leading(reference)
    *others, truth = (extrema(h.time, h.probes[probe][:, component]) for h in motions)
    counts = [_matching(other, truth, reference.time[0]) for other in others]
    count = min(filter(None, counts), default=0 if others else len(truth))
    rows = (measures(other, min(count, n)) for other, n in zip(others, counts, strict=True))
    return (*rows, measures(truth, count))


def _matching(other: np.ndarray, truth: np.ndarray, start: float) -> int:
    """Return the number of first extrema (n, 3) of two motions that match."""
    other, truth = (values[: min(len(other), len(truth))] for values in (other, truth))
    intervals = np.diff(truth[:, 0], prepend=start)
    match = (np.abs(other[:, 0] - truth[:, 0]) < 0.5 * intervals) & (other[:, 2] * truth[:, 2] > 0.0)
    return len(match) if match.all() else int(np.argmin(match))


def largest(history: History, reference: History) -> float:
    """Return the largest difference at the probes over the reference's largest component."""
    return float(difference(history, reference)["largest"])


def difference(history: History, reference: History) -> dict[str, Any]:
    """Return the differences of a motion from its reference.

    `largest` and `rms` over all probes are relative to the reference's largest component, `peak` and `period`
    are relative differences, `decay` is the difference of both decrements.
    """
    count = min(len(history.time), len(reference.time))
    u, truth = (np.array([u[:count] for u in h.probes.values()]) for h in (history, reference))
    scale, errors = float(np.abs(truth).max()) or np.nan, u - truth
    own, true = matching_measures(history, reference)

    def relative(a: float | None, b: float | None) -> float | None:
        return None if a is None or not b else (a - b) / abs(b)

    return {
        "largest": float(np.abs(errors).max() / scale),
        "rms": float(np.sqrt(np.mean(np.sum(errors**2, axis=-1))) / scale),
        "peak": relative(own.peak, true.peak),
        "period": relative(own.period, true.period),
        "decay": None if own.decay is None or true.decay is None else own.decay - true.decay,
    }

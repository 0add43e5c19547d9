"""What a motion is measured by: peaks, period, decay, and how far one is from another.

Of the probe and component that move farthest in the reference the extrema are those that stand out by a
twentieth of its range, placed between samples by a parabola:

    peak     the first extremum [m], and when
    period   twice the mean time between extrema that follow one another
    decay    the logarithmic decrement a period, 2 ln(D_first/D_last)/(n − 1), of the n distances D between
             extrema that follow one another, so that where the sheet comes to rest need not be known

Of two motions those extrema are used that go in pairs from the first on: both highest or both lowest, and
closer in time than half the reference's way from the one before; of several, those that all of them have.
Distances are over the reference's largest component.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from sheetbench.answers.history import History
from sheetbench.answers.table import MILLIMETRES, MILLISECONDS, NUMBER

STANDS_OUT = 0.05  # of the range of a component


@dataclass(frozen=True)
class Measures:
    """peak [m] at peak_time [s]; period [s]; decay: logarithmic decrement a period; last: when the last
    extremum was that both motions have [s]. None where there are too few extrema. model: whose they are."""

    peak: Annotated[float | None, MILLIMETRES("z.3f", "first peak")] = None
    peak_time: Annotated[float | None, MILLISECONDS("z.2f", "at")] = None
    period: Annotated[float | None, MILLISECONDS("z.2f")] = None
    decay: Annotated[float | None, NUMBER("z.4f", "log decrement")] = None
    last: float | None = None
    model: str = ""

    @property
    def damping(self) -> Annotated[float | None, NUMBER("z.4f", "damping ratio")]:
        """The damping ratio of the decrement."""
        return None if self.decay is None else float(self.decay / np.hypot(2.0 * np.pi, self.decay))

    def as_dict(self) -> dict[str, float | None]:
        """For JSON."""
        return {key: value for key, value in vars(self).items() if key not in ("last", "model")}


def leading(history: History) -> tuple[str, int]:
    """The probe and the component that move farthest."""
    probe = max(history.probes, key=lambda name: float(np.abs(history.probes[name]).max()))
    return probe, int(np.abs(history.probes[probe]).max(axis=0).argmax())


def extrema(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Times [s], values and bends (n, 3) of the extrema that stand out; a bend is < 0 at the highest."""
    from scipy.signal import find_peaks

    least = STANDS_OUT * float(np.ptp(values))
    if least == 0.0:
        return np.zeros((0, 3))
    at = np.sort(np.concatenate([find_peaks(sign * values, prominence=least)[0] for sign in (1.0, -1.0)]))
    before, here, after = values[at - 1], values[at], values[at + 1]
    bend, slope = before - 2.0 * here + after, 0.5 * (after - before)
    aside = np.divide(-slope, bend, out=np.zeros(len(at)), where=bend != 0.0)
    step = float(time[1] - time[0])
    return np.column_stack([time[at] + aside * step, here + 0.5 * slope * aside, bend])


def measures(found: np.ndarray, count: int) -> Measures:
    """Of the first `count` extrema (n, 3)."""
    kept = found[:count]
    if count == 0:
        return Measures()
    period = 2.0 * float(np.diff(kept[:, 0]).mean()) if count > 1 else None
    distances = np.abs(np.diff(kept[:, 1]))
    decay = 2.0 * float(np.log(distances[0] / distances[-1])) / (len(distances) - 1) if count > 2 else None
    return Measures(float(kept[0, 1]), float(kept[0, 0]), period, decay, float(kept[-1, 0]))


def measured_alike(*motions: History) -> tuple[Measures, ...]:
    """Return the measures of motions, the reference's last, of the extrema that all have; none of a motion
    without a pair."""
    other = motions[-1]
    probe, component = leading(other)
    *others, truth = (extrema(h.time, h.probes[probe][:, component]) for h in motions)
    pairs = [_paired(one, truth, other.time[0]) for one in others]
    count = min(filter(None, pairs), default=0 if others else len(truth))
    rows = (measures(found, min(count, n)) for found, n in zip(others, pairs, strict=True))
    return (*rows, measures(truth, count))


def _paired(one: np.ndarray, truth: np.ndarray, start: float) -> int:
    """How many extrema (n, 3) go in pairs, from the first on."""
    ours, theirs = (found[: min(len(one), len(truth))] for found in (one, truth))
    way = np.diff(theirs[:, 0], prepend=start)
    pairs = (np.abs(ours[:, 0] - theirs[:, 0]) < 0.5 * way) & (ours[:, 2] * theirs[:, 2] > 0.0)
    return len(pairs) if pairs.all() else int(np.argmin(pairs))


def largest(one: History, other: History) -> float:
    """The largest difference of two motions' probes, over the other's largest component."""
    return float(difference(one, other)["largest"])


def difference(one: History, other: History) -> dict[str, Any]:
    """How far a motion is from its reference: `largest` and `rms` of all probes over the reference's largest
    component; `peak` and `period` relative to its own; `decay`, by how much the decrements differ."""
    count = min(len(one.time), len(other.time))
    ours, theirs = (np.array([u[:count] for u in h.probes.values()]) for h in (one, other))
    scale = float(np.abs(theirs).max()) or np.nan
    off = ours - theirs
    mine, truth = measured_alike(one, other)

    def relative(a: float | None, b: float | None) -> float | None:
        return None if a is None or not b else (a - b) / abs(b)

    return {
        "largest": float(np.abs(off).max() / scale),
        "rms": float(np.sqrt(np.mean(np.sum(off**2, axis=-1))) / scale),
        "peak": relative(mine.peak, truth.peak),
        "period": relative(mine.period, truth.period),
        "decay": None if mine.decay is None or truth.decay is None else mine.decay - truth.decay,
    }

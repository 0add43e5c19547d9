"""Values over time: samples at increasing times [s], joined by lines or by a smooth curve, constant outside.

A smooth curve consists of cubics between the samples, with continuous slope and without overshoot: between
rising samples it rises, between equal ones it is constant. Source: Fritsch and Butland (1984), SIAM J. Sci.
Stat. Comput. 5, 300–304, in the form of SciPy's `PchipInterpolator`.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field

from sheetbench.scenes.objects.quantities import Frozen, Number, Unit

INSTANT = 1e-9  # of a table's span: rounding error of a sum of time steps

Interpolation = Literal["smooth", "linear"]
Values = Sequence[float] | Sequence[Sequence[float]]


class PiecewiseCurve:
    """Curve through values (n, …) at increasing times (n,) [s], linear or smooth, constant outside. A smooth
    curve of two samples is a line. pieces: coefficients (powers, n + 1, …) in the time since a piece's start,
    from the constant on; the first and the last piece are before and after the samples."""

    def __init__(self, time: Sequence[float], values: Values, interpolation: Interpolation = "linear"):
        self._time, samples = np.array(time, dtype=float), np.array(values, dtype=float)
        self._instant = INSTANT * (self._time[-1] - self._time[0])
        inner = samples[None, :0]
        if len(time) > 1 and interpolation == "linear":
            spacing = np.diff(self._time).reshape(-1, *(1,) * (samples.ndim - 1))
            inner = np.stack([samples[:-1], np.diff(samples, axis=0) / spacing])
        elif len(time) > 1:
            from scipy.interpolate import PchipInterpolator  # not needed to read a scene

            inner = np.asarray(PchipInterpolator(self._time, samples).c[::-1])
        self.pieces = np.zeros((len(inner), len(samples) + 1, *samples.shape[1:]))
        self.pieces[:, 1:-1] = inner
        self.pieces[0, 0], self.pieces[0, -1] = samples[0], samples[-1]

    def at(self, time: float | np.ndarray | None = None) -> np.ndarray:
        """Return the value at a time [s], or values (k, …) at times (k,); without a time the last value."""
        if time is None:
            return np.asarray(self.pieces[0, -1])
        return self._sum(time, np.searchsorted(self._time, time, side="right"), 0)

    def slope(self, time: float | np.ndarray, before: bool = False) -> np.ndarray:
        """Return the derivative [1/s] just after a time [s], or just before."""
        return self._sum(time, self._piece(time, before), 1)

    def bend(self, time: float | np.ndarray) -> np.ndarray:
        """Return the second derivative [1/s²] just after a time [s]."""
        return self._sum(time, self._piece(time, False), 2)

    def _piece(self, time: float | np.ndarray, before: bool) -> np.ndarray:
        shifted = time - self._instant if before else time + self._instant
        return np.searchsorted(self._time, shifted, side="right")

    def _sum(self, time: float | np.ndarray, piece: np.ndarray, derivative: int) -> np.ndarray:
        """Return the derivative of this order of the pieces' polynomials, by Horner's rule."""
        since = time - self._time[np.maximum(piece - 1, 0)]
        since = np.reshape(since, (*np.shape(time), *(1,) * (self.pieces.ndim - 2)))
        total = np.zeros(np.shape(self.pieces[0, piece]))
        for power in range(len(self.pieces) - 1, derivative - 1, -1):
            factor = float(np.prod(np.arange(power - derivative + 1, power + 1)))
            total = factor * self.pieces[power, piece] + since * total
        return total


class OverTime(Frozen):
    """Base of the tables: increasing times (n,) [s], and n samples under every other key that is a list."""

    time: Annotated[tuple[Number, ...], Unit("s")] = Field(min_length=1)
    """Increasing times; the first sample holds before and the last one after."""

    @property
    def samples(self) -> dict[str, tuple[Any, ...]]:
        """Return the samples by their keys, without optional keys that are not given."""
        fields = type(self).model_fields
        return {k: v for k, v in self if isinstance(v, tuple) and (v or fields[k].is_required())}

    def _faults(self) -> Iterator[object]:
        for name, samples in self.samples.items():
            unlike = f"{len(self.time)} times but {len(samples)} in {name}"
            yield len(samples) != len(self.time) and unlike
        yield any(b <= a for a, b in pairwise(self.time)) and "times must increase"

    def over_time(self, name: str) -> PiecewiseCurve:
        """Return the samples of a key over time."""
        return PiecewiseCurve(self.time, self.samples[name], getattr(self, "interpolation", "linear"))

    def still(self) -> Self:
        """Return the table with the constant values of t = 0."""
        now = {name: (self.over_time(name).at(0.0).tolist(),) for name in self.samples}
        return self.replace(**{**now, "time": (0.0,)})


class FactorTable(OverTime):
    """A factor over time."""

    factor: tuple[Number, ...]
    """Factor of the load at each time, linear between them; statics take the last one."""


STEADY = FactorTable(time=(0.0,), factor=(1.0,))


class Loading(Frozen):
    """Base of loads and gravity, whose `history` scales them over time."""

    history: FactorTable | None = Field(default=None, kw_only=True)
    """A factor over time; without it the load acts in full from t = 0 on."""

    @property
    def last_factor(self) -> float:
        """Return the last factor of the load, which statics take."""
        return self.history.factor[-1] if self.history is not None else 1.0

    @property
    def course(self) -> PiecewiseCurve:
        """Return the factor over time."""
        return (self.history or STEADY).over_time("factor")

    def times(self, factor: float) -> Self:
        """Return the load times a factor."""
        table = self.history or STEADY
        return self.replace(history=table.replace(factor=tuple(factor * sample for sample in table.factor)))

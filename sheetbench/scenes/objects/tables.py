"""Values over time: samples at increasing times [s], joined by lines or by a smooth curve, constant before
and after.

Smooth means cubics between the samples whose slopes go over into each other and which do not overshoot: where
the samples rise the curve rises, where two are equal it rests. Source: Fritsch and Butland (1984), SIAM J.
Sci. Stat. Comput. 5, 300–304, as SciPy's `PchipInterpolator` has it.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field

from sheetbench.scenes.objects.quantities import Frozen, Number, Unit

INSTANT = 1e-9  # of a table's span, that a sum of time steps may lack of the moment it stands for

Interpolation = Literal["smooth", "linear"]
Values = Sequence[float] | Sequence[Sequence[float]]


class PiecewiseCurve:
    """Values (n, …) at increasing times (n,) [s], constant outside, between them linear or smooth: a smooth
    curve of two is a line."""

    def __init__(self, time: Sequence[float], values: Values, interpolation: Interpolation = "linear"):
        self._time, samples = np.array(time, dtype=float), np.array(values, dtype=float)
        self._instant = INSTANT * (self._time[-1] - self._time[0])
        # coefficients of each piece in the time since its start, from the constant on; the first and the last
        # piece are what lies before and after
        inner = samples[None, :0]
        if len(time) > 1 and interpolation == "linear":
            spacing = np.diff(self._time).reshape(-1, *(1,) * (samples.ndim - 1))
            inner = np.stack([samples[:-1], np.diff(samples, axis=0) / spacing])
        elif len(time) > 1:
            from scipy.interpolate import PchipInterpolator  # a scene that is only read need not wait for it

            inner = np.asarray(PchipInterpolator(self._time, samples).c[::-1])
        self._pieces = np.zeros((len(inner), len(samples) + 1, *samples.shape[1:]))
        self._pieces[:, 1:-1] = inner
        self._pieces[0, 0], self._pieces[0, -1] = samples[0], samples[-1]

    def at(self, time: float | np.ndarray | None = None) -> np.ndarray:
        """The value at a time [s], or those at times (k,), (k, …); without one the last, as statics take
        it."""
        if time is None:
            return np.asarray(self._pieces[0, -1])
        return self._sum(time, np.searchsorted(self._time, time, side="right"), 0)

    def slope(self, time: float | np.ndarray, before: bool = False) -> np.ndarray:
        """Its derivative [1/s] from a time [s] on, or until then."""
        return self._sum(time, self._piece(time, before), 1)

    def bend(self, time: float | np.ndarray) -> np.ndarray:
        """Its second derivative [1/s²] from a time [s] on."""
        return self._sum(time, self._piece(time, False), 2)

    def _piece(self, time: float | np.ndarray, before: bool) -> np.ndarray:
        shifted = time - self._instant if before else time + self._instant
        return np.searchsorted(self._time, shifted, side="right")

    def _sum(self, time: float | np.ndarray, piece: np.ndarray, derivative: int) -> np.ndarray:
        """The derivative of this order of the pieces' polynomials, by Horner's rule."""
        since = time - self._time[np.maximum(piece - 1, 0)]
        since = np.reshape(since, (*np.shape(time), *(1,) * (self._pieces.ndim - 2)))
        found = np.zeros(np.shape(self._pieces[0, piece]))
        for power in range(len(self._pieces) - 1, derivative - 1, -1):
            factor = float(np.prod(np.arange(power - derivative + 1, power + 1)))
            found = factor * self._pieces[power, piece] + since * found
        return found


class OverTime(Frozen):
    """Base of the tables: time (n,) [s], increasing, and n samples of everything else that is a list."""

    time: Annotated[tuple[Number, ...], Unit("s")] = Field(min_length=1)
    """Increasing times; the first sample holds before and the last one after."""

    @property
    def samples(self) -> dict[str, tuple[Any, ...]]:
        """Return the samples by their keys, without those that may be left out and are."""
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
        """Return the table that stays where it is at t = 0."""
        now = {name: (self.over_time(name).at(0.0).tolist(),) for name in self.samples}
        return self.replace(**{**now, "time": (0.0,)})


class FactorTable(OverTime):
    """A factor over time."""

    factor: tuple[Number, ...]
    """What the load is multiplied by at each time, linear between them; statics take the last one."""


STEADY = FactorTable(time=(0.0,), factor=(1.0,))


class Loading(Frozen):
    """Base of loads and gravity, whose `history` scales them over time."""

    history: FactorTable | None = Field(default=None, kw_only=True)
    """A factor over time; without it the load acts in full from t = 0 on."""

    @property
    def last_factor(self) -> float:
        """What the load is multiplied by in the end, and in statics."""
        return self.history.factor[-1] if self.history is not None else 1.0

    @property
    def course(self) -> PiecewiseCurve:
        """The factor over time."""
        return (self.history or STEADY).over_time("factor")

    def times(self, factor: float) -> Self:
        """Return the load times a factor."""
        table = self.history or STEADY
        return self.replace(history=table.replace(factor=tuple(factor * sample for sample in table.factor)))

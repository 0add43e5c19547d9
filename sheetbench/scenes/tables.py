"""Values over time: samples at increasing times [s], linear between them, constant before and after."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated

import numpy as np
from pydantic import Field, model_validator

from sheetbench.scenes.quantities import Frozen, Number, Unit

INSTANT = 1e-9  # of a table's span, that a sum of time steps may lack of the moment it stands for


class PiecewiseLinear:
    """Values (n, …) at increasing times (n,) [s], linear between them and constant outside."""

    def __init__(self, time: Sequence[float], values: Sequence[float] | Sequence[Sequence[float]]):
        self._time, self._values = np.array(time, dtype=float), np.array(values, dtype=float)
        self._instant = INSTANT * np.ptp(self._time)
        spacing = np.diff(self._time).reshape(-1, *(1,) * (self._values.ndim - 1))
        outside = np.zeros_like(self._values[:1])
        self._slopes = np.concatenate([outside, np.diff(self._values, axis=0) / spacing, outside])

    def at(self, time: float | np.ndarray | None = None) -> np.ndarray:
        """The value at a time [s], or those at times (k,), (k, …); without one the last, as statics take
        it."""
        if time is None:
            return np.asarray(self._values[-1])
        passed = np.searchsorted(self._time, time, side="right")
        before = np.maximum(passed - 1, 0)
        since = np.reshape(time - self._time[before], (*np.shape(time), *(1,) * (self._values.ndim - 1)))
        value: np.ndarray = self._values[before] + since * self._slopes[passed]
        return value

    def slope(self, time: float | np.ndarray) -> np.ndarray:
        """Its derivative [1/s] from a time [s] on."""
        return np.asarray(self._slopes[np.searchsorted(self._time, time + self._instant, side="right")])


class OverTime(Frozen):
    """Base of the tables: time (n,) [s], increasing, and n samples of everything else that is a list."""

    time: Annotated[tuple[Number, ...], Unit("s")] = Field(min_length=1)
    """Increasing times; linear between them, the first sample before and the last one after."""

    @model_validator(mode="after")
    def _one_sample_each(self) -> OverTime:
        for name, field in type(self).model_fields.items():
            samples = getattr(self, name)
            if not isinstance(samples, tuple) or not (samples or field.is_required()):
                continue
            if len(samples) != len(self.time):
                raise ValueError(f"{len(self.time)} times but {len(samples)} in {name}")
        if any(b <= a for a, b in pairwise(self.time)):
            raise ValueError("times must increase")
        return self


class FactorTable(OverTime):
    """A factor over time."""

    factor: tuple[Number, ...]
    """What the load is multiplied by at each time; statics take the last one."""


class Loading(Frozen):
    """Base of loads and gravity, whose `history` scales them over time."""

    history: FactorTable | None = Field(default=None, kw_only=True)
    """A factor over time; without it the load acts in full from t = 0 on."""

    @property
    def last_factor(self) -> float:
        """What the load is multiplied by in the end, and in statics."""
        return self.history.factor[-1] if self.history is not None else 1.0

"""Energy from nowhere in a step that touches an obstacle, as a measure of its error."""

from __future__ import annotations

from lumped.dynamics.system import State, System


class EnergyGain:
    """Of the steps of a system. largest: part of its energy so far [J]."""

    def __init__(self, system: System):
        self._system, self.largest = system, 0.0
        self._last: tuple[State | None, list[float]] = None, []  # of no consequence but for speed

    def of(self, before: State, after: State, exchanged: float) -> float:
        """Return by how much energy has grown or fallen in a step, over the largest part of it so far;
        exchanged: what dampers took less what was put in [J]."""
        then = self._last[1] if self._last[0] is before else self._parts(before)
        now = self._parts(after)
        self._last = after, now
        self.largest = max(self.largest, *map(abs, now))
        gained = sum(now) - sum(then) + exchanged
        return abs(gained) / self.largest if self.largest else 0.0

    def _parts(self, state: State) -> list[float]:
        return list(self._system.balance(state)[0].values())

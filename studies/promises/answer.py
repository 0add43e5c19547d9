"""Answer of the study: promised and actual errors, and the share of promises that were kept.

bar              kept where the error of a component is within it; at least 95 % of components, and a
                 median bar of no more than five errors
expected error   kept where the true error is within a factor of two; at least 80 %, never three times it
advice           kept where the error of the choice is within the tolerance; at least 95 %

The median bar of a single kind of scenes may be larger, as orders are low where obstacles touch or points
hold; estimates may be missing there.
Components of one scene are kept or missed together, so that scenes, not components, are the sample: of n
scenes with k of m kept each, p = Σ k/Σ m has the standard error √(n/(n − 1) Σ (k − p m)²)/Σ m (a ratio
estimator: Cochran, Sampling Techniques, 1977, section 6.4).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Annotated, Any, NamedTuple

import numpy as np

from sheetbench.answers.answer import Answer
from sheetbench.answers.table import NUMBER, PERCENT, Column, Table
from sheetbench.scenes.language.summary import few


class Goal(NamedTuple):
    """Requirements on promises: share that must be kept, largest median of promised/actual, largest
    actual/promised."""

    share: float
    loosest: float = np.inf
    farthest: float = np.inf


GOALS = {"bar": Goal(0.95, loosest=5.0), "expected error": Goal(0.8, farthest=3.0), "advice": Goal(0.95)}


@dataclass(frozen=True)
class Promise:
    """Promise about an error: by which rule, on which mesh or at which tolerance, where. promised and actual
    error are shares of the largest displacement; cost: time of an advised model over the cheapest model
    within the tolerance; kind: of the scene, "" where scenes are not counted by kind."""

    promise: str
    at: str
    scene: str
    where: str
    promised: float | None
    actual: float
    cost: float | None = None
    kind: str = ""

    @property
    def ratio(self) -> float:
        """Actual over promised, nan without a promise."""
        if self.promised is None:
            return float("nan")
        if self.promised:
            return self.actual / self.promised
        return np.inf if self.actual > 0.0 else 0.0

    @property
    def kept(self) -> bool:
        """Whether the promise was kept."""
        return 0.5 < self.ratio < 2.0 if self.promise == "expected error" else self.ratio <= 1.0


@dataclass(frozen=True)
class Share:
    """Share of the promises of one kind that were kept."""

    promise: str
    at: str
    kind: Annotated[str, Column("of scenes")]  # "" of all
    scenes: Annotated[int, NUMBER("d")]
    cases: Annotated[int, NUMBER("d")]
    kept: Annotated[float, PERCENT(".1f")]
    chance: Annotated[float, PERCENT(".1f", "±")]  # standard error, nan of a single scene
    loose: Annotated[float, NUMBER(".3g", "median promised/actual")]
    farthest: Annotated[float, NUMBER(".3g", "largest actual/promised")]
    cost: Annotated[float | None, NUMBER(".2f", "median of time over the cheapest")]
    met: Annotated[bool, Column("ok", words=("yes", "NO"))]


@dataclass(frozen=True)
class Miss:
    """Worst broken promise of a scene."""

    promise: str
    at: str
    scene: str
    where: str
    promised: Annotated[float | None, PERCENT(".2g")]
    actual: Annotated[float, PERCENT(".2g")]


@dataclass(frozen=True, repr=False)
class Promises(Answer):
    """Rows of every promise; skipped: scenes that were replaced, and why."""

    rows: tuple[Promise, ...]
    skipped: dict[str, str]

    file_name = "promises"

    def shares(self) -> list[Share]:
        """Return a row per promise and mesh, grid or tolerance, and one of each kind of scene."""
        groups: dict[tuple[str, str, str], list[Promise]] = {}
        for row in self.rows:
            for kind in dict.fromkeys(("", row.kind)):
                groups.setdefault((row.promise, row.at, kind), []).append(row)
        return [share(rows, kind) for (*_, kind), rows in groups.items()]

    def _misses(self) -> list[Miss]:
        worst: dict[tuple[str, str, str], Promise] = {}
        for row in self.rows:
            key = row.promise, row.at, row.scene
            if not row.kept and row.ratio >= (worst[key].ratio if key in worst else 0.0):
                worst[key] = row
        return [Miss(r.promise, r.at, r.scene, r.where, r.promised, r.actual) for r in worst.values()]

    @property
    def succeeded(self) -> bool:
        return all(row.met for row in self.shares())

    def heading(self) -> tuple[str, str, str]:
        return "Promises", "error bars, expected errors and advice beside the errors that there are", ""

    def document(self) -> dict[str, Any]:
        rows = [{**asdict(row), "kept": row.kept} for row in self.rows]
        return {"shares": [asdict(row) for row in self.shares()], "skipped": self.skipped, "rows": rows}

    def tables(self) -> tuple[Table, ...]:
        shares = Table.of(Share, self.shares(), "Promises that were kept", "promises", grouped=True)
        return shares, Table.of(Miss, self._misses(), "Scenes in which one was not", "misses", grouped=True)

    def notes(self) -> list[str]:
        kept = "kept: the error is within the bar or the tolerance, or a factor of two of the expected one."
        replaced = f"Replaced, for a model did not converge on a mesh: {', '.join(self.skipped)}."
        return [kept, *([replaced] if self.skipped else [])]

    def complaints(self) -> list[str]:
        return [
            f"{row.promise}, {row.at}{row.kind and ', '}{row.kind}: {100.0 * row.kept:.1f} ± "
            f"{100.0 * row.chance:.1f} % kept, promised is {few(row.loose)} times the error, "
            f"at most {few(row.farthest)} times too small"
            for row in self.shares()
            if not row.met
        ]

    def choices(self) -> dict[str, Any]:
        return {"promises": list(dict.fromkeys(row.promise for row in self.rows))}


def share(rows: Sequence[Promise], kind: str = "") -> Share:
    """Return the share of promises of one kind that were kept, without rows that promise nothing. kind: of
    scenes."""
    given = [row for row in rows if row.promised is not None]
    kept = float(np.mean([row.kept for row in given])) if given else float("nan")
    ratios = np.array([row.ratio for row in given])
    loose = float(np.median(1.0 / ratios[ratios > 0.0])) if (ratios > 0.0).any() else float("nan")
    farthest, costs = float(ratios.max(initial=0.0)), [row.cost for row in given if row.cost is not None]
    goal = next(goal for name, goal in GOALS.items() if rows[0].promise.startswith(name))
    tight = bool(kind) or not loose > goal.loosest
    met = (kept >= goal.share or (bool(kind) and not given)) and tight and farthest < goal.farthest
    cost = float(np.median(costs)) if costs else None
    scenes = list(dict.fromkeys(row.scene for row in given))
    chance = _chance([[row.kept for row in given if row.scene == scene] for scene in scenes])
    return Share(
        rows[0].promise, rows[0].at, kind, len(scenes), len(given), kept, chance, loose, farthest, cost, met
    )


def _chance(scenes: Sequence[Sequence[bool]]) -> float:
    """Return the standard error of the share that is kept, from its variation between scenes; nan for fewer
    than two."""
    n = len(scenes)
    if n < 2:
        return float("nan")
    kept, given = np.array([sum(scene) for scene in scenes]), np.array([len(scene) for scene in scenes])
    off = kept - kept.sum() / given.sum() * given
    return float(np.sqrt(n / (n - 1) * np.sum(off**2)) / given.sum())

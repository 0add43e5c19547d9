"""The stored reference set: scenes, converged values, error bars, version and licence.

statics  displacement at the probes
motion   displacement at the probes over time, from rest, weight and loads on at t = 0
modes    lowest natural frequencies about the flat, stress-free sheet
curves   as statics: strips whose answer depends on one parameter
natural  as statics: sheets with a curved stress-free shape
contact  as statics: sheets in contact with an obstacle

`sheetbench study reference-set` computes the values of the scenes in the file.
"""

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from sheetbench.answers.table import PERCENT, Column
from sheetbench.errors import require_choice
from sheetbench.scenes import Scene

FILE = Path(__file__).parent / "data" / "suite.json"
VERSION = "2.2"
LICENCE = "CC-BY-4.0"
AT_REST = ("statics", "curves", "natural", "contact")  # displacements without time


@dataclass(frozen=True, eq=False)
class Reference:
    """A case with its values: displacements (probes, 3) [m], with times (t,) [s] (probes, t, 3), or natural
    frequencies (k,) [Hz]; bars: error bar of each value; bar: the largest one over the largest value; judges:
    other models that solved the case, with their errors."""

    name: Annotated[str, Column("case")]
    suite: str
    why: Annotated[str, Column(prose=True)]
    scene: Scene
    values: np.ndarray
    bars: np.ndarray
    bar: Annotated[float, PERCENT(".2g")]
    judges: tuple[dict[str, Any], ...]
    time: np.ndarray | None = None
    duration: float | None = None

    @property
    def agreeing(self) -> list[str]:
        """Names of the models within one percent or within the bar."""
        limit = max(0.01, self.bar)
        return [row["model"] for row in self.judges if row["error"] is not None and row["error"] <= limit]


@cache
def document() -> dict[str, Any]:
    """Return the whole set as plain data."""
    return dict(json.loads(FILE.read_text(encoding="utf-8")))


@cache
def references(suite: str | None = None) -> dict[str, Reference]:
    """Return the cases of a suite, by default of all suites, by name."""
    cases = (_reference(case) for case in document()["cases"])
    return {case.name: case for case in cases if suite in (None, case.suite)}


def reference(name: str, suite: str | None = None) -> Reference:
    """Return a case by name. Raises BadInput for an unknown name."""
    known = references(suite)
    require_choice("--case", name, known)
    return known[name]


def _reference(case: dict[str, Any]) -> Reference:
    if case["suite"] == "modes":
        values, bars = case["frequencies_hz"]["f"], case["frequencies_hz"]["bar"]
    else:
        values, bars = ([probe[key] for probe in case["probes"].values()] for key in ("u", "bar"))
    if "time" in case:  # one bar per probe and component, for all times
        bars = np.broadcast_to(np.array(bars)[:, None], np.shape(values))
    return Reference(
        name=case["name"],
        suite=case["suite"],
        why=case["why"],
        scene=Scene.model_validate(case["scene"]),
        values=np.array(values),
        bars=np.array(bars),
        bar=case["bar"],
        judges=tuple(case["judges"]),
        time=np.array(case["time"]) if "time" in case else None,
        duration=case.get("duration"),
    )

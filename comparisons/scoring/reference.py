"""The reference set as it is kept: scenes, converged values, error bars, version and licence.

statics  displacement at the probes
motion   displacement at the probes over time, from rest, weight and loads on at t = 0
modes    the lowest natural frequencies about the flat, stress-free sheet
curves   as statics: strips whose answer depends on one number alone
natural  as statics: sheets that are not flat at rest
contact  as statics: sheets that touch something

`sheetbench study reference-set` computes the values of the scenes in the file.
"""

from __future__ import annotations

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
    frequencies (k,) [Hz]; bars of each; bar: the largest over the largest value; judges: codes that solved
    the case, and how far each is off."""

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
        """Models within one percent, or within the bar."""
        limit = max(0.01, self.bar)
        return [j["model"] for j in self.judges if j["error"] is not None and j["error"] <= limit]


@cache
def document() -> dict[str, Any]:
    """The whole set as plain data."""
    return dict(json.loads(FILE.read_text(encoding="utf-8")))


@cache
def references(suite: str | None = None) -> dict[str, Reference]:
    """The cases of a suite, or all of them, by name."""
    every = (_reference(case) for case in document()["cases"])
    return {case.name: case for case in every if suite in (None, case.suite)}


def reference(name: str, suite: str | None = None) -> Reference:
    """One case. Raises BadInput for a name that there is not."""
    known = references(suite)
    require_choice("--case", name, known)
    return known[name]


def _reference(case: dict[str, Any]) -> Reference:
    if case["suite"] == "modes":
        values, bars = case["frequencies_hz"]["f"], case["frequencies_hz"]["bar"]
    else:
        values, bars = ([probe[key] for probe in case["probes"].values()] for key in ("u", "bar"))
    if "time" in case:  # one bar a probe and component, at all times
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

"""The three kinds of load.

point     a dead force [N] at a plan point of the mid-surface
edge      per undeformed length of an edge: a dead force [N/m] and a moment [N·m/m] about the current
          edge tangent; moment > 0 turns the edge so that material just outside it would move towards +z
pressure  a follower pressure [Pa] on the whole sheet, along the current normal (initially +z), per
          current area

Each may have a `history = {time = [s], factor = [-]}` that scales it over time: linear between samples, the
first factor before and the last one after; without it a load acts in full from t = 0 on. Statics take the
last factor.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from sheetbench.scenes.quantities import Number, PlanPoint, Vector3
from sheetbench.scenes.sheet import EdgeName
from sheetbench.scenes.tables import Loading


class PointLoad(Loading):
    """A dead force [N] at plan point `at` [m]."""

    kind: Literal["point"] = "point"
    at: PlanPoint
    force: Vector3


class EdgeLoad(Loading):
    """A dead force [N/m] and a moment [N·m/m] along an edge."""

    kind: Literal["edge"] = "edge"
    edge: EdgeName
    force_per_length: Vector3 = (0.0, 0.0, 0.0)
    moment_per_length: Number = 0.0

    @model_validator(mode="after")
    def _loads_something(self) -> EdgeLoad:
        if not self.model_fields_set & {"force_per_length", "moment_per_length"}:
            raise ValueError("needs force_per_length [N/m] or moment_per_length [N·m/m]")
        return self


class Pressure(Loading):
    """A follower pressure [Pa]."""

    kind: Literal["pressure"] = "pressure"
    value: Number


Load = Annotated[PointLoad | EdgeLoad | Pressure, Field(discriminator="kind")]

"""The kinds of load.

point     a dead force [N] at a plan point of the mid-surface
edge      per undeformed length of an edge, or of its part `where` a shape says: a dead force [N/m] and a
          moment [N·m/m] about the current edge tangent; moment > 0 turns the edge so that material just
          outside it would move towards +z
area      a dead force [N/m²] per undeformed area, on the whole sheet or `where` a shape says
pressure  a follower pressure [Pa] on the whole sheet or `where` a shape says, along the current normal
          (initially +z), per current area

Each may have a `history = {time = [s], factor = [-]}` that scales it over time: linear between samples, the
first factor before and the last one after; without it a load acts in full from t = 0 on. Statics take the
last factor.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from sheetbench.scenes.quantities import Number, PlanPoint, Unit, Vector3
from sheetbench.scenes.shapes import Shape
from sheetbench.scenes.sheet import EdgeName
from sheetbench.scenes.tables import Loading


class PointLoad(Loading):
    """A dead force [N] at plan point `at` [m]."""

    kind: Literal["point"] = Field(default="point", kw_only=True)
    """A dead force at a point of the mid-surface."""
    at: Annotated[PlanPoint, Unit("m")]
    """Plan point [x, y] of the undeformed sheet where the force acts."""
    force: Annotated[Vector3, Unit("N")]
    """Along x, y and z; it keeps its direction while the sheet moves."""


class EdgeLoad(Loading):
    """A dead force [N/m] and a moment [N·m/m] along an edge."""

    kind: Literal["edge"] = Field(default="edge", kw_only=True)
    """A dead force and a moment along an edge."""
    edge: EdgeName
    """The edge that is loaded."""
    force_per_length: Annotated[Vector3, Unit("N/m")] = (0.0, 0.0, 0.0)
    """Along x, y and z, per undeformed length of the edge; it keeps its direction."""
    moment_per_length: Annotated[Number, Unit("N·m/m")] = 0.0
    """About the current edge; > 0 turns the edge so that material just outside it would move towards +z."""
    where: Shape | None = Field(default=None, kw_only=True)
    """The part of the edge that is loaded, which lies in a shape; the whole edge unless given."""

    @model_validator(mode="after")
    def _loads_something(self) -> EdgeLoad:
        if not self.model_fields_set & {"force_per_length", "moment_per_length"}:
            raise ValueError("needs force_per_length [N/m] or moment_per_length [N·m/m]")
        return self


class AreaLoad(Loading):
    """A dead force [N/m²] on a part of the sheet."""

    kind: Literal["area"] = Field(default="area", kw_only=True)
    """A dead force on the whole sheet, or on a part of it."""
    force_per_area: Annotated[Vector3, Unit("N/m²")]
    """Along x, y and z, per undeformed area; it keeps its direction."""
    where: Shape | None = None
    """The part that is loaded; the whole sheet unless given."""


class Pressure(Loading):
    """A follower pressure [Pa]."""

    kind: Literal["pressure"] = Field(default="pressure", kw_only=True)
    """A follower pressure on the whole sheet, or on a part of it."""
    value: Annotated[Number, Unit("Pa")]
    """> 0 pushes along the sheet's current normal, at first +z; per current area."""
    where: Shape | None = None
    """The part that is loaded; the whole sheet unless given."""


AnyLoad = PointLoad | EdgeLoad | AreaLoad | Pressure
Load = Annotated[AnyLoad, Field(discriminator="kind")]

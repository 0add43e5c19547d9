"""The kinds of load, each with a `history` that scales it over time.

Factors are linear between samples, the first holds before and the last one after. Without a history the load
acts in full from t = 0 on. Statics take the last factor.
"""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from sheetbench.scenes.objects.quantities import Frozen, Number, PlanPoint, Unit, Vector3
from sheetbench.scenes.objects.shapes import Shape
from sheetbench.scenes.objects.sheet import EdgeName
from sheetbench.scenes.objects.tables import Loading


class _Load(Loading):
    follows: ClassVar = False  # the sheet: a dead load keeps its direction
    hold: bool = Field(default=False, kw_only=True)
    """Whether the load acts only until a motion starts and is let go at t = 0: with [initial]
    shape = "static". For statics it is a load like others."""

    def _faults(self) -> Iterator[object]:
        alone = "hold = true: it acts in full until t = 0 and no longer; leave hold or history out"
        yield self.hold and self.history and alone


class Initial(Frozen):
    """The shape that a motion starts from; statics do not depend on it."""

    shape: Literal["static"]
    """"static": at rest in the equilibrium under all that acts at t = 0, loads with hold = true among it,
    which are let go then; unstable ones are refused. Without this table the sheet starts flat, or as bent and
    tilted supports alone shape it."""


class PointLoad(_Load):
    """A dead force at a point of the mid-surface."""

    kind: Literal["point"] = Field(default="point", kw_only=True)
    at: Annotated[PlanPoint, Unit("m")]
    """Plan point [x, y] of the undeformed sheet where the force acts."""
    force: Annotated[Vector3, Unit("N")]
    """Components along x, y and z; the force keeps its direction while the sheet moves."""


class EdgeLoad(_Load):
    """A dead force and a moment along an edge."""

    kind: Literal["edge"] = Field(default="edge", kw_only=True)
    edge: EdgeName
    """The edge that is loaded."""
    force_per_length: Annotated[Vector3, Unit("N/m")] = (0.0, 0.0, 0.0)
    """Components along x, y and z, per undeformed length of the edge; the force keeps its direction."""
    moment_per_length: Annotated[Number, Unit("N·m/m")] = 0.0
    """Moment about the current edge; > 0 turns it so that material just outside would move towards +z."""
    where: Shape | None = Field(default=None, kw_only=True)
    """The part of the edge that is loaded, which lies in a shape; the whole edge unless given."""

    def _faults(self) -> Iterator[object]:
        yield from super()._faults()
        given = self.model_fields_set & {"force_per_length", "moment_per_length"}
        yield not given and "needs force_per_length [N/m] or moment_per_length [N·m/m]"

    @property
    def follows(self) -> bool:  # type: ignore[override]
        """Return whether there is a moment, which turns with the edge."""
        return self.moment_per_length != 0.0


class AreaLoad(_Load):
    """A dead force on the whole sheet, or on a part of it."""

    kind: Literal["area"] = Field(default="area", kw_only=True)
    force_per_area: Annotated[Vector3, Unit("N/m²")]
    """Components along x, y and z, per undeformed area; the force keeps its direction."""
    where: Shape | None = None
    """The part that is loaded; the whole sheet unless given."""


class Pressure(_Load):
    """A follower pressure on the whole sheet, or on a part of it."""

    kind: Literal["pressure"] = Field(default="pressure", kw_only=True)
    value: Annotated[Number, Unit("Pa")]
    """> 0 pushes along the sheet's current normal, at first +z; per current area."""
    where: Shape | None = None
    """The part that is loaded; the whole sheet unless given."""
    follows: ClassVar = True


AnyLoad = PointLoad | EdgeLoad | AreaLoad | Pressure
Load = Annotated[AnyLoad, Field(discriminator="kind")]

"""The two kinds of actuator, each bound to one edge of the sheet.

A chain is an elastic rod: joints divide the edge evenly into segments, and the part of the rod nearest to a
joint has the joint's curvature. A model may divide it into rigid parts, with joints of the stiffness EI/ds
and the rest angle curvature × ds between them. The chain alone carries its weight and inertia, and holds the
edge's tilt about the rod. A curvature is a number, a list with one value a joint (in the order of the edge's
axis; a held base adds half-length joints at the base), or a table {time, value}. Statics take the last value
of a table, and of a motion. A motion is no chain and has no forces of its own. Rules for neighbouring edges
are in `sheetbench.scenes.meaning.corners`.

An actuator's name is its edge or, if an edge has several, its edge and its number in the scene: "x1.2".
Its support is named among the reactions: a motion as its edge, the base of an edge's chains as "EDGE base".

Actuators on one edge share its masses: chains of a pair must agree in segments, plane and base, and may lie
anywhere through the thickness. They move as one chain whose axis is the mean of their axes; the joints of
each slide along its axis, since two inextensible rods on opposite faces could not bend together.
"""

from collections.abc import Iterator
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Discriminator, Field, Tag

from sheetbench.scenes.objects.quantities import (
    Forms,
    Frozen,
    Length,
    NonNegative,
    Number,
    Positive,
    Unit,
    Vector3,
)
from sheetbench.scenes.objects.sheet import EdgeName
from sheetbench.scenes.objects.tables import OverTime, PiecewiseCurve

Plane = Literal["normal", "inplane", "spatial"]
Base = Literal["free", "start", "middle", "end"]


class CurvatureTable(OverTime):
    """Intrinsic curvature over time, one for all joints."""

    value: Annotated[tuple[Number, ...], Unit("1/m")]
    """Intrinsic curvature of all joints at each time, linear between them; statics take the last one."""


Curvature = Annotated[Number | tuple[Number, ...] | CurvatureTable, Forms(), Unit("1/m")]


class Chain(Frozen):
    """A flexible chain bound to an edge: a rod that bends; it carries weight and inertia of its own."""

    kind: Literal["chain"] = Field(default="chain", kw_only=True)
    edge: EdgeName
    """The edge it is bound to, which has no support."""
    segments: Annotated[int, Field(ge=1, strict=True)]
    """Segments of equal length, with a curvature for each joint between them; forces are summed over them.
    Every model has a rod that bends smoothly: the lattice divides segments that are longer than its cells."""
    bending_stiffness: Annotated[Positive, Unit("N·m²")]
    """EI of the chain; a joint's stiffness is EI divided by the length of a rigid part."""
    line_density: Annotated[Positive, Unit("kg/m")]
    """Mass per length of the chain."""
    radius: Length
    """Radius of the round cross-section, for the rotary inertia and, on a face, the distance of its axis."""
    face: Literal["mid", "top", "bottom"] = "mid"
    """Where its axis lies: in the mid-surface, or thickness/2 + radius above (top) or below (bottom) it."""
    curvature: Curvature = 0.0
    """Intrinsic curvature: a number, one a joint, or a table over time; > 0 lifts the ends towards +z (plane
    "normal", "spatial") or bends them outwards ("inplane")."""
    damping_time: Annotated[NonNegative, Unit("s")] = 0.0
    """Every joint has a damper of damping_time times its stiffness."""
    plane: Plane = "normal"
    """Plane of bending: of the edge and the sheet's normal ("normal"), the sheet's plane ("inplane"), or both
    ("spatial")."""
    base: Base = "free"
    """Place where the chain is held: nowhere ("free"), its middle, or its end at the edge's start or end."""

    def _faults(self) -> Iterator[object]:
        count = len(self.curvature) if isinstance(self.curvature, tuple) else self.joints
        joints = f'{self.segments} segments with base = "{self.base}" have {self.joints} joints'
        yield count != self.joints and f"curvature has {count} values, but {joints}"

    @property
    def held_as(self) -> str:
        """Return the name of the chain's base among the reactions."""
        return f"{self.edge} base"

    @property
    def base_ends(self) -> tuple[int, ...]:
        """Return the ends that the base holds: 0 where the edge starts, 1 where it ends."""
        return {"free": (), "start": (0,), "middle": (), "end": (1,)}[self.base]

    def axis_height(self, thickness: float) -> float:
        """Return the height [m] of the chain's axis along the director of a sheet of a thickness [m]."""
        side = {"mid": 0.0, "top": 1.0, "bottom": -1.0}[self.face]
        return side * (thickness / 2.0 + self.radius)

    def pieces(self) -> np.ndarray:
        """Return the bounds (n + 1,), in segments, of the edge's pieces with one joint's curvature each. A
        piece is nearer to its joint than to others; the outer ones reach to the ends. Without a joint the
        whole edge is one piece."""
        inner = np.arange(1, self.segments - 1) + 0.5  # between joints of whole length
        extra = {"start": 0.5, "end": self.segments - 0.5, "middle": self.segments / 2.0}.get(self.base)
        if extra is not None and self.joints == self.segments and self.joints > 1:
            inner = np.sort(np.append(inner, extra))
        return np.concatenate([[0.0], inner, [self.segments]])

    def curvatures(self) -> PiecewiseCurve:
        """Return the intrinsic curvature (joints,) [1/m] of every joint over time, (1,) without joints."""
        count = max(self.joints, 1)
        if isinstance(self.curvature, CurvatureTable):
            return PiecewiseCurve(self.curvature.time, [(value,) * count for value in self.curvature.value])
        each = self.curvature if isinstance(self.curvature, tuple) else (self.curvature,) * count
        return PiecewiseCurve((0.0,), [each or (0.0,)])

    @property
    def joints(self) -> int:
        """Return the number of joints: between segments, and the half-length ones at a held base."""
        held = self.base in ("start", "end") or (self.base == "middle" and self.segments % 2 == 0)
        return self.segments - 1 + held


class EdgeMotion(OverTime):
    """The edge moved rigidly as prescribed over time."""

    kind: Literal["motion"] = Field(kw_only=True)
    edge: EdgeName
    """The edge that is moved, which has no support."""
    displacement: Annotated[tuple[Vector3, ...], Unit("m")] = ()
    """[ux, uy, uz] of the edge's middle at each time, linear between them."""
    rotation: Annotated[tuple[Vector3, ...], Unit("rad")] = ()
    """Rotation vector [about x, about y, about z] of the edge about its middle at each time, right-handed,
    linear between them."""

    def _faults(self) -> Iterator[object]:
        yield from super()._faults()
        yield not self.displacement and not self.rotation and "needs displacement [m] or rotation [rad]"

    @property
    def held_as(self) -> str:
        """Return the motion's name among the reactions."""
        return str(self.edge)


def _kind(data: Any) -> str:
    return str(data.get("kind", "chain") if isinstance(data, dict) else getattr(data, "kind", "chain"))


Actuator = Annotated[
    Annotated[Chain, Tag("chain")] | Annotated[EdgeMotion, Tag("motion")], Discriminator(_kind)
]

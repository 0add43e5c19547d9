"""The sheet, its edges and its weight.

The flat sheet's mid-surface is z = 0 with x in [0, length_x] and y in [0, length_y].
An edge is named by the axis it is normal to and the end of that axis: x0, x1, y0, y1.
"""

from collections.abc import Iterator
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from sheetbench.scenes.objects.drawn import from_file
from sheetbench.scenes.objects.plan_mesh import PlanMesh
from sheetbench.scenes.objects.quantities import Frozen, Length, PlanPoint, Positive, Unit, Vector3
from sheetbench.scenes.objects.shapes import COINCIDENT, crossing
from sheetbench.scenes.objects.tables import Loading

EdgeName = Literal["x0", "x1", "y0", "y1"]
Outline = Annotated[tuple[PlanPoint, ...], Field(min_length=3)]


def _or_file(kind: Any) -> BeforeValidator:
    """Return the validator that lets the JSON Schema of a key allow a file's name too."""
    return BeforeValidator(lambda value: value, json_schema_input_type=str | kind)


DRAWN = ("mesh", "outline")  # keys that a file's name may stand for
Taper = Annotated[tuple[Positive, Positive], Unit("m")]


class Edge(NamedTuple):
    """An edge: its normal axis, the axis it runs along (0 = x, 1 = y), and its end of the normal axis."""

    normal_axis: int
    along_axis: int
    far_end: bool

    @property
    def outward(self) -> tuple[float, float, float]:
        """Return the unit vector in the plane that points out of the sheet."""
        sign = 1.0 if self.far_end else -1.0
        return (sign, 0.0, 0.0) if self.normal_axis == 0 else (0.0, sign, 0.0)


EDGES: dict[str, Edge] = {"x0": Edge(0, 1, False), "x1": Edge(0, 1, True)}
EDGES |= {"y0": Edge(1, 0, False), "y1": Edge(1, 0, True)}


class Sheet(Frozen):
    """A flat sheet: a rectangle, or an outline or a mesh within the rectangle; lengths in metres."""

    length_x: Length
    """Side along x: the sheet lies in 0 ≤ x ≤ length_x."""
    length_y: Length
    """Side along y: the sheet lies in 0 ≤ y ≤ length_y."""
    thickness: Length
    """Thickness, half of it above and half below the mid-surface z = 0; at most the shorter side."""
    taper_x: Taper | None = Field(default=None, kw_only=True)
    """Thickness at x0 and at x1, linear between, one at least and one at most `thickness`."""
    taper_y: Taper | None = Field(default=None, kw_only=True)
    """Thickness at y0 and at y1, linear between; with taper_x the product of both over `thickness`."""

    outline: Annotated[Outline, Unit("m"), _or_file(Outline)] | None = Field(default=None, kw_only=True)
    """Corners [x, y] in turn of a sheet that is no rectangle: length_x and length_y are the sides of the
    rectangle around it, which begins at x = 0 and y = 0. Or "disc", round in that rectangle; or a drawing, as
    "fin.dxf" or "fin.svg", relative to the scene's file, whose largest ring is the outline; the rings within
    it are cutouts."""
    mesh: Annotated[PlanMesh, _or_file(PlanMesh)] | None = Field(default=None, kw_only=True)
    """In place of `outline`: a flat mesh in a file of Gmsh, Wavefront OBJ or another format, as "fin.msh",
    relative to the scene's file. Plate, shell and solid use its triangles and quadrilaterals as their mesh;
    its boundary is the outline, with its holes."""
    mesh_scale: Length | None = Field(default=None, kw_only=True)
    """Length of a unit of the file of `mesh` or `outline`, as "1 mm"; 1 m unless given, for a drawing the
    unit in its file."""
    mesh_shift: Literal["corner", "centre"] | Annotated[PlanPoint, Unit("m")] | None = Field(
        default=None, kw_only=True
    )
    """Shift of the places of that file [m]: [dx, dy]; "corner" moves the rectangle's corner to x = 0, y = 0,
    the default for drawings; "centre" moves the file's origin to the sheet's middle."""
    drawn_from: str | None = Field(default=None, kw_only=True)
    """Written by the reader of that file: its name, and the changes of its places."""

    @model_validator(mode="before")
    @classmethod
    def _read(cls, data: Any) -> Any:
        """Replace the name of a mesh's or an outline's file by the file's contents."""
        if not isinstance(data, dict) or not any(isinstance(data.get(key), str) for key in DRAWN):
            return data
        read = from_file(data)
        if read.pop("holes", ()):
            raise ValueError("outline: the drawing's holes are cutouts: give the sheet to Scene as a dict")
        return read

    def _faults(self) -> Iterator[object]:
        thickness, shorter = f"thickness = {self.thickness:g} m", min(self.lengths)
        more = f"is more than the shorter side, {shorter:g} m; lengths are in metres"
        yield self.thickness > shorter and f"{thickness} {more}"
        for name, ends in self.given(("taper_x", "taper_y")).items():
            given, beside = f"{name} = [{ends[0]:g}, {ends[1]:g}] m", f"{thickness} is not between the two"
            yield not min(ends) <= self.thickness <= max(ends) and f"{given}: {beside}"
            yield max(ends) > shorter and f"{given} is more than the shorter side"
        for key in self.given(("mesh_scale", "mesh_shift")):
            yield f"{key}: for a file of mesh or outline only; numbers are in metres"
        drawn = {"outline": self.outline, "mesh": self.mesh and self.mesh.points}
        one = "outline and mesh: give one of them; the outline of a mesh is its boundary"
        yield all(drawn.values()) and one
        for key, corners in drawn.items():
            every = zip(*corners or (), strict=True)
            for name, length, places in zip("xy", self.lengths, every, strict=False):
                low, high = min(places), max(places)
                remedy = self._remedy(low, high - low, length) if self.drawn_from else ""
                there = (
                    f"{key}: its corners are at {low:g} ≤ {name} ≤ {high:g} m; they have to reach from 0 to"
                )
                off = max(abs(low), abs(high - length)) > COINCIDENT * length
                yield off and f"{there} length_{name} = {length:g} m{remedy}"
        yield self.outline and crossing("outline", self.outline)

    @staticmethod
    def _remedy(low: float, size: float, length: float) -> str:
        """Return a clause on the key that would correct the places of a file, for the end of a refusal."""
        if abs(size - length) > COINCIDENT * length:
            return f"; mesh_scale = {length / size:.4g} times what it is makes it as long" * (size > 0.0)
        return '; mesh_shift = "corner" puts them there'

    @property
    def drawn(self) -> bool:
        """Return whether the sheet has an outline or a mesh, and need not be a rectangle."""
        return self.outline is not None or self.mesh is not None

    def thickness_at(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Return the thickness [m] at places x, y [m], without patches."""
        thickness = np.full(np.broadcast_shapes(np.shape(x), np.shape(y)), self.thickness)
        for ends, length, at in zip((self.taper_x, self.taper_y), self.lengths, (x, y), strict=True):
            if ends is not None:
                thickness *= (ends[0] + (ends[1] - ends[0]) * at / length) / self.thickness
        return thickness

    @property
    def lengths(self) -> tuple[float, float]:
        """Return the sides along x and y [m]."""
        return (self.length_x, self.length_y)

    def edge_at(self, name: str) -> float:
        """Return an edge's coordinate along its normal axis [m]."""
        return self.lengths[EDGES[name].normal_axis] if EDGES[name].far_end else 0.0

    def edge_ends(self, name: str) -> tuple[PlanPoint, PlanPoint]:
        """Return plan points [m] of an edge's two ends, in the direction of its axis."""
        at, length = self.edge_at(name), self.lengths[EDGES[name].along_axis]
        return ((at, 0.0), (at, length)) if EDGES[name].normal_axis == 0 else ((0.0, at), (length, at))


class Gravity(Loading):
    """A uniform acceleration of every mass; may have a `history`, as loads do."""

    acceleration: Annotated[Vector3, Unit("m/s²")]
    """Components along x, y and z: [0.0, 0.0, -9.81] for a sheet that lies level, z pointing up."""

    @property
    def last_acceleration(self) -> Vector3:
        """Return the last acceleration [m/s²], which statics take."""
        x, y, z = (self.last_factor * component for component in self.acceleration)
        return x, y, z

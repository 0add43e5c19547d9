"""The kinds of support, of an edge or, in place of `edge`, of the part of the sheet in a shape, `where`.

A support holds the mid-surface, or components of it, and may hold its normal too, the director. The director
is, with n pointing out of the sheet, e along the edge and s measured from its middle,

    e_z cos τ − n sin τ    in a clamp of tilt τ, which turns about the edge's mid-line
    e_z cos κs − e sin κs  on a rod of curvature κ, which keeps arc length and the middle's place and tangent

A rod that ends at a plane of symmetry has its middle there. A plane of symmetry holds the displacement across
it and the director's tilt across it.
"""

from collections.abc import Iterable, Iterator, Sequence
from math import pi
from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, BeforeValidator, ConfigDict, Field

from sheetbench.scenes.objects.quantities import Angle, Frozen, Number, PlanPoint, Unit, Vector3
from sheetbench.scenes.objects.shapes import Rectangle, Shape
from sheetbench.scenes.objects.sheet import EDGES, EdgeName
from sheetbench.scenes.objects.tables import Interpolation, OverTime, PiecewiseCurve

Component = Literal["x", "y", "z"]


def _each_once(components: tuple[Component, ...]) -> tuple[Component, ...]:
    if len(set(components)) != len(components):
        raise ValueError("a component is named twice")
    return components


Components = Annotated[tuple[Component, ...], Field(min_length=1), AfterValidator(_each_once)]
LARGEST_TILT = pi / 2.0  # rad, of a clamp
SMALLEST_PLACE = 1e-12  # m, to each side of a point


class Motion(OverTime):
    """Prescribed displacement of a support over time; statics take the last sample."""

    displacement: Annotated[tuple[Vector3, ...], Unit("m")]
    """[ux, uy, uz] of the whole edge at each time."""
    interpolation: Interpolation = Field(default="smooth", kw_only=True)
    """Between samples "smooth" has cubics that do not overshoot, so that the velocity jumps at the first and
    last sample at most; "linear" has lines, and the velocity jumps at every sample."""

    @property
    def course(self) -> PiecewiseCurve:
        """The displacement (3,) [m] over time."""
        return self.over_time("displacement")


_or_rim = BeforeValidator(
    lambda value: {"rim": True} if value == "rim" else value, json_schema_input_type=Shape | Literal["rim"]
)


class _EdgeSupport(Frozen):
    edge: EdgeName
    """The edge that is supported."""
    motion: Motion | None = Field(default=None, kw_only=True)
    """How the support moves over time, in the components that it holds; statics take the last sample."""


class _Support(_EdgeSupport):
    model_config = ConfigDict(
        json_schema_extra={"allOf": [{"oneOf": [{"required": ["edge"]}, {"required": ["where"]}]}]}
    )

    # None only with `where`, which models that read edges refuse by `require_rectangle`
    edge: Annotated[EdgeName, Field(default=None)]
    """The edge that is supported."""
    where: Annotated[Shape, _or_rim] | None = Field(default=None, kw_only=True)
    """In place of `edge`: the part of the sheet that is supported; "rim" for all of its outline, { hole = 1 }
    for the rim of a hole."""

    def _faults(self) -> Iterator[object]:
        yield (self.edge is None) == (self.where is None) and "needs one of edge and where"


class Clamped(_Support):
    """A clamp: mid-surface and its normal are held."""

    kind: Literal["clamped"] = Field(default="clamped", kw_only=True)
    tilt: Angle = 0.0
    """The clamp turned about the edge, at most π/2 either way; > 0 lets the sheet start off downwards."""

    def _faults(self) -> Iterator[object]:
        yield from super()._faults()
        more = f"tilt: {self.tilt:g} rad is more than π/2 either way, the most a clamp may be turned"
        yield abs(self.tilt) > LARGEST_TILT and more
        lost = f"tilt = {self.tilt:g} rad turns the clamp of an edge; leave tilt or where out"
        yield self.tilt and self.where and lost


class Hinged(_Support):
    """A hinge: mid-surface held, free to turn about the edge and, the soft simple support, along it too."""

    kind: Literal["hinged"] = Field(default="hinged", kw_only=True)
    twist: Literal["free", "held"] = Field(default="free", kw_only=True)
    """"held" keeps the sheet's normal from tilting along the edge: the hard simple support, Kirchhoff's. A
    square of thickness h and side a so held all around deflects less than with "free", by 0.85 h/a."""

    def _faults(self) -> Iterator[object]:
        yield from super()._faults()
        yield self.twist == "held" and self.where and 'twist = "held" is for edges; leave twist or where out'


class Held(_Support):
    """A support of some components of the mid-surface's displacement, free to turn."""

    kind: Literal["held"] = Field(default="held", kw_only=True)
    components: Components
    """Which of "x", "y" and "z" are held, for instance ["z"] for an edge that slides on a rail."""


class Point(Frozen):
    """A pin or a tack: some components of the mid-surface's displacement held at one point, free to turn."""

    kind: Literal["point"] = Field(default="point", kw_only=True)
    at: Annotated[PlanPoint, Unit("m")]
    """Plan point [x, y] of the undeformed sheet that is held."""
    components: Components = ("x", "y", "z")
    """Which of "x", "y" and "z" are held there; all unless given."""
    edge: ClassVar[Any] = None
    motion: ClassVar[None] = None

    @property
    def where(self) -> Shape:
        """Return the point as a tiny square, smaller than any distance on a sheet."""
        (x, y), half = self.at, SMALLEST_PLACE
        return Shape(rectangle=Rectangle(x=(x - half, x + half), y=(y - half, y + half)))


class Curved(_EdgeSupport):
    """A clamp on a rigid rod bent in the plane of the edge and z."""

    kind: Literal["curved"] = Field(default="curved", kw_only=True)
    curvature: Annotated[Number, Unit("1/m")]
    """Curvature of the rod; > 0 lifts the edge's ends towards +z, its middle stays in place."""


class Symmetric(Frozen):
    """A plane of symmetry: beyond the edge the sheet goes on as its own mirror image."""

    kind: Literal["symmetric"] = Field(default="symmetric", kw_only=True)
    edge: EdgeName
    """The edge where the sheet is cut."""
    motion: ClassVar[None] = None


AnySupport = Clamped | Hinged | Held | Point | Curved | Symmetric
Support = Annotated[AnySupport, Field(discriminator="kind")]


def place(support: AnySupport) -> Shape | None:
    """Return the shape in which the sheet is supported, None for an edge."""
    return getattr(support, "where", None)


def named(supports: Iterable[AnySupport]) -> dict[str, AnySupport]:
    """Return supports by the names that answers give them: their edge, or "support 2" by their number."""
    return {s.edge if place(s) is None else f"support {n}": s for n, s in enumerate(supports, start=1)}


def held_axes(support: AnySupport) -> tuple[int, ...]:
    """Return the axes (0, 1, 2) along which the support holds the mid-surface."""
    if isinstance(support, Symmetric):
        return (EDGES[support.edge].normal_axis,)
    if isinstance(support, Held | Point):
        return tuple("xyz".index(component) for component in support.components)
    return (0, 1, 2)


def points_overconstrain(supports: Sequence[AnySupport], driven: bool) -> bool:
    """Return whether point supports constrain the sheet in its plane beyond its free rigid motions. Their
    displacement then grows with the logarithm of a mesh's fineness, without a limit. driven: by actuators
    too."""
    points = [support for support in supports if isinstance(support, Point)]
    in_plane = sum(axis in "xy" for point in points for axis in point.components)
    return in_plane > (0 if driven or len(points) < len(supports) else 3)


def encloses_volume(supports: Iterable[AnySupport]) -> bool:
    """Return whether every edge is held normal to itself, so that none sweeps an area. A pressure then has a
    potential, − p times the volume between the sheet and its plan."""
    on_edges = [support for support in supports if place(support) is None]
    held = {support.edge for support in on_edges if EDGES[support.edge].normal_axis in held_axes(support)}
    return held == set(EDGES)


def holds_director(support: AnySupport) -> bool:
    """Return whether the support holds the normal as well as the mid-surface."""
    return isinstance(support, Clamped | Curved)


def tilt_axes(support: AnySupport) -> tuple[int, ...]:
    """Return the axes along which the support also holds the director: all layers, not only their mean."""
    if isinstance(support, Hinged) and support.twist == "held":
        return (EDGES[support.edge].along_axis,)
    return held_axes(support) if isinstance(support, Clamped | Curved | Symmetric) else ()

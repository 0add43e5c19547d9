"""A scene: the question to a model, in raw physics (E, ν, ρ, geometry, supports, loads, probes; SI).

A scene knows no solver. It is read from TOML (`sheetbench.scenes.files`) or built as `Scene(…)`, validated
once, and frozen; see `sheetbench.scenes.supports` and `sheetbench.scenes.loads` for what the words mean.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from difflib import get_close_matches
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from pydantic import ConfigDict, Field, model_validator

from sheetbench.errors import SceneError
from sheetbench.scenes import corners, obstacles, region, summary
from sheetbench.scenes.actuators import Actuator, Chain, EdgeMotion
from sheetbench.scenes.air import Air
from sheetbench.scenes.initial import Initial
from sheetbench.scenes.layers import Layer, misfit
from sheetbench.scenes.loads import AreaLoad, Load
from sheetbench.scenes.masses import Mass
from sheetbench.scenes.material import Material
from sheetbench.scenes.natural import Natural, Temperature
from sheetbench.scenes.obstacles import Obstacle
from sheetbench.scenes.orthotropy import FIBRES
from sheetbench.scenes.patches import Patch, mismatched, misplaced
from sheetbench.scenes.quantities import Frozen, PlanPoint, Unit
from sheetbench.scenes.region import Cutout
from sheetbench.scenes.sheet import EDGES, Gravity, Sheet
from sheetbench.scenes.springs import DamperSet, SpringTable
from sheetbench.scenes.supports import Point, Support, held_axes, lets_twist_go, place
from sheetbench.scenes.words import in_words

if TYPE_CHECKING:
    from shapely import Polygon

LISTS = {  # by their keys in Python: those in a file, where each entry is a table
    "layers": "layer", "patches": "patch", "cutouts": "cutout", "supports": "support", "loads": "load",
    "masses": "mass", "obstacles": "obstacle", "actuators": "actuator",
}  # fmt: skip
SHAPED = (
    "sheet.outline", "sheet.mesh", "cutout", "support.where", "load.where", 'load.kind = "area"',
    "mass.where", 'support.kind = "point"',
)  # fmt: skip


class Scene(Frozen):
    """A sheet with supports, loads, actuators and probes.

    Lists are tuples; in TOML they are [[support]], [[load]], [[actuator]].
    """

    model_config = ConfigDict(alias_generator=lambda key: LISTS.get(key, key))

    name: str = Field(min_length=1)
    """A short name, for tables and messages."""
    title: str = Field(default="", kw_only=True)
    """A line for headings and pictures."""
    sheet: Sheet
    """The flat, stress-free sheet."""
    material: Material
    """What the sheet is made of."""
    layers: tuple[Layer, ...] = Field(default=(), kw_only=True)
    """Plies of a laminate, from the lower face up, symmetric about the middle; none for one material."""
    patches: tuple[Patch, ...] = Field(default=(), kw_only=True)
    """Parts of the sheet with a thickness or a material of their own; where they overlap later ones win."""
    cutouts: tuple[Cutout, ...] = Field(default=(), kw_only=True)
    """Holes and notches: parts of the plan where there is no sheet."""
    natural: Natural | None = Field(default=None, kw_only=True)
    """Strain and curvature of a sheet that is not flat and free of stress at rest."""
    temperature: Temperature | None = Field(default=None, kw_only=True)
    """How much warmer the sheet is than where it was flat."""
    gravity: Gravity | None = None
    """The sheet's weight; without this table the sheet is weightless."""
    air: Air | None = Field(default=None, kw_only=True)
    """Still air, which resists where the sheet moves along its normal; without this table there is none."""
    supports: tuple[Support, ...] = ()
    """How edges are held, at most one support an edge, and parts of the sheet."""
    loads: tuple[Load, ...] = ()
    """Forces, moments and pressures, which add up."""
    masses: tuple[Mass, ...] = Field(default=(), kw_only=True)
    """Payloads: they weigh under gravity and are inert in motion, and stiffen nothing."""
    obstacles: tuple[Obstacle, ...] = Field(default=(), kw_only=True)
    """Rigid bodies that the sheet may touch from one side, without friction at rest."""
    actuators: tuple[Actuator, ...] = ()
    """What moves edges that have no support."""
    initial: Initial | None = Field(default=None, kw_only=True)
    """The shape that a motion starts from; without this table nothing but the supports shapes the sheet."""
    springs: SpringTable | None = None
    """The lattice's own spring constants, as `sheetbench calibrate --toml` writes them; no other model reads
    them. Where cells differ, on a graded grid, a constant is a list of rows of cells from y0 to y1, each from
    x0 to x1."""
    dampers: DamperSet | None = None
    """The lattice's own dampers along its links in `simulate`, in place of the material's damping_time, which
    area and strain springs keep."""
    probes: Annotated[dict[str, PlanPoint], Unit("m")] = Field(default_factory=dict)
    """Named plan points [x, y] of the undeformed sheet where displacements are told; without this table P1 is
    the centre, P4 the corner farthest from the supports, P2 and P3 are the middles of the sides beside P4,
    each a quarter of the sheet inside where it would lie on an edge that is held; where there is no sheet,
    the nearest point of it."""

    @model_validator(mode="after")
    def _with_probes(self) -> Scene:
        if not self.probes:
            on_edges = [support for support in self.supports if place(support) is None]
            held = [support.edge for support in on_edges if 2 in held_axes(support)]
            held += [motion.edge for motion in self.motions().values()]
            probes = default_probes(self.sheet, [support.edge for support in on_edges], held)
            if self.pierced:
                probes = {name: region.nearest(self.region, point) for name, point in probes.items()}
            vars(self)["probes"] = probes  # the scene is frozen, but not whole yet
        return self

    @model_validator(mode="after")
    def _consistent(self) -> Scene:
        if wrong := next((f"{key}{reason}" for key, reason in self._conflicts() if reason), None):
            raise ValueError(wrong)
        return self

    def _conflicts(self) -> Iterator[tuple[str, str | None]]:
        """Yield what does not go together, key and reason, no reason where it does."""
        for key, (x, y) in region.marked(self).items():
            lx, ly = self.sheet.lengths
            on = 0.0 <= x <= lx and 0.0 <= y <= ly
            extent = f"which is 0 ≤ x ≤ {lx:g} m, 0 ≤ y ≤ {ly:g} m"
            yield f"{key} = ", None if on else f"{[x, y]} is off the sheet, {extent}"
        if self.patches:
            yield "patch ", misplaced(self.patches, self.sheet)
        if self.shaped_by:
            yield "", region.misplaced(self)
        if self.layers:
            varied = None if self.homogeneous else self.varied_by
            yield "layer: ", varied and f"a laminate is the same all over, without {varied}"
            heated = self.temperature is not None
            yield "layer: ", misfit(self.layers, self.sheet, self.material, heated)
        yield "", self._unnatural()
        yield "patch ", mismatched(self.patches, self.material)
        law = None if self.springs is None else self.material.law
        yield "springs: ", law and f"of a material with law = '{law}' they are calibrated; leave one out"
        held = next((n for n, load in enumerate(self.loads, start=1) if load.hold), 0)
        alone = 'has no effect without [initial] shape = "static", which lets the load go at t = 0'
        yield f"load {held}.hold = true: ", alone if held and self.initial is None else None
        yield from obstacles.conflicts(self)
        yield from corners.conflicts(self.actuators, self.supports, self.sheet)

    def _unnatural(self) -> str:
        """Return why a natural strain or a temperature cannot be, "" where it can."""
        if not (given := self.natural_by):
            return ""
        if self.material.law is not None:
            return f"{given}: not of rubber (law = '{self.material.law}'), whose strains it would multiply"
        if self.natural is not None and self.natural.pretension is not None and not self.homogeneous:
            return f"natural.pretension: beside {self.varied_by}: give strain"
        if self.temperature is not None:
            bare = [n for n, layer in enumerate(self.layers, start=1) if layer.expansion is None]
            unlike = self.material.expansions or (0.0, 0.0)
            if self.material.expansion is None and (bare or not self.layers):
                return "temperature: needs expansion [1/K], of the material or of every layer"
            if unlike[0] != unlike[1] and any(patch.angle is not None for patch in self.patches):
                return "temperature: beside patch.angle expansion is one number"
        return ""

    def replace(self, **values: Any) -> Scene:
        """Return a copy with other values for some keys, those of its sheet and material too.

        Probes that nobody chose go with the sheet's outline. Raises SceneError for what makes no sense.
        """
        parts = (self, self.sheet, self.material)
        keys = [*LISTS.values(), *(key for part in parts for key in type(part).model_fields)]
        for key in values:
            if key not in keys and (near := get_close_matches(key, keys, 1)):
                raise SceneError(f"replace: {key}: unknown key; did you mean {near[0]}?")
        for part in ("sheet", "material"):
            kind = type(getattr(self, part))
            own = {key: values.pop(key) for key in list(values) if key in kind.model_fields}
            if own:
                values[part] = kind.model_validate(values.get(part, getattr(self, part))).replace(**own)
        redrawn = any(
            values.get(key, getattr(self, key)) != getattr(self, key) for key in ("sheet", "cutouts")
        )
        if redrawn and "probes" not in values and self.probes == super().replace(probes={}).probes:
            values["probes"] = {}
        return super().replace(**values)

    def __repr__(self) -> str:
        return summary.text(*self._summary())

    def _repr_html_(self) -> str:
        return summary.html(*self._summary())

    def _summary(self) -> tuple[str, summary.Facts]:
        return f"Scene {self.name}", in_words(self)

    def document(self) -> dict[str, Any]:
        """The scene as in a file, for JSON: plain lists, dicts, numbers and texts."""
        return self.model_dump(mode="json", by_alias=True, exclude_none=True)

    def named_actuators(self) -> dict[str, Actuator]:
        """The actuators in their order by their names: an actuator's is its edge, or, where an edge has
        several, its edge and its number."""
        names = [str(actuator.edge) for actuator in self.actuators]
        if len(set(names)) < len(names):
            names = [f"{edge}.{i + 1}" for i, edge in enumerate(names)]
        return dict(zip(names, self.actuators, strict=True))

    def motions(self) -> dict[str, EdgeMotion]:
        """The edge motions by their names."""
        return {name: a for name, a in self.named_actuators().items() if isinstance(a, EdgeMotion)}

    def chains(self) -> dict[str, dict[str, Chain]]:
        """The chains by their names, of every edge with some."""
        by_edge: dict[str, dict[str, Chain]] = {}
        for name, actuator in self.named_actuators().items():
            if isinstance(actuator, Chain):
                by_edge.setdefault(str(actuator.edge), {})[name] = actuator
        return by_edge

    @property
    def homogeneous(self) -> bool:
        """Whether the sheet is as thick and of the same material all over."""
        return not (any(p.own for p in self.patches) or self.sheet.taper_x or self.sheet.taper_y)

    @property
    def uniform(self) -> bool:
        """Whether it is so, and isotropic."""
        return not self.varied_by

    @property
    def varied_by(self) -> str:
        """The words by which it is not, "" where it is."""
        fibres = [FIBRES] if self.material.kind == "orthotropic" else []
        tapers = [f"sheet.{name}" for name in ("taper_x", "taper_y") if getattr(self.sheet, name) is not None]
        own = any(patch.own for patch in self.patches)
        drawn = [name for name, given in (("layer", self.layers), ("patch", own)) if given]
        return ", ".join([*fibres, *tapers, *drawn])

    @property
    def natural_by(self) -> str:
        """The words by which it is not flat and free of stress at rest, "" where it is."""
        given = [key for key in ("natural", "temperature") if getattr(self, key) is not None]
        each = enumerate(self.patches, start=1)
        return ", ".join([*given, *(f"patch {n}.natural" for n, one in each if one.natural is not None)])

    @property
    def pierced(self) -> bool:
        """Whether the sheet is no whole rectangle."""
        return bool(self.cutouts) or self.sheet.drawn

    @cached_property
    def region(self) -> Polygon:
        """The sheet's plan [m], with its holes, as shapely has it."""
        return region.region(self.sheet, self.cutouts)

    @property
    def shaped_by(self) -> str:
        """The words by which it is no whole rectangle held and loaded at edges, at points or all over."""
        given = (
            self.sheet.outline is not None,
            self.sheet.mesh is not None,
            bool(self.cutouts),
            any(place(one) is not None and not isinstance(one, Point) for one in self.supports),
            any(getattr(load, "where", None) is not None for load in self.loads),
            any(isinstance(load, AreaLoad) for load in self.loads),
            any(payload.where is not None for payload in self.masses),
            any(isinstance(support, Point) for support in self.supports),
        )
        return ", ".join(word for word, drawn in zip(SHAPED, given, strict=True) if drawn)

    @property
    def drawn_by(self) -> str:
        """The words of these, by which the sheet is no plain one."""
        return ", ".join(filter(None, [self.varied_by, self.shaped_by, self.natural_by]))

    def twisting_edges(self) -> frozenset[str]:
        """The edges along which nothing holds the director: free, hinged and held ones."""
        bound = {actuator.edge for actuator in self.actuators}
        return frozenset(e for e in EDGES if e not in bound and lets_twist_go(e, self.supports))

    def save(self, path: str | Path) -> None:
        """Write the scene as TOML, from which `load` reads an equal one."""
        from sheetbench.scenes.toml import to_toml  # a scene that is only solved need not know how

        Path(path).write_text(to_toml(self), encoding="utf-8")

    def probe_points(self) -> np.ndarray:
        """Plan points of the probes, (n, 2) [m], in the order of `probes`."""
        return np.array(list(self.probes.values()), dtype=float).reshape(-1, 2)


def default_probes(sheet: Sheet, supported: Sequence[str], held: Sequence[str]) -> dict[str, PlanPoint]:
    """Return centre P1, middles P2 (y side) and P3 (x side) beside P4, the corner farthest from supports.

    A point on one of the edges that are `held` would tell nothing: it lies a quarter of the sheet inside.
    """
    lx, ly = sheet.lengths

    def distance(corner: PlanPoint) -> float:
        return sum(abs(corner[EDGES[edge].normal_axis] - sheet.edge_at(edge)) for edge in supported)

    def free(point: PlanPoint) -> PlanPoint:
        inside = list(point)
        for edge in held:
            axis, at = EDGES[edge].normal_axis, sheet.edge_at(edge)
            if point[axis] == at:
                inside[axis] = 0.25 * sheet.lengths[axis] + 0.5 * at
        return inside[0], inside[1]

    far = max([(lx, ly), (lx, 0.0), (0.0, ly), (0.0, 0.0)], key=distance)  # of ties the first
    points = {"P1": (lx / 2, ly / 2), "P2": (lx / 2, far[1]), "P3": (far[0], ly / 2), "P4": far}
    return {name: free(point) for name, point in points.items()}

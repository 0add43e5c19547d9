"""The fields of a scene: tables and lists of them, their names in a file, and properties of the sheet."""

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import numpy as np
from pydantic import ConfigDict, Field, ValidationError, model_validator

from sheetbench.scenes.objects import cutouts
from sheetbench.scenes.objects.actuators import Actuator, Chain, EdgeMotion
from sheetbench.scenes.objects.air import Air
from sheetbench.scenes.objects.cutouts import Cutout
from sheetbench.scenes.objects.drawn import from_file
from sheetbench.scenes.objects.layers import Layer
from sheetbench.scenes.objects.loads import AreaLoad, Initial, Load
from sheetbench.scenes.objects.masses import Mass
from sheetbench.scenes.objects.material import Material
from sheetbench.scenes.objects.natural import Natural, Temperature
from sheetbench.scenes.objects.obstacles import AnyObstacle, Obstacle
from sheetbench.scenes.objects.orthotropy import FIBRES
from sheetbench.scenes.objects.patches import Patch
from sheetbench.scenes.objects.quantities import Frozen, PlanPoint, Unit
from sheetbench.scenes.objects.sheet import EDGES, Gravity, Sheet
from sheetbench.scenes.objects.springs import DamperSet, SpringSet
from sheetbench.scenes.objects.stiffness import as_laminate
from sheetbench.scenes.objects.supports import Point, Support, place, tilt_axes

if TYPE_CHECKING:
    from shapely import Polygon

LISTS = {  # by the keys in Python: the keys in a file, where each entry is a table
    "layers": "layer", "patches": "patch", "cutouts": "cutout", "supports": "support", "loads": "load",
    "masses": "mass", "obstacles": "obstacle", "actuators": "actuator",
}  # fmt: skip
POINTS = 'support.kind = "point"'
SHAPED: dict[str, Callable[["SceneFields"], object]] = {  # by a feature's key: whether a scene has it
    "sheet.outline": lambda scene: scene.sheet.outline,
    "sheet.mesh": lambda scene: scene.sheet.mesh,
    "cutout": lambda scene: scene.cutouts,
    "support.where": lambda scene: any(place(s) for s in scene.supports if not isinstance(s, Point)),
    "load.where": lambda scene: any(getattr(load, "where", None) for load in scene.loads),
    'load.kind = "area"': lambda scene: any(isinstance(load, AreaLoad) for load in scene.loads),
    "mass.where": lambda scene: any(payload.where for payload in scene.masses),
    POINTS: lambda scene: any(isinstance(one, Point) for one in scene.supports),
}


class SceneFields(Frozen, defer_build=True):
    """The fields of a scene, not yet checked against each other, and properties of the sheet."""

    model_config = ConfigDict(alias_generator=lambda key: LISTS.get(key, key))

    name: str = Field(min_length=1)
    """A short name, for tables and messages."""
    title: str = Field(default="", kw_only=True)
    """A line for headings and pictures."""
    sheet: Sheet
    """The flat, stress-free sheet."""
    material: Material
    """Elasticity, density and damping of the sheet."""
    layers: tuple[Layer, ...] = Field(default=(), kw_only=True)
    """Plies of a laminate, from the lower face up; none for one material."""
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
    """Chains and motions of edges that have no support."""
    initial: Initial | None = Field(default=None, kw_only=True)
    """The shape that a motion starts from; without this table nothing but the supports shapes the sheet."""
    springs: SpringSet | None = None
    """The lattice's own spring constants, as `sheetbench calibrate --toml` writes them; no other model reads
    them. Where cells differ, on a graded grid, a constant is a list of rows of cells from y0 to y1, each from
    x0 to x1."""
    dampers: DamperSet | None = None
    """The lattice's own dampers along its links in `simulate`, in place of the material's damping_time, which
    area and strain springs then lack too."""
    probes: Annotated[dict[str, PlanPoint], Unit("m")] = Field(default_factory=dict)
    """Named plan points [x, y] of the undeformed sheet where answers are compared; without this table P1 is
    the centre, P4 the corner farthest from the supports, P2 and P3 are the middles of the sides beside P4,
    each a quarter of the sheet inside where it would lie on an edge that is held; where there is no sheet,
    the nearest point of it."""

    @model_validator(mode="before")
    @classmethod
    def _holes_of_drawing(cls, data: Any) -> Any:
        """Read the sheet's outline from a drawing, and add the drawing's holes to the cutouts."""
        sheet = data.get("sheet") if isinstance(data, dict) else None
        if not isinstance(sheet, dict) or not isinstance(sheet.get("outline"), str):
            return data
        try:
            read = from_file(sheet)
        except ValueError as error:
            raise ValueError(f"sheet.{error}") from None
        holes = [{"shape": {"polygon": corners}} for corners in read.pop("holes", ())]
        key = next((key for key in ("cutout", "cutouts") if key in data), "cutout")
        return {**data, "sheet": read, **({key: [*data.get(key, ()), *holes]} if holes else {})}

    @model_validator(mode="before")
    @classmethod
    def _layers_of_stiffness(cls, data: Any) -> Any:
        """Replace a material given by its stiffnesses by an equivalent laminate."""
        given = data.get("material") if isinstance(data, dict) else None
        kind = given.get("kind") if isinstance(given, dict) else getattr(given, "kind", "")
        if kind != "stiffness" or not isinstance(data.get("sheet"), dict | Sheet):
            return data
        try:
            material = Material.model_validate(given)
        except ValidationError:  # reported, with its keys, when the fields are validated
            return data
        own = given if isinstance(given, dict) else material.model_dump(exclude_defaults=True)
        return as_laminate({**data, "material": own}, material)

    def document(self) -> dict[str, Any]:
        """Return the scene with the keys of a file as plain lists, dicts, numbers and texts, for JSON."""
        return self.model_dump(mode="json", by_alias=True, exclude_none=True)

    def named_actuators(self) -> dict[str, Actuator]:
        """Return the actuators by their names: the edge, with a number if any edge has several actuators."""
        names = [str(actuator.edge) for actuator in self.actuators]
        if len(set(names)) < len(names):
            names = [f"{edge}.{i + 1}" for i, edge in enumerate(names)]
        return dict(zip(names, self.actuators, strict=True))

    def named_obstacles(self) -> dict[str, AnyObstacle]:
        """Return the obstacles by their names in answers: "obstacle 1" and so on."""
        return {f"obstacle {n}": obstacle for n, obstacle in enumerate(self.obstacles, start=1)}

    def motions(self) -> dict[str, EdgeMotion]:
        """Return the edge motions by their names."""
        return {name: a for name, a in self.named_actuators().items() if isinstance(a, EdgeMotion)}

    def chains(self) -> dict[str, dict[str, Chain]]:
        """Return the chains by their names, for every edge that has chains."""
        by_edge: dict[str, dict[str, Chain]] = {}
        for name, actuator in self.named_actuators().items():
            if isinstance(actuator, Chain):
                by_edge.setdefault(str(actuator.edge), {})[name] = actuator
        return by_edge

    @property
    def homogeneous(self) -> bool:
        """Return whether thickness and material are constant over the sheet."""
        return not (any(p.own for p in self.patches) or self.sheet.taper_x or self.sheet.taper_y)

    @property
    def uniform(self) -> bool:
        """Return whether the sheet is homogeneous, isotropic and of one layer."""
        return not self.varied_by

    @property
    def varied_by(self) -> str:
        """Return the keys by which the sheet is not uniform, "" if it is."""
        features: dict[str, object] = {FIBRES: self.material.kind == "orthotropic"}
        features |= {f"sheet.{name}": getattr(self.sheet, name) for name in ("taper_x", "taper_y")}
        features |= {"layer": self.layers, "patch": any(patch.own for patch in self.patches)}
        return ", ".join(word for word, given in features.items() if given)

    @property
    def natural_states(self) -> dict[str, Natural | Temperature]:
        """Return the natural states and the temperature by their names as parameters, without absent ones."""
        of_patches = {f"patch{n}.natural": patch.natural for n, patch in enumerate(self.patches, start=1)}
        every = {"natural": self.natural, **of_patches, "temperature": self.temperature}
        return {name: state for name, state in every.items() if state is not None}

    @property
    def natural_by(self) -> str:
        """Return the keys by which the sheet is not flat and free of stress at rest, "" if it is."""
        return ", ".join(name for name, state in self.natural_states.items() if state.nonzero)

    @property
    def pierced(self) -> bool:
        """Return whether the sheet is no whole rectangle."""
        return bool(self.cutouts) or self.sheet.drawn

    @cached_property
    def region(self) -> "Polygon":
        """Return the sheet's plan [m] with its holes, a polygon of shapely."""
        return cutouts.region(self.sheet, self.cutouts)

    @property
    def shaped_by(self) -> str:
        """Return the keys of an outline, and of supports, loads and masses on a part of the sheet."""
        return ", ".join(word for word, has in SHAPED.items() if has(self))

    @property
    def drawn_by(self) -> str:
        """Return all keys by which the sheet is not a plain one: uniform, rectangular and flat at rest."""
        return ", ".join(filter(None, [self.varied_by, self.shaped_by, self.natural_by]))

    def twisting_edges(self) -> frozenset[str]:
        """Return the edges along which nothing holds the director: free, hinged and held ones."""
        bound = {actuator.edge for actuator in self.actuators}
        return frozenset(EDGES) - bound - {support.edge for support in self.supports if tilt_axes(support)}

    def probe_points(self) -> np.ndarray:
        """Return the plan points of the probes, (n, 2) [m], in the order of `probes`."""
        return np.array(list(self.probes.values()), dtype=float).reshape(-1, 2)


AScene = TypeVar("AScene", bound=SceneFields)  # for functions that return a scene of their argument's class

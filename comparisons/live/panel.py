"""The page's sliders with their bounds, and the validation of its requests.

A question has the values of the page's sliders, JSON from outside: names, types and bounds are checked, which
are also what keeps a solve small.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass
from math import pi, prod
from typing import Annotated, Any, NamedTuple

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from comparisons.models.grids import Elements as Count
from comparisons.models.spec import Lattice, counted
from comparisons.pages.sheets import eye, outline
from sheetbench.choices import CALIBRATION, CALIBRATIONS
from sheetbench.errors import BadInput, require_choice
from sheetbench.scenes import EDGES, Scene, Sheet
from sheetbench.scenes.meaning.parameters import parameter, put
from sheetbench.scenes.objects.grid import DEFAULT_MASSES, near_square

MASSES_CAP, ELEMENTS_CAP = 33, 16  # along the side of a square sheet, and as many in all on any other
ELEMENTS = 8  # unless given: a shell of 8 × 8 elements answers in a tenth of a second
OWN = "scene"  # the calibration's name where the scene brings its own [springs]
SHOWN = 80  # characters of a foreign name
SETTINGS = ("grid", "grading", "elements", "k")  # sliders of the models, not of the scene


@dataclass(frozen=True)
class Slider:
    """A slider: bounds and value in SI units, and the factor of the displayed value."""

    name: str
    label: str
    unit: str
    factor: float
    low: float
    high: float
    value: float
    whole: bool = False
    logarithmic: bool = False

    def require(self, value: float) -> None:
        """Raise BadInput for a value out of bounds, or not whole if it must be."""
        if not self.low <= value <= self.high or (self.whole and value != int(value)):
            kind = "a whole number " if self.whole else ""
            raise BadInput(f"{self.name} = {value:g}: {kind}from {self.low:g} to {self.high:g} on this page")


class Message(BaseModel):
    """Values of all sliders, as the page sends them; number: of the question."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)
    number: Annotated[int, Field(ge=0, lt=2**53)]
    values: dict[str, float]
    calibration: str


class Question(NamedTuple):
    """A scene and models to solve; elements: of the shell, along the shorter side."""

    number: int
    scene: Scene
    lattice: Lattice
    elements: int


class Panel:
    """The sliders of a scene."""

    def __init__(self, scene: Scene, elements: Count = ELEMENTS, lattice: Lattice | None = None) -> None:
        """Make the sliders, set to the given elements and lattice; k has a slider if the lattice has one.
        Raises BadInput for a value out of bounds."""
        self.scene = scene
        self._lattice = lattice or Lattice()
        self.sliders = {s.name: s for s in _make_sliders(scene, elements, self._lattice)}
        own = (
            {OWN: {"said": "the scene's own [springs], on their grid", "takes": []}} if scene.springs else {}
        )
        self.calibrations = own | {  # methods without a fit, the usual one first
            name: {"said": method.summary, "takes": sorted(method.takes)}
            for name in (CALIBRATION, *CALIBRATIONS)
            for method in [CALIBRATIONS[name]]
            if not method.fitted and ("cells" in method.takes or scene.uniform)
        }
        self.start = self._lattice.calibration or next(iter(self.calibrations))
        for slider in self.sliders.values():
            slider.require(slider.value)
        require_choice("calibration", self.start, self.calibrations)

    def document(self) -> dict[str, Any]:
        """Return the panel as the page builds it."""
        return {
            "name": self.scene.name,
            "title": self.scene.title,
            "outline": outline(self.scene),
            "from": eye(self.scene),
            "probes": {name: [*point] for name, point in self.scene.probes.items()},
            "sliders": [asdict(slider) for slider in self.sliders.values()],
            "calibrations": self.calibrations,
            "calibration": self.start,
        }

    def read(self, text: str | bytes) -> Question:
        """Return the question of a message. Raises BadInput, in a line; SceneError where values contradict
        each other."""
        try:
            message = Message.model_validate_json(text)
        except ValidationError as error:
            fault = error.errors(include_url=False)[0]
            place = ["no question", ".".join(map(str, fault["loc"]))[:SHOWN], fault["msg"]]
            raise BadInput(": ".join(filter(None, place))) from None
        scene, values, name = self.scene, message.values, message.calibration
        if keys := values.keys() ^ self.sliders.keys():
            raise BadInput(f"values: {', '.join(sorted(keys))[:SHOWN]}: {', '.join(self.sliders)} are needed")
        require_choice("calibration", name, self.calibrations)
        for slider in self.sliders.values():
            slider.require(value := values[slider.name])
            if slider.name in SETTINGS or value == slider.value:
                continue
            if slider.name == "gravity":
                scene = scene.replace(gravity=scene.gravity and scene.gravity.times(value))
            elif slider.name == "loads":
                scene = scene.replace(loads=tuple(load.times(value) for load in scene.loads))
            else:
                scene = put(scene, slider.name, value)
        options = self.calibrations[name]["takes"]
        k = values.get("k") if "k" in options else None
        distance = self._lattice.layer_distance if "layer_distance" in options else None
        lattice = Lattice(int(values["grid"]), name, k, distance, values["grading"] or None)
        return Question(message.number, scene, Lattice() if name == OWN else lattice, int(values["elements"]))


def _make_sliders(scene: Scene, elements: Count, lattice: Lattice) -> Iterator[Slider]:
    """Yield sliders of the scene, then of the models."""
    material, thickness = scene.material, scene.sheet.thickness
    moduli = {"young_1": "Young's modulus along the fibres", "young_2": "Young's modulus across the fibres"}
    if material.kind != "orthotropic":
        moduli = {"young": "Young's modulus E"}
        yield Slider("poisson", "Poisson's ratio ν", "", 1.0, 0.0, 0.495, material.poisson)
    else:
        yield Slider("angle", "Angle of the fibres", "°", 180.0 / pi, -pi, pi, material.angle or 0.0)
    patches = (n for n, patch in enumerate(scene.patches, start=1) if "young" in patch.own)
    for name, label in (moduli | {f"patch{n}.young": f"E of patch {n}" for n in patches}).items():
        value = parameter(scene, name).value
        yield Slider(name, label, "MPa", 1e-6, value / 30, value * 30, value, logarithmic=True)
    thickest = max(thickness, min(4 * thickness, 0.5 * min(scene.sheet.lengths)))
    yield Slider("thickness", "Thickness h", "mm", 1e3, thickness / 4, thickest, thickness, logarithmic=True)
    if scene.gravity is not None:
        yield Slider("gravity", "Gravity", "× the scene's", 1.0, 0.0, 3.0, 1.0)
    if scene.loads:
        yield Slider("loads", "Loads", "× the scene's", 1.0, -3.0, 3.0, 1.0)
    for edge in EDGES:
        with suppress(BadInput):  # an edge that is not bent, or by no single number
            curve = parameter(scene, f"curvature_{edge}")
            limit = max(2 * abs(curve.value), 1.5 / min(scene.sheet.lengths))
            yield Slider(curve.name, f"Curvature of edge {edge}", "1/m", 1.0, -limit, limit, curve.value)
    masses, finest = largest_count(scene.sheet, MASSES_CAP - 1) + 1, largest_count(scene.sheet, ELEMENTS_CAP)
    grid, grading = str(lattice.grid or min(DEFAULT_MASSES, masses)), lattice.grading or 0.0
    if not (grid.isdecimal() and isinstance(grading, float | int) and isinstance(elements, int)):
        settings = f"grid = {grid}, grading = {grading}, elements = {counted(elements)}"
        raise BadInput(f"{settings}: a number each (near-square cells, all edges)")
    yield Slider("grid", "Masses along the shorter side", "", 1.0, 3, masses, int(grid), whole=True)
    yield Slider("grading", "Grading towards the edges", "", 1.0, 0.0, 1.0, grading)
    if (k := lattice.k) is not None:
        yield Slider("k", "Stiffness k of every spring", "N/m", 1.0, k / 30, k * 30, k, logarithmic=True)
    yield Slider("elements", "Shell elements along it", "", 1.0, 2, finest, min(elements, finest), whole=True)


def largest_count(sheet: Sheet, cap: int) -> int:
    """Return the largest number of near-square cells along the shorter side of a sheet with at most cap²
    cells."""
    return max((n for n in range(2, cap + 1) if prod(near_square(sheet, n)) <= cap**2), default=2)

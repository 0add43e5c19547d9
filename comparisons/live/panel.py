"""What of a scene can be changed on the page, within which bounds, and how a question is read.

A question is what the page's sliders say, JSON from outside: names, types and bounds are checked, which are
also what keeps a solve small.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass
from math import pi, prod
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, PrivateAttr, ValidationError

from comparisons.models.grids import scene_grid
from comparisons.models.spec import Lattice
from comparisons.pages.sheets import eye, outline
from sheetbench.choices import CALIBRATION, CALIBRATIONS
from sheetbench.errors import BadInput, require_choice
from sheetbench.scenes import EDGES, Scene, Sheet
from sheetbench.scenes.meaning.parameters import parameter, put
from sheetbench.scenes.objects.grid import MASSES, near_square

MASSES_CAP, ELEMENTS_CAP = 33, 16  # along the side of a square sheet, and as many in all on any other
ELEMENTS = 8  # unless given: a shell of 8 × 8 elements answers in a tenth of a second
OWN = "scene"  # the calibration's name where the scene brings its own [springs]
SHOWN = 80  # characters of a foreign name
SETTINGS = ("grid", "grading", "elements", "k")  # sliders of the models, not of the scene


@dataclass(frozen=True)
class Slider:
    """A number that can be dragged: its bounds and value in SI units, and how it is shown, times `factor`."""

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
        """Raise BadInput for a value that this page does not take."""
        if not self.low <= value <= self.high:
            raise BadInput(f"{self.name} = {value:g}: from {self.low:g} to {self.high:g} on this page")
        if self.whole and value != int(value):
            raise BadInput(f"{self.name} = {value:g}: a whole number is needed")


class Question(BaseModel):
    """One setting of all sliders, as the page sends it; number: of the question."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)
    number: Annotated[int, Field(ge=0, lt=2**53)]
    values: dict[str, float]
    calibration: str
    _layer_distance: float | None = PrivateAttr(None)

    @property
    def lattice(self) -> Lattice:
        """The lattice of the question; k and layer distance are of the calibrations that take them."""
        if self.calibration == OWN:
            return Lattice()
        takes, grading = CALIBRATIONS[self.calibration].takes, self.values["grading"] or None
        k = self.values.get("k") if "k" in takes else None
        distance = self._layer_distance if "layer_distance" in takes else None
        return Lattice(int(self.values["grid"]), self.calibration, k, distance, grading)


class Panel:
    """The sliders of a scene."""

    def __init__(self, scene: Scene, elements: int = ELEMENTS, lattice: Lattice | None = None) -> None:
        """elements, lattice: to start with; k has a slider where the lattice has one. Raises BadInput for
        what is beyond the bounds."""
        self.scene = scene
        self._lattice = lattice or Lattice()
        self.sliders = {s.name: s for s in (*_of_scene(scene), *_of_models(scene, elements, self._lattice))}
        self.calibrations = _calibrations(scene)
        self.start = self._lattice.calibration or next(iter(self.calibrations))
        for slider in self.sliders.values():
            slider.require(slider.value)
        require_choice("calibration", self.start, self.calibrations)

    def document(self) -> dict[str, Any]:
        """Return the panel as the page builds it."""
        scene = self.scene
        return {
            "name": scene.name,
            "title": scene.title,
            "outline": outline(scene),
            "from": eye(scene),
            "probes": {name: [*point] for name, point in scene.probes.items()},
            "sliders": [asdict(slider) for slider in self.sliders.values()],
            "calibrations": self.calibrations,
            "calibration": self.start,
        }

    def read(self, text: str | bytes) -> Question:
        """Return the question of a message. Raises BadInput, in a line."""
        try:
            question = Question.model_validate_json(text)
        except ValidationError as error:
            fault = error.errors(include_url=False)[0]
            place = ["no question", ".".join(map(str, fault["loc"]))[:SHOWN], fault["msg"]]
            raise BadInput(": ".join(filter(None, place))) from None
        if unlike := question.values.keys() ^ self.sliders.keys():
            names = ", ".join(sorted(unlike))[:SHOWN]
            raise BadInput(f"values: {names}: {', '.join(self.sliders)} are needed")
        for name, slider in self.sliders.items():
            slider.require(question.values[name])
        require_choice("calibration", question.calibration, self.calibrations)
        question._layer_distance = self._lattice.layer_distance
        return question

    def scene_of(self, question: Question) -> Scene:
        """Return the scene of a question. Raises SceneError where the values contradict each other."""
        scene = self.scene
        for name, value in question.values.items():
            if name in SETTINGS or value == self.sliders[name].value:
                continue
            if name == "gravity":
                scene = scene.replace(gravity=scene.gravity and scene.gravity.times(value))
            elif name == "loads":
                scene = scene.replace(loads=tuple(load.times(value) for load in scene.loads))
            else:
                scene = put(scene, name, value)
        return scene


def _of_scene(scene: Scene) -> Iterator[Slider]:
    material, thickness = scene.material, scene.sheet.thickness
    moduli = {"young_1": "Young's modulus along the fibres", "young_2": "Young's modulus across the fibres"}
    if material.kind != "orthotropic":
        moduli = {"young": "Young's modulus E"}
        yield Slider("poisson", "Poisson's ratio ν", "", 1.0, 0.0, 0.495, material.poisson)
    else:
        yield Slider("angle", "Angle of the fibres", "°", 180.0 / pi, -pi, pi, material.angle or 0.0)
    stiff = (n for n, patch in enumerate(scene.patches, start=1) if "young" in patch.own)
    for name, label in (moduli | {f"patch{n}.young": f"E of patch {n}" for n in stiff}).items():
        value = parameter(scene, name).value
        yield Slider(name, label, "MPa", 1e-6, value / 30, value * 30, value, logarithmic=True)
    thick = max(thickness, min(4 * thickness, 0.5 * min(scene.sheet.lengths)))
    yield Slider("thickness", "Thickness h", "mm", 1e3, thickness / 4, thick, thickness, logarithmic=True)
    if scene.gravity is not None:
        yield Slider("gravity", "Gravity", "× the scene's", 1.0, 0.0, 3.0, 1.0)
    if scene.loads:
        yield Slider("loads", "Loads", "× the scene's", 1.0, -3.0, 3.0, 1.0)
    for edge in EDGES:
        with suppress(BadInput):  # an edge that is not bent, or by no single number
            found = parameter(scene, f"curvature_{edge}")
            most = max(2 * abs(found.value), 1.5 / min(scene.sheet.lengths))
            yield Slider(found.name, f"Curvature of edge {edge}", "1/m", 1.0, -most, most, found.value)


def _of_models(scene: Scene, elements: int, lattice: Lattice) -> Iterator[Slider]:
    masses, fine = most(scene.sheet, MASSES_CAP - 1) + 1, most(scene.sheet, ELEMENTS_CAP)
    grid = min(MASSES, masses)
    if lattice.grid is not None:
        grid = min((counts := scene_grid(scene, lattice.grid))[:2])
        if counts != scene_grid(scene, grid):
            raise BadInput(
                f"grid = {'x'.join(map(str, counts))}: cells are near-square on this page; give one number"
            )
    yield Slider("grid", "Masses along the shorter side", "", 1.0, 3, masses, grid, whole=True)
    if not isinstance(lattice.grading, float | int | None):
        raise BadInput(f"grading = {lattice.grading}: this page grades towards all edges; give a number")
    yield Slider("grading", "Grading towards the edges", "", 1.0, 0.0, 1.0, lattice.grading or 0.0)
    if (k := lattice.k) is not None:
        label = "Stiffness k of every spring (uniform)"
        yield Slider("k", label, "N/m", 1.0, k / 30, k * 30, k, logarithmic=True)
    yield Slider("elements", "Shell elements along it", "", 1.0, 2, fine, min(elements, fine), whole=True)


def most(sheet: Sheet, cap: int) -> int:
    """Near-square cells along the shorter side of a sheet, of which it has cap² in all at most."""
    return max((n for n in range(2, cap + 1) if prod(near_square(sheet, n)) <= cap**2), default=2)


def _calibrations(scene: Scene) -> dict[str, dict[str, Any]]:
    """Those that take no fit, the usual one first; whether they can be graded, and whether they take k."""
    own = {OWN: {"said": "the scene's own [springs], on their grid", "graded": False, "k": False}}
    return ({} if scene.springs is None else own) | {
        name: {"said": method.summary, "graded": "grading" in method.takes, "k": "k" in method.takes}
        for name in (CALIBRATION, *CALIBRATIONS)
        for method in [CALIBRATIONS[name]]
        if not method.fitted and ("cells" in method.takes or scene.uniform)
    }

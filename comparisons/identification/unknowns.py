"""Unknowns of an identification: parameters of a scene (`scenes.meaning.parameters`), and their scaling.

Each is varied through a dimensionless x, 0 at the scene's own value: parameters above zero by their
logarithm, value = start·eˣ; Poisson's ratio and a clamp's tilt by x = value − start; a curvature by
x = (value − start) · longer side.
"""

from dataclasses import dataclass
from math import exp, log, pi

from sheetbench.errors import BadInput, SceneError
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.parameters import parameter, put
from sheetbench.scenes.objects.grid import grid_of
from sheetbench.scenes.objects.supports import LARGEST_TILT

DAMPING = ("damping_time", "damping_rate")
VISCOUS = ("loss_factor", "share_", "time_", "drag")  # and these beginnings: no equilibrium depends on them
SYMBOLS = {"E": "young", "nu": "poisson", "ν": "poisson", "rho": "density", "ρ": "density", "h": "thickness"}
FIRST_RATIO = 0.02  # of critical damping, in the lowest mode: where a search starts from a scene without any
COARSE = 5  # masses of the lattice whose lowest mode that is
FARTHEST = 1e6  # times the scene's own value, up or down, that a parameter above zero is sought


@dataclass(frozen=True)
class Unknown:
    """A parameter of a scene: its name and unit, the value the scene gives it, bounds, and the unit of x;
    given: whether the scene gives its start, rather than FIRST_RATIO."""

    name: str
    unit: str
    start: float
    low: float
    high: float
    step: float | None = None
    given: bool = True

    def value(self, x: float) -> float:
        """Return the parameter at x."""
        return self.start * exp(float(x)) if self.step is None else self.start + self.step * float(x)

    def slope(self, x: float) -> float:
        """Return the derivative of the value by x."""
        return self.value(x) if self.step is None else self.step

    @property
    def turns(self) -> bool:
        """Whether another value may reverse the deflection: of supports, not of the sheet."""
        return self.name.startswith(("curvature_", "tilt_"))

    def bounds(self) -> tuple[float, float]:
        """Return the bounds of x."""
        if self.step is None:
            return -log(FARTHEST), min(log(FARTHEST), log(self.high / self.start))
        return (self.low - self.start) / self.step, (self.high - self.start) / self.step

    def interval(self, x: float, half_width: float) -> tuple[float, float]:
        """Return the values at x ± half_width, within the bounds."""
        least, most = self.bounds()
        return (
            self.value(x - half_width) if x - half_width > least else self.low,
            self.value(x + half_width) if x + half_width < most else self.high,
        )


@dataclass(frozen=True)
class Estimate:
    """An unknown's value, its 95 % interval, the value the search started from and the unit.

    refined: value on cells half as large, estimated, None if unknown; noise_interval: from the measurements'
    noise alone, without the error of the grid or mesh. Both intervals are None for as many unknowns as
    numbers without a standard deviation; determined: whether the data determine it."""

    value: float
    interval: tuple[float, float] | None
    start: float
    unit: str
    refined: float | None
    noise_interval: tuple[float, float] | None
    determined: bool


def unknown(scene: Scene, name: str) -> Unknown:
    """Return a parameter of a scene as an unknown, by its name or its SYMBOLS. The search for a damping that
    is 0 in the scene starts from FIRST_RATIO. Raises BadInput for unknown names, and for other parameters at
    0."""
    name = SYMBOLS.get(name, name)
    try:
        given = parameter(scene, name)
        if name.startswith("tilt_"):
            put(scene, name, given.value or LARGEST_TILT)
    except SceneError as error:
        reason = "supports and actuators allow no tilt there"
        raise BadInput(f"unknown = '{name}': {reason}: {error}") from None
    except BadInput as error:
        raise BadInput(f"unknown = {error}") from None
    if given.low < 0.0:
        step = 1.0 / max(scene.sheet.lengths) if name.startswith("curvature_") else 1.0
        return Unknown(name, given.unit, given.value, given.low, given.high, step)
    if given.value == 0.0 and name in DAMPING:
        return Unknown(name, given.unit, _pick_damping(scene, name), given.low, given.high, given=False)
    if given.value == 0.0:
        raise BadInput(
            f"unknown = '{name}': scene '{scene.name}' has it at 0; give a first guess above 0 there"
        )
    return Unknown(name, given.unit, given.value, given.low, given.high)


def _pick_damping(scene: Scene, name: str) -> float:
    """Return a damping that is FIRST_RATIO of critical in the flat sheet's lowest mode: ζ = c ω/2 of a
    damping time c, ζ = c/2ω of a damping rate."""
    import lumped

    springs = lumped.calibrate(scene.sheet, scene.material, grid_of(scene.sheet, COARSE))
    omega = 2.0 * pi * float(lumped.modes(scene, springs, count=1).frequencies[0])
    return 2.0 * FIRST_RATIO / omega if name == "damping_time" else 2.0 * FIRST_RATIO * omega

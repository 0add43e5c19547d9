"""Natural modes of a model, its frequencies as an answer, and its buckling modes."""

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar

import numpy as np

from sheetbench.answers.answer import Answer
from sheetbench.answers.table import HERTZ, NUMBER, Table
from sheetbench.errors import BadInput, Impossible
from sheetbench.scenes.meaning.kinematics import bent_or_tilted
from sheetbench.scenes.objects.loads import EdgeLoad
from sheetbench.scenes.scene import Scene

STILL = 1e-9  # displacement over the sheet's side below which a loaded sheet does not move
COINCIDENT = 1e-6  # largest relative difference of coincident frequencies


@dataclass(frozen=True)
class FrequencyRow:
    """Natural frequency of a mode [Hz]."""

    mode: Annotated[int, NUMBER("d")]
    frequency: Annotated[float, HERTZ(".5g")]


@dataclass(frozen=True, repr=False)
class NaturalModes(Answer):
    """Base of a model's modes. frequencies: (count,) [Hz], rising. shapes: (count, n, 3), displacements of
    the model's nodes. rigid: the number of rigid motions, which are left out. unknowns: of the
    eigenproblem. gradient_of: function of a mode's number that returns the derivatives of its frequency."""

    file_name = "modes"
    no_gradient: ClassVar[str]  # why modes have no derivatives, with {0} for the modes
    frequencies: np.ndarray
    shapes: np.ndarray
    rigid: int
    unknowns: int
    gradient_of: Callable[[int], Any] | None = field(default=None, kw_only=True)

    @abstractmethod
    def displacement(self, points: np.ndarray) -> np.ndarray:
        """Return the mid-surface displacement of every mode (count, p, 3) at plan points (p, 2) [m]."""

    def sensitivity(self, number: int) -> Any:
        """Return the derivatives df/dθ [Hz per unit] of a mode's frequency by name (`mode_sensitivity` of the
        model); number: from 1. Raises Impossible for modes without derivatives, where two frequencies
        coincide, and for the last mode."""
        if self.gradient_of is None:
            raise Impossible(f"derivatives of frequencies: {self.no_gradient.format(self)}")
        if not 1 <= number < len(self.frequencies):
            last = len(self.frequencies) - 1
            raise Impossible(f"mode {number}: derivatives need the next mode: choose 1 to {last}")
        frequency = self.frequencies[number - 1]
        coincident = np.abs(self.frequencies - frequency) <= COINCIDENT * frequency
        if coincident.sum() > 1:
            numbers = " and ".join(str(n + 1) for n in np.flatnonzero(coincident))
            raise Impossible(f"modes {numbers} coincide: a single frequency of them has no derivative")
        return self.gradient_of(number)

    def document(self) -> dict[str, Any]:
        return {"frequencies_hz": self.frequencies, "rigid_modes": self.rigid, "unknowns": self.unknowns}

    def tables(self) -> tuple[Table, ...]:
        rows = [FrequencyRow(number, f) for number, f in enumerate(self.frequencies, start=1)]
        return (Table.of(FrequencyRow, rows, "Natural frequencies", "modes"),)

    def notes(self) -> list[str]:
        return [f"{self.rigid} rigid motions are left out"] if self.rigid else []


@dataclass(frozen=True, eq=False)
class Buckling:
    """Buckling loads of a flat sheet as factors (count,) of its loads, lowest first, and their shapes.
    displacement: plan points (p, 2) [m] → mid-surface displacement (count, p, 3) of the shapes, of any
    scale."""

    model: str
    label: str
    settings: dict[str, Any]
    load_factors: np.ndarray
    unknowns: int
    seconds: float
    displacement: Callable[[np.ndarray], np.ndarray]

    def as_dict(self) -> dict[str, Any]:
        """Return the numbers for JSON."""
        keys = ("model", "label", "settings", "load_factors", "unknowns")
        return {**{key: getattr(self, key) for key in keys}, "solve_seconds": self.seconds}


def require_flat_and_dead(scene: Scene) -> None:
    """Raise BadInput for a scene without a linear buckling load. The sheet must be flat, without actuators
    and bent or tilted supports, and its loads dead."""
    for number, load in enumerate(scene.loads, start=1):
        if load.follows:
            key = "moment_per_length" if isinstance(load, EdgeLoad) else "kind"
            value = getattr(load, key)
            raise BadInput(f"load {number}.{key} = {value!r}: follows the sheet; buckling needs dead loads")
    if scene.actuators:
        raise BadInput("actuator 1: buckling needs a sheet without actuators")
    if bent_or_tilted(scene.supports, scene.sheet):
        raise BadInput("support: a curved or tilted one bends the sheet; buckling needs a flat sheet")

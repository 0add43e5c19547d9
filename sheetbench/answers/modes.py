"""Natural modes of a model, its frequencies as an answer, and its buckling modes."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from sheetbench.answers.answer import Answer
from sheetbench.answers.table import HERTZ, NUMBER, Table
from sheetbench.errors import BadInput
from sheetbench.scenes.meaning.kinematics import bent_or_tilted
from sheetbench.scenes.objects.loads import EdgeLoad, Pressure
from sheetbench.scenes.scene import Scene

STILL = 1e-9  # displacement over the sheet's side within which what is loaded does not move


@dataclass(frozen=True, repr=False)
class NaturalModes(Answer):
    """Base of a model's modes; frequencies: (count,) [Hz], rising; shapes: (count, n, 3) of its nodes; rigid:
    how many rigid motions there are beside them; unknowns: of the eigenproblem."""

    file_name = "modes"
    frequencies: np.ndarray
    shapes: np.ndarray
    rigid: int
    unknowns: int

    @abstractmethod
    def displacement(self, points: np.ndarray) -> np.ndarray:
        """Mid-surface displacement of every mode (count, p, 3) at plan points (p, 2) [m]."""

    def document(self) -> dict[str, Any]:
        return {"frequencies_hz": self.frequencies, "rigid_modes": self.rigid, "unknowns": self.unknowns}

    def tables(self) -> tuple[Table, ...]:
        columns, rows = (NUMBER("d", "mode"), HERTZ(".5g", "frequency")), enumerate(self.frequencies, start=1)
        return (Table.listed("Natural frequencies", columns, rows, "modes"),)

    def notes(self) -> list[str]:
        return [f"{self.rigid} rigid motions are left out"] if self.rigid else []


@dataclass(frozen=True, eq=False)
class Buckling:
    """How a flat sheet buckles: at so many times its loads (count,), lowest first; displacement: plan points
    (p, 2) [m] → of the mid-surface in every shape, (count, p, 3), of any scale."""

    model: str
    label: str
    settings: dict[str, Any]
    load_factors: np.ndarray
    unknowns: int
    seconds: float
    displacement: Callable[[np.ndarray], np.ndarray]

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        keys = ("model", "label", "settings", "load_factors", "unknowns")
        return {**{key: getattr(self, key) for key in keys}, "solve_seconds": self.seconds}


def require_flat_and_dead(scene: Scene) -> None:
    """Raise BadInput for what has no buckling load: loads that follow the sheet, actuators, supports that
    bend or tilt it."""
    for number, load in enumerate(scene.loads, start=1):
        follower = "kind = 'pressure'" if isinstance(load, Pressure) else ""
        if isinstance(load, EdgeLoad) and load.moment_per_length:
            follower = f"moment_per_length = {load.moment_per_length:g} N·m/m"
        if follower:
            raise BadInput(f"load {number}.{follower}: it follows the sheet; buckling is of dead loads")
    if scene.actuators:
        raise BadInput("actuator 1: buckling is of a sheet without actuators")
    if bent_or_tilted(scene.supports, scene.sheet):
        raise BadInput("support: a curved or tilted one bends the sheet; buckling is of a flat one")

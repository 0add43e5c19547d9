"""Natural modes of a model: its frequencies as an answer."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from sheetbench.answers.answer import Answer
from sheetbench.answers.table import HERTZ, NUMBER, Table


@dataclass(frozen=True)
class ModeRow:
    """A mode and its natural frequency."""

    mode: Annotated[int, NUMBER("d")]
    frequency: Annotated[float, HERTZ(".5g")]


class NaturalModes(Answer):
    """Base of a model's modes; frequencies: (count,) [Hz]; unknowns: of the eigenproblem."""

    file_name = "modes"
    frequencies: np.ndarray
    unknowns: int

    @property
    @abstractmethod
    def left_out(self) -> int:
        """How many rigid motions there are beside them."""

    def document(self) -> dict[str, Any]:
        return {"frequencies_hz": self.frequencies, "rigid_modes": self.left_out, "unknowns": self.unknowns}

    def tables(self) -> tuple[Table, ...]:
        rows = (ModeRow(n, f) for n, f in enumerate(self.frequencies, start=1))
        return (Table.of(ModeRow, rows, "Natural frequencies", "modes"),)

    def notes(self) -> list[str]:
        return [f"{self.left_out} rigid motions are left out"] if self.left_out else []

"""Answer of the study: tables of constants, of linear lattices and of the block, and their pictures."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture
from sheetbench.answers.table import Table
from studies.rubber.beam import Block, Fitted, Swing, beam
from studies.rubber.study import Constant, Square, Strip, blown, constants, curves, pulled_and_hung


@dataclass(frozen=True, repr=False)
class Rubber(Answer):
    """Rows by part; block: only where it was requested."""

    file_name = "rubber"

    constants: tuple[Constant, ...]
    strips: tuple[Strip, ...]
    squares: tuple[Square, ...]
    block: Block | None = None

    def heading(self) -> tuple[str, str, str]:
        return "Rubber", "constants of measured rubbers, and where linear lattices end", ""

    def tables(self) -> tuple[Table, ...]:
        top = f"Top of a clamped square blown up, {self.constants[0].material}"
        parts = (
            Table.of(Constant, self.constants, "Constants and 95 % intervals", "constants", grouped=True),
            Table.of(
                Strip, self.strips, "Error of the end's displacement at a stretch", "stretch", grouped=True
            ),
            Table.of(Square, self.squares, top, "blown"),
        )
        if self.block is None:
            return parts
        return (
            *parts,
            Table.of(Swing, self.block.swings, "A silicone block let go", "beam", grouped=True),
            Table.of(Fitted, self.block.fits, "E and loss factor of each run alone", "fitted", grouped=True),
        )

    def figures(self) -> tuple[Picture, ...]:
        lattices = Picture("linear-lattices", "studies.rubber.figure:of_lattices", (self,))
        block = Picture("silicone-beam", "studies.rubber.figure:of_block", (self.block,))
        return (lattices,) if self.block is None else (lattices, block)

    def document(self) -> dict[str, Any]:
        block = self.block
        return {
            "constants": [{**asdict(row), "unit": row.unit.si} for row in self.constants],
            "strips": [asdict(row) for row in self.strips],
            "squares": [asdict(row) for row in self.squares],
            "swings": [asdict(row) for row in block.swings] if block else [],
            "fitted": [asdict(row) for row in block.fits] if block else [],
        }


def measure(data: Path, block: bool, progress: Callable[[str], None]) -> Rubber:
    """Fit the laws, and compute the errors of linear lattices pulled, hung and inflated; block: also the
    released block. Raises BadInput for a missing file."""
    progress("tensile tests")
    fits = curves(data)
    first = next(iter(fits.values())).law
    assert first is not None
    progress("linear lattices pulled, hung and blown up")
    lattices = tuple(pulled_and_hung(fits)), tuple(blown(first))
    return Rubber(tuple(constants(fits)), *lattices, beam(data, progress) if block else None)

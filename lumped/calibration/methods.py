"""Methods that need nothing but the sheet and its material, by name; springs that a scene brings itself."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from lumped.calibration.calibration import Calibration
from lumped.calibration.consistent import consistent, consistent_edges
from lumped.calibration.least_squares import fit_moduli
from lumped.calibration.report import report
from lumped.calibration.textbook import axial, cauchy, lloyd, van_gelder
from lumped.calibration.uniform import uniform
from lumped.springs import by_cell
from sheetbench.scenes import Scene, SpringTable
from sheetbench.scenes.errors import BadInput
from sheetbench.scenes.grid import MASSES, grid_of

Option = Literal["k", "layer_distance", "grading", "targets"]


@dataclass(frozen=True)
class Method:
    """A calibration method: make(sheet, material, grid, **options), the options it takes, what it is."""

    make: Callable[..., Calibration]
    summary: str
    takes: tuple[Option, ...] = ("layer_distance",)

    @property
    def fitted(self) -> bool:
        """Whether it is fitted to targets."""
        return "targets" in self.takes


GRADED: tuple[Option, ...] = ("layer_distance", "grading")
CLOSED: dict[str, Method] = {
    "consistent": Method(consistent, "every modulus met, in closed form where links allow it", GRADED),
    "consistent-edges": Method(consistent_edges, "the same, with the twist that free edges let go", GRADED),
    "moduli": Method(fit_moduli, "bounded least squares on the moduli"),
    "uniform": Method(uniform, "one k for all links, matched to D11 unless given", ("k", "layer_distance")),
    "cauchy": Method(cauchy, "the isotropic central-force lattice, ν = 1/3; square cells", ()),
    "axial": Method(axial, "every link a bar, k = E A/L"),
    "van-gelder": Method(van_gelder, "Van Gelder's areas over squared lengths, in each layer"),
    "lloyd": Method(lloyd, "off-diagonal stiffness of the bilinear element at ν = 1/3, in each layer"),
}


def given(scene: Scene, grid: int | Sequence[int] | None = None, grading: float | None = None) -> Calibration:
    """The springs of the scene's own [springs] table, with their moduli report.

    grid: as `sheetbench.scenes.grid` reads it; by default the table's own, or nine masses along the shorter
    side where it names none; grading: the table's own unless given. Raises BadInput when the scene has no
    springs, or those of another lattice.
    """
    if scene.springs is None:
        raise BadInput(f"scene '{scene.name}' has no [springs] table")
    table = SpringTable.model_validate(scene.springs)
    asked = grid_of(scene.sheet, grid if grid is not None else table.grid or MASSES)
    if table.grid not in (None, asked):
        own, other = ("x".join(map(str, numbers)) for numbers in (table.grid, asked))
        raise BadInput(
            f"scene '{scene.name}': springs.grid = {own}: these springs are not those of {other} masses; "
            f"solve on {own}, or find others: sheetbench calibrate --grid {other} --toml"
        )
    if grading not in (None, table.grading):
        raise BadInput(
            f"scene '{scene.name}': springs.grading = {table.grading:g}: these springs are not those of "
            f"grading {grading:g}; leave --grading out, or find others: "
            f"sheetbench calibrate --grading {grading:g} --toml"
        )
    springs = table.constants
    if table.grading and not by_cell.varies(springs):
        raise BadInput(
            f"scene '{scene.name}': springs.grading = {table.grading:g}: unequal cells have springs of their "
            f"own, and these are the same for all: sheetbench calibrate --grading {table.grading:g} --toml"
        )
    by_cell.require_cells(springs, asked, f"scene '{scene.name}': ")
    found = report("scene", scene.sheet, scene.material, asked, springs, table.grading)
    return replace(found, masses=table.masses)


def default(scene: Scene) -> Calibration:
    """The scene's own springs, or else consistent ones, on nine masses along the shorter side."""
    if scene.springs is not None:
        return given(scene)
    return consistent(scene.sheet, scene.material, grid_of(scene.sheet))

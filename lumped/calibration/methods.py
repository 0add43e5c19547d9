"""Methods that need nothing but the sheet and its material, by name; springs that a scene brings itself."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from lumped.calibration.calibration import Calibration, report
from lumped.calibration.consistent import consistent, consistent_edges
from lumped.calibration.least_squares import fit_moduli
from lumped.calibration.textbook import axial, cauchy, lloyd, van_gelder
from lumped.calibration.uniform import uniform
from sheetbench.scenes import Scene, SpringTable
from sheetbench.scenes.errors import BadInput
from sheetbench.scenes.grid import MASSES, grid_of

Option = Literal["k", "layer_distance", "targets"]


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


CLOSED: dict[str, Method] = {
    "consistent": Method(consistent, "every modulus met, in closed form where links allow it"),
    "consistent-edges": Method(consistent_edges, "the same, with the twist that free edges let go"),
    "moduli": Method(fit_moduli, "bounded least squares on the moduli"),
    "uniform": Method(uniform, "one k for all links, matched to D11 unless given", ("k", "layer_distance")),
    "cauchy": Method(cauchy, "the isotropic central-force lattice, ν = 1/3; square cells", ()),
    "axial": Method(axial, "every link a bar, k = E A/L"),
    "van-gelder": Method(van_gelder, "Van Gelder's areas over squared lengths, in each layer"),
    "lloyd": Method(lloyd, "off-diagonal stiffness of the bilinear element at ν = 1/3, in each layer"),
}


def given(scene: Scene, grid: int | Sequence[int] | None = None) -> Calibration:
    """The springs of the scene's own [springs] table, with their moduli report.

    grid: as `sheetbench.scenes.grid` reads it; by default the table's own, or nine masses along the shorter
    side where it names none. Raises BadInput when the scene has no springs, or those of another lattice.
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
    if table.grading:
        raise BadInput(f"scene '{scene.name}': springs.grading = {table.grading:g}: all cells are alike here")
    found = report("scene", scene.sheet, scene.material, asked, table.constants)
    return replace(found, masses=table.masses)


def default(scene: Scene) -> Calibration:
    """The scene's own springs, or else consistent ones, on nine masses along the shorter side."""
    if scene.springs is not None:
        return given(scene)
    return consistent(scene.sheet, scene.material, grid_of(scene.sheet))

"""The calibration methods by name, and the springs that a scene brings itself."""

from __future__ import annotations

from collections.abc import Sequence

from lumped.calibration.calibration import Calibration, Method, report
from lumped.calibration.consistent import consistent
from lumped.calibration.fitted import fit_modal, fit_static
from lumped.calibration.least_squares import fit_moduli
from lumped.calibration.targets import Target
from lumped.calibration.textbook import axial, cauchy, lloyd, van_gelder
from lumped.calibration.uniform import uniform
from lumped.lattice import Grid
from sheetbench.scenes import Material, Scene, Sheet

CALIBRATIONS: dict[str, Method] = {
    "consistent": consistent,
    "moduli": fit_moduli,
    "uniform": uniform,
    "cauchy": cauchy,
    "axial": axial,
    "van-gelder": van_gelder,
    "lloyd": lloyd,
    "fit-static": fit_static,
    "fit-modal": fit_modal,
}
FITTED = ("fit-static", "fit-modal")  # these take `targets`


def calibrate(
    sheet: Sheet,
    material: Material,
    grid: Sequence[int] = (9, 9),
    method: str = "consistent",
    k: float | None = None,
    layer_distance: float | None = None,
    targets: Sequence[Target] = (),
) -> Calibration:
    """Springs of a grid (nx, ny) or (nx, ny, layers) for a sheet of this material, by a named method.

    k [N/m] and layer_distance [m] are for the methods that take them; the fitted methods need targets.
    Raises ValueError for an unknown method, a grid too small, or an option the method does not take.
    """
    if method not in CALIBRATIONS:
        raise ValueError(f"calibration = {method!r}: unknown; choose from {', '.join(CALIBRATIONS)}")
    options = {"k": k, "layer_distance": layer_distance}
    if method in FITTED:
        return CALIBRATIONS[method](sheet, material, checked_grid(grid), **options, targets=targets)
    if targets:
        raise ValueError(f"calibration '{method}' takes no targets; {' and '.join(FITTED)} do")
    return CALIBRATIONS[method](sheet, material, checked_grid(grid), **options)


def given(scene: Scene, grid: Sequence[int] = (9, 9)) -> Calibration:
    """The springs of the scene's own [springs] table, with their moduli report.

    Raises ValueError when the scene has none.
    """
    if scene.springs is None:
        raise ValueError(f"scene '{scene.name}' has no [springs] table")
    return report("scene", scene.sheet, scene.material, checked_grid(grid), scene.springs)


def checked_grid(grid: Sequence[int]) -> Grid:
    """(nx, ny, layers), layers 2 unless given. Raises ValueError below 2 masses a side or 2 layers."""
    nx, ny, layers = (*grid, 2) if len(grid) == 2 else tuple(grid)
    if min(nx, ny, layers) < 2:
        raise ValueError(f"grid = {nx}x{ny}x{layers}: a lattice has at least 2 masses a side and 2 layers")
    return nx, ny, layers

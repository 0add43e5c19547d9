"""The springs of a lattice as they are asked for: by a calibration, by k, or as a scene brings them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any
from warnings import warn

from comparisons.models.candidate import Candidate
from comparisons.models.grading import Grading, fixed, grading_of
from comparisons.models.grids import Asked, scene_grid
from comparisons.models.method import chosen
from comparisons.models.sizes import require_room
from comparisons.report.work import Progress, silent
from sheetbench.choices import AUTO, CALIBRATION, CALIBRATIONS, method_of
from sheetbench.scenes import Material, Scene, Sheet
from sheetbench.scenes.errors import BadInput, Implausible, require_choice
from sheetbench.scenes.grading import Graded
from sheetbench.scenes.grid import MASSES, grid_of
from sheetbench.scenes.plausibility import layer_slips
from sheetbench.scenes.quantities import require_positive

if TYPE_CHECKING:
    from lumped import Calibration


def calibrate(
    sheet: Sheet,
    material: Material,
    *,
    grid: int | Sequence[int] = MASSES,
    calibration: str | None = None,
    k: float | None = None,
    layer_distance: float | None = None,
    grading: Grading = None,
    training: Sequence[Scene] | None = None,
    large: bool = False,
    progress: Progress = silent,
) -> Calibration:
    """Springs of a lattice; by default consistent ones for nine masses along the shorter side.

    grid: a number is along the shorter side, with near-square cells; or (nx, ny), (nx, ny, layers).

    k [N/m] and layer_distance [m] are the calibration's own options; grading: from 0, cells of one size,
    to 1, cells finest at the edges, or 0.5:x0 at one (`lumped.grid_lines`); training: the scenes that a
    fitted one is fitted to, see `comparisons.models.training`; progress: told what a fit is doing. Raises
    BadInput for a name that is not a calibration or lengths that are not above zero, for options it does not
    take, and unless `large` for a fit that takes more memory than there is; warns of a layer
    distance that is hardly meant.
    """
    check_lattice(calibration, k, layer_distance, grading)
    if not large and k is None and is_fitted(calibration):
        from comparisons.models.training import training_scenes

        for scene in training_scenes(sheet, material) if training is None else training:
            require_room_to_fit(scene, grid)
    return _calibrate(
        sheet, material, grid, calibration, k, layer_distance, fixed(grading) or 0.0, training, progress
    )


def _calibrate(
    sheet: Sheet,
    material: Material,
    grid: int | Sequence[int],
    calibration: str | None = None,
    k: float | None = None,
    layer_distance: float | None = None,
    grading: Graded = 0.0,
    training: Sequence[Scene] | None = None,
    progress: Progress = silent,
) -> Calibration:
    import lumped

    if layer_distance is not None:
        for said in layer_slips(sheet, layer_distance, "layer-distance"):
            warn(Implausible(said), stacklevel=2)
    method = calibration or CALIBRATION
    if k is None and is_fitted(calibration):
        from comparisons.models.training import fitted

        whole = grid_of(sheet, grid)
        return fitted(sheet, material, whole, method, layer_distance, grading, training, progress)
    own: dict[str, Any] = {"k": k, "layer_distance": layer_distance, "grading": grading}
    return lumped.calibrate(sheet, material, grid=grid, method=method, **own)


def is_fitted(calibration: str | None) -> bool:
    """Whether a calibration, the usual one for None, is fitted to targets."""
    return CALIBRATIONS[method_of(calibration, None)].fitted


def require_room_to_fit(scene: Scene, grid: int | Sequence[int]) -> None:
    """Raise BadInput where there is too little memory for a lattice or for the shell that it is fitted to."""
    from comparisons.models.training import ELEMENTS

    require_room(scene, Candidate("lumped", {"grid": grid}))
    instead = "take a calibration that is not fitted"
    require_room(scene, Candidate("shell", {"elements": ELEMENTS}), instead=instead)


def check_lattice(
    calibration: str | None, k: float | None, layer_distance: float | None, grading: Grading = None
) -> None:
    """Raise BadInput for a calibration that does not exist, k or layer_distance not above zero, a grading
    that is not one or that the calibration does not take."""
    if calibration is not None:
        require_choice("calibration", calibration, (*CALIBRATIONS, AUTO))
    require_positive("k", k, "N/m")
    require_positive("layer-distance", layer_distance, "m")
    if graded := fixed(grading):
        takers = [name for name, method in CALIBRATIONS.items() if "grading" in method.takes]
        method = method_of(calibration, k)
        if method not in takers:
            raise BadInput(
                f"grading = {graded:g}: the calibration {method} is for cells of one size; "
                f"cell by cell are {', '.join(takers)}"
            )


def has_own_springs(scene: Scene, **settings: Any) -> bool:
    """Whether the scene's own [springs] are to be used: it has them and nothing else is asked for."""
    chosen = (settings.get(name) for name in ("calibration", "k", "layer_distance"))
    return scene.springs is not None and all(choice is None for choice in chosen)


def scene_springs(
    scene: Scene, *, grid: Asked = None, grading: Grading = None, **settings: Any
) -> tuple[Calibration, dict[str, str]]:
    """Springs of a lattice for a scene, with settings of `calibrate` that `check` has seen: its own [springs]
    if it has them and no calibration, k or layer distance is given, on their own grid and grading.

    grid: as `comparisons.models.grids` reads it; grading: 0 unless given, or "auto", which chooses
    the calibration too where none is given, as the calibration "auto" does; the reasons for what is chosen
    come with the springs, as settings (`comparisons.models.grading`, `comparisons.models.method`).
    """
    import lumped

    masses = scene_grid(scene, grid)
    if has_own_springs(scene, **settings):
        return lumped.given(scene, masses, fixed(grading)), {}
    method, because = chosen(scene, masses, grading=grading, **{"calibration": None, **settings})
    settings["calibration"] = method
    graded, why = grading_of(scene, masses, grading, **settings)
    found = _calibrate(scene.sheet, scene.material, masses, grading=graded or 0.0, **settings)
    reasons = {"grading_reason": why, "calibration_reason": because}
    return found, {name: said for name, said in reasons.items() if said}

"""The springs of a lattice as they are asked for: by a calibration, by k, or as a scene brings them.

`LatticeSpec` is what a user asks; `resolve` makes every choice that it leaves open, by the scene; the springs
are made of that. Every verb that has a lattice goes this way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any
from warnings import warn

from comparisons.models.candidate import Candidate
from comparisons.models.grading import Grading, fixed, grading_of
from comparisons.models.grids import GridLike, scene_grid
from comparisons.models.method import chosen
from comparisons.models.sizes import require_room
from comparisons.report.work import Progress, silent
from sheetbench.choices import AUTO, CALIBRATION, CALIBRATIONS, method_of
from sheetbench.scenes import Material, Scene, Sheet
from sheetbench.scenes.errors import BadInput, Implausible, require_choice
from sheetbench.scenes.grading import Graded
from sheetbench.scenes.grid import MASSES, Grid, grid_of
from sheetbench.scenes.plausibility import layer_slips
from sheetbench.scenes.quantities import require_positive

if TYPE_CHECKING:
    from lumped import Calibration


@dataclass(frozen=True)
class LatticeSpec:
    """A lattice as it is asked for, None where the choice is left open: grid, as `comparisons.models.grids`
    reads it; calibration, a name or "auto"; k [N/m]; layer_distance [m]; grading, a number, towards some
    edges, or "auto"."""

    grid: GridLike = None
    calibration: str | None = None
    k: float | None = None
    layer_distance: float | None = None
    grading: Grading = None

    @property
    def candidate(self) -> Candidate:
        """The lattice as a model with settings."""
        return Candidate("lumped", asdict(self))

    def springs(self, scene: Scene) -> tuple[Calibration, dict[str, str]]:
        """The springs for a scene, and the reasons for what was chosen, as settings."""
        found = resolve(scene, self)
        return found.springs(scene), found.reasons


@dataclass(frozen=True)
class Resolved:
    """A lattice with every choice made. calibration: None where the scene's own [springs] are meant; grading:
    None where none is asked for; reasons: sentences on what was chosen, by the setting `…_reason`."""

    grid: Grid
    calibration: str | None
    k: float | None = None
    layer_distance: float | None = None
    grading: Graded | None = None
    reasons: dict[str, str] = field(default_factory=dict)

    @property
    def options(self) -> dict[str, float]:
        """k and layer_distance, where they are given."""
        own = {"k": self.k, "layer_distance": self.layer_distance}
        return {name: value for name, value in own.items() if value is not None}

    def springs(
        self, scene: Scene, training: Sequence[Scene] | None = None, progress: Progress = silent
    ) -> Calibration:
        """The springs for a scene, which may be another one of the same sides."""
        if self.calibration is None:
            import lumped

            return lumped.given(scene, self.grid, self.grading)
        return _calibrate(
            scene.sheet,
            scene.material,
            self.grid,
            self.calibration,
            self.k,
            self.layer_distance,
            self.grading or 0.0,
            training,
            progress,
        )


def resolve(scene: Scene, asked: LatticeSpec, own: bool = True) -> Resolved:
    """The lattice that is meant on a scene, of settings that `check_lattice` has seen.

    own: whether the scene's [springs], where it has them, are meant if no calibration, k or layer distance
    is given, on their own grid and grading. The grading "auto" chooses the calibration too where none is
    given, as the calibration "auto" does (`comparisons.models.grading`, `comparisons.models.method`).
    """
    masses = scene_grid(scene, asked.grid)
    choices = {"k": asked.k, "layer_distance": asked.layer_distance}
    if own and has_own_springs(scene, calibration=asked.calibration, **choices):
        return Resolved(masses, None, grading=fixed(asked.grading))
    method, because = chosen(scene, masses, asked.calibration, asked.grading, **choices)
    method = method_of(method, asked.k)
    grading, why = grading_of(scene, masses, asked.grading, calibration=method, **choices)
    reasons = {"grading_reason": why, "calibration_reason": because}
    said = {name: reason for name, reason in reasons.items() if reason}
    return Resolved(masses, method, asked.k, asked.layer_distance, grading, said)


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
    graded = fixed(grading) or 0.0
    return _calibrate(sheet, material, grid, calibration, k, layer_distance, graded, training, progress)


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
    choices = (settings.get(name) for name in ("calibration", "k", "layer_distance"))
    return scene.springs is not None and all(choice is None for choice in choices)


def scene_springs(scene: Scene, **settings: Any) -> tuple[Calibration, dict[str, str]]:
    """The springs of a `LatticeSpec` of these settings for a scene, and the reasons for what was chosen."""
    return LatticeSpec(**settings).springs(scene)

"""A model of a scene with all choices made and validated: grid, calibration, grading, springs, size, reasons.

Every verb calls `resolve` before a solve; `comparisons.models.solve` solves its result.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Generic, Literal, TypeVar, cast
from warnings import warn

from comparisons.external import plugins
from comparisons.models.context import context
from comparisons.models.grading import fixed, grading_of, lines_on_shapes, one_size
from comparisons.models.grids import scene_grid
from comparisons.models.method import resolve_calibration
from comparisons.models.sizes import require_room, size
from comparisons.models.spec import Elements, External, GradingLike, Lattice, Spec
from sheetbench.answers.size import Size
from sheetbench.choices import (
    AUTO,
    BRANCHES,
    CALIBRATIONS,
    MASS_DISTRIBUTIONS,
    REFERENCES,
    listed,
    method_of,
)
from sheetbench.errors import BadInput, Implausible, require_choice, require_effect
from sheetbench.scenes import Scene, Sheet
from sheetbench.scenes.meaning.plausibility import layer_slips
from sheetbench.scenes.objects.grid import Grid
from sheetbench.scenes.objects.quantities import require_positive

if TYPE_CHECKING:
    from lumped import Calibration

Use = Literal["statics", "motion", "modes", "springs"]
ONLY: dict[Use, tuple[str, ...]] = {"statics": ("linear", "branch"), "modes": ("masses",)}
OURS = (Lattice.NAME, *REFERENCES)
S = TypeVar("S", bound=Spec)


@dataclass(frozen=True)
class Resolved(Generic[S]):
    """A model of a scene; spec: with all choices made, a lattice's calibration None for the scene's own
    [springs]; reasons: a sentence for each choice, by the setting `…_reason`."""

    scene: Scene
    spec: S
    reasons: dict[str, str] = field(default_factory=dict)

    @property
    def settings(self) -> dict[str, Any]:
        """The model's settings with the reasons, as plain data."""
        return {**self.spec.settings, **self.reasons}

    @property
    def size(self) -> Size | None:
        """Unknowns and memory of the model, None for a plug-in."""
        return size(self.scene, self.spec)

    @property
    def grid(self) -> Grid:
        """The grid of a lattice."""
        assert isinstance(self.spec, Lattice)
        return cast(Grid, self.spec.grid)

    @property
    def fitted(self) -> bool:
        """Whether a lattice's springs are fitted to targets."""
        named = isinstance(self.spec, Lattice) and self.spec.k is None and self.spec.calibration
        return isinstance(named, str) and named in CALIBRATIONS and CALIBRATIONS[named].fitted

    @cached_property
    def springs(self) -> Calibration:
        """The springs of a lattice."""
        return self.calibrated()

    def on(self, scene: Scene) -> Resolved[S]:
        """Return the model with its choices for another scene with equal sides."""
        return replace(self, scene=scene)

    def calibrated(self, training: Sequence[Scene] | None = None) -> Calibration:
        """Return the springs; training: scenes of fitted calibrations (`comparisons.models.training`). Raises
        BadInput for options that a calibration does not take; warns about an implausible layer distance."""
        import lumped

        spec: Spec = self.spec
        assert isinstance(spec, Lattice)
        if spec.calibration is None:
            return lumped.given(self.scene, self.grid, fixed(spec.grading))
        return lumped.calibrated_at_rest(
            self.scene, partial(self._calibrated, spec, spec.calibration, training)
        )

    def _calibrated(
        self, spec: Lattice, method: str, training: Sequence[Scene] | None, sheet: Sheet
    ) -> Calibration:
        import lumped

        grading, material = fixed(spec.grading), self.scene.material
        if spec.layer_distance is not None:
            for slip in layer_slips(sheet, spec.layer_distance, "layer-distance"):
                warn(Implausible(slip), stacklevel=2)
        grading = grading or lines_on_shapes(self.scene, self.grid, spec)
        options: dict[str, Any] = {"layer_distance": spec.layer_distance, "grading": grading}
        calibration = method_of(method, spec.k)
        cells = lumped.sections_of(self.scene, self.grid, grading)
        if "cells" in CALIBRATIONS[calibration].takes:
            options["cells"] = cells
        elif self.scene.uniform and self.scene.pierced and not self.fitted and cells is not None:
            springs = lumped.calibrate(sheet, material, self.grid, method, k=spec.k, **options)
            return lumped.with_shares(springs, sheet, material, cells)
        else:
            takers = [name for name, entry in CALIBRATIONS.items() if "cells" in entry.takes]
            lumped.require_alike(self.scene, f"calibration '{calibration}'", f"choose {listed(takers)}")
        if self.fitted:
            from comparisons.models.training import fitted

            return fitted(sheet, material, self.grid, method, training=training, **options)
        return lumped.calibrate(sheet, material, self.grid, method, k=spec.k, **options)


def resolve(
    scene: Scene, spec: S, use: Use = "statics", *, scene_springs: bool = True, option: str = ""
) -> Resolved[S]:
    """Return a model of a scene with all choices made.

    use: purpose of the model; for "springs" the memory of a solve is not checked. scene_springs: whether the
    scene's [springs], if any, apply on their own grid and grading if no calibration, k or layer distance is
    given. The grading "auto" chooses an open calibration too. option: the option of the model's size
    (`comparisons.models.sizes.require_room`).

    Raises BadInput for an unknown model, for settings that are unknown or incompatible with each other, the
    scene or the use, and, unless the context is `large`, for a model that needs more memory than is free.
    """
    for other, names in ONLY.items():
        if isinstance(spec, Lattice) and use not in (other, "springs"):
            require_effect(f"on {use}", {name: spec.settings.get(name) for name in names})
    model: Resolved[Any]
    if isinstance(spec, Lattice):
        model = _lattice(scene, spec, scene_springs)
    else:
        if isinstance(spec, Elements):
            _check_elements(spec)
        else:
            assert isinstance(spec, External)
            _check_external(spec)
        model = Resolved(scene, spec)
    if not context().large:
        if use != "springs" or model.fitted:
            require_room(scene, model.spec, option, modes=use == "modes")
        if model.fitted:
            from comparisons.models.training import ELEMENTS

            require_room(scene, Elements("shell", ELEMENTS), instead="take a calibration that is not fitted")
    if isinstance(spec, Lattice) and model.spec.calibration is None:
        assert model.springs  # tables of other grids are refused
    return cast(Resolved[S], model)


def resolve_each(
    scene: Scene, lattices: Sequence[Lattice], grading: GradingLike = None
) -> tuple[list[Lattice], tuple[str, ...]]:
    """Return lattices with all choices made, and the reasons. grading: applies to lattices whose calibration
    and layers take one. Raises BadInput if none takes one."""
    for lattice in lattices:
        _check_lattice(lattice)
    takers = [lattice for lattice in lattices if not one_size(scene_grid(scene, lattice.grid), lattice)]
    if fixed(grading) and not takers:
        raise BadInput(f"grading = {grading}: none of these calibrations takes cells of different sizes")
    specs = list[Lattice]()
    calibration_notes, grading_notes = [], list[str]()
    for lattice in lattices:
        model = resolve(scene, lattice.but(grading=grading if lattice in takers else None), use="springs")
        spec, reasons = model.spec, model.reasons
        specs.append(spec if spec.grading else spec.but(grading=None))
        if spec.grading is not None and (reason := reasons.get("grading_reason")):
            grading_notes.append(f"{model.grid[0]} × {model.grid[1]}, grading {spec.grading:g}: {reason}")
        if reason := reasons.get("calibration_reason"):
            calibration_notes.append(f"calibration {spec.calibration}: {reason}")
    return specs, tuple(dict.fromkeys((*calibration_notes, *grading_notes)))


def _check_lattice(spec: Lattice) -> None:
    if spec.calibration is not None:
        require_choice("calibration", spec.calibration, (*CALIBRATIONS, AUTO))
    require_positive("k", spec.k, "N/m")
    require_positive("layer-distance", spec.layer_distance, "m")
    require_choice("branch", spec.branch, BRANCHES)
    if spec.masses is not None:
        require_choice("--masses", spec.masses, MASS_DISTRIBUTIONS)
    if graded := fixed(spec.grading):
        takers = [name for name, method in CALIBRATIONS.items() if "grading" in method.takes]
        named = method_of(spec.calibration, spec.k)
        if named not in takers:
            raise BadInput(
                f"grading = {graded:g}: the calibration {named} is for cells of one size; "
                f"cell by cell are {', '.join(takers)}"
            )


def _lattice(scene: Scene, spec: Lattice, scene_springs: bool) -> Resolved[Lattice]:
    _check_lattice(spec)
    spec = spec.but(grid=scene_grid(scene, spec.grid))
    grid = cast(Grid, spec.grid)
    is_open = spec.calibration is None and spec.k is None and spec.layer_distance is None
    if scene_springs and scene.springs is not None and is_open:
        return Resolved(scene, spec.but(grading=fixed(spec.grading)))
    method, calibration_reason = resolve_calibration(scene, grid, spec)
    spec = spec.but(calibration=method_of(method, spec.k))
    grading, grading_reason = grading_of(scene, grid, spec)
    reasons = {"grading_reason": grading_reason, "calibration_reason": calibration_reason}
    reasons = {name: reason for name, reason in reasons.items() if reason}
    return Resolved(scene, spec.but(grading=grading), reasons)


def _check_elements(spec: Elements) -> None:
    import fem_reference

    require_choice("reference", spec.kind, fem_reference.MODELS)
    elements = spec.elements
    counts = [elements] if isinstance(elements, int) else elements
    whole = isinstance(counts, list | tuple) and len(counts) > 0 and all(type(n) is int for n in counts)
    if not (whole and len(counts) <= 2):
        raise BadInput(f"elements = {elements!r}: a number along the shorter side, or [nx, ny]")
    if min(counts) < 1:
        raise BadInput(f"elements = {elements}: at least 1")
    fem_reference.check(spec.kind, spec.options)


def _check_external(spec: External) -> None:
    names = [*OURS, *plugins.names()]
    if spec.name not in names and not plugins.is_outside(spec.name):
        raise BadInput(f"model = '{spec.name}': unknown, choose one of {', '.join(names)}. {plugins.HINT}")
    plugins.settings_of(plugins.plugin(spec.name), spec.settings)

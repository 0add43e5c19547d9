"""The springs of a lattice as they are asked for: by a calibration, by k, or as a scene brings them.

`LatticeSpec` is what a user asks; `resolve` makes every choice that it leaves open, by the scene; the springs
are made of that. Every verb that has a lattice goes this way.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from typing import TYPE_CHECKING, Any
from warnings import warn

from comparisons.models.candidate import Candidate
from comparisons.models.grading import Grading, fixed, grading_of, one_size, plain
from comparisons.models.grids import GridLike, scene_grid
from comparisons.models.method import chosen
from comparisons.models.sizes import require_room
from comparisons.report.work import Progress, silent
from sheetbench.choices import AUTO, CALIBRATIONS, method_of
from sheetbench.errors import BadInput, Implausible, require_choice
from sheetbench.scenes import Scene
from sheetbench.scenes.grading import Graded
from sheetbench.scenes.grid import Grid
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

    @classmethod
    def of(cls, settings: Mapping[str, Any]) -> LatticeSpec:
        """Return the lattice of a candidate's settings, which may have others too."""
        return cls(**{one.name: settings.get(one.name) for one in fields(cls)})

    @property
    def candidate(self) -> Candidate:
        """The lattice as a model with settings."""
        return Candidate("lumped", asdict(self))

    def springs(self, scene: Scene) -> tuple[Calibration, dict[str, str]]:
        """The springs for a scene, and the reasons for what was chosen, as settings."""
        found = resolve(scene, self)
        return found.springs(scene), found.reasons

    def check(self) -> None:
        """Raise BadInput for a calibration that does not exist, k or layer_distance not above zero, a grading
        that is not one or that the calibration does not take."""
        if self.calibration is not None:
            require_choice("calibration", self.calibration, (*CALIBRATIONS, AUTO))
        require_positive("k", self.k, "N/m")
        require_positive("layer-distance", self.layer_distance, "m")
        if graded := fixed(self.grading):
            takers = [name for name, method in CALIBRATIONS.items() if "grading" in method.takes]
            method = method_of(self.calibration, self.k)
            if method not in takers:
                raise BadInput(
                    f"grading = {graded:g}: the calibration {method} is for cells of one size; "
                    f"cell by cell are {', '.join(takers)}"
                )


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
    def settings(self) -> dict[str, Any]:
        """The lattice as settings of a candidate, plain data, with the reasons."""
        own: dict[str, Any] = {"k": self.k, "layer_distance": self.layer_distance}
        found = {name: value for name, value in own.items() if value is not None}
        found |= {} if self.grading is None else {"grading": plain(self.grading)}
        return {"grid": list(self.grid), "calibration": self.calibration, **found, **self.reasons}

    @property
    def fitted(self) -> bool:
        """Whether the springs are fitted to targets."""
        return self.calibration is not None and self.k is None and CALIBRATIONS[self.calibration].fitted

    def require_room_to_fit(self, scene: Scene) -> None:
        """Raise BadInput where the springs are fitted and there is too little memory for the lattice or for
        the shell that it is fitted to."""
        if self.fitted:
            from comparisons.models.training import ELEMENTS

            require_room(scene, Candidate("lumped", {"grid": self.grid}))
            instead = "take a calibration that is not fitted"
            require_room(scene, Candidate("shell", {"elements": ELEMENTS}), instead=instead)

    def springs(
        self, scene: Scene, training: Sequence[Scene] | None = None, progress: Progress = silent
    ) -> Calibration:
        """Return the springs for a scene, which may be another one of the same sides.

        training: what fitted ones are fitted to, see `comparisons.models.training`; progress: told what a fit
        is doing. Raises BadInput for options that a calibration does not take; warns of a layer distance that
        is hardly meant.
        """
        import lumped

        if self.calibration is None:
            return lumped.given(scene, self.grid, self.grading)
        sheet, material, grading = scene.sheet, scene.material, self.grading or 0.0
        if self.layer_distance is not None:
            for said in layer_slips(sheet, self.layer_distance, "layer-distance"):
                warn(Implausible(said), stacklevel=2)
        own: dict[str, Any] = {"layer_distance": self.layer_distance, "grading": grading}
        if self.fitted:
            from comparisons.models.training import fitted

            own |= {"training": training, "progress": progress}
            return fitted(sheet, material, self.grid, self.calibration, **own)
        return lumped.calibrate(sheet, material, self.grid, self.calibration, k=self.k, **own)


def resolve(scene: Scene, asked: LatticeSpec, own: bool = True) -> Resolved:
    """The lattice that is meant on a scene. Raises BadInput as `LatticeSpec.check` does.

    own: whether the scene's [springs], where it has them, are meant if no calibration, k or layer distance
    is given, on their own grid and grading. The grading "auto" chooses the calibration too where none is
    given, as the calibration "auto" does (`comparisons.models.grading`, `comparisons.models.method`).
    """
    asked.check()
    masses = scene_grid(scene, asked.grid)
    choices = {"k": asked.k, "layer_distance": asked.layer_distance}
    open_choice = asked.calibration is None and all(value is None for value in choices.values())
    if own and scene.springs is not None and open_choice:
        return Resolved(masses, None, grading=fixed(asked.grading))
    method, because = chosen(scene, masses, asked.calibration, asked.grading, **choices)
    method = method_of(method, asked.k)
    grading, why = grading_of(scene, masses, asked.grading, calibration=method, **choices)
    reasons = {"grading_reason": why, "calibration_reason": because}
    said = {name: reason for name, reason in reasons.items() if reason}
    return Resolved(masses, method, asked.k, asked.layer_distance, grading, said)


def resolve_each(
    scene: Scene, lattices: Sequence[Candidate], grading: Grading = None
) -> tuple[list[Candidate], tuple[str, ...]]:
    """Lattices and pairs of grids with every choice made, and the reasons.

    grading: of those whose calibration and layers take one. Raises BadInput where none of them does.
    """
    found, methods, gradings = [], list[str](), list[str]()
    for one in lattices:
        LatticeSpec.of(one.settings).check()
    takers = [one for one in lattices if not one_size(one.settings["grid"], one.settings)]
    if fixed(grading) and not takers:
        raise BadInput(f"grading = {grading}: none of these calibrations is for cells that differ")
    for one in lattices:
        graded = grading if one in takers else None
        meant = resolve(scene, LatticeSpec.of({**one.settings, "grading": graded}))
        found.append(one.but(calibration=meant.calibration))
        if meant.grading:
            found[-1] = found[-1].but(grading=plain(meant.grading))
        if why := meant.reasons.get("grading_reason"):
            gradings.append(f"{meant.grid[0]} × {meant.grid[1]}, grading {meant.grading:g}: {why}")
        if why := meant.reasons.get("calibration_reason"):
            methods.append(f"calibration {meant.calibration}: {why}")
    return found, tuple(dict.fromkeys((*methods, *gradings)))

"""Natural frequencies of a lattice beside those of a reference.

About the undeformed, stress-free sheet, where loads, weight and actuators have no part in them, or about its
equilibrium under its loads. A sheet that supports leave free to move has rigid motions, whose frequency is
zero; they are counted and left out.
Modes are listed lowest first; those of two models are paired by shape (`comparisons.modes.pairing`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast, get_args, overload

import numpy as np

from comparisons.models.candidate import Candidate
from comparisons.models.expected_error import converges, finer_grid
from comparisons.models.grading import Grading
from comparisons.models.grids import Elements, GridLike
from comparisons.models.registry import check, check_reference
from comparisons.models.sizes import size
from comparisons.models.springs import LatticeSpec
from comparisons.modes import tables
from comparisons.modes.expected import expected_errors
from comparisons.modes.kinds import kinds
from comparisons.modes.pairing import CELLS, Pair, assurance, cell_centres, matched
from comparisons.report.work import Progress, Work, silent
from sheetbench.answers.report import Report
from sheetbench.choices import ELEMENTS, MASSES, REFERENCE
from sheetbench.clock import now
from sheetbench.errors import BadInput, NoEquilibrium, require_choice
from sheetbench.scenes import About, Scene, free_rigid_motions, load, summary
from sheetbench.scenes.grading import as_settings

if TYPE_CHECKING:
    from lumped import Calibration


@dataclass(frozen=True)
class Spectrum:
    """A model's lowest natural frequencies (count,) [Hz]; rigid: rigid motions left out; shapes: plan points
    (n, 2) [m] → displacement of the mid-surface in every mode, (count, n, 3), of any scale; expected: the
    relative error to expect of each, where that is estimated."""

    model: str
    label: str
    settings: dict[str, Any]
    frequencies: np.ndarray
    rigid: int
    unknowns: int
    seconds: float
    shapes: Callable[[np.ndarray], np.ndarray]
    expected: tuple[float | None, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "model": self.model,
            "label": self.label,
            "settings": self.settings,
            "frequencies_hz": self.frequencies,
            "rigid_modes": self.rigid,
            "unknowns": self.unknowns,
            "solve_seconds": self.seconds,
            **({"expected_errors": list(self.expected)} if self.expected else {}),
        }


@dataclass(frozen=True, repr=False)
class Spectra(summary.Summarised, Sequence[Spectrum]):
    """The spectra of a scene, the lattice's first, then that of each reference.

    about: "flat" or "deformed"; sag [m]: the largest displacement that the lattice's flat tangent gives under
    the scene's loads, None where there are none, or nothing that stops a rigid motion.
    """

    scene: Scene
    found: tuple[Spectrum, ...]
    about: About = "flat"
    sag: float | None = None

    @overload
    def __getitem__(self, index: int) -> Spectrum: ...

    @overload
    def __getitem__(self, index: slice) -> Sequence[Spectrum]: ...

    def __getitem__(self, index: int | slice) -> Spectrum | Sequence[Spectrum]:
        return self.found[index]

    def __len__(self) -> int:
        return len(self.found)

    @property
    def frequencies(self) -> np.ndarray:
        """The lattice's (count,) [Hz]; the first reference's are `self[1].frequencies`."""
        return self[0].frequencies

    @cached_property
    def _sampled(self) -> tuple[np.ndarray, ...]:
        """Shapes (count, n, 3) of every model on equal plan cells."""
        plan = cell_centres(self.scene.sheet)
        return tuple(spectrum.shapes(plan) for spectrum in self)

    @cached_property
    def kinds(self) -> tuple[str | None, ...]:
        """What kind of mode every one of the lattice is; None about a deformed sheet."""
        if self.about == "deformed":
            return (None,) * len(self[0].frequencies)
        return tuple(kinds(self.scene, self._sampled[0], CELLS))

    @cached_property
    def pairs(self) -> tuple[Pair, ...]:
        """Every mode of the lattice with the mode of the same shape of each reference."""
        of, found = self[0], []
        for spectrum, shapes in zip(self[1:], self._sampled[1:], strict=True):
            mac = assurance(self._sampled[0], shapes, spectrum.frequencies)
            for i, match in enumerate(matched(mac)):
                at = int(np.argmax(mac[i])) if match is None else match
                off = None if match is None else float(of.frequencies[i] / spectrum.frequencies[at] - 1.0)
                is_ = None if match is None else match + 1
                found.append(
                    Pair(of.model, i + 1, spectrum.model, is_, float(mac[i, at]), off, self.kinds[i])
                )
        return tuple(found)

    def against(self, model: str) -> tuple[Pair, ...]:
        """The pairs with one reference, in the order of the lattice's modes."""
        return tuple(pair for pair in self.pairs if pair.against == model)

    def as_dict(self) -> dict[str, Any]:
        """The JSON document of `sheetbench modes`."""
        return {
            "scene": self.scene.document(),
            "about": self.about,
            "sag": self.sag,
            "solutions": [spectrum.as_dict() for spectrum in self],
            "pairs": [pair.as_dict() for pair in self.pairs],
        }

    def _summary(self) -> tuple[str, summary.Facts]:
        found = [(one.label, summary.numbers(one.frequencies.tolist(), "Hz")) for one in self]
        return f"Natural frequencies of {self.scene.name}; .report() has the table", found

    def report(self) -> Report:
        """What is shown of it."""
        return tables.report(self)


def spectra(
    scene: Scene | str | Path,
    *,
    count: int = 10,
    grid: GridLike = None,
    calibration: str | None = None,
    k: float | None = None,
    layer_distance: float | None = None,
    grading: Grading = None,
    masses: str | None = None,
    references: Sequence[str] = (REFERENCE,),
    elements: Elements = ELEMENTS,
    about: str = "flat",
    large: bool = False,
    progress: Progress = silent,
) -> Spectra:
    """The spectra of the lattice and of each reference; masses: how the lattice shares out its mass
    (`lumped.masses`), as `lumped.modes` has it unless given; about: "flat", or "deformed" under the scene's
    loads; large: even where one takes more memory than there is; progress: told what is being done.

    Raises SceneError for a scene that cannot be read, BadInput for choices that do not exist and a count
    that a mesh cannot give, NoEquilibrium for deformed where a model has no stable equilibrium.
    """
    require_choice("--about", about, get_args(About))
    if masses is not None:
        require_choice("--masses", masses, MASSES)
    around = cast(About, about)
    scene = scene if isinstance(scene, Scene) else load(scene)
    if count < 1:
        raise BadInput(f"--count = {count}: at least 1")
    lattice = LatticeSpec(grid, calibration, k, layer_distance, grading)
    asked = [lattice.candidate]
    for reference in references:
        check_reference(reference, elements)
        asked.append(Candidate(reference, {"elements": elements}))
    for candidate in asked:
        check(scene, candidate, large)

    def starting(candidate: Candidate) -> None:
        progress(Work(f"modes of {candidate.model}", size(scene, candidate)))

    starting(asked[0])
    springs, because = lattice.springs(scene)
    first = _lattice(scene, count, springs, because, around, masses)
    found = [first if around == "flat" else _with_expected(scene, lattice, springs, first)]
    for candidate in asked[1:]:
        starting(candidate)
        found.append(_reference(scene, candidate.model, count, elements, around))
    return Spectra(scene, tuple(found), around, _sag(scene, springs))


def _sag(scene: Scene, springs: Calibration) -> float | None:
    """See `Spectra`. Actuators are left out, for small displacements know none."""
    import lumped

    scene = scene.replace(actuators=())
    if free_rigid_motions(scene) or not (scene.loads or scene.gravity):
        return None
    solution = lumped.solve(scene, springs, linear=True)
    return float(np.abs(solution.mesh.point_data["displacement"]).max())


def _lattice(
    scene: Scene,
    count: int,
    springs: Calibration,
    because: dict[str, str],
    about: About,
    masses: str | None,
) -> Spectrum:
    import lumped

    begin = now()
    distribution = cast("lumped.Inertia | None", masses) or lumped.usual_masses(springs)
    modes = lumped.modes(scene, springs, count, distribution, about)
    seconds = now() - begin
    return Spectrum(
        model="lumped",
        label=f"lumped {springs.title}, {distribution} masses",
        settings={
            "grid": list(springs.grid),
            "calibration": springs.method,
            **as_settings(springs.grading),
            "masses": distribution,
            **because,
        },
        frequencies=modes.frequencies,
        rigid=modes.rigid,
        unknowns=modes.unknowns,
        seconds=seconds,
        shapes=modes.displacement,
    )


def _with_expected(scene: Scene, lattice: LatticeSpec, springs: Calibration, first: Spectrum) -> Spectrum:
    """The lattice's spectrum about its equilibrium, with the errors to expect of it where they are known."""
    finer = finer_grid(springs.grid)
    if not converges(springs.method, finer, lattice.candidate.settings):
        return first
    spec = LatticeSpec(finer, springs.method, grading=springs.grading or None)
    masses, count = first.settings["masses"], len(first.frequencies)
    try:
        fine = _lattice(scene, count, spec.springs(scene)[0], {}, "deformed", masses)
    except NoEquilibrium:
        return first
    plan, cells = cell_centres(scene.sheet), [prod(n - 1 for n in g[:2]) for g in (finer, springs.grid)]
    both = [(one.frequencies, one.shapes(plan)) for one in (first, fine)]
    return replace(first, expected=tuple(expected_errors(both[0], both[1], cells[0] / cells[1])))


def _reference(scene: Scene, model: str, count: int, elements: Elements, about: About) -> Spectrum:
    import fem_reference

    modes = fem_reference.modes(scene, model, elements, count, about)
    return Spectrum(
        model=model,
        label=modes.label,
        settings=modes.settings,
        frequencies=modes.frequencies,
        rigid=modes.rigid_modes,
        unknowns=modes.unknowns,
        seconds=modes.solve_seconds,
        shapes=lambda plan: np.stack([modes.displacement(mode, plan) for mode in range(count)]),
    )

"""Natural frequencies of a lattice beside those of a reference.

About the undeformed, stress-free sheet, where loads, weight and actuators have no part in them, or about its
equilibrium under its loads. A sheet that supports leave free to move has rigid motions, whose frequency is
zero; they are counted and left out.
Modes are listed lowest first; those of two models are paired by shape (`comparisons.modes.pairing`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, cast, get_args

import numpy as np

from comparisons.models.candidate import Candidate
from comparisons.models.expected_error import converges, finer_grid
from comparisons.models.grading import Grading
from comparisons.models.grids import Elements, GridLike
from comparisons.models.registry import check, check_reference
from comparisons.models.sizes import size
from comparisons.models.springs import LatticeSpec
from comparisons.modes.answer import Spectra, Spectrum
from comparisons.modes.expected import expected_errors
from comparisons.modes.pairing import cell_centres
from comparisons.report.work import Progress, Work, silent
from sheetbench.choices import ELEMENTS, MASSES, REFERENCE
from sheetbench.clock import now
from sheetbench.errors import BadInput, NoEquilibrium, require_choice
from sheetbench.scenes import About, Scene, free_rigid_motions, load
from sheetbench.scenes.grading import as_settings

if TYPE_CHECKING:
    from lumped import Calibration


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

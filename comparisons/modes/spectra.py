"""Natural frequencies of a lattice and of references.

Modes are computed about the undeformed, stress-free sheet, without loads, weight and actuators, or about the
equilibrium under its loads. Rigid motions that supports leave free have frequency zero; they are counted and
left out. Modes are listed lowest first; two models' modes are paired by shape
(`comparisons.modes.pairing`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from comparisons.models.context import context
from comparisons.models.expected_error import NoEstimate, finer_of, grid_error
from comparisons.models.grids import Elements as Count
from comparisons.models.resolve import Resolved, resolve
from comparisons.models.sizes import has_room
from comparisons.models.spec import Elements, Lattice
from comparisons.modes.answer import Spectra, Spectrum
from comparisons.modes.pairing import on_cells, pairs_of
from comparisons.pictures.work import Work
from sheetbench.answers.modes import Buckling
from sheetbench.answers.solution import About
from sheetbench.choices import REFERENCE
from sheetbench.clock import now
from sheetbench.errors import BadInput
from sheetbench.scenes import AnyScene, Scene, free_rigid_motions, scene_of

if TYPE_CHECKING:
    from lumped import Calibration


def spectra(
    scene: AnyScene,
    lattice: Lattice = Lattice(),  # noqa: B008  # frozen
    *,
    count: int = 10,
    reference: str | Elements | Sequence[str | Elements] = REFERENCE,
    elements: Count | None = None,
    about: About = "flat",
    buckling: bool = False,
) -> Spectra:
    """Return the spectra of the lattice and of one or several references.

    about: "flat", or "deformed" under the scene's loads; buckling: also compute the load factors at which
    lattice and references buckle (not the plate, which is linear).

    Raises SceneError for an unreadable scene, BadInput for unknown choices and a count above a mesh's
    unknowns, NoEquilibrium if a model has no stable equilibrium to be "deformed" in.
    """
    scene = scene_of(scene)
    if not isinstance(count, int) or count < 1:
        raise BadInput(f"--count = {count}: a whole number, at least 1")
    lumped_model = resolve(scene, lattice, "modes")
    kinds = [reference] if isinstance(reference, str | Elements) else reference
    references = [resolve(scene, Elements.given(kind, {"elements": elements}), "modes") for kind in kinds]

    def report(model: Resolved[Any]) -> None:
        context().progress(Work(f"modes of {model.spec.model}", model.size))

    buckling_modes = tuple(_buckling(lumped_model, references, count)) if buckling else ()  # may refuse first
    expected = _expected(lumped_model, buckling_modes[0]) if buckling else None
    report(lumped_model)
    results = [_lattice(lumped_model, count, about)]
    for model in references:
        report(model)
        results.append(_reference(model, count, about))
    return Spectra(scene, tuple(results), about, _sag(scene, lumped_model.springs), buckling_modes, expected)


def _buckling(
    lattice: Resolved[Lattice], references: Sequence[Resolved[Elements]], count: int
) -> Iterator[Buckling]:
    """Yield the buckling modes of the lattice, then of each reference but the plate."""
    import fem_reference
    import lumped

    yield lumped.buckling(lattice.scene, lattice.springs, count)
    for model in references:
        if model.spec.kind != "plate":
            context().progress(Work(f"buckling of {model.spec.model}", model.size))
            yield fem_reference.buckling(model.scene, model.spec.kind, model.spec.elements, count)


def _expected(lattice: Resolved[Lattice], coarse: Buckling) -> tuple[float | None, ...] | NoEstimate:
    """Return the expected grid error of each of a lattice's load factors, or the reason for no estimate. The
    estimate compares modes of equal shape on the finer grid of `comparisons.models.expected_error`."""
    import lumped

    scene, count = lattice.scene, len(coarse.load_factors)
    refinement = finer_of(scene, lattice.spec)
    if isinstance(refinement, NoEstimate):
        return refinement
    grid, ratio = refinement
    finer = lattice.spec.but(grid=grid)
    if not has_room(scene, finer):
        return NoEstimate(f"{finer.size} masses take too much memory")
    fine = lumped.buckling(scene, resolve(scene, finer, "modes").springs, count)
    first, second = (
        (modes.model, modes.load_factors, on_cells(scene, modes.displacement)) for modes in (coarse, fine)
    )
    errors = [
        "" if pair.is_ is None else grid_error(first[1][[i]], second[1][[pair.is_ - 1]], ratio)
        for i, pair in enumerate(pairs_of(first, [second], [None] * count))
    ]
    return tuple(None if isinstance(error, str) else error for error in errors)


def _sag(scene: Scene, springs: Calibration) -> float | None:
    """Return `Spectra.sag`, without actuators and obstacles, which a linear answer cannot include."""
    import lumped

    scene = scene.replace(actuators=(), obstacles=())
    if free_rigid_motions(scene) or not (scene.loads or scene.gravity):
        return None
    solution = lumped.solve(scene, springs, linear=True)
    return float(np.abs(solution.mesh.point_data["displacement"]).max())


def _lattice(model: Resolved[Lattice], count: int, about: About) -> Spectrum:
    import lumped

    springs = model.springs
    start = now()
    distribution = cast("lumped.Inertia | None", model.spec.masses) or lumped.usual_masses(springs)
    modes = lumped.modes(model.scene, springs, count, distribution, about)
    seconds = now() - start
    settings = springs.settings | {"masses": distribution, **model.reasons}
    return Spectrum("lumped", f"lumped {springs.title}, {distribution} masses", settings, seconds, modes)


def _reference(model: Resolved[Elements], count: int, about: About) -> Spectrum:
    import fem_reference

    modes = fem_reference.modes(model.scene, model.spec.kind, model.spec.elements, count, about)
    return Spectrum(model.spec.kind, modes.label, modes.settings, modes.solve_seconds, modes)

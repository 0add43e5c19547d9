"""Natural frequencies of a lattice beside those of a reference.

About the undeformed, stress-free sheet, where loads, weight and actuators have no part in them, or about its
equilibrium under its loads. A sheet that supports leave free to move has rigid motions, whose frequency is
zero; they are counted and left out.
Modes are listed lowest first; those of two models are paired by shape (`comparisons.modes.pairing`).
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
    """Return the spectra of the lattice and of the reference, or of each of several.

    about: "flat", or "deformed" under the scene's loads; buckling: also the load factors at which lattice and
    references buckle (not the plate, which is linear).

    Raises SceneError for a scene that cannot be read, BadInput for choices that do not exist and a count
    that a mesh cannot give, NoEquilibrium for deformed where a model has no stable equilibrium.
    """
    scene = scene_of(scene)
    if not isinstance(count, int) or count < 1:
        raise BadInput(f"--count = {count}: a whole number, at least 1")
    own = resolve(scene, lattice, "modes")
    references = [reference] if isinstance(reference, str | Elements) else reference
    models = [resolve(scene, Elements.given(one, {"elements": elements}), "modes") for one in references]

    def starting(model: Resolved[Any]) -> None:
        context().progress(Work(f"modes of {model.spec.model}", model.size))

    buckled = tuple(_buckling(own, models, count)) if buckling else ()  # refused before anything is solved
    expected = _expected(own, buckled[0]) if buckling else None
    starting(own)
    found = [_lattice(own, count, about)]
    for model in models:
        starting(model)
        found.append(_reference(model, count, about))
    return Spectra(scene, tuple(found), about, _sag(scene, own.springs), buckled, expected)


def _buckling(own: Resolved[Lattice], models: Sequence[Resolved[Elements]], count: int) -> Iterator[Buckling]:
    """The buckling modes of the lattice, then of each reference but the plate."""
    import fem_reference
    import lumped

    yield lumped.buckling(own.scene, own.springs, count)
    for model in models:
        if model.spec.kind != "plate":
            context().progress(Work(f"buckling of {model.spec.model}", model.size))
            yield fem_reference.buckling(model.scene, model.spec.kind, model.spec.elements, count)


def _expected(own: Resolved[Lattice], found: Buckling) -> tuple[float | None, ...] | NoEstimate:
    """Return the grid error to expect of each of a lattice's load factors, from those of the same shapes on
    the finer grid of `comparisons.models.expected_error`; or why there is none."""
    import lumped

    scene, count = own.scene, len(found.load_factors)
    other = finer_of(scene, own.spec)
    if isinstance(other, NoEstimate):
        return other
    finer = own.spec.but(grid=other[0])
    if not has_room(scene, finer):
        return NoEstimate(f"{finer.size} masses take too much memory")
    fine = lumped.buckling(scene, resolve(scene, finer, "modes").springs, count)
    first, second = (
        (one.model, one.load_factors, on_cells(scene, one.displacement)) for one in (found, fine)
    )
    errors = [
        "" if pair.is_ is None else grid_error(first[1][[i]], second[1][[pair.is_ - 1]], other[1])
        for i, pair in enumerate(pairs_of(first, [second], [None] * count))
    ]
    return tuple(None if isinstance(error, str) else error for error in errors)


def _sag(scene: Scene, springs: Calibration) -> float | None:
    """See `Spectra`. Actuators and obstacles are left out, for small displacements know none."""
    import lumped

    scene = scene.replace(actuators=(), obstacles=())
    if free_rigid_motions(scene) or not (scene.loads or scene.gravity):
        return None
    solution = lumped.solve(scene, springs, linear=True)
    return float(np.abs(solution.mesh.point_data["displacement"]).max())


def _lattice(model: Resolved[Lattice], count: int, about: About) -> Spectrum:
    import lumped

    springs = model.springs
    begin = now()
    distribution = cast("lumped.Inertia | None", model.spec.masses) or lumped.usual_masses(springs)
    modes = lumped.modes(model.scene, springs, count, distribution, about)
    seconds = now() - begin
    settings = springs.settings | {"masses": distribution, **model.reasons}
    return Spectrum("lumped", f"lumped {springs.title}, {distribution} masses", settings, seconds, modes)


def _reference(model: Resolved[Elements], count: int, about: About) -> Spectrum:
    import fem_reference

    modes = fem_reference.modes(model.scene, model.spec.kind, model.spec.elements, count, about)
    return Spectrum(model.spec.kind, modes.label, modes.settings, modes.solve_seconds, modes)

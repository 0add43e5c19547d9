"""Why lattice and reference, both at rest, differ by more than 20 %: too coarse a grid, or other branches.

A coarse grid's answer comes nearer to the reference's where its cells are halved; on another branch of
equilibria it goes elsewhere: extrapolated to first order, the slowest that a lattice converges, it is as far
off. The lattice is solved once more to tell. (Begun in the other's shape a model comes back to its own in
both cases.) Up to 100 % something else may keep them apart on every grid: springs that do not tend to the
sheet's, laws of strain; then branches are not told.
"""

from __future__ import annotations

from collections.abc import Callable

from comparisons.models.expected_error import converges
from comparisons.models.resolve import Resolved
from comparisons.models.spec import Lattice, counted
from comparisons.sweep.differences import error
from sheetbench.answers.solution import Solution, Status
from sheetbench.scenes.language.summary import few

FAR, SURE = 0.2, 1.0  # errors from which on a reason is looked for, and is not in springs or laws
NEARER = 0.6  # of the error, that a finer grid leaves
STAYS = 0.75  # of the error, that grids finer still would leave, to first order
STRAIN_LAW = 2.3 * 2.0  # times the largest stretch: an error that laws of strain do not explain (model_error)
UNKNOWN = 0.5  # bar of the reference that tells nothing any more


def far_apart_note(
    lattice: Resolved[Lattice],
    solutions: tuple[Solution, ...],
    bar: float | None,
    solve: Callable[[Lattice], Solution | None],
) -> tuple[str, bool]:
    """Return a sentence where lattice and reference, the first two of the solutions, are FAR apart, else
    nothing; and whether they are known to lie on different branches, so that an error would measure neither.

    bar: of the reference, None where it is not known; solve: answers other grids, None where that takes too
    much memory.
    """
    first, reference = solutions[:2]
    if not first.status is reference.status is Status.CONVERGED:
        return "", False
    points = lattice.scene.probe_points()
    own, right = first.displacement(points), reference.displacement(points)
    off = error(own, right)
    if off is None or off <= FAR:
        return "", False

    def reason(cause: str, after: str = "", apart: bool = False) -> tuple[str, bool]:
        both = f"{first.model} and {reference.model} both converged, {100.0 * off:.3g} % apart"
        return f"{both}: {cause}{after}.", apart

    if other := ", ".join(sorted(first.touched ^ reference.touched)):
        return reason(f"{other}: one of them alone touches it, as too coarse a grid or mesh may")
    finer = None
    if lattice.spec.calibration is not None:
        nx, ny, layers = lattice.grid
        finer = solve(lattice.spec.but(grid=(2 * nx - 1, 2 * ny - 1, layers)))
    if finer is None or finer.status is not Status.CONVERGED:
        ended = "" if finer is None else f"; on twice as many cells a side the lattice ends {finer.status}"
        return reason("different branches of equilibria, or too coarse a grid or mesh", ended)
    fine = finer.displacement(points)
    left, moved = error(fine, right) or 0.0, error(own, fine) or 0.0
    masses = f"on {counted(finer.settings['grid'])} masses"
    moves = f"{masses} the lattice moves by {few(100.0 * moved)} %, to {100.0 * left:.3g} % off"
    if left < NEARER * off:
        return reason(f"the grid is too coarse, {masses} it is {100.0 * left:.3g} %")
    if bar is not None and bar > UNKNOWN:
        return reason(f"the {reference.model}'s mesh leaves ± {few(100.0 * bar)} %, more --elements tell")
    ahead = error(2.0 * fine - own, right) or 0.0
    if ahead > STAYS * off and (off > SURE or _tends(lattice, reference, off)):
        trust = "" if bar is not None else f", if the {reference.model}'s mesh is fine enough"
        branches = f"they lie on different branches of equilibria{trust}, for {moves}"
        return reason(branches, apart=bar is not None)
    return reason(f"different branches of equilibria, or too coarse a grid: {moves}")


def _tends(lattice: Resolved[Lattice], reference: Solution, off: float) -> bool:
    """Return whether on one branch the lattice's answer tends to the reference's, but for less than an
    error."""
    return (
        converges(lattice.spec, lattice.grid)
        and not lattice.scene.actuators
        and off > STRAIN_LAW * (reference.stretch or 0.0)
    )

"""Reasons for a difference above 20 % between lattice and reference at rest: a coarse grid, or two branches.

The answer of a too coarse grid moves towards the reference when its cells are halved. On another branch of
equilibria it does not: extrapolated to first order, the slowest convergence of a lattice, its error remains.
The lattice is therefore solved once more. (Started in the other's shape, a model returns to its own in both
cases.) Differences up to 100 % may have other reasons on every grid, as springs that do not converge to the
sheet's or laws of strain; no branches are reported for them.
"""

from collections.abc import Callable

from comparisons.models.expected_error import converges
from comparisons.models.resolve import Resolved
from comparisons.models.spec import Lattice, counted
from comparisons.sweep.differences import error
from sheetbench.answers.solution import Solution, Status
from sheetbench.scenes.language.summary import few

LARGE, SURE = 0.2, 1.0  # errors that need a reason, and errors beyond the effect of springs and strain laws
NEARER = 0.6  # fraction of the error on a finer grid below which the grid was too coarse
REMAINS = 0.75  # fraction of the error, extrapolated to first order, above which branches differ
STRAIN_LAW = 2.3 * 2.0  # times the largest stretch: larger errors are not due to strain laws (model_error)
UNKNOWN = 0.5  # error bar of the reference above which no reason can be given


def far_apart_note(
    lattice: Resolved[Lattice],
    solutions: tuple[Solution, ...],
    bar: float | None,
    solve: Callable[[Lattice], Solution | None],
) -> tuple[str, bool]:
    """Return a sentence on a difference above LARGE between lattice and reference, "" for smaller ones; and
    whether both certainly lie on different branches, which makes errors meaningless.

    solutions: lattice and reference first; bar: of the reference, None if unknown; solve: solves another
    lattice, None if it needs too much memory.
    """
    first, reference = solutions[:2]
    if not first.status is reference.status is Status.CONVERGED:
        return "", False
    points = lattice.scene.probe_points()
    coarse_u, truth = first.displacement(points), reference.displacement(points)
    value = error(coarse_u, truth)
    if value is None or value <= LARGE:
        return "", False

    def reason(cause: str, addition: str = "", branches_differ: bool = False) -> tuple[str, bool]:
        models = f"{first.model} and {reference.model} both converged, {100.0 * value:.3g} % apart"
        return f"{models}: {cause}{addition}.", branches_differ

    if touched_once := ", ".join(sorted(first.touched ^ reference.touched)):
        return reason(f"{touched_once}: only one of them touches it; a grid or mesh may be too coarse")
    finer = None
    if lattice.spec.calibration is not None:
        nx, ny, layers = lattice.grid
        finer = solve(lattice.spec.but(grid=(2 * nx - 1, 2 * ny - 1, layers)))
    if finer is None or finer.status is not Status.CONVERGED:
        status = "" if finer is None else f"; with twice as many cells per side the lattice is {finer.status}"
        return reason("different branches of equilibria, or too coarse a grid or mesh", status)
    fine_u = finer.displacement(points)
    fine_error, change = error(fine_u, truth) or 0.0, error(coarse_u, fine_u) or 0.0
    masses = f"on {counted(finer.settings['grid'])} masses"
    moves = f"{masses} the lattice moves by {few(100.0 * change)} %, to {100.0 * fine_error:.3g} % off"
    if fine_error < NEARER * value:
        return reason(f"the grid is too coarse, {masses} it is {100.0 * fine_error:.3g} %")
    if bar is not None and bar > UNKNOWN:
        return reason(f"the {reference.model}'s error bar is ± {few(100.0 * bar)} %, take more --elements")
    extrapolated = error(2.0 * fine_u - coarse_u, truth) or 0.0
    if extrapolated > REMAINS * value and (value > SURE or _converges_within(lattice, reference, value)):
        condition = "" if bar is not None else f", if the {reference.model}'s mesh is fine enough"
        text = f"they lie on different branches of equilibria{condition}, for {moves}"
        return reason(text, branches_differ=bar is not None)
    return reason(f"different branches of equilibria, or too coarse a grid: {moves}")


def _converges_within(lattice: Resolved[Lattice], reference: Solution, error: float) -> bool:
    """Return whether the lattice would converge to within `error` of the reference if both lay on one
    branch."""
    return (
        converges(lattice.spec, lattice.grid)
        and not lattice.scene.actuators
        and error > STRAIN_LAW * (reference.stretch or 0.0)
    )

"""Load steps that stay on their branch of equilibria, and when to take them."""

from __future__ import annotations

from typing import Protocol, TypeVar

from fem_reference.solving.path import Path, StepFailed
from fem_reference.solving.stability import stability
from fem_reference.solving.structure import Forces, State, Structure
from sheetbench.numerics.direct import DirectSolver, Factor, SingularMatrixError
from sheetbench.scenes import Status

DOUBTFUL = 16  # factorisations from which on a load step may have jumped over a fold
CONTINUOUS = 0.5  # of a careful linear step: what its equilibrium may be off it
BRANCHING = 1e-3  # sizes of the structure: linear steps so short may cross a bifurcation

Linear = TypeVar("Linear", covariant=True)


class Reached(Protocol[Linear]):
    """A linear step: the state it leads to, its length, and the load factor that it is for."""

    @property
    def state(self) -> Linear: ...

    length: float
    target: float


def doubtful(structure: Structure[State, Forces], solver: DirectSolver, path: Path[State]) -> bool:
    """Whether large load steps may have led to another branch: where the equilibrium is unstable, or took
    long to find. A path that is one linear step, without a correction, has jumped over nothing."""
    if not structure.symmetric or path.load_factor == 0.0 or path.factorisations == 1:
        return False
    return path.factorisations > DOUBTFUL or stability(structure, solver, path)[0] is Status.UNSTABLE


def continuous(
    structure: Structure[State, Forces],
    solver: DirectSolver,
    path: Path[State],
    first: Reached[State],
    state: State,
    found: Factor | None,
    negative: int,
    rounding: float,
) -> tuple[Factor | None, int]:
    """The factors at an equilibrium and their negative eigenvalues. Raises StepFailed where it is on another
    branch than the one that the step set out from: far from where the linear step led, or past a change of
    stability by more than a short step. negative: eigenvalues before; rounding: length that is none."""
    if structure.length(first.state, state) > max(CONTINUOUS * first.length, rounding):
        raise StepFailed(Status.STEP_LIMIT, "the path folds", first.length)
    if found is None:
        path.factorisations += 1
        forces = structure.forces(state, first.target)
        try:
            found = solver.factor(structure.system(state, forces, first.target, mixed=False)[0])
        except SingularMatrixError as error:
            raise StepFailed(Status.SINGULAR, str(error), first.length) from None
    now = found.inertia.negative if found.inertia is not None else 0
    if now > negative and first.length > BRANCHING:
        raise StepFailed(Status.STEP_LIMIT, "the path loses stability", first.length)
    return found, now

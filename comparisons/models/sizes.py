"""Unknowns and memory of a model before it is built, and a refusal of models that do not fit.

A process that runs out of memory in a solve ends without a message, so every verb checks the sizes of its
models first.
"""

from bisect import bisect
from collections.abc import Callable
from math import isqrt, prod

from comparisons.external import memory
from comparisons.models.context import context
from comparisons.models.spec import Spec
from comparisons.pictures import work
from sheetbench.answers.size import Size
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene

MOST = 10**6  # masses or elements along a side
MODES = 1.7  # ratio of a reference's memory for frequencies and for statics, shells of 32² elements
DENSE = 3  # dense matrices in memory at once, from the peaks for 768 and 3072 states


def size(scene: Scene, spec: Spec) -> Size | None:
    """Return unknowns and memory of a model, None for a plug-in."""
    counts = spec.counts(scene)
    return _estimate(spec, counts) if counts else None


def has_room(scene: Scene, spec: Spec) -> bool:
    """Return whether the free memory suffices for a model; true also if either is unknown, or if `large`
    models are allowed."""
    room, needed = memory.available(), size(scene, spec)
    return context().large or room is None or needed is None or needed.memory <= room


def require_room(scene: Scene, spec: Spec, option: str = "", instead: str = "", modes: bool = False) -> None:
    """Raise BadInput if a model needs more memory than is free; the message names a size that fits.

    option: the option of the size, by default --lumped or --elements; instead: advice for a size without
    option; modes: whether natural frequencies are computed.
    """
    room, needed = memory.available(), size(scene, spec)
    if room is not None and modes and not spec.IS_LATTICE:
        room = round(room / MODES)
    if room is None or needed is None or needed.memory <= room:
        return
    counts = "x".join(str(n) for n in spec.counts(scene))
    option = option or (f"--{spec.model}" if spec.IS_LATTICE else "--elements")
    count = "grid" if spec.IS_LATTICE else "count"

    def fits(number: int) -> bool:
        estimate = _estimate(spec, spec.but(**{count: number}).counts(scene))
        return estimate.memory <= room

    fitting = _largest(2 if spec.IS_LATTICE else 1, fits)
    advice = f"{option} {fitting} would fit" if fitting else f"take fewer along the longer side, {option} NxM"
    memory_text, free = work.memory(needed.memory), work.memory(room)
    raise BadInput(
        f"{spec.model} {counts}: {work.count(needed.unknowns)} unknowns take about {memory_text} of "
        f"memory, and {free} are free here; {instead or advice}, or give --large (in Python large=True) to "
        "try all the same"
    )


def require_states(states: int) -> None:
    """Raise BadInput if the dense matrices of a state space need more memory than is free."""
    room, needed = memory.available(), DENSE * 8 * states**2
    if room is not None and needed > room and not context().large:
        memory_text, free, fitting = work.memory(needed), work.memory(room), isqrt(room // (8 * DENSE)) // 2
        raise BadInput(
            f"{work.count(states)} states: their matrices take about {memory_text} of memory, and {free} are "
            f"free here; --state-space {fitting} would fit, or give --large to try all the same"
        )


def mesh(scene: Scene, spec: Spec) -> str:
    """Return the numbers of masses or elements of a model in words, "" for a plug-in."""
    counts = " × ".join(str(n) for n in spec.counts(scene))
    return counts and f"{counts} {'masses' if spec.IS_LATTICE else 'elements'}"


def _estimate(spec: Spec, counts: list[int]) -> Size:
    if spec.IS_LATTICE:
        import lumped

        return lumped.footprint((counts[0], counts[1], counts[2]))
    from fem_reference.footprint import footprint

    return footprint(spec.model, (counts[0], counts[1]), prod(counts[2:]))


def _largest(least: int, fits: Callable[[int], bool]) -> int:
    """Return the largest number that fits, 0 if none fits."""
    return bisect(range(MOST), False, least, key=lambda number: not fits(number)) - 1 if fits(least) else 0

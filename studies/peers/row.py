"""A row of the comparison with peers, and by how much ours is faster at the same error."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass

ENOUGH, MOST = 1.0, 15  # s of repeats, and how many at most


@dataclass(frozen=True)
class PeerRow:
    """question: `statics` or `settling`; code: whose; size: its mesh or tolerance in words; error: of the
    largest displacement, None without an answer; seconds: samples; status: how it ended."""

    question: str
    code: str
    size: str
    ours: bool
    error: float | None
    seconds: tuple[float, ...]
    status: str

    @property
    def median(self) -> float | None:
        """The median time [s]."""
        return statistics.median(self.seconds) if self.seconds else None


def faster(row: PeerRow, rows: Sequence[PeerRow]) -> float | None:
    """How many times as long a peer takes as the fastest of ours with no larger an error; None where none
    is."""
    if row.ours or row.error is None or row.median is None:
        return None
    times = [
        other.median
        for other in rows
        if other.ours
        and other.question == row.question
        and other.median is not None
        and other.error is not None
        and other.error <= row.error
    ]
    return row.median / min(times) if times else None


def repeated(once: Callable[[], float]) -> tuple[float, ...]:
    """Times [s] that `once` tells, again until they are `ENOUGH` together; the first counts if it is long."""
    first = once()
    if first >= ENOUGH:
        return (first,)
    samples: list[float] = []
    while sum(samples) < ENOUGH and len(samples) < MOST:
        samples.append(once())
    return tuple(samples)

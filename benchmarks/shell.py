"""Shells, mesh by mesh: time of the call, what it goes to, and its factorisations.

    python benchmarks/shell.py [--elements N ...] [--keep]

Least CPU seconds of several calls on warm code and one BLAS thread, and the shares of assembly (forces,
tangents, steps), factors (analysis, factors, solutions), set-up with the answer (mesh, numbers, balance), and
of Python between them.
"""

import argparse
import os
from collections.abc import Callable
from time import process_time
from typing import Any

for name in ("OMP", "OPENBLAS", "RAYON", "NUMBA"):
    os.environ[f"{name}_NUM_THREADS"] = "1"

from keeping import keep  # noqa: E402  # after the number of threads is set

import fem_reference  # noqa: E402
from sheetbench.scenes import load  # noqa: E402

ELEMENTS, REPEATS = (4, 8, 16, 32), 6
ASSEMBLY = ("forces", "linearised", "advance", "imbalance", "gap", "length")
FACTORS = ("factor", "solve")


class Clock:
    """Return the CPU seconds by kind of function, without the calls of other kinds."""

    def __init__(self) -> None:
        self.spent: dict[str, float] = {}
        self._now: list[str] = []
        self._since = 0.0

    def watch(self, owner: Any, name: str, kind: str) -> None:
        """Count the seconds of a function."""
        plain: Callable[..., Any] = getattr(owner, name)

        def timed(*arguments: Any, **named: Any) -> Any:
            self._turn(kind)
            try:
                return plain(*arguments, **named)
            finally:
                self._turn(None)

        setattr(owner, name, timed)

    def _turn(self, kind: str | None) -> None:
        now = process_time()
        if self._now:
            self.spent[self._now[-1]] = self.spent.get(self._now[-1], 0.0) + now - self._since
        self._since = now
        if kind is None:
            self._now.pop()
        else:
            self._now.append(kind)


def watched() -> Clock:
    """Return a clock of the shell's functions."""
    from fem_reference import sheets, statics
    from fem_reference.discrete.static import Static
    from sheetbench.numerics.direct import DirectSolver, Factor

    clock = Clock()
    for owner, names, kind in (
        (Static, ASSEMBLY, "assembly"),
        (DirectSolver, FACTORS[:1], "factors"),
        (Factor, FACTORS[1:], "factors"),
        (sheets, ("DiscreteShell",), "set-up"),
        (statics, ("answered",), "set-up"),
    ):
        for name in names:
            clock.watch(owner, name, kind)
    return clock


def main() -> None:
    """Measure, print, keep."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--elements", type=int, nargs="+", default=ELEMENTS, help="along a side")
    parser.add_argument("--keep", action="store_true", help="keep the rows in benchmarks/history")
    arguments = parser.parse_args()
    clock, scene = watched(), load("two-edges-clamped")

    def solved(elements: int) -> dict[str, float]:
        clock.spent, began = {}, process_time()
        found = fem_reference.solve(scene, model="shell", elements=elements)
        spent = {"seconds": process_time() - began, "factorisations": found.iterations}
        return spent | clock.spent

    rows: list[dict[str, Any]] = []
    for elements in arguments.elements:
        calls = [solved(elements) for _ in range(REPEATS + 1)][1:]
        ours = min(calls, key=lambda call: call["seconds"])
        shares = {kind: ours.get(kind, 0.0) / ours["seconds"] for kind in ("assembly", "factors", "set-up")}
        shares["python"] = 1.0 - sum(shares.values())
        rows.append({"shell": f"{elements}×{elements}", **ours, "shares": shares})
        shown = ", ".join(f"{kind} {share:.0%}" for kind, share in shares.items())
        print(
            f"shell {rows[-1]['shell']:>6} {1e3 * ours['seconds']:8.1f} ms  {ours['factorisations']:.0f} "
            f"factorisations  {shown}",
            flush=True,
        )
    if arguments.keep:
        print(keep("shell", rows))


if __name__ == "__main__":
    main()

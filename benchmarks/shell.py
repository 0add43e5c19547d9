"""Shells, mesh by mesh: time of the call, what it goes to, and its factorisations.

    python benchmarks/shell.py [--elements N ...] [--against CHECKOUT] [--keep]

Least CPU seconds of several calls on warm code and one BLAS thread, and the shares of assembly (forces,
tangents, steps), factors (analysis, factors, solutions), set-up with the answer (mesh, numbers, balance), and
of Python between them. --against: another checkout of this repository solves the same in turn, call by call,
in a process of its own; the ratio is its time over ours.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from time import process_time
from typing import Any

from keeping import keep

ELEMENTS, REPEATS = (4, 8, 16, 32), 6
ASSEMBLY = ("forces", "system", "advance", "imbalance", "gap", "length")
FACTORS = ("factor", "solve")
OUTSIDE = ("discretise", "_solution")


class Clock:
    """CPU seconds by kind; what is called from another kind counts there."""

    def __init__(self) -> None:
        self.spent: dict[str, float] = {}
        self._now: list[str] = []
        self._since = 0.0

    def watch(self, owner: Any, name: str, kind: str) -> None:
        """Count what a function takes."""
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


def serve() -> None:
    """Answer every line of the input, a number of elements, with the seconds of a call and of its parts."""
    import fem_reference
    from fem_reference.shell import statics
    from fem_reference.shell.structure import ShellStructure
    from sheetbench.numerics.direct import DirectSolver, Factor
    from sheetbench.scenes import load

    clock, scene = Clock(), load("two-edges-clamped")
    for owner, names, kind in (
        (ShellStructure, ASSEMBLY, "assembly"),
        (DirectSolver, FACTORS[:1], "factors"),
        (Factor, FACTORS[1:], "factors"),
        (statics, OUTSIDE, "set-up"),
    ):
        for name in names:
            clock.watch(owner, name, kind)
    for line in sys.stdin:
        clock.spent, began = {}, process_time()
        found = fem_reference.solve(scene, model="shell", elements=int(line))
        spent = {"seconds": process_time() - began, "factorisations": found.iterations}
        print(json.dumps(spent | clock.spent), flush=True)


class Server:
    """A process that solves shells with the code of a checkout."""

    def __init__(self, checkout: Path):
        environment = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "RAYON", "NUMBA")}
        self._process = subprocess.Popen(
            [sys.executable, str(Path(__file__).resolve()), "--serve"],
            cwd=checkout,
            env={"PYTHONPATH": str(checkout), "PATH": "", "HOME": str(Path.home()), **environment},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def solve(self, elements: int) -> dict[str, float]:
        """Seconds of one call and of its parts."""
        assert self._process.stdin is not None and self._process.stdout is not None
        print(elements, file=self._process.stdin, flush=True)
        found: dict[str, float] = json.loads(self._process.stdout.readline())
        return found

    def close(self) -> None:
        """End it."""
        self._process.communicate()


def main() -> None:
    """Measure, print, keep."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--elements", type=int, nargs="+", default=ELEMENTS, help="along a side")
    parser.add_argument(
        "--against", type=Path, metavar="CHECKOUT", help="another checkout, in turn with ours"
    )
    parser.add_argument("--keep", action="store_true", help="keep the rows in benchmarks/history")
    parser.add_argument("--serve", action="store_true", help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.serve:
        serve()
        return
    here = Path(__file__).resolve().parent.parent
    servers = [Server(checkout.resolve()) for checkout in (here, asked.against) if checkout is not None]
    rows: list[dict[str, Any]] = []
    for elements in asked.elements:
        calls = [[server.solve(elements) for server in servers] for _ in range(REPEATS + 1)][1:]
        ours, *other = (min(each, key=lambda call: call["seconds"]) for each in zip(*calls, strict=True))
        shares = {kind: ours.get(kind, 0.0) / ours["seconds"] for kind in ("assembly", "factors", "set-up")}
        shares["python"] = 1.0 - sum(shares.values())
        rows.append({"shell": f"{elements}×{elements}", **ours, "shares": shares})
        shown = ", ".join(f"{kind} {share:.0%}" for kind, share in shares.items())
        against = ""
        if other:
            rows[-1]["against_seconds"] = other[0]["seconds"]
            against = f"  {other[0]['seconds'] / ours['seconds']:.2f} times as fast as {asked.against.name}"
        print(
            f"shell {rows[-1]['shell']:>6} {1e3 * ours['seconds']:8.1f} ms  {ours['factorisations']:.0f} "
            f"factorisations  {shown}{against}",
            flush=True,
        )
    for server in servers:
        server.close()
    if asked.keep:
        print(keep("shell", rows))


if __name__ == "__main__":
    main()

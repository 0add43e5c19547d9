"""Calls beside those of another state of the code: CPU time, in turns.

    git worktree add ../before a52b402
    python benchmarks/against.py ../before [lattice:9 shell:8 …] [--seconds S] [--keep]

A case is a kind and a size: `lattice` and `pressure` of N × N × 2 masses (springs made before), `shell` and
`pressed-shell` of N × N elements, `settling` of N × N × 2 masses over 2 s by `esdirk` with the samples of
`simulate`'s default, `settling-100` with 100 a second. Each state answers in a process of its own, on warm
code and one thread, in turns of a call, of several if they are short; ratios are its CPU time over ours, of
the least calls and of the medians.
"""

import argparse
import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from statistics import median
from time import process_time
from typing import Any

HERE = Path(__file__).resolve().parent
CASES = (
    "lattice:9",
    "lattice:65",
    "pressure:9",
    "shell:8",
    "pressed-shell:8",
    "settling:9",
    "settling-100:9",
)
THREADS = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "RAYON", "NUMBA")}
TURN, TURNS = 0.1, 3  # CPU seconds of a turn, at least a call; of turns, at least


def call_of(case: str) -> Callable[[], float]:
    """Return what solves a case once and returns its largest displacement [m]."""
    import fem_reference
    import lumped
    from sheetbench.scenes import load

    kind, size = case.split(":")[0], int(case.split(":")[1])
    scene = load("two-edges-settling" if kind.startswith("settling") else "two-edges-clamped")
    if "press" in kind:
        scene = load(str(HERE / "pressed.toml"))
    solve: Callable[[], Any]
    if "shell" in kind:
        solve = partial(fem_reference.solve, scene, "shell", elements=size)
    else:
        springs = lumped.calibrate(scene.sheet, scene.material, grid=(size, size))
        every = {"every": 0.01} if kind == "settling-100" else {}
        solve = partial(lumped.solve, scene, springs)
        if kind.startswith("settling"):
            solve = partial(lumped.simulate, scene, springs, 2.0, integrator="esdirk", **every)

    middle = [[0.5 * scene.sheet.length_x, 0.5 * scene.sheet.length_y]]

    def call() -> float:
        found = solve()
        moved = list(found.probes.values()) if kind.startswith("settling") else found.displacement(middle)
        return max(float(abs(one).max()) for one in moved)

    return call


def serve(case: str) -> None:
    """Answer every line of the input, a number of calls, with their CPU seconds, the answer and the peak of
    memory."""
    bytearray(31 << 20)  # freed at once: glibc then keeps what arrays free, as the command line has it
    call = call_of(case)
    for line in sys.stdin:
        seconds = []
        for _ in range(int(line)):
            began = process_time()
            answer = call()
            seconds.append(process_time() - began)
        peak = 1024 * int(re.search(r"VmHWM:\s*(\d+)", Path("/proc/self/status").read_text())[1])  # type: ignore[index]
        print(json.dumps([seconds, answer, peak]), flush=True)


def beside(case: str, other: Path, seconds: float) -> dict[str, Any]:
    """Return a case's calls in another state and here: least and median seconds, peaks of memory, and by how
    much the answers differ."""
    servers = [
        subprocess.Popen(
            [sys.executable, "-P", str(HERE / "against.py"), "--serve", case],
            cwd=root,
            env=os.environ | THREADS | {"PYTHONPATH": str(root)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        for root in (other, HERE.parent)
    ]

    def turn(server: subprocess.Popen[str], calls: int) -> tuple[list[float], float, int]:
        assert server.stdin is not None and server.stdout is not None
        print(calls, file=server.stdin, flush=True)
        spent, answer, peak = json.loads(server.stdout.readline())
        return spent, answer, peak

    once = [turn(server, 2)[0][-1] for server in servers]  # the first call is cold
    calls = max(1, int(TURN / max(once)))
    turns = max(TURNS, int(seconds / (calls * sum(once))))
    rounds = [[turn(server, calls) for server in servers] for _ in range(turns)]
    for server in servers:
        server.communicate()
    spent = [[one for each in rounds for one in each[state][0]] for state in (0, 1)]
    was, now = (answer for _, answer, _ in rounds[-1])
    return {
        "case": case,
        "calls": turns * calls,
        "least_seconds": [min(of) for of in spent],
        "median_seconds": [median(of) for of in spent],
        "peak_bytes": [of[2] for of in rounds[-1]],
        "difference": abs(now / was - 1.0),
    }


def main() -> None:
    """Measure, print, keep."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("other", type=Path, nargs="?", metavar="FOLDER", help="another state of the code")
    parser.add_argument("case", nargs="*", default=CASES, help=f"default: {' '.join(CASES)}")
    parser.add_argument("--seconds", type=float, default=5.0, help="CPU seconds of a case")
    parser.add_argument("--keep", action="store_true", help="keep the rows in benchmarks/history")
    parser.add_argument("--serve", metavar="CASE", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.serve:
        serve(arguments.serve)
        return
    if arguments.other is None:
        parser.error("name the FOLDER of another state")
    rows = []
    for case in arguments.case:
        row = beside(case, arguments.other.resolve(), arguments.seconds)
        (was, now), medians = row["least_seconds"], row["median_seconds"]
        peaks = " → ".join(f"{peak / 1e9:.2f}" for peak in row["peak_bytes"])
        print(
            f"{case:>15}  {1e3 * was:8.2f} → {1e3 * now:8.2f} ms, {was / now:5.2f} times as fast by the "
            f"least of {row['calls']}, {medians[0] / medians[1]:5.2f} by medians; {peaks} GB; "
            f"answers {row['difference']:.0e} apart",
            flush=True,
        )
        rows.append(row)
    if arguments.keep:
        from keeping import keep

        print(keep("against", rows))


if __name__ == "__main__":
    main()

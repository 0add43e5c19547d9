"""Equilibria of lattices and shells: time, what it goes to, and the rate of the factorisations, in one run.

    python benchmarks/statics.py [--lattices N ...] [--shells N ...] [--batch N] [--json FILE] [--keep]

Of every lattice the best of its solves, the call with its set-up over the solve, factorisations, their share
of the solve and the rate that they reach; then a batch, by the clock, and the shell with the share of its
factorisations. Warm code, one BLAS thread; CPU seconds, which other programs on the machine lengthen less
than the clock's. `--lattices 129 257` takes minutes and 3 GB.
"""

import argparse
import json
import platform
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from resource import RUSAGE_SELF, getrusage
from time import perf_counter, process_time
from typing import Any

import numpy as np
from keeping import keep

import fem_reference
import lumped
from lumped.statics.solver import solve_from_best_start
from sheetbench.numerics import banded
from sheetbench.numerics.direct import DirectSolver
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import load

SCENE = load("two-edges-clamped")
LATTICES, SHELLS, BATCH = (3, 5, 9, 17, 33, 65), (4, 8, 16, 32), 1000


def timed(call: Callable[[], Any], clock: Callable[[], float] = process_time) -> float:
    """Return the seconds of a call."""
    began = clock()
    call()
    return clock() - began


def lattice(masses: int) -> dict[str, Any]:
    """Measure a square lattice: seconds of the solve and of its parts, and the rate of its factorisations."""
    springs = lumped.calibrate(SCENE.sheet, SCENE.material, grid=(masses, masses))
    repeats = 30 if masses < 20 else 3 if masses < 100 else 1
    with one_blas_thread():
        call = min(timed(lambda: lumped.solve(SCENE, springs)) for _ in range(repeats + 1))
        setup = min(timed(lambda: lumped.build_problem(SCENE, springs)) for _ in range(repeats))
        problems = [lumped.build_problem(SCENE, springs) for _ in range(repeats)]
        solve = min(timed(lambda p=problem: solve_from_best_start(p, springs)) for problem in problems)
        problem = problems[-1]
        path = solve_from_best_start(problem, springs)
        factor, flops = factorisation(problem, problem.tangent(np.zeros_like(problem.loads.dead), 0.0))
        once = min(timed(factor) for _ in range(max(1, repeats // 3)))
    return {
        "lattice": f"{masses}×{masses}×2",
        "unknowns": problem.system.unknowns,
        "solve_seconds": solve,
        "setup_seconds": setup,
        "call_over_solve": call / solve,
        "factorisations": path.factorisations,
        "one_factorisation_seconds": once,
        "gflops": flops / once / 1e9,
        "peak_bytes": 1024 * getrusage(RUSAGE_SELF).ru_maxrss,
    }


def factorisation(problem: Any, blocks: np.ndarray) -> tuple[Callable[[], Any], float]:
    """Measure one factorisation, and count its operations."""
    system = problem.system
    if system.band is not None:
        matrix = banded.stored(blocks, system.band)
        n, width = system.unknowns, system.band.width
        return lambda: banded.factor(matrix.copy(), n, width), n * (width + 1.0) ** 2
    import rslab

    matrix = system.matrix(blocks)
    analysis = rslab.analyze(matrix, path="ldlt")
    stages = analysis.factor(matrix).diagnostics()["stages"]
    flops = next(stage["flops"] for stage in stages if stage["name"] == "factor")
    return lambda: analysis.factor(matrix), float(flops)


def batch(count: int) -> dict[str, Any]:
    """Measure many lattices of 9×9×2 with different springs, at once and one by one, in seconds a case."""
    springs = lumped.calibrate(SCENE.sheet, SCENE.material, grid=(9, 9))
    stiffness = lumped.calibrate(SCENE.sheet, SCENE.material, grid=(9, 9)).springs.diagonal
    several = [springs.with_constant("diagonal", k) for k in np.linspace(0.5, 1.5, count) * stiffness]
    some = several[: max(1, count // 20)]
    one_by_one = timed(lambda: [lumped.solve(SCENE, each) for each in some], perf_counter) / len(some)
    with one_blas_thread(), ThreadPoolExecutor() as pool:
        worked, began = process_time(), perf_counter()
        list(pool.map(lambda each: lumped.solve(SCENE, each), several))
    at_once, worked = (perf_counter() - began) / count, (process_time() - worked) / count
    return {
        "batch": count,
        "seconds_each": at_once,
        "cpu_seconds_each": worked,
        "one_by_one_seconds_each": one_by_one,
    }


def shell(elements: int) -> dict[str, Any]:
    """Measure a shell: seconds of its call, and the share of its factorisations."""
    spent = 0.0
    plain = DirectSolver.factor

    def factor(self: DirectSolver, *given: Any) -> Any:
        nonlocal spent
        began = process_time()
        found = plain(self, *given)
        spent += process_time() - began
        return found

    DirectSolver.factor = factor  # type: ignore[method-assign]
    try:
        best = (np.inf, 0.0)
        for _ in range(4):
            spent = 0.0
            seconds = timed(lambda: fem_reference.solve(SCENE, model="shell", elements=elements))
            best = min(best, (seconds, spent))
    finally:
        DirectSolver.factor = plain  # type: ignore[method-assign]
    seconds, of_factors = best
    return {
        "shell": f"{elements}×{elements}",
        "call_seconds": seconds,
        "factorisation_share": of_factors / seconds,
    }


def of_batch_and_shells(count: int, shells: Sequence[int]) -> list[dict[str, Any]]:
    """Print the rows of batches and shells."""
    rows = [batch(count)]
    row = rows[-1]
    print(
        f"batch of {count}: {1e3 * row['seconds_each']:.2f} ms each "
        f"({1e3 * row['cpu_seconds_each']:.2f} of the CPU), "
        f"{1e3 * row['one_by_one_seconds_each']:.2f} ms one by one",
        flush=True,
    )
    for elements in shells:
        rows.append(shell(elements))
        share = rows[-1]["factorisation_share"]
        called = 1e3 * rows[-1]["call_seconds"]
        print(f"shell {rows[-1]['shell']:>6}  call {called:9.1f} ms  factorisations {share:.0%}", flush=True)
    return rows


def main() -> None:
    """Measure, print, keep."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--lattices", type=int, nargs="+", default=LATTICES, help="masses along a side")
    parser.add_argument("--shells", type=int, nargs="+", default=SHELLS, help="elements along a side")
    parser.add_argument("--batch", type=int, default=BATCH, help="lattices in the batch")
    parser.add_argument("--json", metavar="FILE", help="where to keep the numbers")
    parser.add_argument("--keep", action="store_true", help="keep the rows in benchmarks/history")
    arguments = parser.parse_args()
    rows: list[dict[str, Any]] = []
    for masses in arguments.lattices:
        rows.append(lattice(masses))
        row = rows[-1]
        share = min(1.0, row["factorisations"] * row["one_factorisation_seconds"] / row["solve_seconds"])
        print(
            f"lattice {row['lattice']:>10}  solve {1e3 * row['solve_seconds']:9.2f} ms  "
            f"call/solve {row['call_over_solve']:.2f}  factorisations {row['factorisations']} "
            f"({share:.0%})  {row['gflops']:.1f} Gflop/s  {row['peak_bytes'] / 1e9:.1f} GB",
            flush=True,
        )
    rows.extend(of_batch_and_shells(arguments.batch, arguments.shells))
    if arguments.json:
        about = {"machine": platform.processor() or platform.machine(), "python": platform.python_version()}
        with open(arguments.json, "w", encoding="utf-8") as file:
            json.dump({"about": about, "rows": rows}, file, indent=1)
    if arguments.keep:
        print(keep("statics", rows))


if __name__ == "__main__":
    main()

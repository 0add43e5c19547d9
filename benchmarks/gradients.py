"""Cost of gradients and of many designs, over a solve in one process: figures of docs/gradients.md.

    python benchmarks/gradients.py [rounds]

A round takes scenes that have not been seen, sheets clamped at one edge on 9 × 9 × 2 masses of E, ν and h
drawn within 1 %, and for the row of designs a modulus a cell and forces that have not. Each row is the least
CPU time of all rounds. The designs of `solve_many` are moduli a cell, drawn within 10 %, of a sheet between
two clamps: least times by the clock of ten calls, the solve beside them with its springs given.
"""

import argparse
from collections import defaultdict
from collections.abc import Callable
from time import perf_counter, process_time
from typing import Any

import numpy as np

import lumped
from sheetbench.scenes import Scene, load


def drawn(rng: np.random.Generator) -> Scene:
    """Return a sheet of its own, clamped at one edge."""
    scene, (e, nu, h) = load("one-edge-clamped"), 1.0 + 0.01 * rng.random(3)
    material = scene.material.replace(young=5e7 * e, poisson=0.47 * nu)
    return scene.replace(material=material, sheet=scene.sheet.replace(thickness=0.003 * h))


def solved(scene: Scene) -> None:
    """Solve a scene and take all derivatives of the displacement of its last probe along z."""
    answer = lumped.solve(scene)
    dict(answer.sensitivity().at_points(scene.probe_points()[-1:], np.eye(3)[2:]))


def designed(sheet: lumped.Differentiable, rng: np.random.Generator) -> None:
    """Solve a sheet with drawn fields, and take the derivatives of ½ Σ u² by every field."""
    young, forces = sheet.base["cells.young"], sheet.base["forces"]
    drawn = 1.0 + 0.01 * rng.random(young.shape)
    u = sheet.solve({"cells.young": young * drawn, "forces": 1e-4 * rng.random(forces.shape)})
    found = sheet.pullback(u)
    _ = [found[name] for name in sheet.base]


def print_rates(count: int, rng: np.random.Generator) -> None:
    """Print how many designs a second `solve_many` solves, on one thread and on two."""
    scene = load("two-edges-clamped")
    sheet = lumped.Differentiable(scene)
    base = sheet.base["cells.young"]
    designs = {"cells.young": base * np.exp(0.1 * rng.standard_normal((count, *base.shape)))}

    def least(run: Callable[[], Any]) -> float:
        def once() -> float:
            begin = perf_counter()
            run()
            return perf_counter() - begin

        return min(once() for _ in range(10))

    alone = least(lambda: lumped.solve(scene, sheet.calibration))
    for workers in (1, 2):
        each = least(lambda workers=workers: lumped.solve_many(scene, designs, workers=workers)) / count
        print(f"solve_many, {workers} threads: {1.0 / each:.0f} designs a second, {alone / each:.1f} × solve")


def main() -> None:
    """Print the times and their ratios."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("rounds", type=int, nargs="?", default=40)
    times, rng = defaultdict[str, list[float]](list), np.random.default_rng(0)

    def clock(row: str, run: Callable[..., Any], *given: Any) -> None:
        begin = process_time()
        run(*given)
        times[row].append(process_time() - begin)

    sheet = lumped.Differentiable("one-edge-clamped")
    for _ in range(parser.parse_args().rounds):
        clock("solve", lumped.solve, drawn(rng))
        scene = drawn(rng)
        clock("solve with all derivatives", solved, scene)
        clock("the same again", solved, scene)
        clock("a design, with all derivatives by fields", designed, sheet, rng)
    least = {row: min(of) for row, of in times.items()}
    for row, time in least.items():
        print(f"{row}: {1e3 * time:.1f} ms, {time / least['solve']:.2f} solves")
    print_rates(1000, rng)


if __name__ == "__main__":
    main()

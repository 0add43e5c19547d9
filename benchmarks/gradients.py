"""Cost of a gradient, a solve with all derivatives over a solve in one process: figures of docs/gradients.md.

    python benchmarks/gradients.py [rounds]

A round takes scenes that have not been seen, sheets clamped at one edge on 9 × 9 × 2 masses of E, ν and h
drawn within 1 %, and for the row of designs a modulus a cell and forces that have not. Each row is the least
CPU time of all rounds.
"""

import argparse
from collections import defaultdict
from collections.abc import Callable
from time import process_time
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


if __name__ == "__main__":
    main()

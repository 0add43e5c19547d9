"""Microseconds of CPU a step of velocity Verlet, compiled and one by one, by grid and damping.

    OMP_NUM_THREADS=1 python benchmarks/explicit_steps.py [--keep] 9 65

The best of four alternating samples of each. Displacements are random, a thousandth of the layers' distance.
"""

import argparse
import time
from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np
from keeping import keep

import lumped
from lumped import INTEGRATORS, State, System, build_problem
from sheetbench import scenes

STEP = 1e-8  # s, below every limit


def seconds(work: Callable[[], int]) -> float:
    """Return the CPU time of each part of `work`."""
    began = time.process_time()
    count = work()
    return (time.process_time() - began) / count


def measure(masses: int, damping_time: float) -> tuple[float, float]:
    """Return the seconds of a step, compiled and one by one."""
    scene = scenes.load("two-edges-clamped")
    scene = scene.replace(material=scene.material.replace(damping_time=damping_time))
    springs = lumped.calibrate(scene.sheet, scene.material, grid=masses)
    system = System(scene, build_problem(scene, springs))
    size = 1e-3 * springs.layer_distance
    u = system.expand(size * np.random.default_rng(0).standard_normal(system.reduced_mass.shape[0]))
    state = State(0.0, u, u, np.zeros_like(u))
    method = INTEGRATORS["verlet"](system, STEP)

    def alone(count: int) -> int:
        for _ in range(count):
            method.advance(state, STEP)
        return count

    together = method.march(state, STEP, 10**6).steps
    found = [
        (
            seconds(lambda: method.march(state, STEP, together).steps),
            seconds(lambda: alone(max(1, together // 20))),
        )
        for _ in range(4)
    ]
    compiled, single = np.min(found, axis=0)
    return float(compiled), float(single)


def main() -> None:
    """Measure, print, keep."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("masses", nargs="*", type=int, default=[9, 65], help="along each side")
    parser.add_argument("--keep", action="store_true", help="keep the rows in benchmarks/history")
    arguments = parser.parse_args()
    rows: list[dict[str, Any]] = []
    for n, damping in product(arguments.masses, (0.0, 4e-3)):
        one, other = measure(n, damping)
        rate = 2e-6 * n * n / one
        rows.append(
            {"lattice": f"{n}×{n}×2", "dampers": bool(damping), "step_seconds": one,
             "alone_seconds": other}
        )  # fmt: skip
        print(
            f"{n}x{n}x2, {'dampers' if damping else 'undamped'}: {1e6 * one:.1f} µs a step, "
            f"{1e6 * other:.0f} one by one; {rate:.1f} M mass-steps/s",
            flush=True,
        )
    if arguments.keep:
        print(keep("explicit-steps", rows))


if __name__ == "__main__":
    main()

"""Two seconds of the settling sheet by our integrators and by SciPy's BDF: time, steps and error, in one run.

    python benchmarks/settling.py [--all] [--duration S] [--json FILE] [--keep]

BDF has the lattice's own sparse Jacobian and compiled right-hand side; it only returns displacements, where
ours also keep energies and reactions and watch every sample, and set up within their time. Error: of P4 over
the run, relative to its largest displacement, against `esdirk` at fixed steps of 1 ms. Best of three, taken
in turn, on one thread; CPU seconds, which other programs on the machine lengthen less than the clock's. A
step of ours: what the run takes beyond one to the first sample, samples included. --all:
`verlet`, a million steps, and midpoint too.
"""

import argparse
import json
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[name] = "1"

import numpy as np  # noqa: E402  # after the number of threads is set
import scipy.sparse as sp  # noqa: E402
from keeping import keep  # noqa: E402
from scipy.integrate import solve_ivp  # noqa: E402

import lumped  # noqa: E402
from sheetbench import scenes  # noqa: E402

SCENE, GRID, DURATION, EVERY, REPEATS = "two-edges-settling", (9, 9), 2.0, 0.01, 3
Answer = tuple[np.ndarray, int]  # P4 (n, 3) [m] at samples, and steps


def equations() -> tuple[Any, Callable[..., np.ndarray], Callable[..., sp.csc_array]]:
    """Return the lattice's system, and ẏ and ∂ẏ/∂y of y = (free displacements, their velocities), without
    the derivative of the dampers' directions, as in an implicit step."""
    scene = scenes.load(SCENE)
    springs = lumped.calibrate(scene.sheet, scene.material, grid=GRID)
    system = lumped.System(scene, lumped.build_problem(scene, springs))
    n = system.reduced_mass.shape[0]
    weight = sp.diags_array(1.0 / system.reduced_mass.diagonal())

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        u, v = system.expand(y[:n]), system.expand(y[n:])
        return np.concatenate([y[n:], system.solve_mass(system.reduce(system.unbalanced(u, v, t)))])

    def jacobian(t: float, y: np.ndarray) -> sp.csc_array:
        u, v = system.expand(y[:n]), system.expand(y[n:])
        k, c = (
            weight @ system.problem.system.matrix(system.matrix(u, v, t, 0.0, *by))
            for by in ((0.0, 1.0), (1.0, 0.0))
        )
        return sp.csc_array(sp.block_array([[None, sp.eye_array(n)], [-k, -c]]))

    return system, rate, jacobian


def bdf(rtol: float, duration: float) -> Callable[[], Answer]:
    """Run SciPy's BDF on the lattice's equations as a system of first order."""
    system, rate, jacobian = equations()
    times = np.linspace(0.0, duration, round(duration / EVERY) + 1)
    n, corner = system.reduced_mass.shape[0], system.assembly.lattice.columns()[-1, -1]

    def run() -> Answer:
        found = solve_ivp(
            rate, (0.0, duration), np.zeros(2 * n), "BDF", times, rtol=rtol, atol=1e-3 * rtol, jac=jacobian
        )
        u = np.array([system.expand(y[:n])[corner].mean(axis=0) for y in found.y.T])
        return u, found.nfev

    return run


def ours(integrator: str, duration: float, **options: Any) -> Callable[[], Answer]:
    """Run `simulate`, set-up and samples included."""
    scene = scenes.load(SCENE)
    springs = lumped.calibrate(scene.sheet, scene.material, grid=GRID)

    def run() -> Answer:
        history = lumped.simulate(scene, springs, duration, integrator=integrator, every=EVERY, **options)
        return history.probes["P4"], history.steps

    return run


def seconds(work: Callable[[], Any]) -> tuple[float, Any]:
    """Return the CPU time and the result of `work`."""
    began = time.process_time()
    found = work()
    return time.process_time() - began, found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--all", action="store_true", help="verlet and midpoint too")
    parser.add_argument("--duration", type=float, default=DURATION, help="of the runs [s]")
    parser.add_argument("--json", type=Path, help="a file for the rows")
    parser.add_argument("--keep", action="store_true", help="keep the rows in benchmarks/history")
    arguments = parser.parse_args()
    duration = arguments.duration
    rivals = {f"SciPy BDF, rtol {rtol}": bdf(float(rtol), duration) for rtol in ("1e-3", "1e-4")}
    methods: dict[str, tuple[str, dict[str, Any]]] = {
        "generalised-alpha": ("generalised-alpha", {}),
        "esdirk": ("esdirk", {}),
    }
    if arguments.all:
        methods |= {name: (name, {}) for name in ("midpoint", "verlet")}
    truth, _ = ours("esdirk", duration, step=1e-3)()
    near, _ = ours("esdirk", duration, step=2e-3)()
    largest = np.abs(truth).max()
    doubt = np.abs(near - truth).max() / largest
    print(f"{SCENE}, 9×9×2, {duration:g} s; error of the reference at most {doubt:.1e}")
    runs = rivals | {label: ours(name, duration, **options) for label, (name, options) in methods.items()}
    beginnings = {label: ours(name, EVERY, **options) for label, (name, options) in methods.items()}
    spent: dict[str, list[float]] = {label: [] for label in runs}
    started: dict[str, list[float]] = {label: [] for label in runs}
    answers: dict[str, Answer] = {}
    first_steps: dict[str, int] = {}
    for turn in range(REPEATS):
        for label, run in runs.items():
            if turn and label in ("verlet", "midpoint"):
                continue
            whole, answers[label] = seconds(run)
            spent[label].append(whole)
            if label in beginnings:
                part, (_, first_steps[label]) = seconds(beginnings[label])
                started[label].append(part)
    rows: list[dict[str, Any]] = []
    for label, samples in spent.items():
        u, steps = answers[label]
        error = float(np.abs(u - truth).max() / largest)
        row = {"method": label, "seconds": min(samples), "samples": samples, "steps": steps, "error": error}
        each = ""
        if label in beginnings:
            row["step_seconds"] = (min(samples) - min(started[label])) / max(1, steps - first_steps[label])
            each = f", {1e6 * row['step_seconds']:.0f} µs a step"
        rows.append(row)
        faster = rows[0]["seconds"] / row["seconds"]
        print(
            f"{label:26s} {row['seconds']:8.3f} s CPU {steps:8d} steps  error {error:.1e}"
            f"  {faster:6.1f} times as fast as the first{each}",
            flush=True,
        )
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(rows, indent=1), encoding="utf-8")
    if arguments.keep:
        print(keep("settling", rows))


if __name__ == "__main__":
    main()

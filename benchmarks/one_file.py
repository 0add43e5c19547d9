"""Seconds of motion a CPU second on one core: the C file, `verlet`, MuJoCo's flex of an equal grid.

    OMP_NUM_THREADS=1 python benchmarks/one_file.py [9] [--seconds 0.5]

The sheet of two-edges-clamped with a drag on its mass, explicit steps of the C file's own length; MuJoCo,
where it is installed, with its file of `calibrate --for mujoco`, steps of 2 ms. The best of three.
"""

import argparse
import resource
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import lumped
import sheetbench as sb
from comparisons.codes.onefile import program

Run = tuple[Callable[[], float], Callable[[], object]]  # a clock of CPU time [s], and what it is to measure
COMPILER = "gcc -O3 -march=native -ffast-math sheet.c loop.c -lm -o loop"
LOOP = """#include <stdlib.h>
#include "sheet.h"
int main(int n, char **word) {
  static sheet s;
  sheet_reset(&s), sheet_step(&s, atoi(word[1]));
  return n < 2 || !(sheet_energy(&s, 0) < 1e9);
}
"""


def c_steps(texts: dict[str, str], folder: Path, steps: int) -> Run:
    """Return the C file's steps, compiled."""
    folder.mkdir()
    for file, text in (texts | {"loop.c": LOOP}).items():
        (folder / file).write_text(text, encoding="utf-8")
    subprocess.run(COMPILER.split(), cwd=folder, check=True)
    line = [str(folder / "loop"), str(steps)]
    ended = resource.RUSAGE_CHILDREN
    return lambda: resource.getrusage(ended).ru_utime, lambda: subprocess.run(line, check=True)


def mujoco_steps(grid: int, duration: float) -> dict[str, Run]:
    """Return MuJoCo's steps of its flex, nothing without MuJoCo."""
    try:
        import mujoco
    except ImportError:
        return {}
    with tempfile.TemporaryDirectory() as folder:
        sb.calibrate("two-edges-clamped", grid=grid, for_="mujoco", out=folder)
        model = mujoco.MjModel.from_xml_path(f"{folder}/mujoco.xml")
    data = mujoco.MjData(model)

    def run() -> None:
        mujoco.mj_resetData(model, data)
        for _ in range(round(duration / model.opt.timestep)):
            mujoco.mj_step(model, data)

    return {"MuJoCo, flex": (time.process_time, run)}


def main() -> None:
    """Print a row for each."""
    parser = argparse.ArgumentParser()
    parser.add_argument("grid", nargs="?", type=int, default=9)
    parser.add_argument("--seconds", type=float, default=0.5)
    asked = parser.parse_args()
    scene = sb.load("two-edges-clamped")
    scene = scene.replace(material=scene.material.replace(damping_rate=8.0))
    springs = lumped.calibrate(scene.sheet, scene.material, asked.grid)
    of = {name: program(scene, springs, name, 20) for name in ("double", "single")}
    step = of["double"].step
    count = round(asked.seconds / step)
    system, start = lumped.in_motion(scene, springs)
    method = lumped.INTEGRATORS["verlet"](system, step)

    def verlet() -> None:
        state, left = start, count
        while left:
            advance = method.march(state, step, left)
            state, left = advance.state, left - advance.steps

    with tempfile.TemporaryDirectory() as place:
        runs: dict[str, Run] = {}
        if shutil.which("gcc"):
            runs = {f"C, {name}": c_steps(p.texts, Path(place, name), count) for name, p in of.items()}
        runs |= {"verlet": (time.process_time, verlet), **mujoco_steps(asked.grid, asked.seconds)}
        best = dict.fromkeys(runs, float("inf"))
        for turn in range(4):  # the first compiles and loads
            for name, (clock, work) in runs.items():
                began = clock()
                work()
                best[name] = min(best[name], clock() - began if turn else float("inf"))
    print(f"{asked.grid} x {asked.grid}, steps of {1e3 * step:.3g} ms: seconds of motion a CPU second")
    for name, cpu in best.items():
        print(f"{name:14} {asked.seconds / cpu:8.2f}")


if __name__ == "__main__":
    main()

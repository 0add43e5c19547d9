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
from comparisons.cli import main as command_line
from comparisons.codes.onefile import program
from sheetbench import scenes

LOOP = """#include <stdlib.h>
#include "sheet.h"
int main(int n, char **word) {
  static sheet s;
  sheet_reset(&s), sheet_step(&s, atoi(word[1]));
  return n < 2 || !(sheet_energy(&s, 0) < 1e9);
}
"""


def compiled(texts: dict[str, str], folder: Path, name: str) -> Path:
    """Return the program that takes so many steps."""
    for file, text in (texts | {"loop.c": LOOP}).items():
        (folder / file).write_text(text, encoding="utf-8")
    flags = ("-O3", "-march=native", "-ffast-math", "sheet.c", "loop.c", "-lm", "-o", name)
    subprocess.run(["gcc", *flags], cwd=folder, check=True)
    return folder / name


def children() -> float:
    """CPU time [s] of processes that have ended."""
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


def spent(clock: Callable[[], float], work: Callable[[], object]) -> float:
    """CPU time [s] of what `work` does."""
    began = clock()
    work()
    return clock() - began


def mujoco_steps(grid: int, duration: float) -> Callable[[], None] | None:
    """Return a function that steps MuJoCo's flex, None without MuJoCo."""
    try:
        import mujoco
    except ImportError:
        return None
    with tempfile.TemporaryDirectory() as folder:
        try:
            command_line(
                ["calibrate", "two-edges-clamped", "--grid", f"{grid}", "--for", "mujoco", "--out", folder]
            )
        except SystemExit as end:
            assert not end.code
        model = mujoco.MjModel.from_xml_path(f"{folder}/mujoco.xml")
    data = mujoco.MjData(model)

    def run() -> None:
        mujoco.mj_resetData(model, data)
        for _ in range(round(duration / model.opt.timestep)):
            mujoco.mj_step(model, data)

    return run


def main() -> None:
    """Print a row for each."""
    parser = argparse.ArgumentParser()
    parser.add_argument("grid", nargs="?", type=int, default=9)
    parser.add_argument("--seconds", type=float, default=0.5)
    asked = parser.parse_args()
    scene = scenes.load("two-edges-clamped")
    scene = scene.replace(material=scene.material.replace(damping_rate=8.0))
    springs = lumped.calibrate(scene.sheet, scene.material, asked.grid)
    runs: dict[str, tuple[Callable[[], float], Callable[[], object]]] = {}
    with tempfile.TemporaryDirectory() as place:
        step = program(scene, springs, steps=20).step
        if shutil.which("gcc"):
            for precision in ("double", "single"):
                own = compiled(program(scene, springs, precision, 20).texts, Path(place), precision)
                line = [str(own), str(round(asked.seconds / step))]
                runs[f"C, {precision}"] = children, lambda line=line: subprocess.run(line, check=True)
        system, start = lumped.in_motion(scene, springs)

        def verlet() -> None:
            state, left = start, round(asked.seconds / step)
            method = lumped.INTEGRATORS["verlet"](system, step)
            while left:
                advance = method.march(state, step, left)
                state, left = advance.state, left - advance.steps

        runs["verlet"] = time.process_time, verlet
        if (other := mujoco_steps(asked.grid, asked.seconds)) is not None:
            runs["MuJoCo, flex"] = time.process_time, other
        for _, work in runs.values():  # compiled, loaded
            work()
        best = {name: min(spent(*run) for _ in range(3)) for name, run in runs.items()}
    print(f"{asked.grid} x {asked.grid}, steps of {1e3 * step:.3g} ms: seconds of motion a CPU second")
    for name, cpu in best.items():
        print(f"{name:14} {asked.seconds / cpu:8.2f}")


if __name__ == "__main__":
    main()

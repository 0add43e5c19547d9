"""The page docs/try: lattices in the browser, from `--for c`, beside stored answers of the shell.

`python docs/try_page.py` solves the shell anew for `try/answers.json` (a minute); the site's build compiles
the lattices to WebAssembly, by the package ziglang.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from itertools import product
from pathlib import Path

import sheetbench as sb
from sheetbench import scenes
from sheetbench.scenes import Scene

HERE = Path(__file__).parent / "try"
STYLE = Path(__file__).parents[1] / "comparisons" / "live" / "page" / "live.css"
SCENES = ("two-edges-clamped", "one-edge-clamped")
THICKNESSES = (0.002, 0.003, 0.004, 0.006)  # m
LOADS = (0.25, 0.5, 1.0, 2.0, 4.0)  # g/E over the scene's
POINTS = 9  # masses along a side, that can be dragged
EXPORTS = ("sheet_reset", "sheet_step", "sheet_set", "SHEET", "SHEET_REST")
COMPILER = [sys.executable, "-m", "ziglang", "cc", "-target", "wasm32-freestanding", "-O3", "-nostdlib", "-s"]
COMPILER += ["-Dsqrt=__builtin_sqrt", "-Wl,--no-entry", *(f"-Wl,--export={name}" for name in EXPORTS)]


def scene_of(name: str, thickness: float) -> Scene:
    """Return a scene of the catalogue of this thickness, with points all over it, the last of them its P4."""
    scene = scenes.load(name)
    x, y = scene.sheet.lengths
    share = [n / (POINTS - 1) for n in range(POINTS)]
    probes = {f"n{j}{i}": (i * x, j * y) for j in share for i in share}
    return scene.replace(sheet=scene.sheet.replace(thickness=thickness), probes=probes)


def answers() -> str:
    """Return the shell's u_z [m] of the last point by scene and thickness, a line each, and by g/E; null
    without an equilibrium."""
    rows = []
    for name, thickness in product(SCENES, THICKNESSES):
        scene, heights = scene_of(name, thickness), {}
        for load in LOADS:
            shell = sb.solve(scene.replace(gravity=scene.gravity.times(load)), "shell", elements=8)
            last = [*shell.probes.values()][-1]
            heights[f"{load:g}"] = float(last[2]) if shell.status == "converged" else None
        rows.append(f'"{name} {1e3 * thickness:g}": {json.dumps(heights)}')
    return "{" + ",\n".join(rows) + "}\n"


def build(folder: Path) -> str:
    """Write the page with its programs to a folder; return their number, or the reason for none."""
    shutil.copytree(HERE, folder, dirs_exist_ok=True)
    shutil.copy(STYLE, folder)
    if find_spec("ziglang") is None:
        return "no compiler: pip install ziglang, then make docs"
    for name, thickness in product(SCENES, THICKNESSES):
        out = folder.resolve() / f"{name}-{1e3 * thickness:g}.wasm"
        with tempfile.TemporaryDirectory() as place:
            sb.calibrate(scene_of(name, thickness), grid=POINTS, for_="c", out=place)
            Path(place, "room.c").write_text('#include "sheet.h"\nsheet SHEET;\n')
            subprocess.run([*COMPILER, "sheet.c", "room.c", "-o", out], cwd=place, check=True)
    return f"{len(SCENES) * len(THICKNESSES)} lattices"


if __name__ == "__main__":
    (HERE / "answers.json").write_text(answers())

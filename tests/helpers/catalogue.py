"""The solvers' answers to the scenes of the catalogue, on small grids, and the lattice's to some harder ones.

`make catalogue` writes catalogue.json anew, for a change that is meant to change answers; tests compare the
answers with it, and how many factorisations they take. Newton's iterations end at a residual of 5e-9 of the
forces or less: within 1e-7 of the largest displacement an answer is the same on every machine.
"""

import json
from pathlib import Path
from typing import Any

from cases import calibrated

import fem_reference
import lumped
from sheetbench import scenes
from sheetbench.answers.solution import Solution
from sheetbench.scenes import (
    Clamped,
    Curved,
    EdgeLoad,
    Gravity,
    Material,
    Pressure,
    Scene,
    Sheet,
    load,
)

FILE = Path(__file__).with_name("catalogue.json")
GRID, ELEMENTS = 5, 4
WITHIN = 1e-7  # of the largest displacement of the scene
# A chain's segments are 1e12 times stiffer than the plate that they lie on: one rounding of every entry of
# that matrix moves the answer by 3e-7 to 5e-7.
ROUNDED = {("actuated-edge", "plate"): 2e-6}
DIGITS = 13  # decimals of a metre: 1e-11 of the smallest scene's largest displacement


SQUARE = Sheet(length_x=0.15, length_y=0.15, thickness=0.002)
STRIP = Sheet(length_x=0.2, length_y=0.1, thickness=0.002)
FIRM = Material(young=1e7, poisson=0.45, density=1200.0)
SOFT = Material(young=5e6, poisson=0.45, density=1000.0)
DOWN = Gravity(acceleration=(0.0, 0.0, -9.81))
AT_X0 = (Clamped(edge="x0"),)
AROUND = tuple(Clamped(edge=edge) for edge in ("x0", "x1", "y0", "y1"))
FIBRES = {"young_1": 2e8, "young_2": 8e7, "poisson_12": 0.2, "shear_12": 6e6, "density": 1100.0}


def of(sheet, material, supports, *loads, gravity=None):
    at = {"corner": sheet.lengths, "middle": (0.5 * sheet.length_x, 0.4 * sheet.length_y)}
    return Scene("one", sheet, material, gravity, supports, loads, probes=at)


def softened(name, times):
    scene = load(name)
    return scene.replace(material=scene.material.replace(young=scene.material.young / times))


def curved(curvature, up=0.0):
    gravity = Gravity(acceleration=(0.0, 0.0, up)) if up else None
    return of(SQUARE, FIRM, (Curved(edge="x0", curvature=curvature),), gravity=gravity)


def pushed(by):
    motion = {"time": [0.0, 1.0], "displacement": [[0.0, 0.0, 0.0], [-by, 0.0, 0.05 * by]]}
    return of(STRIP, SOFT, (*AT_X0, Clamped(edge="x1", motion=motion)))


def pulled(sheet, material, force, moment=0.0):
    return of(sheet, material, AT_X0, EdgeLoad(edge="x1", force_per_length=force, moment_per_length=moment))


RUBBER = Material(law="neo-hookean", young=1e6, poisson=0.45, density=1000.0)
OTHERS = {
    "two edges, softened tenfold": softened("two-edges-clamped", 10.0),
    "two edges, softened 54-fold": softened("two-edges-clamped", 54.0),
    "one edge, softened tenfold": softened("one-edge-clamped", 10.0),
    "one edge, softened 54-fold": softened("one-edge-clamped", 54.0),
    **{f"curved edge, kappa {kappa}": curved(kappa) for kappa in (-8, -4, 2, 12)},
    "curved edge, kappa -8, weight": curved(-8, -9.81),
    "curved edge, kappa -8, less weight": curved(-8, -0.78 * 9.81),
    "clamps pushed 2 mm together": pushed(2e-3),
    "clamps pushed 20 mm together": pushed(20e-3),
    "clamps pulled 2 mm apart": pushed(-2e-3),
    "follower pressure": of(SQUARE, FIRM, AT_X0, Pressure(value=20.0)),
    "closed pressure": of(SQUARE, FIRM, AROUND, Pressure(value=500.0)),
    "edge moment": pulled(SQUARE, FIRM, (0.0, 0.0, 0.0), 0.2),
    "rubber, pulled": pulled(STRIP, RUBBER, (300.0, 0.0, 0.0)),
    "rubber, own weight": of(SQUARE, RUBBER, AT_X0, gravity=DOWN),
    "fibres at 45°": of(SQUARE, Material(kind="orthotropic", angle="45 deg", **FIBRES), AT_X0, gravity=DOWN),
    "pulled up": pulled(SQUARE, FIRM, (0.0, 0.0, 300.0)),
    "pulled up hard": pulled(SQUARE, FIRM, (0.0, 0.0, 3000.0)),
    "column": of(
        Sheet(length_x=0.2, length_y=0.05, thickness=0.001), Material(young=5e6, poisson=0.0, density=1100.0),
        AT_X0, EdgeLoad(edge="x1", force_per_length=(-0.0334127, 0.0, 0.002)),
    ),
}  # fmt: skip


def lattice(scene: Scene, **options: Any) -> Solution:
    return lumped.solve(scene, calibrated(scene, (GRID, GRID)), **options)


MODELS = {
    "lattice": lattice,
    "linear lattice": lambda scene: lattice(scene, linear=True),
    "plate": lambda scene: fem_reference.solve(scene, model="plate", elements=ELEMENTS),
    "shell": lambda scene: fem_reference.solve(scene, model="shell", elements=ELEMENTS),
    "solid": lambda scene: fem_reference.solve(scene, model="solid", elements=2),
    "usual lattice": lumped.solve,
}
CASES = [
    (name, model)
    for name in scenes.catalogue()
    for model in list(MODELS)[:-1]
    if not (model == "linear lattice" and scenes.load(name).actuators)  # which it refuses
    if not (model in ("linear lattice", "plate") and scenes.load(name).obstacles)  # which they refuse
] + [(name, "usual lattice") for name in OTHERS]


def scene_of(name: str) -> Scene:
    """Return the scene of a name."""
    return OTHERS.get(name) or load(name)


def answer(name: str, model: str) -> dict[str, Any]:
    """Return the `document` of a scene's solution by a model."""
    return document(scene_of(name), MODELS[model](scene_of(name)))


def document(scene: Scene, solution: Solution) -> dict[str, Any]:
    """Return the status and cost of the solution, and the probes' displacements [m]."""
    displacement = solution.displacement(scene.probe_points()).round(DIGITS).tolist()
    return {
        "status": str(solution.status),
        "factorisations": solution.iterations,
        "load_factor": round(float(solution.load_factor), 6),
        "snaps": [round(float(snap), 4) for snap in solution.snaps],
        "displacement": dict(zip(scene.probes, displacement, strict=True)),
    }


def table() -> dict[str, Any]:
    """Return the answers by scene and model."""
    found: dict[str, Any] = {name: {} for name, _ in CASES}
    for name, model in CASES:
        found[name][model] = answer(name, model)
    return found


def written(answers: dict[str, Any]) -> str:
    """Return the table as JSON, a line for every answer."""
    scenes = []
    for name, models in answers.items():
        lines = (f" {json.dumps(model)}: {json.dumps(one)}" for model, one in models.items())
        scenes.append(f"{json.dumps(name)}: {{\n" + ",\n".join(lines) + "}")
    return "{" + ",\n".join(scenes) + "}\n"


if __name__ == "__main__":
    FILE.write_text(written(table()), encoding="utf-8")

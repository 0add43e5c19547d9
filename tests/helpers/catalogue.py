"""What the solvers say of the scenes of the catalogue, on small grids: displacements of the probes [m].

`make catalogue` writes catalogue.json anew, for a change that is meant to change answers; the tests
compare the answers with it. Newton's iterations end at a residual of 5e-9 of the forces or less: within 1e-7
of the largest displacement an answer is the same on every machine.
"""

import json
from pathlib import Path
from typing import Any

import fem_reference
import lumped
from sheetbench import scenes
from sheetbench.answers.solution import Solution
from sheetbench.scenes import Scene

FILE = Path(__file__).with_name("catalogue.json")
GRID, ELEMENTS = 5, 4
WITHIN = 1e-7  # of the largest displacement of the scene
# A chain's segments are 1e12 times stiffer than the plate that they lie on: one rounding of every entry of
# that matrix moves the answer by 3e-7 to 5e-7.
ROUNDED = {("actuated-edge", "plate"): 2e-6}
DIGITS = 13  # decimals of a metre: 1e-11 of the smallest scene's largest displacement


def lattice(scene: Scene, **options: Any) -> Solution:
    grid = (GRID, GRID, 2)
    springs = lumped.calibrate(scene.sheet, scene.material, grid, cells=lumped.sections_of(scene, grid))
    return lumped.solve(scene, springs, **options)


MODELS = {
    "lattice": lattice,
    "linear lattice": lambda scene: lattice(scene, linear=True),
    "plate": lambda scene: fem_reference.solve(scene, model="plate", elements=ELEMENTS),
    "shell": lambda scene: fem_reference.solve(scene, model="shell", elements=ELEMENTS),
    "solid": lambda scene: fem_reference.solve(scene, model="solid", elements=2),
}
CASES = [
    (name, model)
    for name in scenes.catalogue()
    for model in MODELS
    if not (model == "linear lattice" and scenes.load(name).actuators)  # which it refuses
    if not (model in ("linear lattice", "plate") and scenes.load(name).obstacles)  # which they refuse
]


def answer(name: str, model: str) -> dict[str, Any]:
    """Status and the probes' displacements [m] of a scene by a model."""
    return document(scenes.load(name), MODELS[model](scenes.load(name)))


def document(scene: Scene, found: Solution) -> dict[str, Any]:
    """Status and the probes' displacements [m] of a solution."""
    displacement = found.displacement(scene.probe_points()).round(DIGITS).tolist()
    return {"status": str(found.status), "displacement": dict(zip(scene.probes, displacement, strict=True))}


def table() -> dict[str, Any]:
    """Scene → model → what it says."""
    found: dict[str, Any] = {name: {} for name in scenes.catalogue()}
    for name, model in CASES:
        found[name][model] = answer(name, model)
    return found


def written(found: dict[str, Any]) -> str:
    """The table as JSON, a line for every answer."""
    scenes = []
    for name, models in found.items():
        lines = (f" {json.dumps(model)}: {json.dumps(one)}" for model, one in models.items())
        scenes.append(f"{json.dumps(name)}: {{\n" + ",\n".join(lines) + "}")
    return "{" + ",\n".join(scenes) + "}\n"


if __name__ == "__main__":
    FILE.write_text(written(table()), encoding="utf-8")

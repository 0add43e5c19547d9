"""How far other simulators are from the shell on four scenes, with our springs and with their own sheets.

    exported links      the lattice of `central` springs as MuJoCo has it, brought to rest there
    own sheet           MuJoCo's flexible sheet with the sheet's E, ν and h
    own sheet fitted    the same with the E, ν and h that make the worst of its scenes the least wrong
    rods                a sheet without D12 and A12, what a grid of rods is at best: D11 = D, A11 = A, D66 as
                        makes the worst scene the least wrong, in-plane shear the sheet's; solved by the shell

error: largest |component of u − u_shell| over 5 × 5 points, of the largest |component of u_shell| there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any

import numpy as np

from comparisons.codes.mujoco import to_mjcf
from comparisons.external.mujoco import MODEL, relax
from comparisons.report.work import Progress, Work
from sheetbench.answers.answer import Answer
from sheetbench.answers.table import PERCENT, Column, Table
from sheetbench.scenes import Scene
from studies.simulators.mujoco import displacement, loaded, put
from studies.transfer.scenes import transfer_scenes

SCENES = ("one-edge-clamped", "two-edges-clamped", "opposite-edges-clamped", "curved-edge")
GRID = 9
ELEMENTS = 16
EVALUATIONS = 120
AT_REST = 1e-9  # displacement, in sides of the sheet, that one more step would add
TWISTS = np.linspace(0.2, 0.6, 9)  # D66/D of the rods


@dataclass(frozen=True)
class Row:
    """What was solved, and its error by scene, None where it has no such scene."""

    name: Annotated[str, Column("what")]
    errors: Annotated[dict[str, float | None], PERCENT(".3g")]


@dataclass(frozen=True, repr=False)
class Simulators(Answer):
    """Errors of every simulator against the shell."""

    rows: Sequence[Row]

    file_name = "simulators"

    def heading(self) -> tuple[str, str, str]:
        size = f"{GRID}×{GRID} masses or vertices, the shell with {ELEMENTS} elements a side"
        return "simulators", size, ""

    def document(self) -> dict[str, Any]:
        return {"rows": [vars(row) for row in self.rows]}

    def tables(self) -> tuple[Table, ...]:
        return (Table.of(Row, self.rows, "Error against the shell", "errors"),)

    def notes(self) -> tuple[str, ...]:
        return (
            "nothing: no such scene there; exported links are let go flat, and where that takes too many "
            "steps (a bent edge) from where our lattice rests",
        )


def study(progress: Progress) -> Simulators:
    """Carry it out. Needs MuJoCo."""
    import mujoco

    scenes = {name: transfer_scenes()[name] for name in SCENES}
    progress(Work("the shell", None))
    truths = {name: _shell(scene) for name, scene in scenes.items()}

    def row(name: str, answer: Callable[[Scene], np.ndarray | None]) -> Row:
        progress(Work(name, None))
        return Row(name, {key: _error(answer(scene), truths[key]) for key, scene in scenes.items()})

    stiffness, fitted = _fitted({name: scenes[name] for name in SCENES[:3]}, truths)
    rows = [
        row("lattice, consistent", lambda scene: _lattice(scene, "consistent")),
        row("lattice, central", lambda scene: _lattice(scene, "central")),
        row("MuJoCo, exported links", lambda scene: _tendons(mujoco, scene)),
        row("MuJoCo, own sheet", _flex),
        row(f"MuJoCo, own sheet fitted ({fitted})", lambda scene: _flex(_changed(scene, stiffness))),
        min(
            (row(f"rods, D66 = {twist:.2g} D", partial(_rods, twist)) for twist in TWISTS.tolist()),
            key=lambda one: max(error for error in one.errors.values() if error is not None),
        ),
    ]
    return Simulators(rows)


def _points(scene: Scene) -> np.ndarray:
    lines = (np.linspace(0.0, side, 5) for side in scene.sheet.lengths)
    return np.stack(np.meshgrid(*lines), axis=-1).reshape(-1, 2)


def _error(answer: np.ndarray | None, truth: np.ndarray) -> float | None:
    return None if answer is None else float(np.abs(answer - truth).max() / np.abs(truth).max())


def _shell(scene: Scene, **options: Any) -> np.ndarray:
    import fem_reference

    solution = fem_reference.solve(scene, "shell", elements=ELEMENTS, **options)
    return solution.require_stable().displacement(_points(scene))


def _lattice(scene: Scene, method: str) -> np.ndarray:
    import lumped

    springs = lumped.calibrate(scene.sheet, scene.material, grid=GRID, method=method)
    return lumped.solve(scene, springs).require_stable().displacement(_points(scene))


def _tendons(mujoco: Any, scene: Scene) -> np.ndarray | None:
    """The exported lattice at rest in MuJoCo, let go flat, or, where that does not come to rest in
    `comparisons.external.mujoco.STEPS`, from where ours rests; the mean of the layers at 5 × 5 masses."""
    import lumped

    springs = lumped.calibrate(scene.sheet, scene.material, grid=GRID, method="central")
    lattice = lumped.describe(scene, springs)
    text = to_mjcf(lattice, scene)
    model, data = loaded(mujoco, text)
    tolerance = AT_REST * max(scene.sheet.lengths)
    if not relax(mujoco, model, data, tolerance)[1]:
        model, data = loaded(mujoco, text)
        put(model, data, lattice.states[-1].displacement, lattice.positions)
        if not relax(mujoco, model, data, tolerance)[1]:
            return None
    u = np.zeros((GRID, GRID, 3))
    np.add.at(u, (lattice.index[:, 1], lattice.index[:, 0]), 0.5 * displacement(data, lattice.positions))
    step = (GRID - 1) // 4
    return u[::step, ::step].reshape(-1, 3)


def _flex(scene: Scene) -> np.ndarray | None:
    solution = MODEL.solve(scene, {**MODEL.settings, "grid": GRID})
    return solution.displacement(_points(scene)) if solution.comparable else None


def _changed(scene: Scene, stiffness: np.ndarray) -> Scene:
    """With E and h times e to the first and last number, ν the second, and the mass it had."""
    young, thickness = np.exp(stiffness[[0, 2]]).tolist()
    poisson = float(np.clip(stiffness[1], -0.9, 0.49))
    material = scene.material.model_dump() | {"poisson": poisson}
    material |= {
        "young": young * scene.material.young,
        "density": scene.material.density / thickness,
    }
    sheet = scene.sheet.model_dump() | {"thickness": thickness * scene.sheet.thickness}
    return scene.replace(sheet=sheet, material=material)


def _fitted(scenes: dict[str, Scene], truths: dict[str, np.ndarray]) -> tuple[np.ndarray, str]:
    """The E, ν, h of MuJoCo's sheet for the scenes that it has, and the same in words."""
    from scipy.optimize import minimize

    def worst(stiffness: np.ndarray) -> float:
        answers = {name: _flex(_changed(scene, stiffness)) for name, scene in scenes.items()}
        return max(_error(u, truths[name]) or 10.0 for name, u in answers.items())

    start = np.array([[0.3, 0.3, 0.0], [0.8, 0.3, 0.0], [0.3, 0.1, 0.0], [0.3, 0.3, 0.3]])
    options = {"maxfev": EVALUATIONS, "initial_simplex": start}
    best = minimize(worst, start[0], method="Nelder-Mead", options=options).x
    young, thickness = np.exp(best[[0, 2]]).tolist()
    return best, f"{young:.2g} E, ν = {np.clip(best[1], -0.9, 0.49):.2g}, {thickness:.2g} h"


def _rods(twist: float, scene: Scene) -> np.ndarray:
    from fem_reference.surface.materials import Section, section_of

    own = section_of(scene.material, scene.sheet.thickness)
    bending = own.bending[0, 0] * np.diag([1.0, 1.0, twist])
    membrane = np.diag(np.diag(own.membrane))
    return _shell(scene, section=Section(membrane, bending, own.shear))

"""Prints how good contact is: strips on a plane and over a cylinder, balls, a lying sheet, energy in motion.

PYTHONPATH=.:tests/helpers python benchmarks/contact.py          half a minute
"""

import numpy as np
from contact_cases import (
    FALLEN,
    FALLING,
    GRAVITY,
    WEIGHT,
    bent_elastica,
    bent_over,
    heavy_elastica,
    laid_strip,
    lying_quarter,
    pressed_ball,
)
from scipy.optimize import fsolve

import fem_reference
import lumped
from comparisons.models.method import method_for
from lumped.dynamics.explicit.step_limit import SAFETY, TOUCHING
from sheetbench.answers.solution import Solution
from sheetbench.choices import CALIBRATION
from sheetbench.scenes import Scene
from sheetbench.scenes.objects.grading import Grading


def lattice(scene: Scene, grid: tuple[int, ...], grading: Grading | float = 0.0) -> Solution:
    method = method_for(scene)[0] if grading else CALIBRATION  # as `--grading auto` does
    springs = lumped.calibrate(scene.sheet, scene.material, grid=grid, grading=grading, method=method)
    return lumped.solve(scene, springs)


def shell(scene: Scene, elements: int) -> Solution:
    return fem_reference.solve(scene, "shell", elements=(elements, 1), graded=False)


def strips() -> None:
    for drop in (0.05, 0.2):
        scene, free = laid_strip(drop), laid_strip(drop, obstacles=())
        lift_off, carried, moment = heavy_elastica(drop)
        for name, grading in (("even", 0.0), ("auto", Grading(0.5, ("x0",)))):
            found = lattice(scene, (41, 3, 2), grading)
            field, x = found.mesh.point_data, found.mesh.points[:, 0]
            clamped = (
                np.unique(x)[1] ** 2 / 12.0
                - float(found.mesh.points[:, 2] @ field["reaction"][:, 0]) / WEIGHT
            )
            pressed, plane = (
                field["contact_pressure"] * field["mass_share"],
                1.0 - found.reactions["x0"][2] / WEIGHT,
            )
            place = float(pressed @ x / pressed.sum())
            s1 = fsolve(lambda s, r=plane, at=place: r * (at - s) - 0.5 * (1.0 - s) ** 2, 0.5)[0]
            print(
                f"drop {drop}, 41 masses {name}: V0 {100 * ((1.0 - plane) / carried - 1):+.3f} %, moment "
                f"{100 * (clamped / moment - 1):+.3f} %, s1 {100 * (s1 / lift_off - 1):+.2f} %, depth/h "
                f"{found.contacts['obstacle 1'].penetration:.1e}, factorisations {found.iterations} for "
                f"{lattice(free, (41, 3, 2), grading).iterations}"
            )
        for elements in (20, 40):
            found = shell(scene, elements)
            off = 100 * (found.reactions["x0"][2] / WEIGHT / carried - 1)
            print(
                f"drop {drop}, shell {elements}: V0 {off:+.3f} %, factorisations {found.iterations} for "
                f"{shell(free, elements).iterations}"
            )


def cylinders() -> None:
    places = (0.3, 0.35, 0.4, 0.45, 0.5)
    forces = [np.linalg.norm(lattice(bent_over(at), (41, 3, 2)).reactions["obstacle 1"]) for at in places]
    off = [f"{100 * (force / bent_elastica(at) - 1):+.2f}" for force, at in zip(forces, places, strict=True)]
    print(f"cylinder at {places}, 41 masses: {', '.join(off)} %")


def balls() -> None:
    for at in ((0.08, 0.08), (0.0733, 0.0867)):
        scene = pressed_ball(at, 4e-3)
        truth = fem_reference.solve(scene, "shell", elements=32).reactions["obstacle 1"][2]
        found = [lattice(scene, (side, side, 2)) for side in (9, 10, 17)]
        found += [fem_reference.solve(scene, "shell", elements=side) for side in (8, 12, 16)]
        off = [f"{100 * (one.reactions['obstacle 1'][2] / truth - 1):+.2f} %" for one in found]
        steps = ", ".join(str(one.iterations) for one in found)
        print(f"ball {at}, 9, 10, 17 masses, 8, 12, 16 elements: {', '.join(off)}; factorisations {steps}")


def lying() -> None:
    for found in (
        lattice(lying_quarter(), (17, 17, 2)),
        fem_reference.solve(lying_quarter(), "shell", elements=8),
    ):
        pressure = found.mesh.point_data["contact_pressure"] / (1e3 * 0.002 * GRAVITY)
        print(f"lying, {found.model}: pressure off by {np.abs(pressure - 1.0).max():.1e}")


def motion() -> None:
    for grid in ((7, 3, 2), (11, 5, 2)):
        springs = lumped.calibrate(FALLING.sheet, FALLING.material, grid=grid)
        history = lumped.simulate(FALLING, springs, 0.5, every=1e-3)
        free = lumped.simulate(FALLING.replace(obstacles=()), springs, 0.01, integrator="verlet")
        touches = int((np.diff((history.reactions["obstacle 1"][:, 2] > 0.0).astype(int)) == 1).sum())
        shorter = free.settings["largest_step"] / history.settings["largest_step"]
        print(
            f"falls, {grid[0]} x {grid[1]}: {touches} touches, energy off by "
            f"{100 * np.abs(history.balance - history.balance[0]).max() / FALLEN:.2f} %, explicit "
            f"limit {shorter:.3f} times shorter, steps {shorter * SAFETY / TOUCHING:.3f} times"
        )


if __name__ == "__main__":
    for part in (strips, cylinders, balls, lying, motion):
        part()

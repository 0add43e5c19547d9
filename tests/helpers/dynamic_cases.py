"""Scenes and shorthands that the tests of dynamics and actuators share."""

import numpy as np

import fem_reference
import lumped
from lumped import System, build_problem
from lumped.dynamics.runs.initial import initial_state
from sheetbench import scenes

ROD = {"edge": "x1", "segments": 8, "bending_stiffness": 0.05, "line_density": 0.05, "radius": 1.5e-3}


def make_scene(base="two-edges-clamped", actuators=(), gravity=True, supports=None, loads=(), **material):
    """Return a catalogue scene with actuators, without its gravity or supports, or of another material."""
    scene = scenes.load(base)
    data = scene.model_dump(by_alias=True, exclude_none=True)
    data["actuator"] = [{**ROD, **a} if a.get("kind") != "motion" else a for a in actuators]
    data["material"].update(material)
    data["load"] = list(loads)
    if not gravity:
        data.pop("gravity")
    if supports is not None:
        data["support"] = supports
    return scenes.Scene.model_validate(data)


def springs(scene, n=5):
    """Return consistent springs of an n × n × 2 lattice."""
    return lumped.calibrate(scene.sheet, scene.material, grid=(n, n))


def moved(scene, model, duration, elements, **options):
    """Return the history of a lattice of five masses along the shorter side, or of a reference of
    elements."""
    if model == "lumped":
        own = lumped.calibrate(scene.sheet, scene.material, grid=5)
        return lumped.simulate(scene, own, duration, **options)
    return fem_reference.simulate(scene, model, duration, elements=elements, **options)


def system(scene, n=5):
    """Return the equations of motion and the state at rest."""
    calibration = springs(scene, n)
    equations = System(scene, build_problem(scene, calibration))
    return equations, initial_state(equations, calibration, "tributary")


def run(method, state, step, count):
    """Return the states after each of `count` steps, the start first; dissipated energy of each."""
    states, dissipated = [state], []
    for _ in range(count):
        advance = method.advance(states[-1], step)
        states.append(advance.state)
        dissipated.append(advance.dissipated)
    return states, np.array(dissipated)

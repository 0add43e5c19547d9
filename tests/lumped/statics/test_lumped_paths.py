"""Buckling, stable branches and paths through limit points."""

import pickle
import re
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from cases import sheet

import fem_reference
import lumped
from sheetbench import scenes
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.scenes import EdgeLoad, Held, Pressure, load

SIDE, THICKNESS, YOUNG, POISSON = 0.2, 0.001, 1e7, 0.3
RIGIDITY = YOUNG * THICKNESS**3 / 12 / (1 - POISSON**2)
CRITICAL = 4 * np.pi**2 * RIGIDITY / SIDE**2  # simply supported square plate, Timoshenko & Gere 9.2 [N/m]
CENTRE = [[SIDE / 2, SIDE / 2]]


def compressed(times_critical):
    held = {"x0": ("x", "z"), "x1": ("z",), "y0": ("y", "z"), "y1": ("z",)}
    supports = [Held(edge=edge, components=components) for edge, components in held.items()]
    press = EdgeLoad(edge="x1", force_per_length=(-times_critical * CRITICAL, 0, 0))
    return sheet(SIDE, SIDE, THICKNESS, YOUNG, POISSON, supports=supports, loads=(press,))


def springs(masses):
    scene = compressed(1.0)
    return lumped.calibrate(scene.sheet, scene.material, (masses, masses))


def test_flat_is_stable_below_the_buckling_load_and_above_it_the_buckled_state_is():
    flat = lumped.solve(compressed(0.95), springs(17))
    unstable = lumped.solve(compressed(1.3), springs(17))
    buckled = lumped.solve(compressed(1.3), springs(17), branch="stable")
    assert flat.status is buckled.status is Status.CONVERGED and unstable.status is Status.UNSTABLE
    heights = [abs(found.displacement(CENTRE)[0, 2]) for found in (unstable, buckled)]
    assert heights[0] < 1e-9 and heights[1] > THICKNESS


def test_the_last_corrections_reuse_factors():
    """From the second correction on a polished equilibrium costs no factors."""
    scene = scenes.load("two-edges-clamped")
    solution = lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, grid=(3, 3)))
    assert solution.history[-1].residual < 1e-11 and solution.iterations == 5
    assert len(solution.history) == 6 and solution.status is Status.CONVERGED


@pytest.mark.nightly
def test_a_rubber_balloon_stops_at_its_limit_point_and_says_so():
    """Blown up neo-Hooke gives way from p = 1.2 E h/a on: a hundredth below the load told it holds."""
    scene = scenes.load(Path(__file__).parents[3] / "examples" / "rubber" / "inflated-square.toml")
    scene = scene.replace(loads=(Pressure(value=30e3),))
    calibration = lumped.calibrate(scene.sheet, scene.material, 9, "hyperelastic")
    found = lumped.solve(scene, calibration)
    (told,) = map(float, re.search(r"beyond load factor ([\d.]+)", found.message).groups())
    below = scene.replace(loads=(Pressure(value=0.99 * told * 30e3),))
    assert found.status is Status.STEP_LIMIT and told == pytest.approx(found.load_factor, rel=1e-3)
    assert lumped.solve(below, calibration).status is Status.CONVERGED


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"linear": True, "branch": "stable"}, "branch: no effect with linear = True"),
        ({"linear": True, "near": np.zeros((50, 3))}, "near: no effect with linear = True"),
        ({"branch": "stable", "near": np.zeros((50, 3))}, "near: no effect with another branch"),
        ({"weights": "full", "near": np.zeros((50, 3))}, "near: no effect .* weights"),
    ],
)
def test_an_option_that_has_no_effect_is_refused(options, said):
    with pytest.raises(BadInput, match=said):
        lumped.solve("one-edge-clamped", **options)


def test_shear_of_the_faces_alone_makes_no_rubber():
    """The springs of a [springs] table with face_shear: the other cells stay linear, and are judged so."""
    scene = scenes.load("one-edge-clamped")
    given = lumped.calibrate(scene.sheet, scene.material, 5)
    sheared = given.with_constant("face_shear", 1e-3)
    alone, beside = (lumped.solve(scene, each) for each in (given, sheared))
    assert beside.status is alone.status is Status.CONVERGED
    heavy = scene.replace(young=3e4)
    assert lumped.solve(heavy, sheared).status is Status.STRAIN_OUTSIDE_MODEL


@pytest.mark.parametrize("model", ["lumped", "plate", "shell", "solid"])
def test_an_answer_is_kept_and_sent_between_processes(model):
    scene = scenes.load("two-edges-clamped")
    found = lumped.solve(scene) if model == "lumped" else fem_reference.solve(scene, model, elements=2)
    again = pickle.loads(pickle.dumps(found))
    points = scene.probe_points()
    assert (again.displacement(points) == found.displacement(points)).all()
    assert (again.mesh.point_data["displacement"] == found.mesh.point_data["displacement"]).all()


def test_several_threads_look_at_an_answers_mesh_at_once():
    mesh, together = lumped.solve("two-edges-clamped").mesh, threading.Barrier(4)

    def look(_):
        together.wait()
        return mesh.points

    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(look, range(4)))
    assert all((each == mesh.points).all() for each in found)


SCENE = load("two-edges-clamped")
SPRINGS = lumped.calibrate(SCENE.sheet, SCENE.material, grid=(5, 5))


def test_threads_do_not_disturb_each_other():
    several = [SPRINGS.with_constant("diagonal", k) for k in np.linspace(2000.0, 9000.0, 12)]
    with ThreadPoolExecutor(3) as pool:
        answers = list(pool.map(lambda springs: lumped.solve(SCENE, springs), several))
    for many, springs in zip(answers, several, strict=True):
        single = lumped.solve(SCENE, springs)
        assert (many.status, many.iterations) == (single.status, single.iterations)
        np.testing.assert_array_equal(many.mesh.point_data["reaction"], single.mesh.point_data["reaction"])

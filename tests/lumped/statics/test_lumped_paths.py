"""Buckling, stable branches and paths through limit points."""

import pickle
import re
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import fem_reference
import lumped
from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.scenes import EdgeLoad, Held, Material, PointLoad, Pressure, Scene, Sheet, Status

SIDE, THICKNESS, YOUNG, POISSON = 0.2, 0.001, 1e7, 0.3
RIGIDITY = YOUNG * THICKNESS**3 / 12 / (1 - POISSON**2)
CRITICAL = 4 * np.pi**2 * RIGIDITY / SIDE**2  # simply supported square plate, Timoshenko & Gere 9.2 [N/m]
CENTRE = [[SIDE / 2, SIDE / 2]]


def compressed(times_critical):
    return Scene(
        name="compressed",
        sheet=Sheet(length_x=SIDE, length_y=SIDE, thickness=THICKNESS),
        material=Material(young=YOUNG, poisson=POISSON, density=1000.0),
        supports=(
            Held(edge="x0", components=("x", "z")),
            Held(edge="x1", components=("z",)),
            Held(edge="y0", components=("y", "z")),
            Held(edge="y1", components=("z",)),
        ),
        loads=(EdgeLoad(edge="x1", force_per_length=(-times_critical * CRITICAL, 0, 0)),),
    )


def springs(masses):
    scene = compressed(1.0)
    return lumped.calibrate(scene.sheet, scene.material, (masses, masses))


def test_buckling_load_of_plate_theory():
    assert lumped.buckling_loads(compressed(1.0), springs(33))[0] == pytest.approx(1.0, rel=0.02)
    second = (1 / 2 + 2) ** 2 / 4  # (m/1 + 1/m)² with m = 2
    assert lumped.buckling_loads(compressed(1.0), springs(33), 2)[1] == pytest.approx(second, rel=0.02)


def test_flat_is_stable_below_and_unstable_above_the_buckling_load():
    flat = lumped.solve(compressed(0.95), springs(17))
    assert flat.status is Status.CONVERGED
    unstable = lumped.solve(compressed(1.3), springs(17))
    assert unstable.status is Status.UNSTABLE and abs(unstable.displacement(CENTRE)[0, 2]) < 1e-9


def test_the_buckled_state_is_stable():
    buckled = lumped.solve(compressed(1.3), springs(17), branch="stable")
    assert buckled.status is Status.CONVERGED
    assert abs(buckled.displacement(CENTRE)[0, 2]) > THICKNESS


def test_a_buckled_sheet_snaps_through_between_opposite_limit_points():
    scene, lattice = compressed(1.5), springs(17)
    start = lumped.solve(scene, lattice, branch="stable").displacement(CENTRE)[0, 2]
    push = PointLoad(
        at=(SIDE / 2, SIDE / 2), force=(0, 0, -np.sign(start) * 50 * RIGIDITY * abs(start) / SIDE**2)
    )
    path = lumped.trace(
        scene,
        lattice,
        vary=[push],
        branch="stable",
        load_limit=10.0,
        until=lambda _, probes: probes["P1"][2] * np.sign(start) < -abs(start),
    )
    assert path.status is Status.CONVERGED
    height = path.displacements["P1"][:, 2] * np.sign(start)
    assert height[0] == pytest.approx(abs(start), rel=1e-9) and height[-1] < -abs(start)
    top = path.load_factors[height > 0].max()
    bottom = path.load_factors[height < 0].min()
    assert bottom == pytest.approx(-top, rel=0.05)  # the two limit points mirror each other
    falling = np.diff(path.load_factors) < 0
    assert falling.any() and not path.stable[1:][falling & (np.abs(height[1:]) < 0.4 * abs(start))].any()
    assert path.stable[0] and path.stable[-1]


def test_a_path_that_loads_from_flat_ends_where_the_solver_does():
    scene = scenes.load("curved-edge")
    lattice = lumped.calibrate(scene.sheet, scene.material, (9, 9))
    path = lumped.trace(scene, lattice)
    assert path.status is Status.CONVERGED and path.load_factors[-1] == pytest.approx(1.0)
    answer = lumped.solve(scene, lattice).displacement(scene.probe_points())
    for k, name in enumerate(scene.probes):
        assert path.displacements[name][-1] == pytest.approx(answer[k], abs=1e-7)


def test_a_sheet_on_a_curved_rod_snaps_like_a_tape_measure():
    """Pushed down at its free edge, a weightless 1 mm sheet on a rod bent upwards buckles: the load peaks,
    falls past a limit point while the sheet is unstable, and rises again on the bent-over branch."""
    seed = scenes.load("curved-edge")
    sheet = Sheet(length_x=0.188, length_y=0.188, thickness=0.001)
    scene = seed.model_copy(update={"sheet": sheet, "gravity": None})
    lattice = lumped.calibrate(sheet, scene.material, (17, 17))
    push = EdgeLoad(edge="x1", force_per_length=(0, 0, -1.0))
    path = lumped.trace(
        scene, lattice, vary=[push], load_limit=5.0, until=lambda _, probes: probes["P3"][2] < -0.05
    )
    assert path.status is Status.CONVERGED
    down = -path.displacements["P3"][:, 2]
    peak = path.load_factors[down < 0.005].max()
    valley = path.load_factors[(down > 0.005) & (down < 0.03)].min()
    assert valley < 0.6 * peak
    assert path.stable[0] and path.stable[-1] and not path.stable.all()


def test_factors_at_hand_polish():
    """From the second correction on a polished equilibrium costs no factors."""
    scene = scenes.load("two-edges-clamped")
    solution = lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, grid=(3, 3)))
    assert solution.history[-1].residual < 1e-11 and solution.iterations == 5
    assert len(solution.history) == 6 and solution.status is Status.CONVERGED


def test_a_rubber_balloon_stops_at_its_limit_point_and_says_so():
    """Blown up neo-Hooke gives way from p = 1.2 E h/a on; the path by arc length passes the maximum that the
    message brackets."""
    scene = scenes.load(Path(__file__).parents[3] / "examples" / "rubber" / "inflated-square.toml")
    scene = scene.replace(loads=(Pressure(value=30e3),))
    calibration = lumped.calibrate(scene.sheet, scene.material, 13, "hyperelastic")
    found = lumped.solve(scene, calibration)
    low, high = map(float, re.search(r"between load factors ([\d.]+) and ([\d.]+)", found.message).groups())
    assert found.status is Status.DIVERGED and high - low < 2e-3 * high
    path = lumped.trace(scene, calibration, until=lambda _, at: at["centre"][2] > 0.075)
    assert path.negative[-1] == 1 and low - 1e-3 < path.load_factors.max() < high


def test_buckling_loads_are_of_dead_loads_alone():
    scene = compressed(1.0).replace(loads=[{"kind": "pressure", "value": 1.0}])
    with pytest.raises(BadInput, match="follow the sheet"):
        lumped.buckling_loads(scene, springs(5))


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"linear": True, "precision": "single"}, "linear = True: .*leave out precision"),
        ({"linear": True, "branch": "stable"}, "linear = True: .*leave out precision, branch"),
        ({"linear": True, "near": np.zeros((50, 3))}, "leave out precision, branch and near"),
        ({"branch": "stable", "near": np.zeros((50, 3))}, "near: with branch = 'path'"),
        ({"weights": "full", "near": np.zeros((50, 3))}, "near: with .* weights = 'tributary' alone"),
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

"""`sheetbench stability SCENE`: what is varied, where each model holds, the largest stable steps."""

import numpy as np
import pytest
from campaigns import Serial

import lumped
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Lattice
from comparisons.stability import extremes, tiles
from comparisons.stability.answer import limits, summary
from comparisons.stability.extremes import scaled, stability
from comparisons.sweep import task
from sheetbench.answers.solution import Status
from sheetbench.scenes import PointLoad, Pressure, load
from studies.stability import limit

SEED, SETTLING = load("two-edges-clamped"), load("two-edges-settling")


def varied(store, *names, scene=SEED, grid=5):
    return stability(scene, store, varied=names, lattice=Lattice(grid), elements=4, pool=Serial)


@pytest.mark.parametrize(("name", "factor"), [("load", 3.0), ("slenderness", 0.1), ("young", 100.0)])
def test_a_factor_is_of_what_it_names_and_of_nothing_else(name, factor):
    scene = SEED.replace(loads=(PointLoad(at=(0.1, 0.1), force=(0.0, 0.0, 0.1)), Pressure(2.0)))
    found = scaled(scene, name, factor)
    acting = [one.last_factor for one in (found.gravity, *found.loads)]
    assert found.material.young / scene.material.young == pytest.approx(factor if name == "young" else 1.0)
    thinner = found.sheet.thickness / scene.sheet.thickness
    assert thinner == pytest.approx(factor if name == "slenderness" else 1.0)
    assert acting == pytest.approx([factor if name == "load" else 1.0] * 3)
    assert scaled(found, name, 1.0 / factor).material.young == pytest.approx(scene.material.young)


def test_the_linear_plate_degrades_first_and_beyond_the_strains_all_refuse(store, monkeypatch):
    monkeypatch.setitem(extremes.FACTORS, "load", (0.01, 1.0, 1000.0))
    found = varied(store, "load")
    ended = {(row["cell"]["model"], row["cell"]["factor"]): row for row in found.rows}
    assert len(ended) == 9 and all(row["study"] == "load" for row in found.rows)
    assert [ended["plate", f]["error"] < 0.05 for f in (0.01, 1.0)] == [True, False]
    assert ended["lumped", 1.0]["error"] < 0.05 and ended["shell", 1.0]["error"] is None
    assert {ended[model, 1000.0]["status"] for model in ("lumped", "plate", "shell")} == {
        "strain-outside-model"
    }
    rows = {row[1]: row[2:6] for row in summary(found).rows}
    assert rows["lumped"] == ("0.01 to 1", "–", "1000", "–")
    assert rows["plate"] == ("0.01", "1", "1000", "–")


def test_a_sheet_that_cannot_be_is_a_refused_cell(store, monkeypatch):
    monkeypatch.setitem(extremes.FACTORS, "slenderness", (100.0,))  # thicker than it is long
    found = varied(store, "slenderness")
    assert {row["status"] for row in found.rows} == {"refused"} and found.succeeded
    assert all("thickness" in row["message"] for row in found.rows)


def test_a_fault_of_the_program_is_no_verdict_on_a_model(store, monkeypatch):
    def answer(model):
        if model.spec.model == "lumped":
            raise ValueError("wrong dimensions")
        return solve(model)

    monkeypatch.setattr(task, "answer", answer)
    monkeypatch.setitem(extremes.FACTORS, "load", (1.0,))
    found = varied(store, "load")
    assert {row[1]: row[2:6] for row in summary(found).rows}["lumped"] == ("–",) * 4
    assert "a fault of the program: ValueError: wrong dimensions" in found.complaints()[0]
    assert found.result() == "1 of 2 cells hold" and not found.succeeded
    looks = [tiles.tile_style(tiles.outcome({"status": status})) for status in [*Status, "refused", "lost"]]
    assert all(one["facecolor"] != "#ffffff" or one["hatch"] for one in looks)  # white: nothing was run


@pytest.mark.nightly
def test_the_largest_stable_steps_are_those_measured(store, monkeypatch):
    """Undamped to a hundredth of it; damped, the computed one is no larger than the measured, by as much."""
    monkeypatch.setattr(extremes, "DAMPING", (0.0,))
    monkeypatch.setattr(limit, "SHARPNESS", 4e-3)
    found = varied(store, "damping", scene=SETTLING, grid=3)
    steps = {(row[0], row[1]): row for row in limits(found).rows}
    assert len(steps) == 2 and all(row[-1] == "converged" for row in steps.values())
    undamped = SETTLING.replace(material=SETTLING.material.replace(damping_time=0.0, damping_rate=0.0))
    for (_, damping), (*_, computed, advised, _) in steps.items():
        scene = SETTLING if damping == "the scene's" else undamped
        flat = scene.replace(gravity=None, loads=())
        equations = limit.system(flat, resolve(flat, Lattice(3)).springs)
        measured = limit.measured_limit(equations, computed)
        assert measured >= 0.99 * computed and advised == pytest.approx(0.9 * computed)
        assert scene is SETTLING or measured <= 1.02 * computed
    springs = resolve(SETTLING, Lattice(3)).springs
    known = lumped.explicit_limit("verlet", SETTLING, springs)
    assert steps["verlet", "the scene's"][2] == pytest.approx(known)
    implicit = [row for row in found.rows if row["cell"]["integrator"] == "midpoint"]
    assert [row["status"] for row in implicit] == ["converged"] * 2


def test_the_motions_error_is_of_the_largest_displacement():
    truth = {"time": [0.0, 1.0, 2.0], "probes": {"P": [[0.0, 0.0, 0.0], [0.0, 0.0, 2.0], [0.0, 0.0, 4.0]]}}
    row = {"time": [0.0, 2.0], "probes": {"P": [[0.0, 0.0, 0.0], [0.0, 1.0, 4.0]]}}
    assert extremes._motion_error(row, truth) == pytest.approx(0.25)
    still = {"time": [0.0], "probes": {"P": np.zeros((1, 3)).tolist()}}
    assert extremes._motion_error(still, still) is None


def test_grids_are_held_against_the_finest_mesh(store, monkeypatch):
    """Also where fewer elements are requested with what else is varied: then a finer one erred."""
    monkeypatch.setattr(extremes, "CELLS", {"lumped": (2, 8), "references": (2, 6)})
    rows = {(row["cell"]["model"], row["cell"]["cells"]): row for row in varied(store, "grid").rows}
    meshes = {(model, n) for model in ("plate", "shell") for n in (2, 4, 6)}
    assert set(rows) == {("lumped", 2), ("lumped", 8), *meshes}
    assert rows["shell", 6]["error"] is None and rows["shell", 4]["error"] < rows["shell", 2]["error"]
    assert rows["lumped", 8]["error"] < rows["lumped", 2]["error"]

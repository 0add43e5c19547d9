"""Stability studies: their cells, rows and texts, the limits they promise, the command from end to end."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from commands import json_of, one_line, run
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp

import lumped
from comparisons.runs.campaign import campaign
from comparisons.stability import limit
from comparisons.stability.rows import LARGE
from sheetbench.scenes import BadInput, EdgeLoad, Status
from studies.stability import (
    STUDIES,
    curved_edge,
    damping,
    equilibria,
    mass,
    page,
    slenderness,
    stiffness,
    time_step,
)  # fmt: skip
from studies.stability import load as weights
from studies.stability.answer import text
from studies.stability.equilibria import compare, consistent, mechanism, sheet, shell
from studies.stability.survey import Study, columns, survey

NAMES = ["time-step", "stiffness", "slenderness", "grid", "load", "damping", "mass", "curved-edge"]
FEW = {1: 17, 2: 17}  # masses a side


def test_the_studies_are_those_asked_for():
    assert list(STUDIES) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_cells_are_plain_and_distinct_and_the_full_map_has_more(name):
    study = STUDIES[name]
    default, full = ([json.dumps(c, sort_keys=True) for c in study.cells(f)] for f in (False, True))
    assert len(set(default)) == len(default) > 10 and len(set(full)) == len(full) >= len(default)
    assert set(default) <= set(full)


def fake(cells, measure="campaign_tasks:square"):
    return Study(
        "fake", "A title", "What is varied.", lambda full: cells, measure, columns(x=""), lambda f, r: None
    )


def test_every_cell_is_a_row_with_a_status_whatever_happens(tmp_path):
    with campaign(tmp_path) as store:
        good = survey([fake([{"x": 2.0}, {"x": 3.0}])], store)
        bad = survey([fake([{}], f"campaign_tasks:{task}") for task in ("refuse", "fail", "die")], store)
    assert [(row["study"], row["cell"], row["status"]) for row in good] == [
        ("fake", {"x": 2.0}, "done"),
        ("fake", {"x": 3.0}, "done"),
    ]
    assert [row["status"] for row in bad] == ["refused", "failed", "lost"]
    assert all(row["message"] for row in bad)
    assert all({"error", "iterations", "seconds"} <= row.keys() for row in good + bad)


@pytest.mark.usefixtures("in_process")
def test_a_grading_is_of_the_studies_whose_cells_take_one(tmp_path):
    """Cells without one stay as they are, so that what was measured is not measured again."""
    taking = replace(fake([{"x": 2.0}], "campaign_tasks:graded"), graded=True)
    with campaign(tmp_path) as store:
        (graded,) = survey([taking], store, grading="0.5:x0")
        (even, other) = survey([taking, fake([{"x": 3.0}])], store)
        with pytest.raises(BadInput, match="none of these studies"):
            survey([fake([{"x": 3.0}])], store, grading=0.5)
    assert graded["cell"] == {"x": 2.0, "grading": "0.5:x0"} and graded["grading"] == "0.5:x0"
    assert even["cell"] == {"x": 2.0} and other["cell"] == {"x": 3.0}
    assert [name for name, study in STUDIES.items() if study.graded] == ["slenderness", "load", "curved-edge"]


def test_a_cell_on_a_graded_grid(monkeypatch):
    """A sheet at a tenth of its weight, 5 × 5 masses: another answer where cells are finer at the clamp."""
    monkeypatch.setattr(weights, "GRID", (5, 5))
    even, graded = (weights.measure("weight", 0.1, grading=g) for g in (None, "0.5:x0"))
    assert even["status"] == graded["status"] == "converged"
    assert max(even["error"], graded["error"]) < LARGE and even["error"] != graded["error"]


def test_texts_list_what_is_off_with_its_mechanism_and_what_did_not_converge():
    every = {"study": "fake", "message": "", "iterations": 1, "seconds": 0.1, "status": "converged"}
    rows = [
        {**every, "cell": {"x": "off"}, "error": 0.3},
        {**every, "cell": {"x": "told"}, "error": 0.2, "mechanism": "resolution", "evidence": "halved"},
        {**every, "cell": {"x": "fine"}, "error": 0.01},
        {**every, "cell": {"x": "lost"}, "error": None, "status": "diverged", "message": "too far"},
    ]
    said = text(fake([]), rows)
    assert "4 cells: 3 converged, 1 diverged." in said
    assert "- x lost: diverged, too far" in said
    assert "- x off: 30 %, unknown: no test showed one" in said
    assert "- x told: 20 %, resolution: halved" in said
    assert "fine" not in said


@pytest.mark.parametrize(
    ("ratio", "vertical"), [(0.0, "4 C"), (0.0, "E l²/h"), (0.3, "E l²/h"), (1.0, "4 C")]
)
def test_the_measured_explicit_limit_is_the_computed_one_and_the_default_step_safe(
    ratio, vertical, monkeypatch
):
    monkeypatch.setattr(limit, "SHARPNESS", 4e-3)
    row = time_step.measure("verlet", masses=3, vertical=vertical, damping_ratio=ratio, slenderness=0.016)
    assert row["error"] < 0.02 and row["status"] == "converged" and row["iterations"] >= time_step.SAFE_STEPS


def test_uneven_masses_move_the_limit_as_computed(monkeypatch):
    monkeypatch.setattr(limit, "SHARPNESS", 4e-3)
    rows = [mass.measure(5, ratio) for ratio in (1.0, 1e6)]
    assert all(row["error"] < 0.02 and row["status"] == "converged" for row in rows)
    assert rows[1]["computed"] < 2e-3 * rows[0]["computed"]
    assert all(abs(row["energy_drift"]) < 1e-8 for row in rows)


@pytest.mark.parametrize("integrator", time_step.IMPLICIT)
def test_implicit_steps_end_in_the_theory_s_error_or_a_status(integrator):
    fine, coarse, far = (time_step.measure(integrator, step=step) for step in (1e-4, 1e-2, 1.0))
    assert fine["status"] == "converged" and fine["error"] < 2e-4
    assert coarse["error"] == pytest.approx(coarse["theory"], rel=0.05)
    assert far["status"] == "diverged" or far["mechanism"] == "resolution"


@pytest.mark.parametrize("ratio", [0.0, 0.3, 1.0, 3.0, 1000.0])
def test_the_damped_oscillator_is_exact(ratio):
    times = np.linspace(0.0, 6.0, 13)
    truth = solve_ivp(
        lambda t, y: [y[1], -y[0] - 2.0 * ratio * y[1]],
        (0.0, 6.0),
        [1.0, 0.0],
        "Radau",
        times,
        rtol=1e-10,
        atol=1e-12,
    )
    assert damping.exact(ratio, times) == pytest.approx(truth.y[0], abs=1e-7)


def test_damping_is_followed_from_none_to_a_thousand_times_critical():
    for ratio in (0.0, 1.0, 1000.0):
        row = damping.measure("generalised-alpha", "springs", ratio)
        assert row["status"] == "converged" and row["error"] < 2e-3
    assert damping.measure("verlet", "springs", 1000.0)["status"] == "refused"


@pytest.mark.parametrize("thin", [1e-4, 1e-2])
def test_thin_sheets_converge_and_agree_at_every_load(thin, monkeypatch):
    monkeypatch.setattr(slenderness, "MASSES", FEW)
    for load in (1e-3, 10.0):
        row = slenderness.measure(1, thin, load)
        assert row["status"] == row["reference"]["status"] == "converged"
        assert row["error"] < 0.05


@pytest.mark.slow
@pytest.mark.parametrize("thin", [1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1])
@pytest.mark.parametrize("load", [1e-3, 1.0, 30.0, 300.0, 1e3])
def test_one_clamped_edge_converges_everywhere_within_the_model(thin, load):
    row = slenderness.measure(1, thin, load)
    weight = load * thin**2 / (12.0 * (1.0 - 0.48**2))
    ended = "converged" if weight <= 0.05 else "strain-outside-model"
    assert slenderness.MASSES[1] == 33
    assert row["status"] == row["reference"]["status"] == ended
    assert ended != "converged" or row["error"] < 0.05


def test_a_thin_sheet_clamped_twice_is_said_not_to_be_unique_on_the_grid():
    row = compare(sheet(1e-4, 10.0, edges=("x0", "y0")), (9, 9), elements=8, explain=False)
    assert row["status"] == "converged" and row["error"] > LARGE and "not unique" in row["message"]


def test_single_precision_says_when_it_has_no_digits_left():
    scene = sheet(1e-5, 1.0)
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(17, 17))
    single = lumped.solve(scene, springs, precision="single")
    assert single.status is not Status.CONVERGED and "rounding" in single.message
    assert lumped.solve(scene, springs).status is Status.CONVERGED
    row = stiffness.measure(young=1e13)
    assert row["single_status"] == "converged" and row["single_error"] < 1e-5


def test_a_cell_of_explicit_steps_runs_in_the_precision_it_names(monkeypatch):
    """Limit and run both: the run under gravity was in double precision whatever the cell said."""
    runs, asked = [], []

    def simulate(*arguments, **options):
        runs.append(genuine(*arguments, **options))
        return runs[-1]

    def limit(equations, guess):
        asked.append(equations.assembly.precision)
        return guess

    genuine = lumped.simulate
    monkeypatch.setattr(lumped, "simulate", simulate)
    monkeypatch.setattr(time_step, "measured_limit", limit)
    cell = {"masses": 3, "vertical": "4 C", "damping_ratio": 0.0, "slenderness": 0.016}
    for precision in ("double", "single"):
        time_step.measure("verlet", **cell, precision=precision)
    assert asked == ["double", "single"]
    assert "precision" not in runs[0].settings and runs[1].settings["precision"] == "single"
    assert not np.array_equal(runs[0].probes["P4"], runs[1].probes["P4"])


def test_mechanisms():
    coarse = compare(sheet(0.016, 3.0), (3, 3))
    assert coarse["error"] > 0.05 and coarse["mechanism"] == "resolution"
    uneven = stiffness.measure(family="axial", contrast=10.0)
    assert uneven["mechanism"] == "wrong limit"
    scene = sheet(0.016, 0.0)  # without weight: one that chooses a side bends lattice and shell alike
    force = 1.5 * np.pi**2 * scene.material.young * scene.sheet.thickness**3 / 48.0 / scene.sheet.length_x**2
    pressed = scene.model_copy(update={"loads": (EdgeLoad(edge="x1", force_per_length=(-force, 0.0, 0.0)),)})
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(5, 5))
    bent, flat = lumped.solve(pressed, springs, branch="stable"), shell(pressed, 6)
    assert bent.status is Status.CONVERGED and flat.status is Status.UNSTABLE
    assert mechanism(pressed, (5, 5), 6, bent, flat, consistent(pressed))["mechanism"] == "branch"


def test_a_curved_clamp_snaps_and_says_where(monkeypatch):
    monkeypatch.setattr(curved_edge, "GRID", (9, 9))
    monkeypatch.setattr(curved_edge, "ELEMENTS", 4)
    monkeypatch.setattr(equilibria, "LARGE", np.inf)  # why it is off on this grid is not requested
    row = curved_edge.measure(turn=-0.25, load_number=10.0)
    assert row["status"] == "converged" and len(row["snaps"]) > 0
    assert all(0.0 < load_factor < 1.0 for load_factor in row["snaps"])


@pytest.mark.usefixtures("in_process")
def test_command_writes_maps_tables_and_texts_and_resumes(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(slenderness, "MASSES", FEW)
    for name, study in STUDIES.items():  # each map must be drawn with whatever cells there are
        first = 20 if name == "curved-edge" else 0  # there the rod is straight, which is quickly solved
        few = study.cells(False)[first : first + 1]
        monkeypatch.setitem(STUDIES, name, replace(study, cells=lambda full, few=few: few))
    asked = ("study", "stability", "--workers", "1", "--out", str(tmp_path))
    names = [part for name in NAMES for part in ("--study", name.replace("-", " "))]
    savefig, drawn = Figure.savefig, []

    def save(self, place, **options):
        """As PNG, the first time; in other formats and again it is the same."""
        if Path(place).suffix == ".png" and len(drawn) < len(NAMES):
            drawn.append(place)
            savefig(self, place, **options)
        else:
            Path(place).write_bytes(bytes(200))

    monkeypatch.setattr(Figure, "savefig", save)
    assert run(*asked, *names) == 0
    said = capsys.readouterr().out
    for name in NAMES:
        assert name in said
        for suffix in ("png", "pdf", "csv"):
            assert (tmp_path / f"{name}.{suffix}").stat().st_size > 100
        assert f"## {name}" in (tmp_path / "stability.md").read_text()
    rows = json.loads((tmp_path / "stability.json").read_text())["rows"]
    assert len(rows) == len(NAMES) and all(row["status"] for row in rows)
    before = (tmp_path / "campaign.sqlite").stat().st_mtime_ns
    assert json_of(capsys, *asked)["rows"] == rows
    assert (tmp_path / "campaign.sqlite").stat().st_mtime_ns == before


def test_an_unknown_study_is_refused_in_one_line(capsys):
    assert run("study", "stability", "--study", "weather") == 2
    assert "study" in (said := one_line(capsys)) and "weather" in said and "time-step" in said


def test_the_page_is_that_of_the_tables_beside_it():
    """Every figure of docs/stability.md is of the last full run: `make stability-full` writes it again."""
    assert page.page() == page.PAGE.read_text(encoding="utf-8")
    assert all(page.promises().values())
    page._table("mass")[0]["status"] = "failed"
    assert [said for said, holds in page.promises().items() if not holds] == ["no cell failed"]
    page._table.cache_clear()

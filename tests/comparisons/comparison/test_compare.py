"""Comparisons: what errors and differences mean, what fails and is left out, real solves and their files."""

import json
import re
import subprocess
from dataclasses import replace

import fake_solutions
import meshio
import numpy as np
import pytest
import pyvista

import lumped
from comparisons.comparison.answer import Comparison
from comparisons.comparison.comparison import compare
from comparisons.comparison.error_bar import ErrorBar
from comparisons.models.spec import Lattice
from comparisons.pictures import offscreen as rendering
from comparisons.sweep.differences import error, relative
from comparisons.sweep.folder import Folder
from fem_reference.uncertainty import estimate
from sheetbench import scenes
from sheetbench.answers.files import to_json
from sheetbench.answers.solution import Status
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.parameters import put

pytestmark = pytest.mark.smoke

SCENE = scenes.load("two-edges-clamped")
HELD = SCENE.replace(probes={"held": (0.0, 0.1), "free": (0.188, 0.188)})


def test_a_reference_without_a_mesh_costs_its_own_row_alone():
    """A circle that reaches 0.6 mm beyond an edge, in elements of 36 mm."""
    circle = {"centre": (0.05751113918296833, 0.03877145273250193), "radius": 0.015973917074423933}
    sheet = scenes.Sheet(0.072887463402407, 0.1636361240755881, 1.38e-3)
    supports = [{"kind": "clamped", "where": {"circle": circle}}]
    scene = Scene(name="s", sheet=sheet, material=SCENE.material, gravity=SCENE.gravity, supports=supports)
    found = compare(scene, Lattice(5), elements=2)
    assert [one.status for one in found.solutions] == [Status.CONVERGED, Status.FAILED]
    assert not found.succeeded and "no mesh of 2 elements" in found.solutions[1].message
    assert json.loads(to_json(found.document()))["solutions"][0]["probes"]["P4"][2] < 0.0


def test_error_is_the_largest_component_over_the_probes_and_none_where_nothing_moves_or_is_finite():
    reference = np.array([[0.0, 0.0, -2.0], [1.0, 0.0, -10.0]])
    model = np.array([[0.5, 0.0, -2.0], [1.0, -0.1, -10.2]])
    assert error(model, reference) == pytest.approx(0.05)
    assert relative(model[0], reference[0]) == pytest.approx(0.25)
    still = np.zeros((4, 3))
    assert error(still, still) is None
    assert relative(np.array([np.nan, 0.0, 0.0]), np.ones(3)) is None


def test_the_error_over_the_sheet_stands_beside_that_at_the_probes():
    """A lattice that is right at the only probe and 3 % off in the middle says so; one that is 3 % off
    everywhere has two alike, and no note."""
    scene = SCENE.replace(probes={"corner": (0.188, 0.188)})
    truth, size = fake_solutions.solution(scene, "shell"), scene.sheet.lengths

    def bulged(points):
        bump = np.prod(4.0 * points / size * (1.0 - points / size), axis=1)
        return truth.sample(points) + 3e-4 * bump[:, None] * [0.0, 0.0, 1.0]

    lattices = fake_solutions.solution(scene, sample=bulged), fake_solutions.solution(scene, size=-0.0103)
    for lattice, at_probe in zip(lattices, (0.0, 0.03), strict=True):
        both = Comparison(scene, (lattice, truth))
        (said,) = json.loads(to_json(both.document()))["errors"]
        assert (said["error"], said["field_error"]) == pytest.approx((at_probe, 0.03), abs=1e-12)
        costs = next(table for table in both.tables() if table.name == "models")
        at = [column.name for column in costs.columns].index("field error")
        assert [row[at] for row in costs.rows] == [pytest.approx(0.03), None]
        assert both.figures()[0].description.endswith(f"{100 * at_probe:.2f} %, over the sheet 3.00 %")
        assert any("over the sheet is more than 1.5 times" in note for note in both.notes()) == (not at_probe)


def test_a_sentence_says_how_far_the_lattice_is_from_the_sheet_as_described(tmp_path):
    """Its numbers are the error, bar and model error together, and with what another clamp would change; it
    comes first, on a terminal alone."""
    both = compare(SCENE, Lattice(5), elements=4)
    assert both.lattice is both["lumped"] is both.solutions[0] and both["shell"] is both.reference
    numbers = [float(n) for n in re.findall(r"([\d.]+) %", both.sentence)]
    within = both.bar.error + both.model_error.value
    wanted = [both.error(both.solutions[0]), within, within + both.model_error.clamp]
    assert numbers == pytest.approx([100.0 * one for one in wanted], rel=0.051)
    assert re.fullmatch(
        r"The lattice is [\d.]+ % off the shell, and the shell within [\d.]+ % of the sheet as described "
        r"\([\d.]+ % if the clamp also holds the thickness\); errors of E are not included\.",
        both.sentence,
    )
    report = both.report()
    assert report.notes[0] == both.sentence == report.document["sentence"] and report.notes_shown == 1
    assert both.sentence in report.to_markdown()
    for other, said in (
        ({"reference": "plate"}, "is not known"),
        ({"uncertainty": False}, "error of its mesh"),
    ):
        assert said in compare(SCENE, Lattice(5), elements=4, **other).sentence
    fibres = scenes.load("fabric-square")
    assert "errors of its constants are not included" in compare(fibres, Lattice(5), elements=3).sentence
    partial = fake_solutions.solution(SCENE, "lumped", status=Status.DIVERGED, load_factor=0.4)
    assert not Comparison(SCENE, (partial, fake_solutions.solution(SCENE, "shell"))).sentence


@pytest.mark.parametrize("status", [Status.DIVERGED, Status.STEP_LIMIT, Status.REFUSED])
def test_a_partial_answer_is_kept_but_not_measured(status):
    partial = fake_solutions.solution(SCENE, "lumped", status=status, load_factor=0.4)
    both = Comparison(SCENE, (partial, fake_solutions.solution(SCENE, "shell")))
    assert both.error(partial) is None
    assert [d.relative for d in both.differences] == [None] * 4
    assert not both.succeeded
    document = json.loads(to_json(both.document()))
    assert document["solutions"][0]["probes"]["P4"][2] == pytest.approx(-0.01)
    (said,) = both.complaints()
    assert partial.status.advice in said


def test_a_probe_on_a_clamped_edge_has_no_relative_difference():
    truth = fake_solutions.solution(HELD, "shell")

    def round_off(points):
        return truth.sample(points) + 1e-18

    lattice = fake_solutions.solution(HELD, "lumped", sample=round_off)
    first, second = Comparison(HELD, (lattice, replace(truth, sample=round_off))).differences
    assert (first.relative, second.relative) == (None, 0.0)


def test_a_probe_on_a_clamped_edge_has_no_bar_in_percent():
    """The bar of rounding over rounding is no number that says anything."""
    rounding = np.array([[1e-18], [0.0]])
    meshes = [fake_solutions.solution(HELD, "shell", size).sample for size in (-0.01, -0.0101, -0.0103)]
    answers = [sample(HELD.probe_points()) + i * rounding for i, sample in enumerate(meshes, start=1)]

    def shown(answers):
        bar = ErrorBar(estimate(answers, [1.0, 4.0 / 3.0, 2.0]), ("held", "free"), (16, 12, 8), 0.0)
        near = {tuple(at): u for at, u in zip(HELD.probe_points(), answers[0], strict=True)}

        def sample(points):
            return np.array([near.get(tuple(at), meshes[0](at[None])[0]) for at in points])

        truth = fake_solutions.solution(HELD, "shell", sample=sample)
        table, *_ = Comparison(HELD, (fake_solutions.solution(HELD), truth), bar).tables()
        names = [column.name for column in table.columns]
        rows = [dict(zip(names, row, strict=True)) for row in table.rows]
        return {row["probe"]: row["±"] for row in rows if row["model"] == "shell"}

    assert shown(answers)["held"] is None and 0.0 < shown(answers)["free"] < 0.1
    assert shown([answers[0] * (1.0 + i * 1e-14) for i in range(3)]) == {"held": None, "free": 0.0}


def test_default_comparison_is_consistent_then_shell_then_uniform_which_is_farther_off(compared):
    solutions = compared.solutions
    assert [one.model for one in solutions] == ["lumped", "shell", "lumped-uniform"]
    assert [one.settings.get("calibration") for one in solutions] == ["consistent", None, "uniform"]
    assert compared.succeeded
    pairs = {(one.of, one.against) for one in compared.differences}
    assert pairs == {("lumped", "shell"), ("lumped-uniform", "shell")}
    near, own, far = map(compared.error, solutions)
    assert near < 0.02 and far > near and own is None


def test_a_column_says_how_far_one_percent_of_a_parameter_moves_the_probes():
    """As a lattice one percent stiffer moves, and less than nothing where a probe is held."""
    scene = scenes.load("one-edge-clamped").replace(probes={"held": (0.0, 0.1), "P4": (0.188, 0.188)})
    found = replace(compare(scene, Lattice(4), elements=2), sensitive_to=("young", "gravity.z"))
    u, stiffer = (
        lumped.solve(at, lumped.calibrate(at.sheet, at.material, 4)).displacement([(0.188, 0.188)])[0]
        for at in (scene, put(scene, "young", 1.01 * scene.material.young))
    )
    moved = float(u @ (stiffer - u) / (u @ u))
    shown = found.sensitivities
    assert shown["lumped"]["young"]["P4"] == pytest.approx(moved, rel=0.02)
    assert shown["shell"]["young"]["P4"] == pytest.approx(moved, rel=0.1)
    assert shown["shell"]["gravity.z"]["P4"] == pytest.approx(-shown["shell"]["young"]["P4"], rel=1e-4)
    assert shown["lumped"]["young"]["held"] is None
    assert "by 1 % of young" in found.tables()[0].to_csv() and found.document()["sensitivities"] == shown


def test_json_document_has_the_promised_keys(compared):
    document = json.loads(to_json(compared.document()))
    assert Scene.model_validate(document["scene"]) == compared.scene
    first, second = document["solutions"][:2]
    assert first["settings"]["grid"] == [5, 5, 2] and first["settings"]["calibration"] == "consistent"
    for solution in document["solutions"]:
        assert solution["unknowns"] > 0 and solution["iterations"] > 0
        assert solution["solve_seconds"] >= 0 and solution["setup_seconds"] >= 0
        assert np.shape([*solution["probes"].values()]) == (4, 3) and {*solution["reactions"]} == {"x0", "y0"}
    difference = document["differences"][0]
    assert set(difference) == {"probe", "of", "against", "relative", "distinguishable"}
    u, truth = (np.array(s["probes"]["P1"]) for s in (first, second))
    assert difference["relative"] == pytest.approx(np.linalg.norm(u - truth) / np.linalg.norm(truth))


def test_the_pull_of_a_stretched_sheet_stands_beside_the_costs(compared):
    """Of supports that are moved; the vectors of all supports are in the tables that are written."""
    moved = {"time": [0.0, 1.0], "displacement": [[0.0, 0.0, 0.0], [1e-3, 0.0, 0.0]]}
    supports = [{"edge": "x0", "kind": "clamped"}, {"edge": "x1", "kind": "clamped", "motion": moved}]
    pulled = compared.scene.replace(supports=supports, gravity=None)
    both = compare(pulled, Lattice(5), elements=2, uncertainty=False)
    costs = both.printed()[-1]
    pull = [column.name for column in costs.columns].index("force of x1")
    forces = [np.linalg.norm(s.reactions["x1"]) for s in both.solutions]
    assert [row[pull] for row in costs.rows] == pytest.approx(forces, rel=1e-14)
    assert {row[0] for row in both.tables()[-1].rows} == {"x0", "x1"}
    assert not [c.name for table in compared.printed() for c in table.columns if c.name.startswith("force")]


@pytest.fixture(scope="module")
def folder(compared, tmp_path_factory):
    place = tmp_path_factory.mktemp("out")
    kept = Folder(place, "compare", ["sheetbench", "compare"], about={"scene": compared.scene.document()})
    kept.report(replace(compared.report(), pictures=()))
    assert sorted([*kept.written, "manifest.json"]) == sorted(path.name for path in place.iterdir())
    return place


@pytest.mark.parametrize("fault", [OSError(), subprocess.TimeoutExpired("trial", 120)], ids=["start", "end"])
def test_no_picture_where_the_trial_of_drawing_does_not_start_or_end(fault, monkeypatch):
    def run(*_, **__):
        raise fault

    monkeypatch.setattr(subprocess, "run", run)
    rendering._working_window.cache_clear()
    assert "off-screen drawing does not work" in (rendering.unavailable_reason() or "")
    rendering._working_window.cache_clear()


def test_common_plan_grid_holds_all_solutions_and_their_difference(folder, compared):
    """In meshio and PyVista alike."""
    read = meshio.read(folder / "comparison.vtu")
    fields = read.point_data
    lumped, shell, uniform = (one.displacement(read.points[:, :2]) for one in compared.solutions)
    assert np.allclose(fields["displacement"], shell) and np.abs(shell).max() > 0.01
    assert np.allclose(fields["displacement_lumped"], lumped)
    assert np.allclose(fields["displacement_shell"], shell)
    assert np.allclose(fields["difference"], lumped - shell)
    assert np.allclose(fields["difference_lumped-uniform"], uniform - shell)
    for name in ("lumped", "shell", "comparison"):
        path = folder / f"{name}.vtu"
        one, other = (reader.read(path).point_data["displacement"] for reader in (meshio, pyvista))
        assert np.isfinite(one).all() and np.allclose(one, other)


def test_manifest_tells_versions_machine_scene_and_settings(folder, compared):
    record = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    assert {"numpy", "scipy", "numba", "scikit-fem", "pyvista", "meshio"} <= set(record["versions"])
    assert record["machine"]["python"] and record["machine"]["cpu_count"] >= 1
    assert record["settings"]["lumped"]["grid"] == [5, 5, 2]
    assert Scene.model_validate(record["scene"]) == compared.scene
    assert record["command"] == ["sheetbench", "compare"] and record["date"]


def test_without_a_way_to_draw_there_is_a_sentence_and_no_picture(compared, tmp_path, monkeypatch):
    monkeypatch.setattr(rendering, "_draws", lambda environment: False)
    rendering._working_window.cache_clear()
    said = compared.figures()[0].write(tmp_path)
    rendering._working_window.cache_clear()
    assert said is not None and "libegl1" in said and not list(tmp_path.iterdir())

"""Springs calibrated from moduli on scenes they never saw, and where the others converge to."""

import json
from concurrent.futures import ThreadPoolExecutor

import pytest
from commands import run

import lumped  # noqa: F401  (rslab is to be imported by the thread that lives longest)
from comparisons.sweep.campaign import campaign
from lumped.calibration.central_table import ROWS
from studies.transfer.scenes import TRAINING, transfer_scenes
from studies.transfer.study import transfer
from studies.transfer.training import trained_to_bend

SCENES = transfer_scenes()
SEED = list(TRAINING)


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """The study in this process; runs are kept from one test to the next."""
    with campaign(tmp_path_factory.mktemp("transfer")) as store:

        def carried_out(**settings):
            settings = {"elements": 10, **settings}
            found = transfer(store, pool=lambda workers: ThreadPoolExecutor(1), **settings)
            assert found.failed == []
            return found

        yield carried_out


def test_every_scene_at_seventeen(study):
    """2 % of the largest displacement on every scene, of which springs from moduli have seen none."""
    found = study(methods=["consistent"], grids=[17], parts=["static"])
    assert len(found.static) == len(SCENES) == 17
    assert {row["scene"]: row["errors"][0] for row in found.static if row["errors"][0] > 0.02} == {}


def test_wrong_limits_are_measured_and_predicted(study):
    """In linear bending the error of uniform and Cauchy springs tends to that of the plate they are."""
    methods, scenes = ["consistent", "uniform", "cauchy"], ["two-edges-linear"]
    found = study(methods=methods, grids=[9, 17, 33], scenes=scenes, parts=["limits"])
    rows = {row["method"]: row for row in found.limits}
    for method, least in (("uniform", 0.2), ("cauchy", 0.05)):
        row = rows[method]
        assert row["extrapolated"] > least and row["lattice_less_plate"] < 0.01
        assert row["extrapolated"] == pytest.approx(row["predicted_limit"], rel=0.03)
    assert rows["consistent"]["extrapolated"] < 0.004 and rows["consistent"]["predicted_limit"] < 0.001


def test_leave_one_out(study):
    found = study(methods=["fit-static"], grids=[9], scenes=SEED, parts=["left-out"])
    assert [row["left_out"] for row in found.left_out] == SEED
    assert max(row["error"] for row in found.left_out) < 0.03


def test_command_writes_the_errors_of_the_chosen_methods(tmp_path, in_process, capsys):
    arguments = ["--methods", "uniform", "--scenes", "two-edges-clamped", "--grids", "5,9", "--elements", "4"]
    arguments += ["--part", "static", "--workers", "1", "--json", "--out", str(tmp_path)]
    assert run("study", "transfer", *arguments) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["static"][0]["method"] == "uniform" and len(document["static"][0]["errors"]) == 2
    assert "two-edges-clamped" in (tmp_path / "transfer.md").read_text(encoding="utf-8")


def test_the_table_of_central_is_what_its_scenes_ask_for():
    """Of one row: the numbers are as fine as the search, the errors flat about their least."""
    row = next(row for row in ROWS if row.poisson == 0.45)
    a, b, worst, cauchy = trained_to_bend(0.45)
    assert (a, b) == pytest.approx((row.bending, row.twisting), abs=2e-3)
    assert (worst, cauchy) == pytest.approx((row.bending_error, row.cauchy_error), abs=1e-3)

"""The study of Habibi et al. reproduced: its inputs, the tables beside our answers, the verb."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.reproduction.answers import answer
from comparisons.reproduction.findings import all_of
from comparisons.reproduction.published import published, scene
from comparisons.reproduction.reproduction import Reproduction
from sheetbench.answers.report import Report
from sheetbench.scenes import Status
from sheetbench.scenes.habibi import published_inputs


@pytest.fixture(scope="module")
def test_1():
    return answer(1, 0, 2)


def test_the_scenes_have_the_published_inputs():
    given = published_inputs()
    for test, sense in ((1, 1), (2, 1), (2, -1)):
        asked = scene(test, sense)
        assert (*asked.sheet.lengths, asked.sheet.thickness) == (
            given["side"],
            given["side"],
            given["thickness"],
        )
        for name in ("young", "poisson", "density"):
            assert getattr(asked.material, name) == pytest.approx(given[name], rel=1e-12)
        assert asked.gravity is not None and asked.gravity.acceleration == (0.0, 0.0, -given["gravity"])
    assert scene(2, -1).supports[0].curvature == -given["curvature"]


def test_a_misprint_is_left_out_and_the_axes_are_the_scenes():
    model, experiment = published(1, "model"), published(1, "experiment")
    np.testing.assert_allclose(model[:, 1], [-0.33e-3, -0.76e-3, -0.87e-3, -1.80e-3])
    assert np.argwhere(np.isnan(experiment)).tolist() == [[3, 1]]
    assert np.isfinite(model).all() and np.isfinite(published(2, "experiment")).all()


def test_the_tables_hold_what_was_published_and_what_we_answer(test_1):
    assert [s.model for s in test_1.comparison.solutions] == ["lumped", "shell", "k550-lz3", "k550-lz17"]
    assert test_1.comparison.solutions[2].settings["weights"] == "full"
    found = Reproduction(("tables",), 2, answers=(test_1,))
    document = found.document()
    assert {"parts", "inputs", "known_faults", "findings", "tests"} == set(document)
    assert document["findings"][0]["finding"].startswith("Our lattice with consistent springs is ")
    assert found.succeeded and document["tests"][0]["name"] == "test-1"
    report: Report = found.report()
    table = next(table for table in report.tables if table.name == "test-1")
    assert (
        len(table.rows) == 4 * 6
        and "| P4 | published experiment | −1.91 | – | −20.09 |" in table.to_markdown()
    )
    assert {"test-1.vtu", "test-1-shell.vtu", "test-1-k550-lz17.vtu"} <= set(report.files())
    assert any(
        "with the published inputs" in one.finding.lower() for one in all_of(found.answers, found.settling)
    )


def test_a_published_lattice_without_an_answer_is_a_complaint_and_no_failure(test_1):
    *others, last = test_1.comparison.solutions
    solutions = (*others, replace(last, status=Status.UNSTABLE))
    fallen = replace(test_1, comparison=replace(test_1.comparison, solutions=solutions))
    found = Reproduction(("tables",), 2, answers=(fallen,))
    assert found.succeeded
    assert [said.partition(": ")[0] for said in found.report().complaints] == ["Test 1, k550-lz17"]

"""Answers in: scores, the place beside other models, and every fault named in a line."""

import csv
import json

import numpy as np
import pytest
from commands import json_of, one_line, run

from comparisons.scoring.answers import HEADERS
from comparisons.scoring.reference import references
from comparisons.scoring.score import score


@pytest.fixture
def write(tmp_path):
    """Writes answers: the reference's own values, changed."""

    def write(suite="statics", change=lambda case, values: values, leave_out=(), seconds=None):
        path = tmp_path / "answers.csv"
        with path.open("w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow([*HEADERS[suite], *(["seconds"] if seconds else [])])
            for case in references(suite).values():
                if case.name not in leave_out:
                    for row in lines(case, change(case, case.values.copy())):
                        writer.writerow([case.name, *row, *([seconds] if seconds else [])])
        return path

    return write


def lines(case, values):
    if case.suite == "modes":
        return [[n + 1, f] for n, f in enumerate(values)]
    rows = zip(case.scene.probes, values, strict=True)
    if case.time is None:
        return [[name, *u] for name, u in rows]
    return [[name, time, *u[n]] for name, u in rows for n, time in enumerate(case.time)]


def test_an_error_is_that_of_the_design(write):
    found = score(write(change=lambda case, values: 1.02 * values))
    assert [row.error for row in found.rows if row.case == "thick"][-1] == pytest.approx(0.02)
    assert found.score == pytest.approx(0.02) and not found.faults
    models = [one.model for one in found.leaderboard]
    between = models.index("answers")
    assert all(one.score <= 0.02 for one in found.leaderboard[:between])
    assert all(one.score >= 0.02 for one in found.leaderboard[between + 1 :])
    assert "lumped:grid=9,calibration=consistent" in models[:between]
    assert "lumped:grid=9,calibration=uniform" in models[between:]
    whose = {one.model.partition(":")[0]: one.whose for one in found.leaderboard}
    others = dict.fromkeys(["mujoco", "kratos", "calculix"], "other program")
    assert whose == {"answers": "yours", **dict.fromkeys(["lumped", "plate", "shell"], "ours"), **others}
    assert found.leaderboard[between].seconds is None
    others = [one for one in found.leaderboard if one.model != "answers"]
    near = min(others, key=lambda one: abs(np.log(one.score / 0.02)))
    said = (
        f"you rank {between + 1} of {len(models)}; nearest neighbour {near.model}, {100 * near.score:.3g} %"
    )
    assert found.notes()[-1] == said
    assert repr(found).startswith("score 2 %") and models[0] in repr(found)  # the place is a table of its own


@pytest.mark.parametrize(("suite", "change", "said"), [
    ("statics", lambda case, u: u / 1000.0, "displacements are 1000 times too small in all 20 cases"),
    ("statics", lambda case, u: u * [1, 1, -1], "uz has the opposite sign in all 20 cases"),
    ("statics", lambda case, u: u[[0, 3, 2, 1]] if case.name == "soft-one-edge" else u,
        "probes P2 and P4 look swapped in soft-one-edge"),
    ("statics", lambda case, u: -u if case.name in ("thick", "thin") else u,
        "ux, uy and uz have the opposite sign in thin"),
    ("motion", lambda case, u: 1e3 * u, "mm for m, in all 8 cases"),
    ("motion", lambda case, u: -u, "opposite sign"),
    ("motion", lambda case, u: u[[0, 3, 2, 1]], "probes P2 and P4 look swapped"),
    ("modes", lambda case, f: 2.0 * np.pi * f, "rad/s for Hz"),
    ("curves", lambda case, u: 1e3 * u, "mm for m, in all 13 cases"),
    ("natural", lambda case, u: 1e3 * u, "mm for m, in all 4 cases"),
    ("contact", lambda case, u: -u, "opposite sign"),
])  # fmt: skip
def test_a_slip_is_named(write, suite, change, said):
    faults = score(write(suite, change), suite).faults
    assert any(said in fault for fault in faults), faults


def test_faults_are_printed_and_end_with_3(write, capsys):
    path = write(change=lambda case, u: 1000.0 * u)
    said = "displacements are 1000 times too large, as in mm for m, in all 20 cases"
    assert run("score", str(path), "--json") == 3
    printed = capsys.readouterr()
    assert said in " ".join(printed.err.split()) and json.loads(printed.out)["faults"] == [said]


@pytest.mark.parametrize("suite", ["motion", "modes", "curves", "natural", "contact"])
def test_other_suites_are_scored_and_ranked(write, suite):
    right = score(write(suite), suite)
    assert not right.faults and right.score < 0.02
    off = score(write(suite, lambda case, u: 1.05 * u), suite)
    assert off.score == pytest.approx(0.05, rel=0.2) and not off.faults
    last = len(off.leaderboard)
    assert off.notes()[-1].startswith(f"you rank {last} of {last}; nearest neighbour ") and last > 1


@pytest.mark.parametrize(("case", "grid"), [("free-swing", "9"), ("pressure-step", "17")])
def test_a_run_of_ours_is_scored_from_its_history(case, grid, tmp_path, capsys):
    """The lattice, 2 % off with so many masses a side; samples between the reference's are passed over."""
    known = references()[case]
    assert known.time is not None and known.duration is not None
    assert run("score", "--suite", "motion", "--out", str(tmp_path / "set")) == 0
    springs = ["--lumped", grid, "--duration", str(known.duration), "--every", str(known.time[1] / 2)]
    out = ["--no-pictures", "--out", str(tmp_path / "run")]
    assert run("simulate", str(tmp_path / "set" / f"{case}.toml"), *springs, *out) == 0
    path = tmp_path / "run" / "displacements.csv"
    capsys.readouterr()
    found = json_of(capsys, "score", str(path), "--case", case)
    (row,) = found["cases"]
    assert found["suite"] == "motion" and found["faults"] == [] and row["error"] < 0.03
    path.write_text(path.read_text().replace("[m]", "[mm]"))
    assert run("score", str(path), "--case", case) == 3
    assert "displacements are 1000 times too small" in capsys.readouterr().err


def test_what_is_missing_of_a_motion_is_refused(write, capsys):
    path = write("motion")
    text = path.read_text()
    needed = "61 times are needed, every 0.01 s from 0 to 0.6 s"
    for old, new, said in (
        ("free-swing,P2,0.01,", "free-swing,P2,0.0101,", f"P2 is missing at 0.01 s: {needed}; given are 62"),
        ("free-swing,P2,0.6,", "free-swing,P2,600,", "from 0 to 600 s, as in ms: name the column time [ms]"),
        ("free-swing,P2,0.01,", "free-swing,P2,0.02,", "probe = 'P2': has this time twice"),
        (
            "case,probe,time",
            "case,probe,time [ms]",
            "0.005 s from 0 to 0.3 s; given are 61 from 0 to 0.0003 s",
        ),
        ("case,", "scene,", "with one --case, case may be left out"),
    ):
        path.write_text(text.replace(old, new))
        assert run("score", str(path)) == 2
        assert said in one_line(capsys)


def test_what_is_missing_is_refused_in_a_line(write, capsys):
    path = write(leave_out=["thin"])
    text = path.read_text()
    no_p2 = "\n".join(line for line in text.splitlines() if "thick,P2" not in line)
    other = "case = 'modes-free': a case of modes: score it with --suite modes"
    for case, changed, said in (
        ("thin", text, "no answer yet to thin: fill in the numbers of a case"),
        ("modes-free", text, "case = 'modes-free'"),
        ("thick", text.replace("thick,P2,", "thick,P9,"), "probe = 'P9': thick has P1, P2, P3, P4"),
        ("thick", no_p2, "probe P2 is missing"),
        ("thick", text.replace("case,probe", "case,point"), "header of statics must be case,probe,ux,uy,uz"),
        ("thick", text.replace("thick,P2,", "thick,P2,x"), "not a number"),
        (
            "thick",
            text.replace("thick,", "thik,"),
            "case = 'thik': statics has no such case; did you mean thick?",
        ),
        ("thick", text.replace("thick,", "modes-free,"), other),
    ):
        path.write_text(changed)
        assert run("score", str(path), "--case", case) == 2
        assert said in one_line(capsys)
    path.write_text(text)
    document = json_of(capsys, "score", str(path), "--case", "thick")
    assert {row["case"] for row in document["rows"]} == {"thick"}


def test_a_form_is_filled_in_in_stages(write, capsys):
    path = write(seconds=1e-3)
    header, *rows = path.read_text().splitlines()
    empty = [",".join(row.split(",")[:2]) for row in rows]
    filled = [row if row.startswith(("thick,", "thin,")) else e for row, e in zip(rows, empty, strict=True)]
    path.write_text("\n".join([header, *filled]))
    found = score(path)
    assert {answer.reference.name for answer in found.answers} == {"thick", "thin"}
    assert len(found.unanswered) == 18 and "soft-one-edge" in found.unanswered
    report = found.report()
    assert "on 2 of 20 cases" in report.subtitle and any("not answered yet" in said for said in report.notes)
    assert report.notes[-1].startswith("you rank ")
    document = json_of(capsys, "score", str(path), "--case", "thick", "--case", "thin")
    assert [case["case"] for case in document["cases"]] == ["thick", "thin"] and document["unanswered"] == []
    path.write_text("\n".join([header, *empty]))
    assert run("score", str(path)) == 2
    assert "no answer yet" in one_line(capsys)


@pytest.mark.parametrize(
    ("suite", "factor", "said"),
    [
        ("statics", 1 / 1.05, "all 20 cases too stiff by about 5 %"),
        ("statics", 1 / 0.9, "all 20 cases too soft by about 10 %"),
        ("modes", 1.05**0.5, "all 7 cases too stiff by about 5 %"),
        ("statics", 1.0, "not distinguishable from the reference in all 20 cases"),
    ],
)
def test_the_verdict_comes_first_and_says_what_is_off_throughout(write, suite, factor, said, capsys):
    path = write(suite, lambda case, u: factor * u)
    assert run("score", str(path), "--suite", suite) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert said in printed and printed.index("Verdict") < printed.index("Errors by case")

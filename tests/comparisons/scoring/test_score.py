"""The reference set, frozen and complete; answers to it: scores, ranks, every fault named in a line."""

import csv
import json
import re
from hashlib import sha256

import numpy as np
import pytest
from commands import json_of, one_line, run

import fem_reference
from comparisons.scoring.answers import HEADERS, read_answers
from comparisons.scoring.reference import FILE, VERSION, document, references
from comparisons.scoring.score import score
from sheetbench import scenes
from sheetbench.choices import SUITES
from sheetbench.errors import BadInput

FROZEN = {  # of scenes and values, by the version that they are from
    ("statics", "motion", "modes"): "15198e1a28208c6d",  # 2.0
    ("curves",): "bfd47df4914f80ff",  # 2.1
    ("natural", "contact"): "4f2d9024223f2472",  # 2.2
}


def values_digest(suites):
    """Of scenes and values alone: titles, measured times and the machine may change."""
    kept = [
        {key: case[key] for key in ("name", "scene", "probes", "frequencies_hz", "time") if key in case}
        for case in document()["cases"]
        if case["suite"] in suites
    ]
    for case in kept:
        case["scene"] = {**case["scene"], "title": ""}
    return sha256(json.dumps(kept, sort_keys=True).encode()).hexdigest()[:16]


def test_a_published_version_does_not_change():
    assert document()["version"] == VERSION
    assert {suites: values_digest(suites) for suites in FROZEN} == FROZEN, "others: another VERSION"
    assert sorted(name for suites in FROZEN for name in suites) == sorted(SUITES)
    assert document()["licence"] == "CC-BY-4.0"


def test_every_case_has_a_suite_a_model_that_agrees_and_a_small_bar():
    assert len(references()) == len(document()["cases"]) == 56
    for known in references().values():
        assert known.suite in SUITES and known.agreeing and known.why, known.name
        assert (known.duration is not None) == (known.suite == "motion"), known.name
    limits = dict.fromkeys(SUITES, 1e-3) | {"motion": 0.02}
    first_order = {"over-cylinder": 0.02}  # of where the nodes are on it
    for known in references().values():
        assert 0.0 < known.bar <= first_order.get(known.name, limits[known.suite]), known.name
        assert known.values.shape == known.bars.shape and np.isfinite(known.values).all()


@pytest.mark.parametrize("name", ["thick", "poisson-0"])
def test_a_coarser_shell_is_near_the_reference_values(name):
    """On 8 elements instead of 24: nine times the error at order 2, which is what these limits leave."""
    known = references()[name]
    solution = fem_reference.solve(known.scene, "shell", elements=8)
    off = np.abs(solution.displacement(known.scene.probe_points()) - known.values).max()
    assert off < 2e-3 * np.abs(known.values).max()


def test_the_verb_lists_and_exports_it(tmp_path, capsys):
    assert json_of(capsys, "score", "--out", str(tmp_path))["cases"] == json.loads(FILE.read_text())["cases"]
    assert scenes.load(str(tmp_path / "thick.toml")) == references()["thick"].scene
    assert "CC-BY-4.0" in (tmp_path / "LICENCE.txt").read_text()
    with (tmp_path / "values-statics.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 4 * 20 and float(rows[0]["ux"]) == references()["two-edges-clamped"].values[0, 0]
    forms = {(tmp_path / f"answers-{suite}.csv").read_text().splitlines()[0] for suite in SUITES}
    assert len(forms) == 3  # all at rest have that of statics
    for suite in ("statics", "motion"):  # where the probes are, and nothing answered yet
        with (tmp_path / f"answers-{suite}.csv").open() as file:
            row = list(csv.DictReader(file))[-1]
        place = references(suite)[row["case"]].scene.probes[row["probe"]]
        assert (float(row["x"]), float(row["y"])) == place and row["ux"] == row["seconds"] == ""
        with pytest.raises(BadInput, match="no answer yet"):  # x and y are none
            read_answers(tmp_path / f"answers-{suite}.csv")


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
    assert [one.score for one in found.leaderboard] == sorted(one.score for one in found.leaderboard)
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
    assert run("score", str(path), "--case", case, "--json") == 3
    printed, said = capsys.readouterr(), "displacements are 1000 times too small"
    assert said in " ".join(printed.err.split()) and said in json.loads(printed.out)["faults"][0]


TIMES = "61 times are needed, every 0.01 s from 0 to 0.6 s"
WRONG = (  # suite and --case; what of the answers is written otherwise, and what is said of it
    (
        "motion",
        "",
        "free-swing,P2,0.01,",
        "free-swing,P2,0.0101,",
        f"is missing at 0.01 s: {TIMES}; given are 62",
    ),
    (
        "motion",
        "",
        "free-swing,P2,0.6,",
        "free-swing,P2,600,",
        "from 0 to 600 s, as in ms: name the column time [ms]",
    ),
    ("motion", "", "free-swing,P2,0.01,", "free-swing,P2,0.02,", "probe = 'P2': has this time twice"),
    ("motion", "", "case,probe,time", "case,probe,time [ms]", "to 0.3 s; given are 61 from 0 to 0.0003 s"),
    ("motion", "", "case,", "scene,", "with one --case, case may be left out"),
    ("statics", "thin", "", "", "no answer yet to thin: fill in the numbers of a case"),
    ("statics", "modes-free", "", "", "case = 'modes-free'"),
    ("statics", "thick", "thick,P2,", "thick,P9,", "probe = 'P9': thick has P1, P2, P3, P4"),
    ("statics", "thick", "thick,P2,.*\n", "", "probe P2 is missing"),
    ("statics", "thick", "case,probe", "case,point", "header of statics must be case,probe,ux,uy,uz"),
    ("statics", "thick", "thick,P2,", "thick,P2,x", "not a number"),
    ("statics", "thick", "thick,", "thik,", "case = 'thik': statics has no such case; did you mean thick?"),
    (
        "statics",
        "thick",
        "thick,",
        "modes-free,",
        "modes-free': a case of modes: score it with --suite modes",
    ),
)


def test_what_is_missing_or_wrong_is_refused_in_a_line(write, capsys):
    texts = {suite: write(suite, leave_out=["thin"]).read_text() for suite in ("motion", "statics")}
    path = write(leave_out=["thin"])
    for suite, case, old, new, said in WRONG:
        path.write_text(re.sub(old, new, texts[suite]) if old else texts[suite])
        assert run("score", str(path), *(["--case", case] if case else [])) == 2
        assert said in one_line(capsys)
    path.write_text(texts["statics"])
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

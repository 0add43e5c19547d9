"""`sheetbench crosscheck` with external codes whose errors are known."""

import json

import pytest
from commands import json_of, one_line, run

from sheetbench.scenes import load

SEED = load("two-edges-clamped")

FAKE = '''
import numpy as np
from pathlib import Path
from fake_solutions import solution
from sheetbench.answers.solution import Status


class Fake:
    """Answers limit + error h² at every point; counts its solves."""

    called, needs, meshes, layered = "a fake", "luck", (4, 6, 8), False
    settings = {"elements": 4}
    limit, error, fails = -0.01, 0.001, ""

    def __init__(self, name, **own):
        self.name = name
        vars(self).update(own)

    def version(self):
        return None if self.fails == "absent" else "1.0"

    def solve(self, scene, settings):
        n = settings["elements"]
        with open(Path(__file__).with_name("solves"), "a") as kept:
            kept.write(f"{self.name} {n}\\n")
        if self.fails == "raises":
            raise RuntimeError("out of luck")
        refused, diverged = self.fails == "refuses" or scene.actuators, self.fails == "diverges" and n == 8
        status = Status.REFUSED if refused else Status.DIVERGED if diverged else Status.CONVERGED
        u = np.array([0.1, 0.2, 1.0]) * (self.limit + self.error / n**2)
        return solution(
            scene, self.name, label=f"{self.name} {n}", settings={"elements": [n, n]}, status=status,
            sample=lambda points: np.tile(u, (len(points), 1)), load_factor=1.0 * (status == "converged"),
            remarks=("takes no such scene",) if refused else (),
        )


EXACT, SAME, OTHER = Fake("exact"), Fake("same", error=-0.002), Fake("other", limit=-0.0102)
REFUSES, RAISES, DIVERGES, ABSENT = (Fake(one, fails=one) for one in "refuses raises diverges absent".split())
'''
NONE = ("--lumped", "", "--plate", "", "--shell", "", "--solid", "")


@pytest.fixture
def fakes(tmp_path, in_process):
    """The judges' names as options: `fakes("EXACT", "SAME")`."""
    file = tmp_path / "fakes.py"
    file.write_text(FAKE, encoding="utf-8")
    return lambda *names: ("--judges", ",".join(f"{file}:{name}" for name in names))


def test_judges_side_by_side(fakes, capsys):
    document = json_of(capsys, "crosscheck", "two-edges-clamped", *NONE, *fakes("EXACT", "SAME", "OTHER"))
    assert [one["model"] for one in document["solutions"]] == ["exact", "same", "other"]
    exact = document["solutions"][0]
    assert (exact["meshes"], exact["version"], exact["settings"]["elements"]) == ("4, 6, 8", "1.0", [8, 8])
    assert exact["extrapolated"]["P4"][2] == pytest.approx(-0.01)
    assert exact["uncertainty"]["P4"][2] == pytest.approx(1.35 * 0.001 / 64)
    points = {(one["a"], one["b"]): one["apart"] for one in document["pairs"]}
    assert points["exact", "same"] == [] and points["exact", "other"] == ["P1", "P2", "P3", "P4"]
    assert [judge["status"] for judge in document["judges"]] == ["found"] * 3


def test_what_a_judge_refuses_or_fails_at_is_a_row_of_its_own(fakes, capsys):
    judges = fakes("EXACT", "REFUSES", "DIVERGES")
    assert run("crosscheck", "two-edges-clamped", *NONE, *judges, "--json") == 3  # one mesh of diverges
    captured = capsys.readouterr()
    exact, refuses, diverges = json.loads(captured.out)["solutions"]
    assert refuses["status"] == "refused" and refuses["message"] == "takes no such scene"
    assert "uncertainty" not in refuses and refuses["failed"] == []
    assert diverges["meshes"] == "4, 6" and "diverges 8: diverged" in diverges["failed"][0]
    assert "uncertainty" in diverges and exact["failed"] == []
    assert "diverges 8: diverged" in captured.err
    assert run("crosscheck", "two-edges-clamped", *NONE, *fakes("EXACT", "RAISES")) == 3
    captured = capsys.readouterr()
    assert "no answer" in captured.out and "out of luck" in captured.err


def test_only_meshes_that_the_folder_does_not_have_are_solved(fakes, tmp_path):
    """As an interrupted run is resumed."""
    line = ("crosscheck", "two-edges-clamped", *NONE, "--out", str(tmp_path / "out"), *fakes("EXACT"))
    assert run(*line) == run(*line, "--meshes", "6,8,12") == 0
    assert (tmp_path / "solves").read_text().split("\n")[:-1] == [f"exact {n}" for n in (4, 6, 8, 12)]


def test_scenes_stand_in_one_table_and_their_refusals_in_one_sentence(fakes, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "160")
    scenes = ("two-edges-clamped", "one-edge-clamped", "actuated-edge")
    assert run("crosscheck", *scenes, *NONE, *fakes("EXACT", "REFUSES")) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "exact leaves out actuated-edge: takes no such scene." in said
    assert f"refuses leaves out {', '.join(scenes)}: takes no such scene." in said


def test_an_absent_code_is_refused_with_what_it_needs(fakes, capsys):
    assert run("crosscheck", "two-edges-clamped", *fakes("ABSENT")) == 2
    assert "needs luck" in one_line(capsys)

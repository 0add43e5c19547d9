"""Reports: figures with their units, text of a scene made harmless, files of one scene in a folder."""

import csv
import io
import json
import re
import warnings

import pytest
from commands import one_line, run
from scene_files import GOOD, written

from comparisons.cli.messages import in_lines
from comparisons.cli.output import OutputOptions
from comparisons.sweep.folder import MANIFEST, Folder
from sheetbench import scenes
from sheetbench.answers import escape
from sheetbench.answers.report import Picture, Report
from sheetbench.answers.table import Column, Table, TableUnit, quantity, unit
from sheetbench.errors import BadInput, Implausible

pytestmark = pytest.mark.smoke

HOSTILE = '\x1b[31m<script>alert("x")</script>|=1+1\n`$\\'
NUMBERS = Column("a", "m", "mm", 1e3, ".4g")


def test_a_row_with_a_unit_is_shown_in_it_and_kept_in_si():
    values = (Column("value", form=".4g"), Column("off", "", "%", 100.0, ".1f"))
    columns = (Column("name"), Column("unit"), *values)
    table = Table("", columns, (("young", unit("Pa"), 4.1e6, 0.5), ("poisson", unit(""), 0.3, 0.5)))
    assert table.shown_rows() == [["young", "MPa", "4.1", "50.0"], ["poisson", "", "0.3", "50.0"]]
    assert "young,Pa,4100000.0,0.5" in table.to_csv()
    assert unit("kg/m³") == TableUnit("kg/m³", "kg/m³")
    assert [quantity(-4.1e6, "Pa"), quantity(0.3, "")] == ["−4.1 MPa", "0.3"]


def test_terminal_text_acts_on_no_terminal():
    shown = escape.terminal(HOSTILE + "\x9b2J\u202eab\u2028")
    assert shown.startswith(r"\x1b[31m<script>") and shown.isprintable()
    assert escape.terminal("E = 5 MPa · ν ≥ ½ 膜 e\u0301") == "E = 5 MPa · ν ≥ ½ 膜 e\u0301"
    assert escape.terminal("a\nb", keep="\n") == "a\nb"


def hostile_table():
    return Table(HOSTILE, (Column(HOSTILE), NUMBERS), ((HOSTILE, 1.0), ("=HYPERLINK(1)", -2.0)))


def test_markdown_has_neither_tags_nor_more_cells():
    page = Report("x", HOSTILE, {}, tables=(hostile_table(),), notes=("[a](javascript:b)",)).to_markdown()
    assert "<" not in page and "\x1b" not in page
    rows = [line for line in page.splitlines() if line.startswith("|")]
    assert len(rows) == 4
    assert all(len(re.findall(r"(?<!\\)\|", row)) == 3 for row in rows)
    assert not re.search(r"(?<!\\)\]\(", page)


def test_csv_cells_are_no_formulas_and_numbers_stay_numbers():
    rows = list(csv.reader(io.StringIO(hostile_table().to_csv())))
    assert rows[2] == ["'=HYPERLINK(1)", "-2.0"]
    assert (
        escape.csv_cell("\tx") == "'\tx" and escape.csv_cell(-1.0) == -1.0 and escape.csv_cell("P1") == "P1"
    )


HOSTILE_SCENE = (
    'name = "=cmd<script>"\ntitle = "\\u001b[2J <img src=x> | `$\\\\foo$"\n'
    + GOOD[GOOD.index("[sheet]") : GOOD.index("P1")]
    + '"=HYPERLINK(1)" = [0.1, 0.1]\n"a|b<i>" = [0.188, 0.1]\n'
)


@pytest.mark.usefixtures("quick")
def test_a_hostile_scene_is_harmless_wherever_it_is_shown(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(Picture, "write", lambda *_: "not drawn here")
    assert run("compare", str(written(tmp_path, HOSTILE_SCENE)), "--out", str(tmp_path / "out")) == 0
    printed = capsys.readouterr()
    assert "\x1b" not in printed.out + printed.err and r"\x1b[2J" in printed.out
    page = (tmp_path / "out" / "table.md").read_text(encoding="utf-8")
    assert "<" not in page and "\x1b" not in page
    first = [row[0] for row in csv.reader((tmp_path / "out" / "table.csv").open(encoding="utf-8"))]
    assert "'=HYPERLINK(1)" in first and "=HYPERLINK(1)" not in first


def test_a_refusal_spells_out_what_would_act_on_the_terminal(tmp_path, capsys):
    text = HOSTILE_SCENE.replace("[sheet]", '"\\u001b[2Jkey" = 1\n[sheet]')
    assert run("compare", str(written(tmp_path, text))) == 2
    said = one_line(capsys)
    assert "\x1b" not in said and r"\x1b[2Jkey" in said


def about(**changes):
    document = scenes.load("one-edge-clamped").model_dump(mode="json", by_alias=True, exclude_none=True)
    return {"scene": {**document, **changes}}


class Said(Report):
    """An answer that is its own report."""

    def report(self):
        return self


def report(*names):
    return Report(
        "answer", "t", {"a": 1}, attachments={name: lambda path: path.write_text("x") for name in names}
    )


def files(folder):
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


SHEET = about()["scene"]["sheet"]
THICKER = {**SHEET, "thickness": 0.004}
HERE, OTHER = about(), about(name="other", sheet=THICKER)
SHELL, PLATE = {"--reference": "shell"}, {"--reference": "plate"}


def entered(folder, verb, about=None, variant=None, **options):
    return Folder(folder, verb, ["x"], about=about, variant=variant, **options)


def test_the_same_scene_and_verb_again_is_fine_and_so_is_another_verb(tmp_path):
    for _ in range(2):
        entered(tmp_path, "modes", HERE, SHELL).report(report("a.txt"))
    entered(tmp_path, "advise", HERE, PLATE).report(report("b.txt", "a.txt"))
    entered(tmp_path, "calibrate", {"sheet": SHEET})
    runs = json.loads((tmp_path / MANIFEST).read_text())["runs"]
    assert runs["modes"]["files"] == []  # what another verb has written since is that verb's
    assert runs["advise"]["files"] == ["b.txt", "a.txt", "answer.json"]


@pytest.mark.parametrize(
    ("first", "second", "differs"),
    [
        (("modes", HERE), ("modes", OTHER), r"another 'modes' \(of another scene, sheet\)"),
        (("modes", HERE), ("compare", OTHER), r"another 'modes' \(of another scene, sheet\)"),
        (("modes", HERE), ("calibrate", {"sheet": THICKER}), r"another 'modes' \(of another sheet\)"),
        (("compare", HERE, SHELL), ("compare", HERE, PLATE), "of another --reference"),
        (("stability",), ("compare", HERE), r"another 'stability' \(of another question\)"),
        (("stability",), ("verify", {}), r"another 'stability' \(of another question\)"),
    ],
)
def test_a_folder_of_something_else_is_refused_with_what_differs(tmp_path, first, second, differs):
    entered(tmp_path, *first).report(report("map.csv"))
    before = files(tmp_path)
    with pytest.raises(BadInput, match="holds files of .*" + differs):
        entered(tmp_path, *second)
    assert files(tmp_path) == before
    entered(tmp_path, *second, overwrite=True).report(report("a.txt"))
    assert files(tmp_path) == {"a.txt", "answer.json", MANIFEST}


def test_overwrite_removes_what_the_manifest_lists_and_nothing_else(tmp_path):
    first = entered(tmp_path, "simulate", HERE)
    run_folder = first.reserve("run/")
    run_folder.mkdir()
    (run_folder / "samples.bin").write_text("x")
    first.report(report("old.txt"))
    (tmp_path / "mine.txt").write_text("mine")
    again = entered(tmp_path, "modes", OTHER, overwrite=True)
    assert (tmp_path / "old.txt").exists()  # until there is something to put there
    again.report(report("new.txt"))
    assert files(tmp_path) == {"mine.txt", "new.txt", "answer.json", MANIFEST}
    assert list(json.loads((tmp_path / MANIFEST).read_text())["runs"]) == ["modes"]


def test_a_manifest_cannot_lead_out_of_its_folder(tmp_path):
    outside, inside = tmp_path / "outside.txt", tmp_path / "in"
    outside.write_text("keep")
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "kept.txt").write_text("keep")
    entered(inside, "modes", HERE).report(report())
    (inside / "link").symlink_to(tmp_path / "elsewhere")
    manifest = json.loads((inside / MANIFEST).read_text())
    names = ["../outside.txt", str(outside), "link/kept.txt", "link/", "."]
    manifest["runs"]["modes"]["files"] += names
    (inside / MANIFEST).write_text(json.dumps(manifest))
    entered(inside, "modes", HERE, overwrite=True).report(report())
    assert outside.exists() and (tmp_path / "elsewhere" / "kept.txt").exists()


@pytest.mark.parametrize("text", ["", "[]", '{"a": 1}', '{"runs": 3}', "\x00"])
def test_a_manifest_that_is_not_ours_is_refused(tmp_path, text):
    (tmp_path / MANIFEST).write_text(text)
    with pytest.raises(BadInput, match=r"its manifest\.json cannot be read"):
        entered(tmp_path, "modes", HERE, overwrite=True)


def test_a_questions_own_warnings_stand_before_those_about_its_scene(capsys):
    with in_lines():
        warnings.warn(Implausible("young = 54.5 Pa"), stacklevel=1)
        with OutputOptions("identify", json=True).open() as out:
            out.show(Said("identification", "t", {"warnings": ["a poor fit"]}))
    assert json.loads(capsys.readouterr().out)["warnings"] == ["a poor fit", "young = 54.5 Pa"]


def test_what_compiling_took_is_said_before_the_remarks_which_may_end_in_a_command(capsys, monkeypatch):
    monkeypatch.setattr("comparisons.cli.output.clock.compiled", lambda: 23.2)
    with OutputOptions("advise").open() as out:
        out.show(Said("advice", "t", {}, notes=("Solve it with:", "sheetbench compare x")))
    *_, compiled, before, command = capsys.readouterr().out.splitlines()
    assert compiled.startswith("Kernels were compiled, once on this machine: 23.2 s")
    assert (before, command) == ("Solve it with:", "sheetbench compare x")

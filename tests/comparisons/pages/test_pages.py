"""`sheetbench report`: a folder's studies as one page, in a browser and as text."""

import json
import re
import sys
from dataclasses import replace
from typing import Any

import pytest
from browser import browser, colours, opened, pixels  # noqa: F401
from commands import run

from comparisons.comparison.comparison import compare
from comparisons.models.spec import Lattice
from comparisons.pages.page import page
from comparisons.pages.studies import read, tables
from comparisons.sweep.folder import Folder
from sheetbench.answers.report import Report
from sheetbench.answers.table import Column, Table, unit
from sheetbench.scenes import load

EVIL = "<script>alert(1)</script>"
VIEW = "canvas[tabindex]"


@pytest.fixture(scope="module")
def studies(tmp_path_factory):
    """A comparison of a scene with an evil title, and modes, without pictures; a file that nobody knows."""
    folder = tmp_path_factory.mktemp("studies")
    scene = load("two-edges-clamped").model_copy(update={"title": EVIL})
    found = compare(scene, Lattice(3), reference="plate", elements=2, uncertainty=False)
    about = {"scene": scene.document()}
    undrawn = replace(found.report(), pictures=())
    Folder(folder, "compare", ["sheetbench", "compare"], about=about).report(undrawn)
    words = (Column("remark"), Column("of"))
    columns = (Column("mode", form="d"), Column("lumped", "Hz", "Hz", 1.0, ".4g"), *words)
    rows = tuple((n, float(f), f"=r{n}", unit("Pa")) for n, f in enumerate((9.5, 10.25, 100.0), start=1))
    document = {
        "solutions": [{"model": "lumped", "label": "lumped 3", "frequencies_hz": [9.5, 10.25, 100.0]}]
    }
    modes = Report("modes", "modes", document, tables=(Table("Frequencies", columns, rows, "modes"),))
    Folder(folder / "modes", "modes", ["sheetbench", "modes"]).report(modes)
    return folder


@pytest.fixture(scope="module")
def shown(browser, studies):  # noqa: F811
    """The page in a browser; at the end no complaint, none by its policy, and no request."""
    path = studies.parent / "report.html"
    path.write_text(page(read(studies), f"Report {EVIL}"), encoding="utf-8")
    with opened(browser, path.as_uri()) as (found, watch):
        dialogs: list[Any] = []
        found.on("dialog", lambda dialog: dialogs.append(dialog))
        yield found
        assert watch.troubles == [] and watch.requests == [path.as_uri()] and not dialogs


def test_its_policy_lets_nothing_but_its_own_script_and_style_in(shown):
    (said,) = (m.get_attribute("content") for m in shown.locator("meta[http-equiv]").all())
    assert said.startswith("default-src 'none'; script-src 'sha256-") and "unsafe" not in said


def test_what_a_scene_says_stays_text(shown):
    assert EVIL in shown.locator("article").first.text_content()
    assert EVIL in shown.locator("h1").text_content()


def test_the_sheets_are_drawn(shown):
    """Turned and coloured they are in test_viewer.py."""
    shown.locator(".sv-stage").scroll_into_view_if_needed()
    assert colours(pixels(shown, VIEW)) > 100
    options = shown.get_by_label("Show", exact=True).locator("option").all_text_contents()
    assert options[:3] == ["lumped and plate", "lumped", "plate"]
    shown.get_by_label("Show", exact=True).select_option("difference")
    assert "Distance from the reference [mm]" in shown.locator(".sv-legend").text_content()


def test_tables_sort_by_click_and_by_key_numbers_by_value(shown):
    table = shown.locator("#study-2 table").first
    heading = table.get_by_role("button", name="lumped [Hz]")
    column = table.locator("tbody td:nth-child(2)")
    heading.click()
    assert column.all_text_contents() == ["9.5", "10.25", "100"]
    heading.press("Enter")
    assert column.all_text_contents() == ["100", "10.25", "9.5"]
    assert table.locator("th").nth(1).get_attribute("aria-sort") == "descending"
    assert table.locator("tbody tr").first.locator("td").all_text_contents()[2:] == ["=r3", "MPa"]


def test_print_has_pictures_for_sheets_and_all_open(shown):
    shown.emulate_media(media="print")
    shown.evaluate("dispatchEvent(new Event('beforeprint'))")
    taken = shown.locator(".taken")
    assert taken.is_visible() and taken.get_attribute("src").startswith("data:image/png;base64,")
    assert not shown.locator(".sv-stage").is_visible()
    assert shown.locator("details:not([open])").count() == 0
    shown.evaluate("dispatchEvent(new Event('afterprint'))")
    assert shown.locator(".taken").count() == 0 and shown.locator("details[open]").count() == 0
    shown.emulate_media(media="screen")


def test_tables_are_shown_as_the_run_showed_them(studies):
    comparison = next(study for study in read(studies).studies if study.verb == "compare")
    shown = tables(comparison)
    text = (studies / "table.md").read_text(encoding="utf-8")
    assert [table.caption for table in shown][:2] == [
        "Displacement of the mid-surface",
        "Cost and error of each model",
    ]
    for table in shown:
        for row in table.shown_rows():
            assert f"| {' | '.join(row)} |" in text
    assert not comparison.troubles


@pytest.mark.parametrize("there", [True, False])
def test_the_page_is_opened_where_that_is_asked(tmp_path, capsys, monkeypatch, there):
    opened_pages: list[str] = []
    monkeypatch.setattr("webbrowser.open", lambda address: opened_pages.append(address) or there)
    Folder(tmp_path, "modes", ["sheetbench", "modes"]).report(Report("modes", "t", {}))
    assert run("report", str(tmp_path)) == 0 and opened_pages == []
    assert run("report", str(tmp_path), "--open") == 0
    assert opened_pages == [(tmp_path / "report.html").as_uri()]
    assert ("There is no browser here" in capsys.readouterr().err) is not there


def test_damage_costs_a_sentence(tmp_path, capsys):
    files = {
        "broken.vtu": "<VTKFile", "broken.json": "{", "broken.csv": "\xff\xfe\0", "broken.png": "no picture",
        "broken2.svg": "<svg>", "good.svg": '<svg xmlns="http://www.w3.org/2000/svg"/>',
        "found.json": '{"findings": [{"finding": "k <b>"}], "rows": [{"of": "a", "at": 7}]}',
        "broken.pvd": "<a><DataSet timestep='0' file='../x.vtu'/></a>",
        "other.pvd": "<a><DataSet timestep='0' file='endless.ele'/></a>",
        "endless.ele": "# a reader of TetGen's does not end\n", "good.csv": "x [m],what\n0.001,a\n",
    }  # fmt: skip
    columns = [{"name": "x", "unit": "m", "shown_unit": "mm", "scale": 1e3, "form": ".5g"}, {"name": "what"}]
    described = {"tables": [{"name": name, "columns": columns} for name in ("broken", "good")]}
    outside = {"files": ["../broken.png", "gone.png"], "command": ["x"], "scene": {"name": 1}}
    manifests = {
        "deep/manifest.json": "[" * 100_000,
        "odd/manifest.json": json.dumps({"runs": {"compare": outside}}),
        "manifest.json": json.dumps({"runs": {"check": {"files": sorted(files), "words": described}}}),
    }
    for name, text in {**files, **manifests}.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(text.encode("latin-1"))
    assert run("report", str(tmp_path), "--json") == 0
    said = capsys.readouterr()
    troubles = json.loads(said.out)["troubles"]
    broken = ("vtu", "json", "csv", "png", "pvd")  # the first document of a run is its own
    for name in (*(f"broken.{kind}" for kind in broken), "other.pvd", "broken2.svg", "deep/manifest.json"):
        assert any(one.startswith(name) for one in troubles), name
    assert any("lies outside" in one for one in troubles) and any("not there" in one for one in troubles)
    assert "Traceback" not in said.err
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert re.search(r'data-value="0.001">1<', text) and "x [mm]" in text
    assert "data:image/svg+xml;base64" in text


def test_without_its_extra_the_verb_says_what_to_install(studies, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "jinja2", None)
    monkeypatch.delitem(sys.modules, "comparisons.pages.page")
    assert run("report", str(studies)) == 2
    assert "pip install 'sheetbench[report]'" in " ".join(capsys.readouterr().err.split())


RUN = {"files": ["comparison.json"], "words": {"title": "A", "document": "comparison.json"}}


@pytest.mark.parametrize("damaged", [
    7,
    {"runs": [RUN]},
    {"runs": {"compare": None}},
    {"runs": {"compare": {"files": None}}},
    {"runs": {"compare": {"files": ["a\0b.json"]}}},
    {"runs": {"compare": {"files": ["x" * 300 + ".json"]}}},
    {"runs": {"compare": {**RUN, "words": {"notes": 5}}}},
    {"runs": {"compare": {**RUN, "words": {"tables": ["a"]}}}},
    {"runs": {"compare": {**RUN, "command": 3}}},
    {"runs": {"compare": RUN}, "machine": ["processor"]},
], ids=lambda value: str(value)[-40:])  # fmt: skip
def test_a_manifest_of_another_shape_costs_a_sentence(tmp_path, capsys, damaged):
    for name, record in (("odd", damaged), ("sound", {"runs": {"compare": RUN}})):
        (tmp_path / name).mkdir()
        (tmp_path / name / "manifest.json").write_text(json.dumps(record))
        (tmp_path / name / "comparison.json").write_text("{}")
    assert run("report", str(tmp_path)) == 0
    said = capsys.readouterr()
    assert "1 study in" in said.out
    assert "odd/manifest.json: damaged, cannot be read: " in said.err and "Traceback" not in said.err

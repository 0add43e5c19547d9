"""`sheetbench report`, a folder's studies as one page in a browser and as text; its viewer of sheets."""

import hashlib
import json
import re
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import browser, colours, opened, pixels  # noqa: F401
from commands import run

from comparisons.comparison.comparison import compare
from comparisons.models.spec import Lattice
from comparisons.pages import sheets
from comparisons.pages.page import page as page_of
from comparisons.pages.sheets import own_text
from comparisons.pages.studies import read, tables
from comparisons.pictures.plan import plan_mesh
from comparisons.sweep.folder import Folder
from sheetbench.answers.report import Report
from sheetbench.answers.solution import FieldMesh
from sheetbench.answers.table import Column, Table, unit
from sheetbench.scenes import EdgeLoad, PointLoad, Pressure, load

SOURCE = Path(sheets.__file__).parent / "source"
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
    path.write_text(page_of(read(studies), f"Report {EVIL}"), encoding="utf-8")
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
    assert ("No browser was found" in capsys.readouterr().err) is not there


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


# ---- the viewer
def test_bundle_is_of_the_source_that_is_here():
    """`make viewer` writes the digest of the source into the bundle's first line: run it after a change."""
    digest = hashlib.sha256()
    for path in sorted(p for p in SOURCE.iterdir() if p.suffix in (".js", ".mjs", ".json")):
        digest.update(f"{path.name}\0".encode() + path.read_bytes() + b"\0")
    assert own_text("viewer.js").startswith(f"/* source {digest.hexdigest()} */")


def test_bundle_is_small_asks_for_nothing_and_says_whose_it_is():
    script = own_text("viewer.js")
    assert len(script) < 700_000 and "</script" not in script.lower()
    assert "three.js" in script[:200] and "Permission is hereby granted" in script
    assert not re.search(r"\beval\(|new Function\(|importScripts|XMLHttpRequest", script)
    lock = json.loads((SOURCE / "package-lock.json").read_text())
    assert not any("resolved" in package for package in lock["packages"].values())


def test_bricks_show_their_outer_faces_alone():
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1, 2)], dtype=float)
    bricks = np.array([[0, 1, 4, 3, 6, 7, 10, 9], [1, 2, 5, 4, 7, 8, 11, 10]])
    mesh = FieldMesh(corners, [("hexahedron", bricks)], {"displacement": np.zeros((12, 3))})
    assert len(sheets._find_quads(mesh)) == 10


@pytest.mark.parametrize(("cells", "lines"), [(1, 2), (8, 9), (64, 9), (256, 9), (257, 258)])
def test_a_fine_regular_surface_shows_its_shape_by_nine_lines(cells, lines):
    """Up to four cells in one of the finest picture; with more lines the mesh is no regular one."""
    x, y = np.meshgrid(np.arange(cells + 1.0), [0.0, 1.0])
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    first = np.arange(cells)[:, None]
    mesh = FieldMesh(
        points, [("quad", first + np.array([0, 1, cells + 2, cells + 1]))], {"displacement": 0.0 * points}
    )
    sides = points[sheets._find_sides(mesh)]
    assert len(np.unique(sides[sides[:, 0, 0] == sides[:, 1, 0], 0, 0])) == lines


def options():
    """Two sheets of 8 × 8 cells, one of which moves, and a lattice of two masses a side."""
    scene = load("two-edges-clamped")
    flat = plan_mesh(scene, 8)
    bent = np.zeros_like(flat.points)
    bent[:, 2] = -0.02 * (flat.points[:, 0] * flat.points[:, 1]) / 0.188**2
    flat.point_data["displacement"] = bent
    square = plan_mesh(scene, 1)
    square.point_data["displacement"] = np.zeros((4, 3))
    links = [("line", np.array([[0, 1], [1, 3], [3, 2], [2, 0], [0, 3]]))]
    lattice = FieldMesh(square.points, links, square.point_data)
    off = sheets.field("difference", "Difference", bent[:, 2], "mm", 1e3)
    moving = [(0.1 * i, 0.5 * i * bent) for i in range(3)]
    shown = [
        sheets.viewer_sheet("lattice", lattice, "Lattice", scene=scene),
        sheets.viewer_sheet("shell", flat, "Shell", [off], scene),
        sheets.viewer_sheet("motion", flat, "Motion", frames=moving),
    ]
    views = [
        {"name": "shell", "label": "Shell", "sheets": ["shell"], "field": "displacement"},
        {"name": "off", "label": "Difference", "sheets": ["shell"], "field": "difference"},
        {"name": "both", "label": "Both", "sheets": ["shell", "lattice"]},
        {"name": "motion", "label": "Motion", "sheets": ["motion"]},
    ]
    eye = sheets.eye(scene)
    return {"sheets": shown, "views": views, "outline": sheets.outline(scene), "from": eye}


@pytest.fixture(scope="module")
def page(browser, tmp_path_factory):  # noqa: F811
    path = tmp_path_factory.mktemp("viewer") / "page.html"
    policy = "default-src 'none'; script-src 'nonce-a'; style-src 'nonce-a'; img-src data:"
    path.write_text(
        f'<!doctype html><meta charset="utf-8"><meta http-equiv="Content-Security-Policy" content="{policy}">'
        f'<style nonce="a">{own_text("viewer.css")}</style><div id="here"></div>'
        f'<script nonce="a">{own_text("viewer.js")}'
        f"</script><script nonce='a'>var view = Sheets.createViewer(document.getElementById('here'), "
        f"{json.dumps(options())});</script>",
        encoding="utf-8",
    )
    with opened(browser, path.as_uri()) as (shown, watch):
        yield shown
        assert watch.troubles == [] and watch.requests == [path.as_uri()]


def test_it_draws_and_turns_by_key_and_by_mouse(page):
    canvas = page.locator(VIEW)
    box = canvas.bounding_box()

    def changed(before, after):
        return (np.abs(after - before) > 20).any(axis=2).mean() > 0.01

    first = pixels(page, VIEW)
    assert colours(first) > 100
    canvas.focus()
    page.keyboard.press("ArrowLeft")
    turned = pixels(page, VIEW)
    page.mouse.move(box["x"] + 300, box["y"] + 200)
    page.mouse.down()
    page.mouse.move(box["x"] + 380, box["y"] + 220, steps=3)
    page.mouse.up()
    assert changed(first, turned) and changed(turned, pixels(page, VIEW))
    page.get_by_role("button", name="Reset view").click()
    assert not changed(first, pixels(page, VIEW))


def test_arrows_of_point_loads():
    scene = load("two-edges-clamped")
    mesh = plan_mesh(scene, 4)

    def forces(*loads):
        points = [PointLoad(at=at, force=(0, 0, force)) for at, force in loads]
        return sheets.forces(mesh.points, np.zeros_like(mesh.points), scene.replace(loads=points))

    weak, strong = forces(((0.1, 0.1), 1e-4), ((0.188, 0.09), -2.0))
    assert strong["at"] == [0.188, 0.09, 0.0] and strong["along"] == pytest.approx([0, 0, -0.16 * 0.188])
    assert weak["along"] == pytest.approx([0, 0, 0.4 * 0.16 * 0.188])
    assert mesh.points[strong["point"]][:2] == pytest.approx([0.188, 0.094])
    assert forces() == forces(((0.1, 0.1), 0)) == []


def test_arrows_of_edge_loads_and_pressures():
    """Along the edge; all over the sheet, along the normal that it has where it is turned about y."""
    scene, turn, size = load("two-edges-clamped"), 0.7, 0.188
    mesh = plan_mesh(scene, 4)
    x = mesh.points[:, 0]
    turned = np.column_stack([x * (np.cos(turn) - 1.0), np.zeros_like(x), x * np.sin(turn)])
    pulled = EdgeLoad("x1", force_per_length=(3.0, 0.0, 0.0))
    found = sheets.forces(mesh.points, turned, scene.replace(loads=(pulled, Pressure(-5.0))))
    along_edge, pressed = found[:5], found[5:]
    assert [one["at"][:2] for one in along_edge] == [[size, 0.25 * n * size] for n in range(5)]
    assert all(one["along"] == pytest.approx([0.1 * size, 0.0, 0.0]) for one in along_edge)
    expected = 0.08 * size * np.array([np.sin(turn), 0.0, -np.cos(turn)])
    assert len(pressed) == 16 and all(one["along"] == pytest.approx(expected, abs=1e-9) for one in pressed)
    moment = scene.replace(loads=(EdgeLoad("x1", moment_per_length=1.0),))
    assert sheets.forces(mesh.points, turned, moment) == []


def test_views_fields_and_what_is_under_the_pointer(page):
    page.get_by_label("Show", exact=True).select_option("off")
    assert page.locator(".sv-legend-title").text_content() == "Difference [mm]"
    assert "−20" in page.locator(".sv-ticks").text_content()
    page.get_by_label("Colour").select_option("uz")
    assert page.locator(".sv-legend-title").text_content() == "Displacement uz [mm]"
    box = page.locator(VIEW).bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    said = page.locator(".sv-under").text_content()
    assert re.search(r"Shell at [\d., ]+ mm: moved 0, 0, −[\d.]+ mm", said)

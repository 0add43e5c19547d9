"""The viewer of sheets in a browser: it is built from its source, draws, turns, colours, moves, plays."""

import hashlib
import json
import re
from pathlib import Path

import numpy as np
import pytest
from browser import browser, colours, opened, pixels  # noqa: F401

from comparisons.pages import sheets
from comparisons.pages.sheets import own_text
from comparisons.pictures.plan import plan_mesh
from sheetbench.answers.solution import FieldMesh
from sheetbench.scenes import EdgeLoad, PointLoad, Pressure, load

SOURCE = Path(sheets.__file__).parent / "source"


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
    assert len(sheets._quads(mesh)) == 10


@pytest.mark.parametrize(("cells", "lines"), [(1, 2), (8, 9), (64, 9), (256, 9), (257, 258)])
def test_a_fine_regular_surface_shows_its_shape_by_nine_lines(cells, lines):
    """Up to four cells in one of the finest picture; with more lines the mesh is no regular one."""
    x, y = np.meshgrid(np.arange(cells + 1.0), [0.0, 1.0])
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    first = np.arange(cells)[:, None]
    mesh = FieldMesh(
        points, [("quad", first + np.array([0, 1, cells + 2, cells + 1]))], {"displacement": 0.0 * points}
    )
    sides = points[sheets._shape_lines(mesh)]
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
    canvas = page.locator("canvas[tabindex]")
    box = canvas.bounding_box()

    def changed(before, after):
        return (np.abs(after - before) > 20).any(axis=2).mean() > 0.01

    first = pixels(page, "canvas[tabindex]")
    assert colours(first) > 100
    canvas.focus()
    page.keyboard.press("ArrowLeft")
    turned = pixels(page, "canvas[tabindex]")
    page.mouse.move(box["x"] + 300, box["y"] + 200)
    page.mouse.down()
    page.mouse.move(box["x"] + 380, box["y"] + 220, steps=3)
    page.mouse.up()
    assert changed(first, turned) and changed(turned, pixels(page, "canvas[tabindex]"))
    page.get_by_role("button", name="Reset view").click()
    assert not changed(first, pixels(page, "canvas[tabindex]"))


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
    box = page.locator("canvas[tabindex]").bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    said = page.locator(".sv-under").text_content()
    assert re.search(r"Shell at [\d., ]+ mm: moved 0, 0, −[\d.]+ mm", said)

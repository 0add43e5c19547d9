"""`sheetbench view`: of a scene and of a folder, in one page for the browser and in a window."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import browser, colours, opened, pixels  # noqa: F401
from commands import one_line, run

import sheetbench as sb
from comparisons.browser.sheets import packed
from comparisons.motion.frames import frames, write_series
from comparisons.report.offscreen import why_not
from comparisons.view import staged
from comparisons.view.page import page
from comparisons.view.window import Window, display_there, unpacked


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A comparison and a motion, each in a folder of its own."""
    place = tmp_path_factory.mktemp("view")
    (place / "both").mkdir()
    both = sb.compare("one-edge-clamped", grid=3, elements=2, uncertainty=False)
    for name, write in both.report().files().items():
        if name.endswith(".vtu"):
            write(place / "both" / name)
    run = sb.simulate("two-edges-settling", 0.02, grid=3, every=0.004, frames=5)
    (place / "run").mkdir()
    write_series(place / "run" / "frames.pvd", frames(run))
    return place


def test_a_scene_shows_both_models_and_their_difference() -> None:
    both = sb.compare("one-edge-clamped", grid=3, elements=2, calibration="consistent", uncertainty=False)
    shown = staged.of_comparison(both)
    assert [view["label"] for view in shown.options["views"]] == [
        "lumped and shell",
        "lumped",
        "shell",
        "Difference: lumped",
    ]
    assert shown.options["views"][0]["field"] == "uz"  # as in the picture of compare
    lattice = next(sheet for sheet in shown.options["sheets"] if sheet["name"] == "lumped")
    moved = both.solutions[0].mesh.point_data["displacement"]
    np.testing.assert_allclose(unpacked(lattice["displacement"]), moved.ravel(), rtol=1e-6, atol=1e-9)
    off = next(sheet for sheet in shown.options["sheets"] if sheet["name"] == "difference")
    field = next(one for one in off["fields"] if one["name"] == "difference")
    assert field["kind"] == "difference"
    corner = np.array([[*both.scene.sheet.lengths]])
    apart = np.linalg.norm(both.solutions[0].displacement(corner) - both.solutions[1].displacement(corner))
    assert unpacked(field["values"])[-1] == pytest.approx(apart, rel=1e-5)


def test_a_folder_shows_what_it_holds(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    capsys.readouterr()
    target = tmp_path / "sheets.html"
    assert run("view", str(folder), "--out", str(target), "--json") == 0
    told = json.loads(capsys.readouterr().out)
    assert told["file"] == str(target) and {"Motion", "lumped", "Difference: lattice"} <= set(told["views"])
    assert "Content-Security-Policy" in target.read_text(encoding="utf-8")


def test_a_folder_without_sheets_and_a_page_of_a_window_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("view", str(tmp_path), "--out", str(tmp_path / "a.html")) == 2
    assert "no sheets there" in one_line(capsys)
    assert run("view", "one-edge-clamped", "--window", "--out", str(tmp_path / "a.html")) == 2
    assert "--window" in one_line(capsys)


def test_text_of_a_scene_stays_text() -> None:
    shown = staged.Staged("</script><b>x", "\x1b[31m<i>", {"sheets": [], "views": []})
    text = page([shown])
    assert "</script><b>" not in text and "<i>" not in text and "\x1b" not in text


@pytest.fixture(scope="module")
def opened_page(browser: Any, folder: Path) -> Any:  # noqa: F811
    shown, troubles = staged.of_folder(folder)
    assert troubles == []
    path = folder / "sheets.html"
    path.write_text(page(shown), encoding="utf-8")
    with opened(browser, path.as_uri()) as found:
        yield found


def test_the_page_draws_and_plays(opened_page: Any) -> None:
    shown, watch = opened_page
    assert shown.inner_text("h1") == "both"
    assert colours(pixels(shown, "canvas")) > 50
    places = "Array.from(viewer.sheets.values().next().value.positions.array)"
    shown.select_option("#study", "1")
    assert shown.inner_text("h1") == "frames.pvd"
    end = shown.evaluate(places)
    shown.evaluate("viewer.setTime(0)")
    assert shown.evaluate(places) != end
    assert watch.troubles == [] and all(url.startswith(("file:", "data:", "blob:")) for url in watch.asked)


def test_the_window_shows_the_views_and_plays(folder: Path) -> None:
    if (said := why_not()) is not None:
        pytest.skip(said)
    shown, _ = staged.of_folder(folder)
    window = Window(shown, off_screen=True)
    assert len(window.times) > 3 and window.plotter.camera.up == (0.0, 0.0, 1.0)
    labels = [view["label"] for one in shown for view in one.options["views"]]
    window.view(labels.index("Difference: lattice"))
    assert colours(window.plotter.screenshot(return_img=True)) > 50
    window.view(labels.index("Motion"))
    end = window.plotter.screenshot(return_img=True)
    window.time(0.0)
    assert not np.array_equal(end, window.plotter.screenshot(return_img=True))
    window.plotter.close()


def test_numbers_come_back_as_they_were_packed() -> None:
    assert unpacked(packed(np.array([[1, 2], [3, 4]]))).tolist() == [1, 2, 3, 4]
    np.testing.assert_allclose(unpacked(packed([0.1, -2.5])), [0.1, -2.5], rtol=1e-7)


def test_a_window_is_for_where_there_is_a_display(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    assert not display_there()
    monkeypatch.setenv("DISPLAY", ":0")
    assert display_there()

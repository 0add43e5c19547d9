"""Pictures for papers: a column's width, no title, embedded fonts, the same bytes again."""

import json
from dataclasses import replace
from functools import partial

import matplotlib
import numpy as np
import pytest
from commands import run
from fake_solutions import history

from comparisons.models.spec import Lattice
from comparisons.modes import figure as swinging
from comparisons.modes.spectra import spectra
from comparisons.sweep.solved import Ask
from comparisons.tradeoff import figure as trading
from comparisons.tradeoff.answer import Tradeoff
from comparisons.tradeoff.row import TradeoffRow
from sheetbench import scenes
from sheetbench.answers import history_figure as moving
from sheetbench.answers.figure_style import PLAIN, WIDTHS, FigureStyle, parse_figure
from sheetbench.answers.style import STYLE, save
from sheetbench.errors import BadInput


@pytest.fixture(scope="module")
def scene():
    return scenes.load("two-edges-clamped")


@pytest.fixture(scope="module")
def composed(scene):
    time = np.linspace(0.0, 1.0, 5)
    moved = {"tip": np.outer(time, [0.0, 0.0, 1e-3])}
    rows = [
        TradeoffRow(
            Ask(scene, Lattice((n, n, 2), "consistent")), "converged", error=0.1 / n,
            row={"cost": {"samples": [1e-3 * n]}},
        )
        for n in (3, 5, 9)
    ]  # fmt: skip
    trade = Tradeoff(scene, tuple(rows), rows[-1], 1e-3, 1e-3)
    swings = spectra(scene, Lattice(3), count=4, reference="plate", elements=2)
    return {
        "history": partial(moving.compose, history(time, moved), scene.title),
        "tradeoff": partial(trading.compose, trade),
        "modes": partial(swinging.compose, swings),
    }


def test_what_a_figure_may_be():
    pdf = FigureStyle(("pdf",), titled=False)
    png = FigureStyle(("png",), narrow=True, titled=False)
    assert parse_figure(None) == (PLAIN,) and not PLAIN.formats
    assert parse_figure("pdf") == (pdf,)
    assert parse_figure("PNG, svg:single") == (replace(png, formats=("png", "svg")),)
    assert parse_figure("pdf:single,png:single") == (replace(png, formats=("pdf",)), png)
    assert parse_figure("png:single, pdf") == parse_figure("png:single,pdf:double") == (png, pdf)
    for wrong in ("", " ,", "eps", "pdf:wide", "pdf;png", "pdf:single,pdf"):
        with pytest.raises(BadInput, match="--figure"):
            parse_figure(wrong)


NAMES = ("history", "tradeoff", "modes")


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", NAMES)
def test_a_paper_has_its_columns_width_units_and_no_title(composed, scene, name):
    with matplotlib.rc_context(STYLE):
        titled, paper = composed[name](PLAIN), composed[name](*parse_figure("pdf:single"))
    assert paper.get_figwidth() == pytest.approx(WIDTHS["single"])
    said = [text.get_text() for text in paper.findobj(matplotlib.text.Text)]
    assert not any(scene.title in text for text in said)
    assert any(scene.title in t.get_text() for t in titled.findobj(matplotlib.text.Text))
    for axis in paper.axes:
        if axis.axison:
            assert "[" in axis.get_xlabel() + axis.get_ylabel()
    paper.draw_without_rendering()
    box = paper.get_tightbbox()
    assert box.width <= paper.get_figwidth() + 0.1


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", ["history", "tradeoff"])
def test_the_same_picture_is_the_same_bytes_with_its_fonts(composed, tmp_path, name):
    files = [tmp_path / f"{name}.{form}" for form in ("pdf", "svg")]
    written = []
    for _ in range(2):
        with matplotlib.rc_context(STYLE):
            save(composed[name](*parse_figure("pdf")), files)
        written.append([path.read_bytes() for path in files])
    assert written[0] == written[1]
    pdf, svg = written[0]
    assert b"/FontFile2" in pdf and b"/Type3" not in pdf and b"CreationDate" not in pdf
    assert b"<text" not in svg and b"dc:date" not in svg


def test_the_option(tmp_path, capsys):
    out = tmp_path / "out"
    arguments = ["modes", "two-edges-clamped", "--grid", "3", "--reference", "plate", "--elements", "2"]
    assert run(*arguments, "--figure", "svg:single,pdf", "--out", str(out)) == 0
    files = json.loads((out / "manifest.json").read_text(encoding="utf-8"))["runs"]["modes"]["files"]
    drawn = {name for name in files if name.endswith((".png", ".pdf", ".svg"))}
    assert drawn == {"modes.svg", "modes.pdf"} and all((out / name).is_file() for name in drawn)
    assert f'width="{72.0 * WIDTHS["single"]:f}pt"' in (out / "modes.svg").read_text(encoding="utf-8")
    assert f"/MediaBox [ 0 0 {72.0 * WIDTHS['double']:.8f}".encode() in (out / "modes.pdf").read_bytes()
    capsys.readouterr()

"""Pictures: plain text, names apart, loads and actuators; for papers widths, fonts, the same bytes."""

import json
from dataclasses import replace
from functools import partial

import matplotlib
import numpy as np
import pytest
from commands import run
from fake_solutions import history, solution
from matplotlib.figure import Figure

from comparisons.comparison import figure as comparing
from comparisons.comparison.answer import Comparison
from comparisons.models.check import check
from comparisons.models.spec import Lattice
from comparisons.modes import figure as swinging
from comparisons.modes.spectra import spectra
from comparisons.pictures import offscreen
from comparisons.pictures.labels import place_labels
from comparisons.pictures.plan import edge_ends, held_lines, load_arrows, plan_lines, plan_mesh, rims
from comparisons.pictures.stage import Stage
from comparisons.sweep.solved import Request
from comparisons.tradeoff import figure as trading
from comparisons.tradeoff.answer import Tradeoff
from comparisons.tradeoff.row import TradeoffRow
from sheetbench.answers import history_figure as moving
from sheetbench.answers import style
from sheetbench.answers.figure_style import PLAIN, WIDTHS, FigureStyle, parse_figure
from sheetbench.answers.style import STYLE, plain, save
from sheetbench.errors import BadInput
from sheetbench.scenes import load

SCENE = load("two-edges-clamped")
HOSTILE = "T $\\foo$ \x1b[31m _x^y\n$"


@pytest.mark.parametrize("suffix", ["png", "pdf", "svg"])
def test_text_of_a_scene_is_no_mathematics(tmp_path, suffix):
    figure = Figure()
    figure.suptitle(plain(HOSTILE, width=10))
    with matplotlib.rc_context(STYLE):
        save(figure, [tmp_path / f"a.{suffix}"])
    assert [path.name for path in tmp_path.iterdir()] == [f"a.{suffix}"]
    assert "\x1b" not in plain(HOSTILE)


def test_labels_of_near_points_do_not_overlap():
    figure = Figure(figsize=(7.2, 3.0))
    axis = figure.add_axes((0.0, 0.0, 1 / 3, 1.0))
    axis.imshow(np.zeros((1200, 1000)))
    near = np.array([[500.0, 600.0], [506.0, 603.0], [510.0, 598.0], [985.0, 600.0]])
    place_labels(axis, near, ["one", "two", "three", "a name that is far too long for a panel"])
    figure.draw_without_rendering()
    boxes = [text.get_window_extent() for text in axis.texts]
    panel = axis.get_window_extent()
    assert all(box.x0 >= panel.x0 and box.x1 <= panel.x1 for box in boxes)
    for i, first in enumerate(boxes):
        assert not any(first.overlaps(second) for second in boxes[i + 1 :])


DISC = {"circle": {"centre": (0.1, 0.1), "radius": 0.03}}
SPOT = {"circle": {"centre": (0.03, 0.15), "radius": 0.02}}
GRIP = {"rectangle": {"x": (0.16, 0.2), "y": (0.15, 0.2)}}
BARE = load("one-edge-clamped").replace(probes={})
DRAWN = BARE.replace(
    cutouts=[{"shape": DISC}, {"shape": {"rectangle": {"x": (0.15, 0.2), "y": (0.0, 0.05)}}}],
    loads=[
        {"kind": "pressure", "value": 1.0},
        {"kind": "area", "force_per_area": (0.0, 0.0, -1.0), "where": SPOT},
        {"kind": "edge", "edge": "x1", "force_per_length": (1.0, 0.0, 0.0)},
    ],
    supports=[*BARE.supports, {"kind": "clamped", "where": GRIP}],
)  # fmt: skip


def area(mesh):
    corners = mesh.points[mesh.cells[0][1]][:, :, :2]
    a, b = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    up = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    assert np.all(up >= 0.0)
    return up.sum()


def test_all_that_is_drawn_lies_on_the_sheet():
    import shapely

    near = DRAWN.region.buffer(1e-9)
    mesh = plan_mesh(DRAWN, 32)
    assert area(mesh) == pytest.approx(DRAWN.region.area, rel=0.01)
    starts, arrows = load_arrows(DRAWN, lambda points: np.tile([0.0, 0.0, 1.0], (len(points), 1)))
    ends = np.array(edge_ends(DRAWN, "x1")).reshape(-1, 2)
    drawn = [mesh.points, starts, ends, *plan_lines(DRAWN, 8), *rims(DRAWN)]
    drawn += [line for support in DRAWN.supports for line in held_lines(DRAWN, support)]
    assert len(rims(DRAWN)) == 2 and len(starts) == len(arrows)
    for points in drawn:
        assert shapely.intersects_xy(near, points[:, 0], points[:, 1]).all()
    assert ends[:, 1].tolist() == [0.05, 0.188]


def test_check_draws_the_plan_of_any_scene():
    """The sheet with its hole, and what is held, loaded and probed; as many patches as the scene has."""
    patched = DRAWN.replace(patches=[{"shape": GRIP, "young": 1e6}])
    for scene, labels in ((BARE, set()), (patched, {"patch 1", "support 2", "load 2"})):
        axis = check(scene).figures()[0].figure().axes[0]
        texts = {text.get_text() for text in axis.texts}
        assert texts >= labels | set(scene.probes)
        assert axis.patches[0].get_path().vertices.max() == pytest.approx(188.0)


@pytest.fixture(scope="module")
def composed():
    time = np.linspace(0.0, 1.0, 5)
    moved = {"tip": np.outer(time, [0.0, 0.0, 1e-3])}
    rows = [
        TradeoffRow(
            Request(SCENE, Lattice((n, n, 2), "consistent")), "converged", error=0.1 / n,
            row={"cost": {"samples": [1e-3 * n]}},
        )
        for n in (3, 5, 9)
    ]  # fmt: skip
    trade = Tradeoff(SCENE, tuple(rows), rows[-1], 1e-3, 1e-3)
    swings = spectra(SCENE, Lattice(3), count=4, reference="plate", elements=2)
    return {
        "history": partial(moving.compose, history(time, moved), SCENE.title),
        "tradeoff": partial(trading.compose, trade),
        "modes": partial(swinging.compose, swings),
    }


def test_what_a_figure_may_be():
    pdf = FigureStyle(("pdf",), titled=False)
    png = FigureStyle(("png",), narrow=True, titled=False)
    assert parse_figure(None) == (PLAIN,) and not PLAIN.formats
    assert parse_figure("pdf") == (pdf,)
    assert parse_figure("PNG, svg:single") == (replace(png, formats=("png", "svg")),)
    assert parse_figure("pdf:single,png:single") == (replace(png, formats=("pdf", "png")),)
    assert parse_figure("png:single, pdf") == parse_figure("png:single,pdf:double") == (png, pdf)
    for wrong in ("", " ,", "eps", "pdf:wide", "pdf;png", "pdf:single,pdf"):
        with pytest.raises(BadInput, match="--figure"):
            parse_figure(wrong)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", ["history", "tradeoff", "modes"])
def test_a_paper_has_its_columns_width_units_and_no_title(composed, name):
    with matplotlib.rc_context(STYLE):
        titled, paper = composed[name](PLAIN), composed[name](*parse_figure("pdf:single"))
    assert paper.get_figwidth() == pytest.approx(WIDTHS["single"])
    said = [text.get_text() for text in paper.findobj(matplotlib.text.Text)]
    assert not any(SCENE.title in text for text in said)
    assert any(SCENE.title in t.get_text() for t in titled.findobj(matplotlib.text.Text))
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


def test_figure_option_sets_formats_and_widths(tmp_path, capsys):
    out = tmp_path / "out"
    arguments = ["modes", "two-edges-clamped", "--grid", "3", "--reference", "plate", "--elements", "2"]
    assert run(*arguments, "--figure", "svg:single,pdf", "--out", str(out)) == 0
    files = json.loads((out / "manifest.json").read_text(encoding="utf-8"))["runs"]["modes"]["files"]
    drawn = {name for name in files if name.endswith((".png", ".pdf", ".svg"))}
    assert drawn == {"modes.svg", "modes.pdf"} and all((out / name).is_file() for name in drawn)
    assert f'width="{72.0 * WIDTHS["single"]:f}pt"' in (out / "modes.svg").read_text(encoding="utf-8")
    assert f"/MediaBox [ 0 0 {72.0 * WIDTHS['double']:.8f}".encode() in (out / "modes.pdf").read_bytes()
    capsys.readouterr()


@pytest.mark.skipif(bool(offscreen.unavailable_reason()), reason="needs to draw off screen")
def test_a_comparison_of_a_sheet_that_hangs_low_fits_a_column(monkeypatch):
    monkeypatch.setattr(style, "PIXELS", 60)
    found = Comparison(SCENE, tuple(solution(SCENE, name, -0.5) for name in ("lumped", "shell")))
    with matplotlib.rc_context(STYLE):
        drawn = comparing.compose(found, *parse_figure("pdf:single"))
    assert 25.4 * drawn.get_figheight() < 220.0  # mm of a page
    assert comparing.DIFFERENCES(1.0)[0] > 0.2  # names of probes are read on it


@pytest.mark.skipif(bool(offscreen.unavailable_reason()), reason="needs to draw off screen")
def test_the_camera_sees_an_obstacle_and_no_box_about_it():
    scene = load("napkin-on-ball")
    stage = Stage(scene, solution(scene), 1.0, 60)
    (ball,) = scene.obstacles
    from_middle = np.linalg.norm(stage.obstacles() - np.array(ball.position), axis=1)
    stage.plotter.close()
    assert from_middle == pytest.approx(ball.radius, rel=1e-3)

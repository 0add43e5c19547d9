"""Pictures: text of scenes is no mathematics, names do not overlap, loads and actuators are seen."""

import matplotlib
import numpy as np
import pytest
from matplotlib.figure import Figure

from comparisons.models.check import check
from comparisons.pictures.labels import place_labels
from comparisons.pictures.plan import (
    edge_ends,
    held_lines,
    load_arrows,
    plan_lines,
    plan_mesh,
    rims,
)
from sheetbench.answers.style import STYLE, plain, save
from sheetbench.scenes import load

HOSTILE = "T $\\foo$ \x1b[31m _x^y\n$"


@pytest.mark.parametrize("suffix", ["png", "pdf", "svg"])
def test_text_of_a_scene_is_no_mathematics(tmp_path, suffix):
    figure = Figure()
    figure.suptitle(plain(HOSTILE, width=10))
    with matplotlib.rc_context(STYLE):
        save(figure, [tmp_path / f"a.{suffix}"])
    assert [path.name for path in tmp_path.iterdir()] == [f"a.{suffix}"]
    assert "\x1b" not in plain(HOSTILE)


def test_names_of_near_points_stand_apart():
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
PLAIN = load("one-edge-clamped").replace(probes={})
DRAWN = PLAIN.replace(
    cutouts=[{"shape": DISC}, {"shape": {"rectangle": {"x": (0.15, 0.2), "y": (0.0, 0.05)}}}],
    loads=[
        {"kind": "pressure", "value": 1.0},
        {"kind": "area", "force_per_area": (0.0, 0.0, -1.0), "where": SPOT},
        {"kind": "edge", "edge": "x1", "force_per_length": (1.0, 0.0, 0.0)},
    ],
    supports=[*PLAIN.supports, {"kind": "clamped", "where": GRIP}],
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
    for scene, labels in ((PLAIN, set()), (patched, {"patch 1", "support 2", "load 2"})):
        axis = check(scene).plot("plan").axes[0]
        texts = {text.get_text() for text in axis.texts}
        assert texts >= labels | set(scene.probes)
        assert axis.patches[0].get_path().vertices.max() == pytest.approx(188.0)

"""The plan of a drawn scene in pictures: mesh, lines, rims, what is held and loaded."""

import numpy as np
import pytest

from comparisons.models.check import check
from comparisons.pictures.plan import (
    edge_ends,
    held_lines,
    load_arrows,
    on_sheet,
    plan_lines,
    plan_mesh,
    rims,
)
from sheetbench.scenes import load

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


def test_a_rectangle_is_drawn_as_it_was():
    mesh = plan_mesh(PLAIN, 4)
    assert (
        area(mesh) == pytest.approx(0.188**2)
        and len(mesh.points) == 25
        and len(plan_lines(PLAIN, 4)) == 10
        and len(rims(PLAIN)) == 1
    )
    assert on_sheet(PLAIN, np.array([[-1.0, 0.1]])).tolist() == [[0.0, 0.1]]


def test_check_draws_the_plan_of_any_scene():
    """The sheet with its hole, and what is held, loaded and probed; as many patches as the scene has."""
    patched = DRAWN.replace(patches=[{"shape": GRIP, "young": 1e6}])
    for scene, labels in ((PLAIN, set()), (patched, {"patch 1", "support 2", "load 2"})):
        axis = check(scene).plot("plan").axes[0]
        texts = {text.get_text() for text in axis.texts}
        assert texts >= labels | set(scene.probes)
        assert axis.patches[0].get_path().vertices.max() == pytest.approx(188.0)

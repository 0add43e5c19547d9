"""Outlines, cutouts and shapes that say where: the plan of a sheet, and what is refused."""

import numpy as np
import pytest
import shapely

from sheetbench.answers.balance import dead_force
from sheetbench.scenes import BadInput, Clamped, Scene, SceneError, Sheet, free_rigid_motions
from sheetbench.scenes.meaning.composition import mass_of, shares_of
from sheetbench.scenes.meaning.region import edge_length
from sheetbench.scenes.meaning.words import in_words

FIN = [(0.0, 0.0), (0.2, 0.02), (0.2, 0.08), (0.0, 0.1)]
HOLE = {"shape": {"circle": {"centre": (0.1, 0.05), "radius": 0.02}}}
ROOT = {"kind": "clamped", "where": {"rectangle": {"x": (0.0, 0.02), "y": (0.0, 0.1)}}}
DISC = {"circle": {"centre": (0.17, 0.05), "radius": 0.02}}
CORNER = {"rectangle": {"x": (0.19, 0.2), "y": (0.09, 0.1)}}
AREA = 0.2 * 0.1 - 0.2 * 0.02 - np.pi * 0.02**2


def fin(outline=FIN, cutout=(HOLE,), support=(ROOT,), **keys):
    material = {"young": 5e6, "poisson": 0.4, "density": 1000.0}
    sheet = {"length_x": 0.2, "length_y": 0.1, "thickness": 0.003, "outline": outline}
    scene = {"name": "fin", "sheet": sheet, "material": material, "cutout": cutout, "support": support}
    return Scene(**{**scene, **keys})


def test_area_mass_edges_and_weight():
    scene = fin(gravity={"acceleration": (0.0, 0.0, -10.0)})
    assert scene.region.area == pytest.approx(AREA)
    assert scene.shaped_by == "sheet.outline, cutout, support.where"
    assert scene.uniform and scene.drawn_by == scene.shaped_by
    assert mass_of(scene) == pytest.approx(3.0 * AREA)
    assert [edge_length(scene, edge) for edge in ("x0", "x1")] == pytest.approx([0.1, 0.06])
    assert dead_force(scene)[2] == pytest.approx(-30.0 * AREA)
    x, y = np.linspace(0.0, 0.2, 7), np.linspace(0.0, 0.1, 4)
    assert np.diff(y) @ shares_of(scene.region, x, y) @ np.diff(x) == pytest.approx(AREA)
    drawn = scene.replace(patches=[{"shape": DISC, "density": 3e3}], cutouts=())  # a third of it beyond x1
    assert mass_of(drawn) > mass_of(scene.replace(cutouts=()))


def test_loads_on_a_part_count_what_of_it_is_sheet():
    half = {"rectangle": {"x": (0.15, 0.2), "y": (0.05, 0.2)}}
    scene = fin(
        load=[
            {"kind": "area", "force_per_area": (0.0, 2.0, 0.0), "where": half},
            {"kind": "pressure", "value": 5.0, "where": DISC},
        ]
    )
    part = 0.05 * (0.035 + 0.03) / 2.0
    assert dead_force(scene) == pytest.approx([0.0, 2.0 * part, 0.0])
    words = dict(in_words(scene))
    assert words["load 1"].endswith("in the rectangle 150 ≤ x ≤ 200, 50 ≤ y ≤ 200 mm")
    assert words["load 2"].startswith("pressure of 5 Pa") and "0.00628 N" in words["load 2"]
    assert "a polygon of 4 corners in it, 147.4 cm² in all" in words["sheet"]
    assert words["support 1"].endswith("everywhere in the rectangle 0 ≤ x ≤ 20, 0 ≤ y ≤ 100 mm")


def test_probes_nobody_chose_lie_on_the_sheet():
    scene = fin()
    region = scene.region.buffer(1e-9)
    assert all(region.contains_properly(shapely.Point(place)) for place in scene.probes.values())
    assert scene.probes["P1"] != (0.1, 0.05) and fin(cutout=()).probes["P1"] == (0.1, 0.05)


def test_what_a_shape_holds_stops_motions():
    assert free_rigid_motions(fin()) == []
    held = {"kind": "held", "components": ["z"], "where": DISC}
    free = ["translation along x", "translation along y", "rotation about z"]
    assert free_rigid_motions(fin(support=[held])) == free


@pytest.mark.parametrize(
    ("drawn", "said"),
    [
        ({"outline": [(0, 0), (0.2, 0.1), (0.2, 0.0), (0.0, 0.1)]}, "sheet.outline: its sides cross"),
        ({"outline": [(0, 0), (0.1, 0.0), (0.1, 0.1)]}, "outline: .* 0 ≤ x ≤ 0.1 m; .* length_x = 0.2 m"),
        ({"cutout": [{"shape": CORNER}]}, "cutout 1.shape: rectangle .*: no part of it is on what is left"),
        ({"cutout": [HOLE, HOLE]}, "cutout 2.shape: circle .* no part"),
        (
            {"cutout": [{"shape": {"rectangle": {"x": (0.1, 0.11), "y": (0.0, 0.1)}}}]},
            "cutout: they leave 2 parts",
        ),
        (
            {"cutout": [{"shape": {"polygon": [(0.1, 0.0), (0.1, 0.05), (0.15, 0.0)]}},
                        {"shape": {"polygon": [(0.1, 0.1), (0.1, 0.05), (0.05, 0.1)]}}]},
            "cutout: they leave 2 parts that are connected at points",
        ),
        ({"cutout": [{"shape": {"rectangle": {"x": (0, 0.2), "y": (0, 0.1)}}}]}, "they leave no part"),
        ({"support": [{**ROOT, "where": CORNER}]}, "support 1.where: rectangle .* no part of it"),
        ({"support": [{**ROOT, "edge": "x0"}]}, "needs one of edge and where"),
        ({"support": [{"kind": "clamped"}]}, "needs one of edge and where"),
        ({"support": [{**ROOT, "tilt": 0.1}]}, "tilt = 0.1 rad"),
        ({"support": [{"kind": "curved", "curvature": 1.0, "where": DISC}]}, "where"),
        ({"support": [{"kind": "clamped", "edge": "y0"}]}, "support on edge y0: the sheet touches"),
        ({"load": [{"kind": "edge", "edge": "y1", "force_per_length": (0, 0, 1)}]}, "load 1 on edge y1"),
        ({"load": [{"kind": "point", "at": (0.1, 0.05), "force": (0, 0, 1)}]}, r"load 1.at = \[0.1, 0.05\]"),
        ({"load": [{"kind": "pressure", "value": 1.0, "where": CORNER}]}, "load 1.where: "),
        ({"probes": {"P": (0.2, 0.1)}}, r"probes.P = \[0.2, 0.1\] m: there is no sheet"),
        (
            {"support": [ROOT, {**ROOT, "motion": {"time": [0, 1], "displacement": [[0, 0, 0], [0, 0, 1]]}}]},
            "support 1 and support 2 move the same part",
        ),
        (
            {"actuator": [{"kind": "motion", "edge": "x1", "time": [0.0, 1.0],
                           "displacement": [[0, 0, 0], [0, 0, 1]], "rotation": [[0, 0, 0], [0, 0, 0]]}]},
            "actuator 1: the sheet does not reach all of edge x1",
        ),
    ],
)  # fmt: skip
def test_what_is_no_sheet_is_refused(drawn, said):
    with pytest.raises(SceneError, match=said):
        fin(**drawn)


def test_a_rectangle_as_outline_is_the_rectangle():
    corners = [(0.0, 0.0), (0.2, 0.0), (0.2, 0.1), (0.0, 0.1)]
    scene = fin(outline=corners, cutout=(), support=[{"kind": "clamped", "edge": "x0"}])
    assert scene.region.area == pytest.approx(0.02) and scene.probes == fin(None, (), scene.supports).probes
    with pytest.raises(BadInput, match="outline"):
        Sheet(0.2, 0.1, 0.003, outline=corners[:2])


def test_a_support_where_a_shape_says_is_replaced_as_one_at_an_edge():
    bolt = Clamped(where={"circle": {"centre": (0.05, 0.05), "radius": 0.01}})
    wider = {"circle": {"centre": (0.05, 0.05), "radius": 0.02}}
    assert bolt.replace(where=wider) == Clamped(where=wider)
    assert bolt.replace(edge="x0", where=None) == Clamped("x0")

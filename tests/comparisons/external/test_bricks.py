"""A sheet of bricks, what holds it and what acts on it, as other people's programs are given them."""

import numpy as np
import pytest

from comparisons.external.bricks import Bricks, forces, held, materials
from comparisons.external.calculix.model import deck
from comparisons.external.kratos.model import Triangles, problem
from fem_reference.surface.biquadratic import areas
from fem_reference.surface.mesh import nodes_of
from sheetbench.scenes import Clamped, EdgeLoad, Hinged, PointLoad, Sheet, load
from sheetbench.scenes.meaning.composition import mass_of

SEED = load("two-edges-clamped")


@pytest.fixture(scope="module")
def bricks():
    return Bricks.of(SEED, 4, 2, "edges")


def test_the_mid_surface_of_a_quadratic_field_is_sampled_exactly(bricks):
    def field(at):
        x, y = at[:, 0], at[:, 1]
        return np.column_stack([x * y, x**2 - 3 * y, 2 * y**2 + x + 1])

    points = np.random.default_rng(1).uniform(0.0, 0.188, (50, 2))
    nodes, weights = bricks.weights(points)
    sampled = np.einsum("pk,pkc->pc", weights, field(bricks.positions)[nodes])
    np.testing.assert_allclose(sampled, field(points), atol=1e-14)


def test_forces_add_up_and_act_where_they_should(bricks):
    triangles = Triangles.of(SEED.sheet, 4)
    point = PointLoad(at=(0.11, 0.07), force=(1.0, 2.0, 3.0))
    line = EdgeLoad(edge="x1", force_per_length=(0.0, 0.0, 5.0))
    for load_, total, at in (
        (point, (1.0, 2.0, 3.0), (0.11, 0.07)),
        (line, (0.0, 0.0, 5.0 * 0.188), (0.188, 0.094)),
    ):
        scene = SEED.model_copy(update={"loads": (load_,)})
        pull = forces(scene, bricks)
        np.testing.assert_allclose(pull.sum(axis=0), total, atol=1e-12)
        middle = pull[:, 2] @ bricks.positions / pull[:, 2].sum()
        np.testing.assert_allclose(middle, (*at, 0.0), atol=1e-12)
        np.testing.assert_allclose(problem(scene, triangles, np.ones(1))["force"].sum(axis=0), total)
    first, *others = np.moveaxis(triangles.positions[triangles.elements], 1, 0)
    twice = np.cross(*(other - first for other in others))[:, 2]
    assert twice.min() > 0.0 and twice.sum() / 2.0 == pytest.approx(0.188**2)


DISC = {"circle": {"centre": (0.12, 0.12), "radius": 0.03}}
ROOT = {"rectangle": {"x": (0.0, 0.05), "y": (0.0, 0.188)}}
FIBRES = {"kind": "orthotropic", "young_1": 9e6, "young_2": 3e6, "poisson_12": 0.3, "shear_12": 1e6,
          "angle": 0.3, "density": 1000.0}  # fmt: skip
DRAWN = SEED.replace(
    sheet=Sheet(
        0.188, 0.188, 0.003, outline=[(0, 0), (0.188, 0.03), (0.188, 0.16), (0, 0.188)], taper_x=(3e-3, 1e-3)
    ),
    material=FIBRES,
    cutouts=[{"shape": {"circle": {"centre": (0.05, 0.09), "radius": 0.02}}}],
    patches=[
        {"shape": DISC, "angle": -0.4},
        {"shape": ROOT, "young": 2e6, "poisson": 0.3, "density": 2000.0},
    ],
    supports=(Clamped(edge="x0"), Hinged(where={"circle": {"centre": (0.15, 0.07), "radius": 0.01}})),
    loads=[
        {"kind": "area", "force_per_area": (0.0, 3.0, 1.0), "where": DISC},
        {"kind": "pressure", "value": 20.0, "where": DISC},
        {"kind": "pressure", "value": 4.0},
    ],
)  # fmt: skip


@pytest.fixture(scope="module")
def drawn():
    return Bricks.of(DRAWN, 8, 2, "edges")


def volumes(bricks):
    """Of the bricks, by the plan's and the thickness in their middles."""
    nodes, elements = nodes_of(bricks.plan)
    plan = areas(nodes[elements]).sum(axis=1)
    return np.tile(plan * bricks.taper[elements[:, :8]].mean(axis=1) * 0.003 / bricks.layers, bricks.layers)


def test_bricks_of_a_drawn_sheet_fill_it(drawn):
    corners = drawn.positions[drawn.elements]
    along, across, up = (corners[:, i] - corners[:, 0] for i in (1, 3, 4))
    assert np.all(np.einsum("mc,mc->m", np.cross(along, across), up) > 0.0)
    sides = [drawn.positions[drawn.edge(name), 0] for name in ("x0", "x1")]
    assert np.ptp(sides[0]) == np.ptp(sides[1]) == 0.0
    parts = materials(DRAWN, drawn)
    assert sum(len(on) for _, on in parts) == drawn.plan.nelements == len(drawn.elements) / 2
    assert {(m.kind, m.angle, m.density) for m, _ in parts} == {
        ("orthotropic", 0.3, 1000.0), ("orthotropic", -0.4, 1000.0), ("isotropic", None, 2000.0)
    }  # fmt: skip
    mass = sum(2.0 * m.density * volumes(drawn)[on].sum() for m, on in parts)
    assert mass == pytest.approx(mass_of(DRAWN), rel=2e-3)  # which has tapers in steps of 1/32
    pull = forces(DRAWN, drawn)
    np.testing.assert_allclose(pull.sum(axis=0), np.pi * 0.03**2 * np.array([0.0, 3.0, 1.0]), rtol=1e-3)
    np.testing.assert_allclose(pull[:, 2] @ drawn.positions / pull[:, 2].sum(), (0.12, 0.12, 0.0), atol=1e-4)
    rows = held(DRAWN, drawn)
    assert np.flatnonzero(rows.fixed[:, 0]).tolist() == drawn.edge("x0").tolist()
    bolt = drawn.positions[[tie.nodes[0] for tie in rows.tied], :2] - (0.15, 0.07)
    assert len(bolt) > 20 and np.linalg.norm(bolt, axis=1).max() == pytest.approx(0.01, rel=1e-3)


def test_a_deck_of_a_drawn_sheet_has_its_parts(drawn):
    text = deck(DRAWN, drawn)
    found = {name: text.count(f"*{name}") for name in ("ELSET,", "MATERIAL", "ORIENTATION", "SOLID SECTION")}
    assert found == {"ELSET,": 3, "MATERIAL": 3, "ORIENTATION": 2, "SOLID SECTION": 3}
    assert text.count("ORIENTATION=FIBRES") == 2
    inside = len(drawn.inside(DRAWN.loads[1].where))
    assert text.count(", P1, 12.0\n") == text.count(", P2, -12.0\n") == inside > 5
    assert text.count(", P1, 2.0\n") == drawn.plan.nelements - inside

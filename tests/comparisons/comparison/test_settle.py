"""Sheets that statics do not bring to rest, begun where their motion ends."""

from dataclasses import replace

import numpy as np
import pytest
from commands import one_line, run

import fem_reference
import lumped
from comparisons.comparison.branches import shape
from comparisons.comparison.comparison import compare
from comparisons.comparison.settle import CREEPING, LONG, frequency, shape_after_motion, solved_from_motion
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements, Lattice
from lumped.statics.energy_descent import descend
from sheetbench.numerics.continuation.path import Path
from sheetbench.scenes import Scene

PILLOW = Scene(
    name="pillow",
    sheet={"length_x": 0.1, "length_y": 0.1, "thickness": 0.5e-3},
    material={"young": 200e6, "poisson": 0.3, "density": 1000.0},
    supports=(
        *({"kind": "symmetric", "edge": edge} for edge in ("x0", "y0")),
        *({"kind": "held", "edge": edge, "components": ["z"]} for edge in ("x1", "y1")),
    ),
    loads=({"kind": "pressure", "value": 1e4},),
    probes={"C": (0.0, 0.0)},
)  # the quarter of an upper side, CalculiX-Examples `Pillow`: 44.8 mm with S8R


@pytest.mark.nightly
@pytest.mark.parametrize("masses", [9, 17])
def test_an_inflated_pillow_is_at_rest_where_its_motion_ends(masses):
    """Statics end at 5 to 13 % of the pressure; folds of the rim are of the grid, the middle is not."""
    plain = compare(PILLOW, Lattice(5), elements=2, companion=False)
    assert not plain.succeeded and any("--settle" in line for line in plain.complaints())
    found = compare(PILLOW, Lattice(masses), elements=(masses - 1) // 2, settle=True)
    assert found.succeeded and not found.complaints()
    lattice, shell = (one.displacement([[0.0, 0.0]])[0, 2] for one in found.solutions)
    assert lattice == pytest.approx(shell, rel=0.02) and shell == pytest.approx(44.8e-3, rel=0.04)
    assert [found.branch(one) for one in found.solutions] == ["of motion"] * 2
    assert found.expected is None and found.bar is None


def rag(thickness: float, young: float, density: float) -> Scene:
    """Return a quarter of a rag of 0.5 m and 0.15 kg/m² on a ball of 0.1 m."""
    return Scene(
        name="rag",
        sheet={"length_x": 0.25, "length_y": 0.25, "thickness": thickness},
        material={"young": young, "poisson": 0.3, "density": density},
        gravity={"acceleration": (0.0, 0.0, -9.81)},
        supports=tuple({"kind": "symmetric", "edge": edge} for edge in ("x0", "y0")),
        obstacles=({"kind": "sphere", "position": (0.0, 0.0, -0.1 - 0.5 * thickness), "radius": 0.1},),
        probes={"corner": (0.25, 0.25)},
    )


THIN, THICK = rag(0.3e-3, 3.3e6, 500.0), rag(0.834e-3, 1.187e6, 179.86)  # bending lengths of 18 and 35 mm


def check_lattice(lattice, corner, near):
    """Assert that a lattice's answer is at rest with its corner at a height, and on the ball with its
    weight."""
    assert lattice.status == "converged" and lattice.balance.holds
    assert lattice.displacement([[0.25, 0.25]])[0, 2] == pytest.approx(corner, rel=near)
    assert lattice.reactions["obstacle 1"][2] == pytest.approx(0.15 * 0.25**2 * 9.81, rel=1e-3)


@pytest.mark.nightly
def test_a_descent_ends_where_rounding_is_all_that_is_left():
    """Rounding of the stiff links through the thickness exceeds their estimate in a thin sheet on a ball."""
    springs = lumped.calibrate(THIN.sheet, THIN.material, grid=(5, 5))
    problem = lumped.build_problem(THIN, springs)
    unreached = 1e-14  # of forces: whatever the order of sums leaves is more
    path = Path(problem, problem, problem.rest(), limits=replace(problem.limits, tolerance=unreached))
    path.limit = 2000
    state = descend(path, 1.0)
    residual = problem.residual(state.u, 1.0)
    assert unreached < residual.norm / residual.size < 1e-8
    assert path.factored(path.tangent(state, 1.0)).negative == 0 and path.factorisations < 600


@pytest.mark.nightly
def test_a_thin_rag_is_at_rest_on_a_ball_by_statics():
    """The shell does not reach it, nor from the end of its motion (docs/comparing.md)."""
    check_lattice(solve(resolve(THIN, Lattice(17))), -0.295, 0.02)


@pytest.mark.nightly
def test_a_thick_rag_comes_to_rest_on_a_ball():
    """The lattice of 17 masses leaves the symmetry by rounding. Statics of the shell leave the shape at the
    end of its motion."""
    _, at_rest, fault = shape_after_motion(resolve(THICK, Elements("shell", 8)))
    across, along, corner = at_rest(np.array([[0.125, 0.25], [0.25, 0.125], [0.25, 0.25]]))[:, 2]
    assert not fault and across == pytest.approx(along, rel=1e-6)
    assert corner == pytest.approx(-0.156, rel=0.02)
    lattice = solved_from_motion(resolve(THICK, Lattice(17)), "lattice").answer
    assert "left the shape" not in lattice.message
    check_lattice(lattice, corner, 0.05)


def test_where_statics_lead_alike_nothing_is_changed():
    own, begun = (compare("one-edge-clamped", Lattice(5), elements=4, settle=on) for on in (False, True))
    for one, other in zip(own.solutions[:2], begun.solutions, strict=True):
        points = own.scene.probe_points()
        assert other.displacement(points) == pytest.approx(one.displacement(points), rel=1e-6, abs=1e-9)


def test_a_shell_begun_beside_an_edge_that_holds_the_tilt_keeps_it():
    """Normals of a shape's one-sided slopes lean: at a plane of symmetry they are none of the shell's."""
    scene = PILLOW.replace(loads=(PILLOW.loads[0].replace(value=300.0),))
    known = fem_reference.solve(scene, elements=4)
    leaning = fem_reference.solve(
        scene, elements=4, near=lambda at: shape(scene, known.displacement, at) + 0.02 * at[:, 2:] * [1, 1, 0]
    )
    assert leaning.status == "converged" and leaning.iterations < known.iterations
    points = np.random.default_rng(0).uniform(0.0, 0.1, (9, 2))
    assert leaning.displacement(points) == pytest.approx(known.displacement(points), abs=1e-9)


def test_the_drag_leaves_nothing_to_swing_and_the_time_is_of_the_load():
    heavy = PILLOW.replace(loads=(PILLOW.loads[0].replace(value=4e4),))
    assert frequency(heavy) == pytest.approx(2.0 * frequency(PILLOW), rel=1e-3)
    assert frequency(PILLOW) == pytest.approx((1e4 / (0.5 * 0.1)) ** 0.5, rel=2e-3)  # E h²/(ρ L⁴): 0.1 %
    assert CREEPING > 2.0 and LONG > 50.0 * CREEPING


def test_models_that_begin_flat_and_options_without_effect_are_refused(capsys):
    assert run("compare", "one-edge-clamped", "--settle", "--reference", "plate") == 2
    assert "--settle: plate" in one_line(capsys)
    assert run("compare", "one-edge-clamped", "--settle", "--branch", "buckled") == 2
    assert "--branch" in one_line(capsys)


def test_a_motion_that_ends_early_is_said(monkeypatch):
    text = "its motion did not come to rest: inverted: refine the grid"
    early = lambda *_, **__: (None, lambda points: np.zeros((len(points), 3)), text)  # noqa: E731
    monkeypatch.setattr("comparisons.comparison.settle.shape_after_motion", early)
    found = compare("one-edge-clamped", Lattice(3), elements=2, settle=True)
    for one in found.solutions:
        assert "did not come to rest" in one.message
        assert "statics left the shape" in one.message

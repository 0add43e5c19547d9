"""The reference's error bar: orders and bars of made-up answers, true errors covered, what compare says."""

import json

import fake_solutions
import numpy as np
import pytest
from cases import sheet

import fem_reference
from comparisons.comparison.comparison import compare
from comparisons.models.spec import Elements, Lattice
from comparisons.sweep import in_process as table
from fem_reference.edge_layer import NOTHING, UnresolvedLayers, resolved, unresolved
from fem_reference.uncertainty import FITTED, coarser, estimate, largest_order, of_solutions, solve_with_bar
from sheetbench import scenes
from sheetbench.answers.files import to_json
from sheetbench.answers.solution import Status

SIZES = [1 / 16, 1 / 12, 1 / 8]
SWINGING_OR_GROWING = (1.0, 1.1, 1.0), (1.0, 1.2, 1.3), (1.0, 1.1, 1.12)


def made(order, size=0.3, sizes=SIZES):
    """Answers 1 + size hᵖ."""
    return [np.array([[1.0 + size * h**order]]) for h in sizes]


def errors_at(answers, order):
    """Of the finest answer, by the change between each two meshes at an order."""
    powers = [(size / SIZES[0]) ** order for size in SIZES]
    return [abs(answers[i] - answers[j]) / (powers[j] - powers[i]) for i, j in ((0, 1), (0, 2), (1, 2))]


@pytest.mark.parametrize("order", [1.0, 2.0, 3.3, 4.0])
@pytest.mark.parametrize("sizes", [SIZES, [0.1, 0.2, 0.4], [1 / 16, 1 / 11, 1 / 8]])
def test_the_order_and_the_limit_of_a_power_law_are_found(order, sizes):
    found = estimate(made(order, sizes=sizes), sizes)
    assert found.order.item() == pytest.approx(order, rel=1e-6)
    assert found.extrapolated.item() == pytest.approx(1.0, abs=1e-9)
    assert found.trusted.all()


@pytest.mark.parametrize(
    ("answers", "share", "order"),
    [
        *((made(order), 0.0, min(order, 3.0)) for order in (1.0, 2.0, 3.0, 4.0)),
        *((made(3.0), share, order) for share, order in ((0.5, 2.0), (1.0, 1.0))),
        *((np.array(three).reshape(3, 1, 1), 0.0, 3.0) for three in SWINGING_OR_GROWING),
    ],
)
def test_the_bar_is_1_35_times_the_largest_error_at_the_order_that_is_banked_on(answers, share, order):
    """What is seen, of changes that swing or grow that of the elements, 3; at most 3 − 2 s where meshes miss
    a share s of the layer."""
    found = estimate(answers, SIZES, [UnresolvedLayers(share, 0.0)] * 3)
    assert found.bar.item() == pytest.approx(1.35 * max(errors_at(answers, order)).item(), rel=1e-6)
    assert found.error == pytest.approx(found.bar.item() / abs(found.answer.item()))
    if isinstance(answers, np.ndarray):
        assert not found.trusted.any() and found.extrapolated.item() == answers[0].item()


@pytest.mark.parametrize("order", [1.0, 2.0, 3.3])
def test_on_meshes_fitted_to_rims_order_2_at_most_counts(order):
    found, counts = estimate(made(order), SIZES, largest=FITTED), min(order, 2.0)
    assert found.bar.item() == pytest.approx(1.35 * max(errors_at(made(order), counts)).item(), rel=1e-6)


@pytest.mark.parametrize("odd", [0.6, 1.0, 5.0])
def test_the_order_of_one_component_moves_no_bar(odd):
    """Six points at order 2, but for one: its bar is by its own changes at the field's order."""
    field = [np.repeat(f, 6, axis=0) for f in made(2.0)]
    for f, other in zip(field, made(odd), strict=True):
        f[2] = other
    found, alone = estimate(field, SIZES), estimate(made(2.0), SIZES)
    assert found.order[2].item() == pytest.approx(odd, rel=1e-6)
    others = np.delete(found.bar, 2, axis=0)
    assert np.all(others >= alone.bar / 1.35) and np.ptp(others) == 0.0
    own = max(each[2, 0] for each in errors_at(field, 2.0))
    assert own < found.bar[2, 0] < own + 0.35 * 1.001 * max(own, alone.bar.item() / 1.35)


def test_a_component_that_changes_little_by_chance_has_the_bar_of_its_neighbours():
    field = [np.repeat(f, 4, axis=0) for f in made(2.0)]
    field[1][3], field[2][3] = field[0][3] + 1e-8, field[0][3] - 1e-8
    found = estimate([np.hstack([f, 1e-3 + 0.0 * f]) for f in field], SIZES)
    of_others = 0.35 * np.sqrt(3 / 4) * 0.3 * SIZES[0] ** 2
    assert found.bar[3, 0] == pytest.approx(of_others, rel=1e-3)
    assert np.all(found.bar[:, 1] == 0.0)  # another direction


def test_what_the_meshes_miss_of_the_layer_is_in_the_bar():
    """Answers that are too stiff by half of η, and by nothing else."""
    missed = [UnresolvedLayers(0.2, 0.01), UnresolvedLayers(0.3, 0.016), UnresolvedLayers(0.5, 0.03)]
    answers = [np.array([[1.0 - 0.5 * layer.stiffening]]) for layer in missed]
    assert estimate(answers, SIZES, missed).bar.item() > 0.5 * missed[0].stiffening
    alike = [UnresolvedLayers(0.99, 0.03)] * 3
    same = [np.array([[1.0 + 1e-6 * k]]) for k in range(3)]
    assert estimate(same, SIZES, alike).bar.item() == pytest.approx(1.35 * 0.3 * 0.03, rel=1e-3)
    still = estimate(same, SIZES, missed).bar.item()
    assert still < 1e-5  # a layer that is found on one mesh more than on another and changes nothing


def test_differences_of_rounding_show_no_order():
    answers = [np.array([[1.0, 1e-17 * k, 0.5]]) for k in (1, -3, 2)]
    found = estimate(answers, SIZES)
    assert found.trusted.all() and np.isnan(found.order).all() and np.isnan(found.overall_order)
    assert found.bar.max() < 1e-15


def test_two_meshes_assume_order_2_and_factor_3():
    found = estimate(made(2.0)[::2], SIZES[::2])
    assert found.bar.item() == pytest.approx(3 * 0.3 * SIZES[0] ** 2)
    assert np.isnan(found.order).all() and not found.trusted.any()


@pytest.mark.parametrize(("count", "sizes"), [(1, SIZES[:1]), (3, SIZES[::-1]), (3, SIZES[:2])])
def test_estimate_refuses_too_few_or_unordered_meshes(count, sizes):
    with pytest.raises(ValueError, match=r"meshes|rise"):
        estimate(made(2.0)[:count], sizes)


def test_coarser_meshes_have_three_quarters_and_half_the_elements():
    assert coarser(16) == [16, 12, 8] and coarser(2) == [2, 1] and coarser(1) == [1]
    assert coarser((16, 40)) == [(16, 40), (12, 30), (8, 20)]


@pytest.mark.sweep(4)
@pytest.mark.parametrize(
    ("name", "model"),
    [
        ("one-edge-clamped", "shell"),
        ("curved-edge", "shell"),
        ("two-edges-clamped", "plate"),
        ("curved-edge-down", "plate"),
    ],
)
def test_the_bar_covers_the_true_error_at_the_default_mesh(name, model):
    scene = scenes.load(name)
    points = scene.probe_points()
    truth = fem_reference.solve(scene, model, elements=24).displacement(points)
    _, found = solve_with_bar(scene, points, model)
    assert found is not None
    assert np.all(np.abs(found.answer - truth) <= found.bar + 1e-12)
    assert found.error < (1e-3 if model == "shell" else 1e-2)


ROUND = [  # sides, thickness; E, nu, rho; weight; supports of x0, x1, y0, y1; centre and radius of the hole
    ((0.2185, 0.1509, 0.0012563, 507729, 0.3408, 1100.2), 0.000869381, "h-h-", (0.09978, 0.08079, 0.03218)),
    ((0.2121, 0.1464, 0.0041359, 957382, 0.3628, 1006.4), 0.55314, "chhh", (0.12372, 0.08730, 0.02549)),
    ((0.2923, 0.1704, 0.0027048, 6.77e6, 0.1112, 1175.5), 1.00928, "hhcc", (0.15568, 0.09361, 0.03660)),
    ((0.1805, 0.1295, 0.0020707, 8.29e6, 0.3692, 1201.2), 2.85762, "cchh", (0.10035, 0.07591, 0.02679)),
    ((0.1521, 0.0957, 0.0010980, 1.86e6, 0.4518, 1008.6), 0.157661, "c---", (0.08648, 0.05226, 0.01609)),
    ((0.1631, 0.1121, 0.0028932, 8.246e6, 0.2093, 1172.9), 0.862744, "c---", (0.07696, 0.06479, 0.02191)),
]
SHARES = np.array([[0.5, 0.85], [0.75, 0.5], [0.75, 0.75]])  # of the sides, where it is looked at


@pytest.mark.nightly
def test_bars_hold_at_round_holes():
    """54 components of six drawn sheets, truth: 28 elements; by the rule of meshes in rows 28 were held."""
    held = []
    for data, weight, kinds, (x, y, radius) in ROUND:
        names = {"h": "hinged", "c": "clamped"}
        edges = zip(("x0", "x1", "y0", "y1"), kinds, strict=True)
        supports = [{"kind": names[kind], "edge": edge} for edge, kind in edges if kind != "-"]
        hole = {"shape": {"circle": {"centre": [x, y], "radius": radius}}}
        scene = sheet(*data, weight=weight, supports=supports, cutouts=[hole])
        points = SHARES * scene.sheet.lengths
        _, found = solve_with_bar(scene, points, elements=12)
        off = found.answer - fem_reference.solve(scene, "shell", elements=28).displacement(points)
        held.append(np.abs(off) <= found.bar)
    assert np.mean(held) >= 0.95


def hinged_at(*edges):
    return [{"kind": "hinged", "edge": edge} for edge in edges]


CLAMP = {"kind": "clamped", "edge": "x0"}
PINS = [{"kind": "point", "at": at, "components": ["z"]} for at in ((0.1338, 0.1097), (0.1416, 0.1355))]
TABLE = {"kind": "plane", "position": (0.1392, 0.1535, -0.02147), "normal": (0.0, 0.0, 1.0)}
PLIES = {
    **{"kind": "orthotropic", "young_1": 3.41e6, "young_2": 1.311e5, "poisson_12": 0.26, "density": 969.4},
    **{"shear_12": 4.645e4, "shear_13": 4.645e4, "shear_23": 3.716e4, "angle": 0.9736},
}
LESS_SMOOTH = {  # largest order, places as shares of the sides, and the sheet
    "over a plane": (
        1.5,
        SHARES,
        sheet(
            *(0.2784, 0.307, 0.0022517, 1.806e7, 0.2661, 1125.9),
            weight=1.1934,
            supports=[CLAMP, *hinged_at("y0")],
            obstacles=[TABLE],
        ),
    ),
    "on two points": (
        1.5,
        [[0.5, 0.57], [0.75, 0.5], [1.0, 1.0]],
        sheet(*(0.2737, 0.1727, 0.0034244, 2.492e6, 0.1676, 1226.2), weight=0.6237, supports=[CLAMP, *PINS]),
    ),
    "with fibres": (
        2.5,
        SHARES,
        sheet(
            *(0.1434, 0.1117, 0.0026419),
            weight=0.6415,
            supports=[CLAMP, {**CLAMP, "edge": "x1"}],
            material=PLIES,
        ),
    ),
}


@pytest.mark.parametrize("kind", LESS_SMOOTH)
def test_bars_hold_where_the_solution_is_less_smooth(kind):
    """Of drawn sheets over planes 83 % of the components were held, 67 % on points, 93 % with fibres."""
    order, shares, scene = LESS_SMOOTH[kind]
    assert largest_order(scene) == order
    points = np.array(shares) * scene.sheet.lengths
    _, found = solve_with_bar(scene, points, elements=12)
    off = found.answer - fem_reference.solve(scene, "shell", elements=26).displacement(points)
    assert np.all(np.abs(off) <= found.bar)


def test_a_mesh_without_an_answer_is_left_out():
    scene = scenes.load("one-edge-clamped")
    good = [fake_solutions.solution(scene, "shell", size) for size in (-0.01, -0.0101, -0.0103)]
    bad = fake_solutions.solution(scene, "shell", status=Status.DIVERGED, load_factor=0.5)
    points = scene.probe_points()
    assert of_solutions(scene, [bad, *good[1:]], SIZES, points) is None
    two = of_solutions(scene, [good[0], bad, good[2]], SIZES, points)
    assert two is not None and two.sizes == (SIZES[0], SIZES[2])


@pytest.fixture
def by_mesh(monkeypatch):
    """Answers without a solver: the reference's error is 8 % at one element and falls like h²."""
    sizes = {"lumped": -0.0100, "limit": -0.0100, "share": 0.08}

    def answer(model, name="", near=None):
        if not isinstance(model.spec, Elements):
            return fake_solutions.solution(model.scene, name, sizes["lumped"])
        n = model.spec.elements
        assert isinstance(n, int)
        size = sizes["limit"] * (1 + sizes["share"] / n**2)
        own = {"settings": {"elements": n}, "solve_seconds": 0.004}
        return fake_solutions.solution(model.scene, model.spec.model, size, **own)

    monkeypatch.setattr(table, "solve", answer)
    return sizes


@pytest.mark.parametrize(("lumped", "told_apart"), [(-0.0100, False), (-0.0101, True)])
def test_compare_says_what_its_mesh_cannot_tell_apart(by_mesh, lumped, told_apart):
    by_mesh["lumped"] = lumped
    found = compare("one-edge-clamped", Lattice(calibration="consistent"), elements=8)
    assert found.bar is not None
    layer = unresolved(found.scene, {"elements": 8}).stiffening
    assert 1.35 * 0.08 / 64 < 1.0001 * found.bar.error < 1.35 * (0.08 / 64 + 0.3 * layer)
    document = json.loads(to_json(found.document()))
    assert {d["distinguishable"] for d in document["differences"]} == {told_apart}
    assert document["errors"][0]["distinguishable"] is told_apart
    bar = document["solutions"][1]["uncertainty"]
    assert bar["elements"] == [8, 6, 4] and bar["order"] == pytest.approx(2.0, abs=1e-3)
    assert bar["solve_seconds"] == pytest.approx(0.008)
    assert document["solutions"][1]["solve_seconds"] == 0.004
    said = " ".join(found.notes())
    assert ("not distinguishable" in said) is not told_apart
    assert "observed order 2.0" in said


def test_it_is_off_when_not_wanted_and_for_the_solid_unless_wanted(by_mesh):
    def wanted(**settings):
        return compare("one-edge-clamped", Lattice(calibration="consistent"), **settings).bar is not None

    assert wanted() and wanted(reference="plate")
    assert not wanted(uncertainty=False)
    assert not wanted(reference="solid") and wanted(reference="solid", uncertainty=True)
    assert not wanted(elements=1)
    without = compare("one-edge-clamped", Lattice(calibration="consistent"), uncertainty=False)
    assert "uncertainty" not in without.document()["solutions"][1]
    assert {d.distinguishable for d in without.differences} == {None}


def test_a_field_that_converges_is_trusted_whatever_a_small_component_does():
    """Drawn sheets' bars held and none was trusted: one of a dozen components swings by a thousandth."""
    coarse, middle, fine = (np.array([[1.0 + size**2, -2.0]]) for size in (1.0, 0.75, 0.5))
    swing = 1e-3 * np.array([[0.0, 1.0]])
    found = estimate([fine - swing, middle + swing, coarse - swing], [0.5, 0.75, 1.0])
    assert found.converging and not found.trusted.all()
    assert not estimate([coarse, fine, middle], [0.5, 0.75, 1.0]).converging
    assert not estimate([fine, middle], [0.5, 0.75]).converging
    assert estimate([fine, fine, fine], [0.5, 0.75, 1.0]).converging


def test_the_layer_is_found_by_small_elements_and_missed_by_large_ones():
    assert resolved(np.full(60, 0.2)) == pytest.approx(1.0, abs=1e-5)
    for length in (100.0, 1000.0):  # the mass alone, of elements of one length
        assert resolved(np.full(20, length)) == pytest.approx(6.0 * 2.0**0.5 / length, rel=15.0 / length)
    assert np.all(np.diff([resolved(np.full(20, t)) for t in (0.5, 1.0, 2.0, 4.0, 8.0)]) < 0.0)


def hinged(thickness):
    supports = [{"kind": "hinged", "edge": edge} for edge in ("x0", "x1", "y0", "y1")]
    return sheet(1.0, 1.0, thickness, 1e9, weight=1e-4, supports=supports)


@pytest.mark.sweep(4)
@pytest.mark.parametrize(("thickness", "elements"), [(0.003, 12), (0.006, 12), (0.012, 8), (0.025, 8)])
def test_hinged_plates_are_too_stiff_by_two_thirds_of_what_is_missed(thickness, elements):
    scene, middle = hinged(thickness), np.array([[0.5, 0.5]])
    truth, coarse = (
        fem_reference.solve(scene, "plate", elements=n).displacement(middle)[0, 2] for n in (32, elements)
    )
    lost = unresolved(scene, {"elements": elements}).stiffening
    assert 1.0 - coarse / truth == pytest.approx(0.63 * lost, rel=0.15)


def test_clamps_have_no_such_layer_and_even_meshes_miss_more():
    held = sheet(0.188, 0.188, 0.003, held="x0 x1 y0 y1")
    assert unresolved(held, {"elements": 8}) == NOTHING
    scene = hinged(0.01)
    graded, even = (unresolved(scene, {"elements": [8, 8], "graded": g}) for g in (True, False))
    assert even.share > graded.share > 0.0
    assert graded == unresolved(scene, {"elements": 8})
    assert even == unresolved(scene, {"elements": 8, "grading": "uniform"})


def test_bricks_miss_a_layer_where_stiffness_steps():
    """CalculiX on `ray-fin` is 1.4, 1.0 and 0.7 % off the shell with 6, 8 and 12 across: first order."""
    scene, bricks = scenes.load("ray-fin"), {"elements": [24, 12], "grading": "edges"}
    plain = scene.replace(patches=())
    same = scene.replace(patches=[scene.patches[0].replace(young=scene.material.young)])
    assert unresolved(scene, bricks).share == 1.0 > unresolved(plain, bricks).share
    assert unresolved(same, bricks) == unresolved(plain, bricks)
    assert unresolved(scene, {"elements": [24, 12]}) == unresolved(plain, {"elements": [24, 12]})
    answers = [np.array([[1.0 + off]]) for off in (0.00684, 0.00959, 0.01375)]
    found = estimate(answers, [1 / 12, 1 / 8, 1 / 6], [unresolved(scene, bricks)] * 3)
    assert found.bar.item() > 0.00684  # 0.0032 at the order of meshes that miss half of the rim

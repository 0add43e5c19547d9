"""`sheetbench modes`: frequencies of all models, flat and deformed; buckling loads by closed forms."""

import json

import meshio
import numpy as np
import pytest
from cases import sheet
from commands import json_of, run

import fem_reference
import lumped
import sheetbench as sb
from comparisons.models.spec import Lattice
from comparisons.modes.pairing import assurance, cell_centres, matched
from comparisons.modes.spectra import spectra
from sheetbench.errors import BadInput
from sheetbench.scenes import (
    Clamped,
    EdgeLoad,
    Gravity,
    Held,
    PointLoad,
    Pressure,
    load,
)

STRIP = sheet(0.12, 0.04, 0.002, 0.6e6, 0.48, 1070.0)


def test_shapes_of_both_models_are_in_one_file(kept):
    document = kept("modes").document
    assert [len(one["frequencies_hz"]) for one in document["solutions"]] == [3, 3]
    shapes = meshio.read(kept("modes").folder / "modes.vtu").point_data
    assert len(shapes) == 1 + 2 * 3
    first, second = shapes["lumped_mode_1"][:, 2], shapes["shell_mode_1"][:, 2]
    # of shapes scaled alike; the signs are each model's own
    assert np.abs(np.abs(first) - np.abs(second)).max() < 0.1 * np.abs(second).max()


def test_modes_of_a_strip_are_paired_by_shape_where_their_order_differs():
    found = spectra(STRIP, count=6, elements=8)
    lattice, shell = (spectrum.frequencies for spectrum in found)
    assert [pair.kind for pair in found.pairs] == [
        "bending 1", "twist", "bending 2", "bending 3", "twist 2", "in plane",
    ]  # fmt: skip
    assert [pair.is_ for pair in found.pairs] == [1, 2, 3, 4, 6, 5]
    assert min(pair.mac for pair in found.pairs) > 0.99
    np.testing.assert_allclose(lattice[:2], shell[:2], rtol=0.03)
    twist, in_plane = found.pairs[4:]
    assert twist.relative == pytest.approx(lattice[4] / shell[5] - 1.0)
    assert in_plane.relative == pytest.approx(lattice[5] / shell[4] - 1.0)
    assert abs(twist.relative) < 0.004 < 0.01 < in_plane.relative < 0.015  # by rank both are between
    document = found.document()["pairs"][4]
    assert list(document) == ["of", "number", "against", "is", "mac", "relative", "kind"]
    assert list(document.values())[:4] == ["lumped", 5, "shell", 6]
    report = found.report()
    assert any("swapped" in said and "5 (twist 2) is 6" in said for said in report.notes)
    assert [row[3] for row in report.tables[0].rows] == [1, 2, 3, 4, 6, 5]


def test_a_mode_without_counterpart_among_the_first_says_so():
    found = spectra(STRIP, count=5, elements=8)  # the lattice's fifth is the shell's sixth
    assert (found.pairs[4].is_, found.pairs[4].relative) == (None, None)
    assert found.report().tables[0].rows[4][-2] is None
    assert any("none of the shell's first 5" in said for said in found.report().notes)


def test_repeated_frequencies_pair_whatever_their_rotation():
    scene = load("one-edge-clamped").model_copy(update={"supports": ()})
    x, y = (cell_centres(scene.sheet) / scene.sheet.length_x).T
    zero = np.zeros_like(x)
    shapes = np.stack([np.stack([zero, zero, w], axis=-1) for w in (np.sin(9 * x), np.sin(9 * y), x * y)])
    turned = np.einsum("ij,jnk->ink", [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]], shapes)
    distinct, same = (assurance(shapes, turned, np.array(f)) for f in ([1.0, 1.1, 2.0], [1.0, 1.0, 2.0]))
    assert distinct[0, 0] < 0.7
    assert matched(same) == [0, 1, 2]
    # not exactly 1: sin 9x and sin 9y are not orthogonal, so that the turn is not one in their mass
    assert np.diag(same).min() > 0.95


@pytest.mark.parametrize("damped, within", [({"frequency": 6.0}, np.inf), ({"band": (1.0, 200.0)}, 0.1)])
def test_damping_of_modes_is_told_as_asked_and_got(damped, within):
    """Branches keep it over the band; one damper has it at its frequency: ζ goes with the frequency."""
    scene = load("one-edge-clamped").replace(loss_factor=0.12, **damped)
    found = spectra(scene, Lattice(5), elements=4, count=6)
    damping = found.document()["damping"]
    assert list(damping) == ["lumped", "shell"] and len(found.tables()) == 3
    assert "ζ requested" not in " ".join(found.notes())
    for mode in damping["lumped"] + damping["shell"]:
        assert mode["asked"] == 0.06 and abs(mode["got"] / 0.06 - 1.0) < within
    if "frequency" in damped:
        first = damping["lumped"][0]
        undamped = found.frequencies[0]
        assert first["got"] == pytest.approx(0.06 * undamped / 6.0, rel=1e-9)
        assert first["frequency_hz"] == pytest.approx(undamped * np.sqrt(1.0 - first["got"] ** 2), rel=1e-9)


# a strip of soft silicone, 250 × 120 × 1.5 mm, hanging down from x0
HANGING = sheet(0.25, 0.12, 0.0015, 125e3, 0.49, 1070.0, gravity=Gravity(acceleration=(9.81, 0.0, 0.0)))


def test_a_hanging_strip_swings_as_a_heavy_string():
    """f = j/(4π) √(g/L), j = 2.4048 the zero of J0."""
    string = 2.4048 / (4.0 * np.pi) * np.sqrt(9.81 / 0.25)
    shell = fem_reference.modes(HANGING, "shell", 8, 2, "deformed").frequencies
    assert shell[0] == pytest.approx(string, rel=0.02)
    springs = lumped.calibrate(HANGING.sheet, HANGING.material, (33, 17))
    lattice = lumped.modes(HANGING, springs, 2, about="deformed").frequencies
    assert lattice[0] == pytest.approx(shell[0], rel=0.02)
    assert fem_reference.modes(HANGING, "shell", 8, 1).frequencies[0] < 0.05 * string


def test_what_has_no_modes_is_refused_in_a_line():
    scene = load("two-edges-clamped")
    springs = lumped.calibrate(scene.sheet, scene.material, (5, 5))
    pressed = scene.model_copy(update={"loads": (Pressure(value=1.0),)})
    for ask in (
        lambda: lumped.modes(pressed, springs, 2, about="deformed"),
        lambda: fem_reference.modes(pressed, "shell", 2, 2, "deformed"),
        lambda: fem_reference.modes(scene, "plate", 2, 2, "deformed"),
        lambda: sb.modes(scene, count=1, about="sideways"),
    ):
        with pytest.raises(BadInput):
            ask()


def test_the_verb_warns_of_a_sheet_that_is_not_flat(capsys):
    arguments = ["modes", "two-edges-clamped", "--lumped", "5", "--elements", "2", "--count", "1", "--json"]
    for about in ("flat", "deformed"):
        assert run(*arguments, "--about", about) == 0
        said = capsys.readouterr()
        assert ("--about deformed" in said.err) is (about == "flat")
        assert json.loads(said.out)["about"] == about


SIDE, THICKNESS, YOUNG = 0.2, 0.001, 1e7
WIDTH = 0.05  # b/L of the strip on edge
UPRIGHT = (
    Held(edge="x0", components=("x", "z")),
    Held(edge="x1", components=("z",)),
    Held(edge="y0", components=("y", "z")),
    Held(edge="y1", components=("z",)),
)


def square():
    """Simply supported under 4 π² D/b² along x: Timoshenko & Gere, Theory of Elastic Stability, 9.2."""
    critical = 4.0 * np.pi**2 * YOUNG * THICKNESS**3 / 12.0 / (1.0 - 0.3**2) / SIDE**2
    press = EdgeLoad(edge="x1", force_per_length=(-critical, 0.0, 0.0))
    return sheet(SIDE, SIDE, THICKNESS, YOUNG, supports=UPRIGHT, loads=(press,))


def column():
    """A clamped strip of ν = 0 under Euler's load π² E I/(4 L²)."""
    critical = np.pi**2 * YOUNG * THICKNESS**3 / 12.0 / (4.0 * SIDE**2)
    press = EdgeLoad(edge="x1", force_per_length=(-critical, 0.0, 0.0))
    return sheet(SIDE, 0.1 * SIDE, THICKNESS, YOUNG, 0.0, loads=(press,))


def on_edge():
    """A cantilever of narrow section under P at its tip in the plane: P L²/√(E I_z G J) = 4.013, Timoshenko &
    Gere, 6.3; J with the ends' share of a section of b/h = 20. The clamp keeps the section from warping over
    some of its width, which the closed form leaves out: loads are higher by half of b/L or so."""
    width = WIDTH * SIDE
    thickness = width / 20.0
    bending = YOUNG * width * thickness**3 / 12.0
    twist = 0.5 * YOUNG * width * thickness**3 / 3.0 * (1.0 - 0.63 * thickness / width)
    critical = 4.013 * np.sqrt(bending * twist) / SIDE**2
    press = EdgeLoad(edge="x1", force_per_length=(0.0, -critical / width, 0.0))
    return sheet(SIDE, width, thickness, YOUNG, 0.0, loads=(press,))


def found(scene, model, count=1):
    if model == "lumped":
        grid = 33 if scene.sheet.length_x == scene.sheet.length_y else (41, 5)
        return lumped.buckling(scene, lumped.calibrate(scene.sheet, scene.material, grid), count)
    elements = (8, 8) if scene.sheet.length_x == scene.sheet.length_y else (16, 2)
    return fem_reference.buckling(scene, model, elements, count)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("model", ["lumped", "shell", "solid"])
@pytest.mark.parametrize(("case", "within"), [(square, 0.02), (column, 0.02), (on_edge, 0.02 + 0.5 * WIDTH)])
def test_buckling_loads_are_the_closed_forms(case, within, model):
    assert found(case(), model).load_factors[0] == pytest.approx(1.0, rel=within)


def test_under_more_than_its_buckling_load_the_flat_lattice_is_unstable():
    flat = square()
    springs = lumped.calibrate(flat.sheet, flat.material, 17)
    (factor,) = lumped.buckling(flat, springs).load_factors
    along_x = flat.loads[0].force_per_length[0]
    for share, status in ((0.99, "converged"), (1.01, "unstable")):
        press = EdgeLoad(edge="x1", force_per_length=(share * factor * along_x, 0.0, 0.0))
        assert lumped.solve(flat.replace(loads=(press,)), springs).status == status


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"loads": (Pressure(value=1.0),)}, "load 1.kind = 'pressure'"),
        ({"loads": (EdgeLoad(edge="x1", moment_per_length=0.1),)}, "load 1.moment_per_length"),
        ({"loads": (PointLoad(at=(0.1, 0.1), force=(0.0, 0.0, 1.0)),)}, "bend the sheet at once"),
        ({"loads": (EdgeLoad(edge="x1", force_per_length=(0.0, 0.0, 0.0)),)}, "do not soften"),
        ({"loads": (), "gravity": Gravity(acceleration=(0.0, 0.0, -9.81))}, "bend the sheet at once"),
        ({"supports": (Clamped(edge="x0", tilt=0.1),)}, "support"),
    ],
)
def test_what_has_no_buckling_load_is_refused_by_name(change, message):
    scene = square().replace(**change)
    for model in ("lumped", "shell", "solid"):
        with pytest.raises(BadInput, match=message):
            if model == "lumped":
                lumped.buckling(scene, lumped.calibrate(scene.sheet, scene.material, 5))
            else:
                fem_reference.buckling(scene, model, 2)
    with pytest.raises(BadInput, match="its strains are linear; choose shell or solid"):
        fem_reference.buckling(square(), "plate", 2)


def test_the_verb_pairs_shapes(tmp_path, capsys):
    file = tmp_path / "pressed.toml"
    square().save(file)
    arguments = ("modes", str(file), "--lumped", "9", "--elements", "4", "--count", "2", "--buckling")
    found = json_of(capsys, *arguments, "--reference", "shell", "--reference", "plate")["buckling"]
    assert [one["model"] for one in found["solutions"]] == ["lumped", "shell"]
    factors = np.array([one["load_factors"] for one in found["solutions"]])
    for pair, ours, theirs in zip(found["pairs"], *factors, strict=True):
        assert (pair["against"], pair["is"]) == ("shell", pair["number"]) and pair["mac"] > 0.99
        assert pair["relative"] == pytest.approx(ours / theirs - 1.0)


@pytest.mark.parametrize("case", [square, column])
def test_the_error_of_a_buckling_load_is_foretold_by_a_finer_grid(case):
    """To a quarter; where springs do not converge to the sheet a note says that there is none."""
    scene = case()
    found = spectra(scene, Lattice(9), count=3, elements=8 if case is square else (40, 4), buckling=True)
    true = [pair.relative for pair in found.buckling_pairs]
    assert np.array(found.expected) == pytest.approx(np.array(true), rel=0.25)
    table = next(table for table in found.tables() if table.name == "buckling")
    assert [column.name for column in table.columns][1:3] == ["lumped", "est."]
    uniform = spectra(scene, Lattice(5, "uniform"), count=1, elements=2, buckling=True)
    assert "do not converge to the sheet" in uniform.document()["buckling"]["no_estimate"]
    assert any("no estimate of its grid error" in note for note in uniform.notes())

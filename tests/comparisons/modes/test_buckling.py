"""Buckling loads of lattice, shell and solid against closed forms, and what has none."""

import numpy as np
import pytest
from commands import json_of

import fem_reference
import lumped
from sheetbench.errors import BadInput
from sheetbench.scenes import Clamped, EdgeLoad, Gravity, Held, Material, PointLoad, Pressure, Scene, Sheet

SIDE, THICKNESS, YOUNG = 0.2, 0.001, 1e7
WIDTH = 0.05  # b/L of the strip on edge
UPRIGHT = (
    Held(edge="x0", components=("x", "z")),
    Held(edge="x1", components=("z",)),
    Held(edge="y0", components=("y", "z")),
    Held(edge="y1", components=("z",)),
)


def make_scene(length_x, length_y, thickness, poisson, supports, *loads, gravity=None):
    sheet, material = Sheet(length_x, length_y, thickness), Material(YOUNG, poisson, 1000.0)
    return Scene("buckling", sheet, material, gravity, supports, loads)


def square():
    """Simply supported under 4 π² D/b² along x: Timoshenko & Gere, Theory of Elastic Stability, 9.2."""
    critical = 4.0 * np.pi**2 * YOUNG * THICKNESS**3 / 12.0 / (1.0 - 0.3**2) / SIDE**2
    press = EdgeLoad(edge="x1", force_per_length=(-critical, 0.0, 0.0))
    return make_scene(SIDE, SIDE, THICKNESS, 0.3, UPRIGHT, press)


def column():
    """A clamped strip of ν = 0 under Euler's load π² E I/(4 L²)."""
    critical = np.pi**2 * YOUNG * THICKNESS**3 / 12.0 / (4.0 * SIDE**2)
    press = EdgeLoad(edge="x1", force_per_length=(-critical, 0.0, 0.0))
    return make_scene(SIDE, 0.1 * SIDE, THICKNESS, 0.0, (Clamped(edge="x0"),), press)


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
    return make_scene(SIDE, width, thickness, 0.0, (Clamped(edge="x0"),), press)


def found(scene, model, count=1):
    if model == "lumped":
        grid = 33 if scene.sheet.length_x == scene.sheet.length_y else (41, 5)
        return lumped.buckling(scene, lumped.calibrate(scene.sheet, scene.material, grid), count)
    elements = (8, 8) if scene.sheet.length_x == scene.sheet.length_y else (16, 2)
    return fem_reference.buckling(scene, model, elements, count)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("model", ["lumped", "shell", "solid"])
@pytest.mark.parametrize(("case", "within"), [(square, 0.02), (column, 0.02), (on_edge, 0.02 + 0.5 * WIDTH)])
def test_closed_forms(case, within, model):
    assert found(case(), model).load_factors[0] == pytest.approx(1.0, rel=within)


def test_under_more_than_its_buckling_load_the_flat_lattice_is_unstable():
    flat, springs = square(), lumped.calibrate(Sheet(SIDE, SIDE, THICKNESS), Material(YOUNG, 0.3, 1000.0), 17)
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
    with pytest.raises(BadInput, match="of shell and solid; the plate's strains are linear"):
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

"""What natural strains, curvatures and temperatures of a scene mean, and which are refused."""

import numpy as np
import pytest

from sheetbench.errors import BadInput
from sheetbench.scenes import Clamped, FactorTable, Layer, Material, Patch, Scene, Sheet
from sheetbench.scenes.meaning.composition import require_plain
from sheetbench.scenes.meaning.motion import at_start
from sheetbench.scenes.meaning.natural_state import (
    growth_of_cells,
    natural_at,
    natural_of_cells,
    sheet_at_rest,
    thermal,
)
from sheetbench.scenes.meaning.parameters import parameter, put
from sheetbench.scenes.meaning.words import natural_in_words
from sheetbench.scenes.objects.natural import Natural, Temperature

MATERIAL = Material(young=1e6, poisson=0.3, density=1e3, expansion=1e-4)


def scene(**more):
    own = {"material": MATERIAL, "supports": (Clamped(edge="x0"),), **more}
    sheet = own.pop("sheet", Sheet(length_x=0.2, length_y=0.1, thickness=0.002))
    return Scene(name="natural", sheet=sheet, **own)


def rectangle(x0, x1):
    return {"rectangle": {"x": (x0, x1), "y": (0.0, 0.1)}}


def test_patches_win_over_the_sheet_and_later_ones_over_those_before():
    of = scene(
        natural=Natural((0.01, 0.0, 0.0)),
        patches=(
            Patch(shape=rectangle(0.0, 0.1), natural=Natural((0.02, 0.0, 0.0))),
            Patch(shape=rectangle(0.05, 0.15), natural=Natural((0.03, 0.0, 0.0))),
        ),
    )
    state = natural_at(of, np.array([[0.02, 0.05], [0.07, 0.05], [0.12, 0.05], [0.18, 0.05]]))
    strain, _ = state.at()
    np.testing.assert_allclose(strain[:, 0, 0], [0.02, 0.03, 0.03, 0.01])
    cells = natural_of_cells(of, np.array([0.0, 0.2]), np.array([0.0, 0.1]))
    mean, _ = cells.at()
    assert mean[0, 0, 0, 0] == pytest.approx(0.25 * 0.02 + 0.5 * 0.03 + 0.25 * 0.01)
    assert sheet_at_rest(of).lengths == (0.2, 0.1)  # cells have grown each by itself
    growth = growth_of_cells(of, np.array([0.0, 0.2]), np.array([0.0, 0.1]))
    np.testing.assert_allclose(growth, [[[1.0 + mean[0, 0, 0, 0], 1.0]]])
    assert growth_of_cells(of.replace(patches=()), np.array([0.0, 0.2]), np.array([0.0, 0.1])) is None
    assert sheet_at_rest(of.replace(patches=())).lengths == pytest.approx((0.202, 0.1))


def test_histories_scale_each_source_of_its_own():
    grows = FactorTable(time=(0.0, 1.0), factor=(0.0, 2.0))
    of = scene(
        natural=Natural(curvature=(1.0, 0.0, 0.5), history=grows), temperature=Temperature(change=10.0)
    )
    state = natural_at(of, np.zeros(2))
    strain, curvature = state.at(time=0.25)
    np.testing.assert_allclose(curvature, [[0.5, 0.25], [0.25, 0.0]])
    np.testing.assert_allclose(strain, 1e-3 * np.eye(2), rtol=1e-12)
    assert state.moves and state.rates(0.25, before=False).tolist() == [2.0, 0.0]


def test_a_gradient_of_temperature_bends_and_a_bimetal_is_timoshenkos():
    _, k = thermal(scene(), Temperature(gradient=1e4))
    np.testing.assert_allclose(k, [-1.0, -1.0, 0.0], atol=1e-12)
    layers = (
        Layer(thickness=0.001, young=1e6, poisson=0.3, expansion=1e-3),
        Layer(thickness=0.002, young=3e6, poisson=0.3, expansion=0.0),
    )
    bimetal = scene(
        sheet=Sheet(length_x=0.2, length_y=0.1, thickness=0.003), layers=layers,
        temperature=Temperature(change=20.0),
    )  # fmt: skip
    ratio, stiff = 0.5, 1.0 / 3.0
    exact = 6.0 * 0.02 * (1.0 + ratio) ** 2 / 0.003
    exact /= 3.0 * (1.0 + ratio) ** 2 + (1.0 + ratio * stiff) * (ratio**2 + 1.0 / (ratio * stiff))
    assert thermal(bimetal, bimetal.temperature)[1][0] == pytest.approx(exact, rel=1e-13)
    assert at_start(bimetal).temperature == Temperature()  # which a motion starts without


def test_pretension_is_by_linear_law_the_strain_that_pulls_so_much():
    of = scene(natural=Natural(pretension=(2.0, 1.0)))
    strain, _ = (part[0] for part in natural_at(of, np.zeros((1, 2))).at())
    said = dict(natural_in_words(of))["natural"]
    assert said == "a tension of 2 N/m along x and 1 N/m along y, held flat, stresses from 500 Pa to 1 kPa"
    stiffness = 1e6 * 0.002 / 0.91 * np.array([[1.0, 0.3], [0.3, 1.0]])
    np.testing.assert_allclose(-stiffness @ np.diag(strain), [2.0, 1.0])


def test_words_say_radius_strain_and_stress():
    of = scene(natural=Natural((0.02, 0.0, 0.0), (5.0, 0.0, 0.0)), temperature=Temperature(change=10.0))
    words = dict(natural_in_words(of))
    assert (
        "2 % longer along x" in words["natural"] and "radius 200 mm along x, towards +z" in words["natural"]
    )
    assert "0.1 % longer along x" in words["temperature"]
    assert f"to −{1e3 * 1e-3 / 0.7:.3g} kPa" in words["temperature"]
    passing = Natural(
        curvature=(5.0, 0.0, 0.0), history=FactorTable(time=(0.0, 0.5, 1.0), factor=(0.0, 2.0, 0.0))
    )
    (said,) = dict(natural_in_words(scene(natural=passing))).values()
    assert "radius 200 mm" in said and said.endswith("times 0 to 2 to 0 over 1 s")


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: scene(natural=Natural(), material=MATERIAL.replace(law="neo-hookean")), "not of rubber"),
        (
            lambda: scene(temperature=Temperature(change=1.0), material=MATERIAL.replace(expansion=None)),
            "expansion",
        ),
        (lambda: Natural((0.9, 0.0, 0.0)), r"at most 0\.5"),
        (lambda: Natural((0.1, 0.0, 0.0), pretension=(1.0, 1.0)), "strain and pretension"),
        (lambda: Patch(shape=rectangle(0.0, 0.1), natural=Natural(pretension=(1.0, 1.0))), "give strain"),
        (
            lambda: require_plain(scene(natural=Natural(curvature=(1.0, 0.0, 0.0))), "this"),
            "flat at rest",
        ),
    ],
)
def test_what_cannot_be_is_refused(make, said):
    with pytest.raises(BadInput, match=said):
        make()


def test_components_are_parameters():
    root = Patch(shape=rectangle(0.0, 0.1), natural=Natural())
    of = scene(natural=Natural(curvature=(5.0, 0.0, 0.0)), patches=(root,))
    assert (parameter(of, "natural.kxx").value, parameter(of, "natural.kxx").unit) == (5.0, "1/m")
    assert put(of, "natural.exy", 0.1).natural.strain == (0.0, 0.0, 0.1)
    assert put(of, "patch1.natural.kyy", 2.0).patches[0].natural.curvature == (0.0, 2.0, 0.0)
    with pytest.raises(BadInput, match="first guess"):
        parameter(scene(), "natural.kxx")

"""Which springs a scene gets where the choice is left to it, and how near that brings coarse grids."""

import pytest
from commands import json_of

import sheetbench as sb
from comparisons.models import training as targets
from comparisons.models.method import FAR, MEMBRANE, method_for, resolve_calibration
from comparisons.models.resolve import resolve
from comparisons.models.scales import scales
from comparisons.models.spec import Lattice
from comparisons.tradeoff.choices import of_lattices
from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.face import solve
from sheetbench.scenes import Clamped, Scene, load
from studies.transfer.scenes import transfer_scenes

SCENES = transfer_scenes()
RUBBER = SCENES["two-edges-clamped"]


def held(*edges, poisson=0.3, softer=1.0):
    """Habibi et al.'s sheet of another material, clamped along these edges."""
    material = RUBBER.material.replace(poisson=poisson, young=RUBBER.material.young / softer)
    return RUBBER.replace(supports=tuple(Clamped(edge=edge) for edge in edges), material=material)


def test_a_trade_names_the_springs_that_auto_takes():
    """Each once, on every grid, with the reason; what is named outright stays."""
    methods = "consistent,consistent-membrane,auto"
    found, reasons = of_lattices(RUBBER, Lattice(), "3,5", methods)
    names = [candidate.settings["calibration"] for candidate in found]
    assert names == [*2 * ["consistent"], *2 * [MEMBRANE]]
    assert reasons == (f"calibration {MEMBRANE}: ν = 0.48 is above 0.4",)


def test_by_edges_load_and_poissons_ratio():
    assert method_for(held("y1")) == (MEMBRANE, "y1 alone holds the sheet")
    assert method_for(held("x0", "x1"))[0] == method_for(held("x0", "x1", "y0"))[0] == "consistent"
    assert method_for(held("x0", "x1", poisson=0.45)) == (MEMBRANE, "ν = 0.45 is above 0.4")
    for softer, expected in ((1.0, "consistent"), (10.0, MEMBRANE)):
        scene = held("x0", "y0", softer=softer)
        numbers = scales(scene)
        assert (numbers.load_number / numbers.slenderness > FAR) == (expected == MEMBRANE)
        assert method_for(scene)[0] == expected
    assert method_for(load("actuated-edge"))[0] == "consistent"


def test_it_chooses_where_nothing_but_a_grading_is_asked():
    scene = held("x0")

    def chosen(*grid, **lattice):
        return resolve_calibration(scene, grid, Lattice(**lattice))

    assert chosen(5, 5, 2, grading="auto")[0] == chosen(5, 5, 2, calibration="auto")[0] == MEMBRANE
    assert chosen(5, 5, 2, calibration="consistent", grading="auto") == ("consistent", "")
    assert chosen(5, 5, 2, grading=0.5) == chosen(5, 5, 2, grading="auto", k=500.0) == (None, "")
    assert chosen(5, 5, 3, calibration="auto")[0] == "consistent"
    found = solve(scene, "lumped", grid=3, grading="auto").settings
    assert (found["calibration"], found["calibration_reason"]) == (MEMBRANE, "x0 alone holds the sheet")
    assert "calibration_reason" not in solve(scene, "lumped", grid=3).settings
    assert sb.calibrate(scene, grid=3, grading="auto").method == MEMBRANE
    assert sb.calibrate(scene, grid=3).method == "consistent"


@pytest.mark.parametrize(("pull", "method"), [(4000.0, "neo-hookean"), (40.0, MEMBRANE)])
def test_a_sheet_that_a_load_stretches_far_is_rubber_to_auto(pull, method):
    """q a/(E h) = 0.2 and 0.002 of a strip of 5 MPa pulled at one end."""
    sheet, material = sb.Sheet(0.2, 0.1, 0.002), sb.Material(5e6, 0.45, 1000.0)
    load_ = {"kind": "edge", "edge": "x1", "force_per_length": [pull, 0.0, 0.0]}
    scene = Scene(name="strip", sheet=sheet, material=material, supports=[Clamped(edge="x0")], loads=[load_])
    found, why = resolve_calibration(scene, (9, 5, 2), Lattice(calibration="auto"))
    assert found == method and ("q a/(E h)" in why) == (method == "neo-hookean")
    assert resolve_calibration(scene, (9, 5, 2), Lattice()) == (None, "")  # no calibration was named


def test_rubber_gets_the_springs_of_its_law():
    material = {"law": "gent", "shear": 3e5, "limit": 50.0, "poisson": 0.49, "density": 1000.0}
    scene, chosen = RUBBER.replace(material=material), ("hyperelastic", "the material has the law gent")
    for lattice in (Lattice(), Lattice(calibration="auto")):
        assert resolve_calibration(scene, (9, 9, 2), lattice) == chosen
    assert resolve_calibration(scene, (9, 9, 2), Lattice(calibration="uniform"))[0] == "uniform"


SCENE = scenes.load("two-edges-clamped")


def test_training_scenes_are_the_seeds_sheet_held_by_one_and_two_edges():
    one, two = targets.training_scenes(SCENE.sheet, SCENE.material)
    assert [s.edge for s in one.supports] == ["x0"] and [s.edge for s in two.supports] == ["x0", "y0"]
    assert two.gravity == SCENE.gravity


def test_calibrate_trains_on_the_scene_it_is_given(capsys):
    found = []
    for scene in ("two-edges-clamped", "one-edge-clamped"):
        found.append(json_of(capsys, "calibrate", scene, "--calibration", "fit-static", "--grid", "5"))
    assert found[0]["springs"] != found[1]["springs"]
    assert found[0]["fit"]["residual"] < 0.01
    assert set(found[0]["fit"]["half_widths"]) <= set(found[0]["springs"])


def test_a_scene_in_which_nothing_moves_is_nothing_to_train_on():
    still = SCENE.replace(gravity=None)
    with pytest.raises(BadInput, match="nothing moves"):
        resolve(SCENE, Lattice(3, "fit-static")).calibrated([still])

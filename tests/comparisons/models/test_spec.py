"""Specs, one noun for a model in Python, text and JSON; which springs a scene gets by itself."""

import json

import numpy as np
import pytest
from commands import json_of

import sheetbench as sb
from comparisons.models import training as targets
from comparisons.models.context import context, running
from comparisons.models.method import FAR, MEMBRANE, method_for, resolve_calibration
from comparisons.models.resolve import resolve
from comparisons.models.scales import scales
from comparisons.models.spec import Lattice, Spec, parse, spec_of
from comparisons.tradeoff.choices import of_lattices
from sheetbench.errors import BadInput
from sheetbench.face import solve
from sheetbench.scenes import Clamped, Scene, load
from sheetbench.scenes.objects.grading import Grading

SPECS: dict[str, Spec] = {
    "lumped": sb.Lattice(),
    "lumped:grid=9x13x2,k=550.0,grading=0.5:x0,linear=true": sb.Lattice(
        (9, 13, 2), k=550.0, grading="0.5:x0", linear=True
    ),
    "shell:elements=8x4,law=biot": sb.Elements("shell", (8, 4), law="biot"),
    "solid:elements=4,layers=2": sb.Elements("solid", 4, layers=2),
    "calculix:elements=4": sb.External("calculix", {"elements": 4}),
}


@pytest.mark.parametrize("text", SPECS)
def test_a_spec_reads_and_writes_itself(text):
    spec = SPECS[text]
    assert str(spec) == text and parse(text) == spec
    assert spec_of(spec.model, json.loads(json.dumps(spec.settings))) == spec


def test_what_comes_from_elsewhere_is_plain_data():
    spec = sb.Lattice(np.array([5, 7]), grading=Grading(0.5, ("x0",)))
    assert json.loads(json.dumps(spec.settings)) == {"grid": [5, 7], "grading": "0.5:x0"}


def test_a_reference_is_a_spec_or_its_name_and_keywords():
    few, spec = {"grid": 3, "uncertainty": False}, sb.Elements("shell", 3, law="biot")
    flat = sb.compare("one-edge-clamped", reference="shell", elements=3, law="biot", **few)
    both = sb.compare("one-edge-clamped", sb.Lattice(3), spec, uncertainty=False, model=["plate"])
    assert both.reference.settings == flat.reference.settings
    assert "plate" in [one.model for one in both.solutions]
    answer, points = sb.solve("one-edge-clamped", spec), both.scene.probe_points()
    assert np.array_equal(answer.displacement(points), both.reference.displacement(points))


@pytest.mark.parametrize(("ask", "said"), [
    (lambda scene: sb.modes(scene, sb.Lattice(linear=True)), "linear: no effect on modes"),
    (lambda scene: sb.simulate(scene, lattice=sb.Lattice(masses="gregory")), "masses: no effect on motion"),
    (lambda scene: sb.tradeoff(scene, tolerance=0.1, lattice=sb.Lattice(9)), "grid = 9: is chosen by"),
    (lambda scene: sb.solve(scene, sb.External("nosuch")), "model = 'nosuch': unknown"),
    (lambda scene: sb.solve(scene, "shell", k=3.0), "shell: no option 'k'; it has elements, graded"),
])  # fmt: skip
def test_what_does_not_go_with_a_question_is_refused(ask, said):
    with pytest.raises(sb.BadInput, match=said):
        ask("one-edge-clamped")


def test_a_context_holds_for_a_block_and_for_a_call():
    reports: list[object] = []
    with running(progress=reports.append):
        sb.solve("one-edge-clamped", "plate", elements=2)
        assert context().progress == reports.append and not context().large
    assert reports and context().progress != reports.append
    sb.solve("one-edge-clamped", "plate", elements=2, large=True)
    assert not context().large


def test_the_choices_for_a_scene_hold_for_another_one():
    scene = sb.load("curved-edge")
    meant = resolve(scene, sb.Lattice(calibration="auto", grading="auto"))
    softer = scene.replace(material=scene.material.replace(young=1e6))
    assert meant.on(softer).spec == meant.spec and meant.on(softer).springs != meant.springs
    assert set(meant.reasons) == {"calibration_reason", "grading_reason"}


# ---- which springs
RUBBER = load("two-edges-clamped")


def held(*edges, poisson=0.3, softer=1.0):
    """Habibi et al.'s sheet of another material, clamped along these edges."""
    material = RUBBER.material.replace(poisson=poisson, young=RUBBER.material.young / softer)
    return RUBBER.replace(supports=tuple(Clamped(edge=edge) for edge in edges), material=material)


def test_a_trade_names_the_springs_that_auto_takes():
    """Each once, on every grid, with the reason; what is named outright stays."""
    methods = ["consistent", "consistent-membrane", "auto"]
    found, reasons = of_lattices(RUBBER, Lattice(), ["3", "5"], methods)
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
    rubber = scene.replace(material=scene.material.replace(law="neo-hookean"))
    for own in ({"calibration": "consistent"}, {"k": 500.0}):
        taken, why = resolve_calibration(rubber, (5, 5, 2), Lattice(**own))
        assert taken == own.get("calibration") and why.startswith(
            "linear springs: the material's law neo-hookean"
        )
    assert resolve_calibration(rubber, (5, 5, 2), Lattice(calibration="hyperelastic")) == ("hyperelastic", "")
    assert (
        "linear springs"
        in solve(rubber, "lumped", grid=3, calibration="consistent").settings["calibration_reason"]
    )
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


def test_training_scenes_are_the_seeds_sheet_held_by_one_and_two_edges():
    one, two = targets.training_scenes(RUBBER.sheet, RUBBER.material)
    assert [s.edge for s in one.supports] == ["x0"] and [s.edge for s in two.supports] == ["x0", "y0"]
    assert two.gravity == RUBBER.gravity


def test_calibrate_trains_on_the_scene_it_is_given(capsys):
    found = []
    for scene in ("two-edges-clamped", "one-edge-clamped"):
        found.append(json_of(capsys, "calibrate", scene, "--calibration", "fit-static", "--grid", "5"))
    assert found[0]["springs"] != found[1]["springs"]
    assert found[0]["fit"]["residual"] < 0.01
    assert set(found[0]["fit"]["half_widths"]) <= set(found[0]["springs"])


def test_a_scene_in_which_nothing_moves_is_nothing_to_train_on():
    still = RUBBER.replace(gravity=None)
    with pytest.raises(BadInput, match="nothing moves"):
        resolve(RUBBER, Lattice(3, "fit-static")).calibrated([still])

"""Specs: one noun for a model, in Python, as text and as JSON."""

import json

import numpy as np
import pytest

import sheetbench as sb
from comparisons.models.context import context, running
from comparisons.models.resolve import resolve
from comparisons.models.spec import Spec, parse, spec_of
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
    (lambda scene: sb.tradeoff(scene, tolerance=0.1, lattice=sb.Lattice(9)), "grid = 9: is chosen here"),
    (lambda scene: sb.solve(scene, sb.External("nosuch")), "model = 'nosuch': unknown"),
    (lambda scene: sb.solve(scene, "shell", k=3.0), "shell: no option 'k'"),
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

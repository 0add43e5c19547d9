"""The advisor: what it chooses and leaves out."""

import json
import re
import shlex
from dataclasses import replace

import pytest
from answers import once
from cases import sheet
from commands import json_of

from comparisons.models import solve as solvers
from comparisons.models.resolve import resolve
from comparisons.models.scales import scales
from comparisons.models.spec import Elements
from comparisons.sweep import in_process as table
from comparisons.sweep.differences import error
from comparisons.sweep.front import cheapest
from comparisons.tradeoff.advisor import advise
from sheetbench import scenes
from sheetbench.scenes import Clamped, Gravity, Point

SECONDS = 1e-5  # an unknown and factorisation
answer = once(solvers.solve)  # one for all tests: what is looked at is what the advisor makes of it


@pytest.fixture(autouse=True)
def clock(monkeypatch):
    """Every solve takes what its size says, however busy the machine is."""

    def answer_in_time(model, name="", near=None):
        solution = replace(answer(model), model=name or model.spec.model)
        seconds = SECONDS * solution.unknowns * (1 + solution.iterations)
        return replace(solution, solve_seconds=seconds)

    monkeypatch.setattr(table, "solve", answer_in_time)


def actual_error(advice):
    """Error of the choice against a shell that the advisor does not see."""
    points, specs = advice.scene.probe_points(), (advice.choice, Elements("shell", 16))
    return error(*(answer(resolve(advice.scene, spec)).displacement(points) for spec in specs))


def test_scales_of_the_seed_sheet():
    found = scales(scenes.load("two-edges-clamped"))
    rigidity = 54.5e6 * 0.003**3 / 12 / (1 - 0.48**2)
    assert found.load_number == pytest.approx(1678 * 9.81 * 0.003 * 0.188**3 / rigidity)
    assert found.slenderness == pytest.approx(0.003 / 0.188)
    assert found.strain == pytest.approx(1678 * 9.81 * 0.188 / 54.5e6)


def test_the_load_number_is_of_the_length_that_hangs():
    """A strip held at a short edge; at a long one, and at both, it reaches over its shorter side."""
    strip = sheet(0.12, 0.04, 0.002, weight=9.81)
    far = scales(strip)
    assert far.span == 0.12
    assert far.span_load_number == pytest.approx(27.0 * far.load_number)
    across = Clamped(edge="y0")
    for held in ((across,), (*strip.supports, across)):
        near = scales(strip.replace(supports=held))
        assert near.span == 0.04 and near.span_load_number == near.load_number


@pytest.mark.sweep(4)
@pytest.mark.parametrize("name", ["two-edges-clamped", "one-edge-clamped", "curved-edge"])
@pytest.mark.parametrize("tolerance", [0.05, 0.01, 0.003])
def test_the_choice_meets_the_tolerance(name, tolerance):
    """The shell's own model error, 0.5 % on the curved edge by its law of strain, counts."""
    advice = advise(scenes.load(name), tolerance)
    assert advice.model is not None
    assert advice.succeeded == (advice.model.value < tolerance) == ("own model error" not in advice.reason)
    assert actual_error(advice) <= tolerance


def test_what_the_scene_does_not_need_is_left_out():
    """A hundredth of its weight bends it slightly."""
    scene = scenes.load("one-edge-clamped").replace(gravity=Gravity((0.0, 0.0, -0.0981)))
    light, heavy = advise(scene, 0.02), advise(scenes.load("two-edges-clamped"), 0.01)
    assert light.choice.settings.get("linear") or light.choice.model == "plate"
    assert "large displacements" not in light.needs and actual_error(light) <= 0.02
    said = " ".join(light.left_out)
    assert "dynamics" in said and "nonlinearity" in said
    assert heavy.choice is not None and not any(spec.settings.get("linear") for spec in heavy.trials.rows)
    assert {"bending", "membrane stiffening", "large displacements"} <= set(heavy.needs)


def test_within_a_budget_the_most_accurate_is_chosen():
    scene = scenes.load("two-edges-clamped")
    short, long = advise(scene, None, 0.02), advise(scene, None, 0.2)
    assert short.succeeded and long.succeeded
    assert short.chosen.seconds <= 0.02 and long.error <= short.error
    hopeless = advise(scene, 0.01, 1e-7)
    assert not hopeless.succeeded and hopeless.choice is None and "no model solves this" in hopeless.message


def test_a_scene_with_actuators():
    advice = advise(scenes.load("actuated-edge"), 0.05)
    assert "actuators" in advice.needs
    assert actual_error(advice) <= 0.05


def test_the_printed_command_solves_the_choice(capsys):
    advice = json_of(capsys, "tradeoff", "curved-edge", "--tolerance", "0.02")
    _, *arguments = shlex.split(advice["command"])
    solved = json_of(capsys, *arguments)["solutions"]
    choice = advice["choice"]
    alike = [one["settings"] for one in solved if one["model"] == choice["model"]]
    assert any(choice["settings"].items() <= settings.items() for settings in alike)


def test_one_rule_says_what_a_tolerance_is_held_against():
    """Error, bar and model error together, as a column and in a sentence; the cheapest of the table."""
    advice = advise("two-edges-clamped", 0.01)
    assert advice.tolerance == 0.01 and advice.model is not None and advice.choice is not None
    assert advice.heading()[0] == "two-edges-clamped"
    rows, predicted = (advice.document()[key] for key in ("tried", "predicted"))
    assert 0.0 < predicted["model"] == pytest.approx(sum(predicted["model_parts"].values()), rel=1e-12)
    for row in rows:
        assert row["total"] == pytest.approx(row["error"] + advice.bar + advice.model.value)
    assert 0.0 < predicted["error"] < predicted["field_error"] < 0.02
    (table,) = advice.tables()
    taken = r"model error takes 0\.\d+ %, its mesh's bar 0\.\d+ %: 0\.\d+ % are left for the grid\."
    assert re.fullmatch(f"Of 1 % the shell's {taken}", table.text)
    within = [row for row in rows if row["total"] <= 0.01]
    cheapest = min(within, key=lambda row: row["solve_seconds"])
    assert cheapest["settings"] == json.loads(json.dumps(advice.choice.settings))
    (tight,) = advise("two-edges-clamped", 0.5 * advice.model.value).tables()
    assert " %, exceeds " in tight.text and "of a converged shell only" in tight.text


def test_cheapest_row_allows_for_the_model_error():
    """0.92 % off are within 1 % but for what the reference leaves out."""
    names, errors, seconds = ("coarse", "fine"), (0.0092, 0.003), (1e-3, 1e-2)
    assert cheapest(names, errors, seconds) == ["Cheapest within 5 %: coarse, 0.92 % off in 1 ms."]
    (of_five, of_one) = cheapest(names, errors, seconds, bar=0.0, model_error=0.002)
    assert of_five.startswith("Cheapest within 5 %: coarse") and of_one.startswith(
        "Cheapest within 1 %: fine"
    )
    (converged,) = cheapest(("finest",), (5e-4,), (1.0,), model_error=0.06)
    assert converged.startswith("Cheapest within 5 % of a converged reference: finest")


def test_models_may_be_named():
    lattice = advise("two-edges-clamped", 0.01, models=["lumped"])
    assert lattice.succeeded and lattice.choice.model == "lumped"
    assert lattice.error + lattice.bar + lattice.model.value <= 0.01
    hopeless = advise("two-edges-clamped", 1.05 * lattice.model.value, models=["lumped"])
    assert not hopeless.succeeded and hopeless.choice.model == "lumped"
    assert "no model here is within" in hopeless.reason


def test_grids_without_a_mass_at_a_held_point_are_left_out_and_named():
    """Four lines along a side cannot pass through three points within it."""
    points = tuple(Point(at=at) for at in ((0.0, 0.02), (0.0, 0.06), (0.03, 0.04)))
    scene = sheet(0.12, 0.08, 0.003, weight=0.1, supports=points, probes={"tip": [0.12, 0.04]})
    advice = advise(scene, 0.2)
    assert advice.succeeded
    assert any("lumped 4×3×2 left out: support 1.at" in warning for warning in advice.warnings)

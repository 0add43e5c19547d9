"""Quantities with units where a person types them: options; and -V, help VERB."""

import pytest
from commands import json_of, run

import sheetbench as sb
from comparisons.models.quantities import sides


def test_options_take_units(capsys):
    common = ("calibrate", "--poisson", "0.45", "--grid", "3")
    units, plain = (
        ("--young", "0.6 MPa", "--thickness", "2mm", "--side", "12cmx40 mm", "--density", "1.1 g/cm3"),
        ("--young", "6e5", "--thickness", "0.002", "--side", "0.12x0.04", "--density", "1100"),
    )
    assert json_of(capsys, *common, *units)["springs"] == json_of(capsys, *common, *plain)["springs"]


OBLONG = ("120x80 mm", "12 × 8cm", "1.2e2X80mm", "12cmx80mm", "0.12x0.08", [0.12, "80 mm"])


def test_a_unit_at_the_end_is_that_of_both_sides():
    """Of 0.12x80 mm too, which is refused or warned of as a sheet, not guessed."""
    for text in OBLONG:
        assert tuple(sides(text).values()) == pytest.approx((0.12, 0.08), rel=1e-12), text
    for text, lengths in (("0.12x80 mm", (0.12e-3, 0.08)), ("80 mm", (0.08, 0.08)), (0.12, (0.12, 0.12))):
        assert tuple(sides(text).values()) == pytest.approx(lengths, rel=1e-12)


def test_the_version_and_the_help_of_a_verb_have_short_ways(capsys):
    assert run("-V") == 0 and capsys.readouterr().out.startswith("sheetbench ")
    assert run("check", "--help") == 0
    page = capsys.readouterr().out
    assert run("help", "check") == 0 and capsys.readouterr().out == page
    assert run("help") == 0 and "compare" in capsys.readouterr().out


WRONG = {
    "calibrate": {"loss_factor": "a lot", "thickness": [1.0], "prony": 3, "lattice": {"grid": 9}, "cell": {}},
    "check": {"scene": 7.5, "out": True, "progress": "yes"},
    "compare": {"elements": {}, "reference": b"shell", "k": "soft"},
    "report": {"folder": 5},
    "stability": {"vary": [object()]},
}


@pytest.mark.parametrize(("verb", "name"), [(verb, name) for verb, given in WRONG.items() for name in given])
def test_values_of_another_kind_are_refused_by_name_in_python(verb, name):
    scene = {} if verb == "report" or name == "scene" else {"scene": "two-edges-clamped"}
    with pytest.raises(sb.BadInput, match=f"^{name}"):
        getattr(sb, verb)(**scene, **{name: WRONG[verb][name]})

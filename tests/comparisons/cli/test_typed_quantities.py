"""Quantities with units where a person types them: options, the questions of `new`; and -V, help VERB."""

import json

import pytest
import typer
from commands import run

import sheetbench as sb
from comparisons.cli import new
from comparisons.models.quantities import sides


def test_options_take_units(capsys):
    common = ("calibrate", "--poisson", "0.45", "--grid", "3", "--json")
    options = ("--young", "0.6 MPa", "--thickness", "2mm", "--side", "12cmx40 mm", "--density", "1.1 g/cm3")
    assert run(*common, *options) == 0
    typed = json.loads(capsys.readouterr().out)
    assert (
        run(*common, "--young", "6e5", "--thickness", "0.002", "--side", "0.12x0.04", "--density", "1100")
        == 0
    )
    assert json.loads(capsys.readouterr().out)["springs"] == typed["springs"]


@pytest.mark.parametrize(
    ("text", "lengths"),
    [
        ("120x80 mm", (0.12, 0.08)),
        ("12 × 8cm", (0.12, 0.08)),
        ("1.2e2X80mm", (0.12, 0.08)),
        ("12cmx80mm", (0.12, 0.08)),
        ("0.12x80 mm", (0.12e-3, 0.08)),  # refused or warned of as a sheet, not guessed
        ("0.12x0.08", (0.12, 0.08)),
        ("80 mm", (0.08, 0.08)),
    ],
)
def test_a_unit_at_the_end_is_that_of_both_sides(text, lengths):
    assert tuple(sides(text).values()) == pytest.approx(lengths, rel=1e-12)


@pytest.fixture
def typed(monkeypatch):
    """The answers typed to the questions, in their order; "" takes what is offered."""
    answers: list[str] = []

    def prompt(question, default):
        return answers.pop(0) or default

    monkeypatch.setattr(typer, "prompt", prompt)
    monkeypatch.setattr(typer, "confirm", lambda question, default: answers.pop(0) == "y")
    monkeypatch.setattr(new, "_at_a_terminal", lambda: True)
    return answers


def test_new_asks_again_and_converts(tmp_path, typed, capsys):
    typed += [
        "120 mm",
        "4 cm",
        "2 MPa",
        "2 mm",
        "0.6 MPa",
        "0.45",
        "1,1 g/cm3",
        "1.1 g/cm3",
        "z0",
        "x0,x1",
        "3 Pa",
    ]
    assert run("new", str(tmp_path / "strip.toml")) == 0
    scene = sb.load(tmp_path / "strip.toml")
    assert scene.sheet == sb.Sheet(0.12, 0.04, 0.002)
    assert scene.material == sb.Material(0.6e6, 0.45, 1100.0)
    assert [support.edge for support in scene.supports] == ["x0", "x1"]
    assert scene.loads == (sb.Pressure(3.0),) and not typed
    said = capsys.readouterr().err
    assert "needed is a length" in said and "decimal point" in said and "z0" in said


def test_new_warns_before_it_writes(tmp_path, typed, capsys):
    typed += ["120", "40", "2", "", "", "", "", "", "n"]
    assert run("new", str(tmp_path / "mm.toml")) == 0
    assert "lengths are in metres" in capsys.readouterr().err
    assert not (tmp_path / "mm.toml").exists()


def test_the_version_and_the_help_of_a_verb_have_short_ways(capsys):
    assert run("-V") == 0 and capsys.readouterr().out.startswith("sheetbench ")
    assert run("check", "--help") == 0
    page = capsys.readouterr().out
    assert run("help", "check") == 0 and capsys.readouterr().out == page
    assert run("help") == 0 and "compare" in capsys.readouterr().out

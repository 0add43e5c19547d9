"""A folder's own options, from a file."""

import pytest
from commands import json_of, one_line, run

from comparisons.cli.arguments import FILE
from comparisons.cli.arguments import with_defaults as with_defaults_of

VERBS = ("compare", "modes")
OPTIONS = ("grid", "layer-distance", "uncertainty", "no-uncertainty", "model", "animate", "count", "large")


def with_defaults(arguments, verbs):
    return with_defaults_of(arguments, verbs, lambda verb: [f"--{name}" for name in OPTIONS])


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_options_of_the_file_come_before_those_of_the_command(folder, capsys):
    text = '[compare]\ngrid = "3"\nlayer_distance = -1\nuncertainty = false\nmodel = ["a", "b"]\n'
    text += "animate = true\nlarge = false\n"
    (folder / FILE).write_text(text + "[modes]\ncount = 2\n", encoding="utf-8")
    options = ["--grid=3", "--layer-distance=-1", "--no-uncertainty", "--model=a", "--model=b", "--animate"]
    assert with_defaults(["compare", "S", "--grid", "5"], VERBS) == ["compare", *options, "S", "--grid", "5"]
    assert capsys.readouterr().err == f"{FILE}: compare {' '.join(options)}\n"
    assert with_defaults(["modes", "S", "--quiet"], VERBS) == ["modes", "--count=2", "S", "--quiet"]
    assert "--no-uncertainty" not in with_defaults(["compare", "S", "--uncertainty"], VERBS)
    capsys.readouterr()
    assert with_defaults(["check", "S"], VERBS) == ["check", "S"]
    assert with_defaults(["modes", "--help"], VERBS) == ["modes", "--help"] and with_defaults([], VERBS) == []
    assert capsys.readouterr().err == ""


def test_a_command_takes_them(folder, capsys):
    (folder / FILE).write_text("[modes]\ncount = 2\nelements = 2\ngrid = 3\n", encoding="utf-8")
    lattice, shell = json_of(capsys, "modes", "one-edge-clamped", "--count", "1")["solutions"]
    assert lattice["settings"]["grid"] == [3, 3, 2] and shell["settings"]["elements"] == [2, 2]
    assert len(lattice["frequencies_hz"]) == 1


def test_a_flag_that_is_false_is_left_out(folder, capsys):
    (folder / FILE).write_text(
        "[modes]\nlarge = false\ncount = 2\nelements = 2\ngrid = 3\n", encoding="utf-8"
    )
    assert json_of(capsys, "modes", "one-edge-clamped")["solutions"][0]["settings"]["grid"] == [3, 3, 2]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[modes\n", "cannot be read"),
        ("[mode]\ncount = 2\n", "mode: a table of a verb is needed"),
        ("count = 2\n", "count: a table of a verb is needed"),
        ("[modes]\ncount = {a = 1}\n", "modes.count: a number"),
        ("[modes]\nmany = 2\n", "modes.many: no option"),
        ("[modes]\ncounts = 2\n", "modes.counts: no option; did you mean count?"),
    ],
)
def test_a_file_that_cannot_be_meant_is_refused_in_a_line(folder, capsys, text, said):
    (folder / FILE).write_text(text, encoding="utf-8")
    assert run("modes", "one-edge-clamped", "--quiet") == 2
    assert said in one_line(capsys)

"""A sheet that buckles, in every verb that solves one: with exit status 3 too --json prints one."""

import json

import pytest
from commands import run

SCENE = """name = "buckled"
sheet = { length_x = 0.12, length_y = 0.1, thickness = 0.003 }
material = { young = 1e6, poisson = 0.4, density = 1000.0 }
[[support]]
edge = "x0"
kind = "clamped"
[[load]]
kind = "edge"
edge = "x1"
force_per_length = [-2.0, 0.0, 0.0]
"""
STATIC = {  # the small question of each, about an equilibrium that does not hold
    "compare": "--lumped 3 --elements 2",
    "modes": "--about deformed --lumped 3 --elements 2",
    "modes --state-space": "3 --lumped 3",
    "identify": "--measured {heights} --lumped 3",
    "tradeoff": "--lumped 3 --plate= --shell 2 --solid= --elements 3 --repeats 1 --workers 1",
    "crosscheck": "--lumped 3,4 --plate= --shell 2,3 --solid= --judges= --workers 1",
    "stability": "--lumped 3 --elements 2 --vary grid --workers 1",
    "tradeoff --tolerance": "0.9",
}
MAPS = ("tradeoff", "crosscheck", "stability")  # of many solves, each with its status


@pytest.mark.sweep(2)
@pytest.mark.usefixtures("few", "undrawn")
@pytest.mark.parametrize("verb", STATIC)
def test_an_answer_that_is_none_is_a_document_too(verb, places, tmp_path, capsys):
    arguments = STATIC[verb].format(**places).split()
    (tmp_path / "buckled.toml").write_text(SCENE)
    name, *first = verb.split()
    status = run(name, str(tmp_path / "buckled.toml"), *first, *arguments, "--json")
    said = capsys.readouterr()
    assert status == (0 if verb in MAPS else 3) and "Traceback" not in said.err
    document = json.loads(said.out)
    assert "unstable" in json.dumps(document)
    assert verb == "stability" or "negative" in said.err, "it maps what holds; others say why this does not"

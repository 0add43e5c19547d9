"""The same words mean the same lattice in every verb and function: the constants that a solver gets."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from commands import run

import lumped
import sheetbench as sb
from comparisons.live import server
from comparisons.models import solve as solvers
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from comparisons.sweep import campaign, task
from comparisons.sweep.campaign import function
from comparisons.tradeoff.trials import TrialSolves
from sheetbench.scenes import SpringSet

CONSUMERS = ("solve", "simulate", "modes", "linearise", "sensitivity", "describe", "build_problem")
WORDS = frozenset({"grid", "calibration", "k", "layer_distance", "grading"})
LISTS = {"grid": "9", "calibration": "consistent"}  # of verbs that take several, unless given
OPTIONS: tuple[dict[str, Any], ...] = (
    *({}, {"grid": "5"}, {"grid": "5x7"}, {"calibration": "van-gelder"}, {"calibration": "auto"}),
    *({"k": 550.0}, {"layer_distance": 0.004}, {"grid": "4", "k": 550.0, "layer_distance": 0.004}),
    *({"grading": "0.3"}, {"grading": "0.4:x0"}, {"grading": "auto"}),
    {"calibration": "consistent", "grading": "auto"},
)
SCENE = "curved-edge"  # whose calibration and grading "auto" are others than the usual ones


class Used(BaseException):
    """The springs that a solver was given."""


def used(scene, springs, *_, **__):
    raise Used(springs)


def carried_out(runs, *_, **__):
    """The lattices among the runs of a campaign, here."""
    for one in runs:
        if one.arguments.get("model", "lumped") == "lumped":
            function(one.task)(**one.arguments)


@pytest.fixture(autouse=True)
def caught(monkeypatch, tmp_path):
    for name in CONSUMERS:
        monkeypatch.setattr(lumped, name, used)
    monkeypatch.setattr(campaign, "carry_out", carried_out)
    monkeypatch.setattr(lumped, "shortest_period", lambda *_: 1.0)
    monkeypatch.setattr(lumped, "explicit_limit", lambda *_: 1.0)
    for module in (solvers, task):
        monkeypatch.setattr(module, "warm", lambda _: None)
    monkeypatch.setattr(server, "Server", lambda panel, *_: used(panel.scene, of_panel(panel)))
    monkeypatch.chdir(tmp_path)
    Path("measured.csv").write_text(FILE, encoding="utf-8")


def of_panel(panel):
    values = {name: slider.value for name, slider in panel.sliders.items()}
    sent = {"number": 0, "values": values, "calibration": panel.start}
    return resolve(panel.scene, panel.read(json.dumps(sent)).lattice).springs


def verb(words):
    """The command line with the options of a lattice."""

    def ask(scene, **options):
        flags = {f"--{key.replace('_', '-')}": options[key] for key in options}
        run(*words.format(scene).split(" "), *(str(part) for pair in flags.items() for part in pair))

    return ask


def python(function):
    """A function of the package: a grid as text is a number there, or numbers."""

    def call(scene, grid=None, **options):
        shape = {} if grid is None else {"grid": int(grid) if str(grid).isdigit() else grid}
        function(sb.load(scene), **shape, **options)

    return call


def of_advice(scene, **options):
    """Of the last lattice of 9 × 9 masses that may be chosen."""
    found = TrialSolves(scene, Lattice(**options), ["lumped"]).candidates(linear=False)
    (*_, last) = [c for c in found if c.settings["grid"] == [9, 9, 2]]
    raise Used(resolve(scene, last).springs)


FILE = "x,y,uz\n0.094,0.094,-0.002\n0.188,0.188,-0.013\n"
GRIDS = WORDS - {"k", "layer_distance"}
VERBS: dict[str, tuple[Callable[..., None], frozenset[str]]] = {
    "compare": (verb("compare {}"), WORDS),
    "simulate": (verb("simulate {} --duration 0.01"), WORDS),
    "modes": (verb("modes {}"), WORDS),
    "state space": (verb("modes {} --state-space 20"), WORDS),
    "identify": (verb("identify {} --measured measured.csv --unknown thickness"), WORDS),
    "calibrate": (verb("calibrate {} --export lattice"), WORDS),
    "tradeoff of a motion": (verb("tradeoff {} --duration 0.01"), WORDS),
    "tradeoff": (verb("tradeoff {} --shell= --solid= --plate="), WORDS),
    "crosscheck": (verb("crosscheck {} --grid 9,13 --shell="), WORDS - {"grid"}),
    "advise": (python(of_advice), WORDS - {"grid"}),
    "live": (verb("live {} --no-browser"), GRIDS),
    "sb.solve": (python(sb.solve), WORDS),
}
ANEW = {"calibrate", "identify"}  # make the springs, whatever the scene has
NAMED = {"tradeoff"}  # lists its calibrations, where the others leave them open
CHOSEN = {*NAMED, "crosscheck", "advise"}
UNABLE = {"live": ("5x7", "0.4:x0")}  # one number for the grid, one grading for all edges


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", VERBS)
def test_the_same_words_are_the_same_lattice(name):
    ask, words = VERBS[name]
    scene = sb.load(SCENE)
    for options in OPTIONS:
        if not words >= options.keys() or not set(UNABLE.get(name, ())).isdisjoint(options.values()):
            continue
        usual = {**LISTS, **({"calibration": "uniform"} if "k" in options else {})} if name in NAMED else {}
        meant = Lattice(**usual | options)
        assert springs_of(ask, SCENE, **usual | options) == constants(resolve(scene, meant).springs), options


@pytest.mark.parametrize("name", [name for name in VERBS if name not in CHOSEN])
def test_every_verb_takes_a_scenes_own_springs(name):
    """Where nothing is named the scene's own [springs] are meant; in any case their grid is the usual one."""
    ask, words = VERBS[name]
    plain = sb.load(SCENE)
    springs = lumped.calibrate(plain.sheet, plain.material, grid=(4, 6), method="uniform", k=400.0)
    table = {**springs.document()["springs"], "layer_distance": springs.layer_distance, "grid": [4, 6, 2]}
    scene = plain.replace(springs=SpringSet.model_validate(table))
    scene.save("own.toml")
    for options in ({}, {"calibration": "van-gelder"}, {"k": 550.0}):
        if words >= options.keys() and not (name == "live" and options):  # whose grid is the slider's
            expected = resolve(scene, Lattice(**options), scene_springs=name not in ANEW).springs
            assert springs_of(ask, "own.toml", **options) == constants(expected), options
            assert tuple(expected.grid) == (4, 6, 2)


def constants(springs):
    """What a lattice is made of."""
    document = springs.document()
    return {key: document.get(key) for key in ("method", "grid", "grading", "springs", "layer_distance")}


def springs_of(ask, scene, **options):
    """The constants that a solver is given."""
    with pytest.raises(Used) as used:
        ask(scene, **options)
    return constants(used.value.args[0])

"""Numbers that nobody means: one line that names the option or the key, or a status that says so."""

import re
import warnings

import pytest
from commands import json_of, one_line, run
from scene_files import GOOD, written

import lumped
from sheetbench import face as models
from sheetbench import scenes
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.scenes.objects.quantities import LARGEST, SMALLEST

SEED, SETTLING = "two-edges-clamped", "two-edges-settling"
COMPARE = ("compare", SEED, "--lumped", "3", "--elements", "2", "--no-uncertainty")
CALIBRATE = ("calibrate", SEED, "--grid", "3")
SIMULATE = ("simulate", SETTLING, "--lumped", "3")
OPTIONS = [
    *((verb, option) for verb in (COMPARE, CALIBRATE) for option in ("--layer-distance", "--k")),
    *((CALIBRATE, option) for option in ("--young", "--side", "--thickness", "--density", "--poisson")),
    *((SIMULATE, option) for option in ("--step", "--duration", "--every")),
    (("tradeoff", SEED), "--duration"),
    (("tradeoff", SEED), "--tolerance"),
]


@pytest.mark.parametrize("value", ["1e-308", "1e308", "inf", "nan"])
@pytest.mark.parametrize(
    ("verb", "option"), OPTIONS, ids=lambda part: part if isinstance(part, str) else part[0]
)
def test_an_extreme_option_is_refused_by_its_name(verb, option, value, capsys):
    if option in ("--poisson", "--tolerance") and value == "1e-308":
        return  # as good as 0, or as strict as may be
    assert run(*verb, option, value) == 2
    assert option.removeprefix("--") in one_line(capsys)


@pytest.mark.parametrize("value", ["1e-308", "1e308", "1e16", "1e-13"])
@pytest.mark.parametrize("key", ["length_x", "thickness", "young", "density"])
def test_an_extreme_quantity_of_a_scene_is_refused(key, value, tmp_path):
    lines = [f"{key} = {value}" if line.startswith(f"{key} ") else line for line in GOOD.splitlines()]
    with pytest.raises(BadInput, match=re.escape(f".{key} = {float(value):g}: must be 1e")):
        scenes.load(written(tmp_path, "\n".join(lines)))


@pytest.mark.parametrize("factor", [SMALLEST, LARGEST])
@pytest.mark.parametrize("key", ["young", "density"])
@pytest.mark.parametrize(("model", "size"), [("lumped", {"grid": 3}), ("shell", {"elements": 2})])
def test_what_is_just_allowed_ends_in_a_status(key, factor, model, size):
    scene = scenes.load(SEED)
    scene = scene.replace(material=scene.material.replace(**{key: factor}))
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        solution = models.solve(scene, model, **size)
    assert isinstance(solution.status, Status)


@pytest.mark.parametrize("k", [SMALLEST, LARGEST])
def test_springs_just_allowed_end_in_a_status(k):
    scene = scenes.load(SEED)
    springs = lumped.calibrate(scene.sheet, scene.material, 3, "uniform", k=k)
    assert isinstance(lumped.solve(scene, springs).status, Status)


def test_a_step_longer_than_the_run_is_the_run(capsys):
    assert json_of(capsys, *SIMULATE, "--step", "1e15", "--duration", "0.001")["steps"] == 1


def test_of_many_faults_three_are_told_and_the_rest_counted(tmp_path):
    text = GOOD
    for key in ("length_x", "length_y", "thickness", "young", "density"):
        lines = [f"{key} = 1e308" if line.startswith(f"{key} ") else line for line in text.splitlines()]
        text = "\n".join(lines)
    with pytest.raises(BadInput, match="; and 2 more") as error:
        scenes.load(written(tmp_path, text))
    assert str(error.value).count("must be") == 3

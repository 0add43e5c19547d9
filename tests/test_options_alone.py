"""Each option of each verb, alone: the answer's numbers change, in Python too, or it is refused.

An option is in a table, or in `SAME` or `SAME_OF` with the reason.
"""

import json
import math

import pytest
from commands import run
from verbs import TENSILE, in_python, values_of
from verbs import write_inputs as write_inputs_of_verbs

from comparisons.cli.app import verb_group
from sheetbench.errors import BadInput
from sheetbench.scenes import load
from sheetbench.scenes.language.toml import to_toml

SPRINGS = {
    "--lumped": "4",
    "--calibration": "uniform",
    "--k": "550",
    "--layer-distance": "0.004",
    "--grading": "0.4",
}
SEED, ONE, SETTLING = "two-edges-clamped", "one-edge-clamped", "two-edges-settling"
BASE = {
    "compare": f"{SEED} --lumped 3 --elements 2",
    "simulate": f"{SETTLING} --lumped 3 --duration 0.01 --every 0.002",
    "modes": f"{ONE} --lumped 3 --elements 2 --count 2",
    "calibrate": f"{ONE} --lumped 3",
    "identify": f"{SEED} --measured measured.csv --lumped 3",
    "tradeoff": f"{ONE} --lumped 3,4 --plate= --shell 2 --solid= --elements 3 --repeats 1 --workers 1",
    "crosscheck": f"{ONE} --lumped 3,4 --plate= --shell 2,3 --solid= --judges= --workers 1",
    "stability": f"{ONE} --lumped 3 --elements 2 --vary load --workers 1",
    "check": ONE,
    "score": "answers.csv --case thick",
    "verify": "--case patch",
}
VALUES = {  # of options that all verbs with them take alike, then of verbs
    **SPRINGS,
    "--reference": "plate",
    "--elements": "3",
    "--law": "biot",
    "--uncertainty": None,
    "--no-uncertainty": None,
    "--duration": "0.004",
    "--animate": None,
    "--model": "plate",
    "--branch": "buckled",
    "--step": "1e-3",
    "--integrator": "verlet",
    "--every": "0.001",
    "--measured": "other.csv",
    "--error": "1e-5",
    "--count": "3",
    "--masses": "tributary",
    "--about": "deformed",
    "--state-space": "4",
    "--cell": "one-diagonal",
    "--schema": None,
    "--no-refine": None,
    "--reduce": "balanced:2",
    "--young": "2e6",
    "--poisson": "0.3",
    "--thickness": "0.004",
    "--density": "900",
    "--side": "0.1",
    "--calibration": "central",
    "--for": "mujoco",
    "--unknown": "poisson",
    "--offset": "0.001",
    "--tensile": "tensile-softer.csv",
    "--up-to": "2",
    "--area": "18mm2",
    "--gauge": "40mm",
    "--loss-factor": "0.2 --at 5",
    "--at": "5",
    "--band": "2 8 --loss-factor 0.2",
    "--prony": "prony.csv",
    "--plate": "2,3",
    "--shell": "3,4",
    "--solid": "1,2",
    "--repeats": "2",
    "--judges": "calculix",
    "--meshes": "2,3",
    "--vary": "slenderness",
    "--tolerance": "0.02",
    "--budget": "1ms",
    "--spacing": "0.01",
    "--hinge": "angle",
    "--coefficient": "hinge=1e-5",
    "--suite": "curves",
    "--case": "thin",
    "--buckling": None,
    "--settle": None,
    "--sensitivity": "young",
}
OF_VERB = {
    ("tradeoff", "--lumped"): "3,5",
    ("tradeoff", "--elements"): "4",
    ("crosscheck", "--lumped"): "3,5",
    ("modes", "--reference"): "plate",
    ("verify", "--case"): "strain-laws",
    ("identify", "--model"): "solid",
    ("identify", "--uncertainty"): "1mm",
}
SHELL = f"{SEED} --measured measured.csv --model shell --elements 2"
MOVING = f"{SETTLING} --lumped 3,4 --plate= --shell 2 --solid= --elements 3 --workers 1 --duration 0.002"
CELL, STATE_SPACE = f"{ONE} --cell equilateral", f"{SETTLING} --lumped 3 --state-space 3"
PULLED = "--tensile tensile.csv --area 20mm2"
OTHER_BASE = {  # where an option has an effect on something else alone
    ("compare", "--every"): f"{SETTLING} --lumped 3 --elements 2 --duration 0.004",
    ("calibrate", "--at"): f"{ONE} --lumped 3 --loss-factor 0.2 --at 4",
    ("identify", "--elements"): SHELL,
    ("identify", "--law"): SHELL,
    ("identify", "--offset"): f"{SEED} --measured cloud.csv --lumped 3",
    ("identify", "--tensile"): PULLED,
    ("identify", "--up-to"): PULLED,
    ("identify", "--area"): PULLED,
    ("identify", "--gauge"): "--tensile machine.csv --area 20mm2 --gauge 50mm",
    ("stability", "--grading"): f"{ONE} --lumped 4 --elements 2 --vary load --workers 1",
    ("tradeoff", "--duration"): MOVING,
    ("tradeoff", "--integrator"): MOVING,
    ("tradeoff", "--grading"): f"{ONE} --lumped 3,4 --plate= --shell 2 --solid= --elements 3 --repeats 1"
    " --workers 1 --calibration consistent",
    ("identify", "--model"): SHELL,
    ("modes", "--buckling"): "edge.toml --lumped 3 --elements 2 --count 2",
    **dict.fromkeys((("modes", "--state-space"), ("modes", "--reduce")), STATE_SPACE),
    **dict.fromkeys((("tradeoff", "--tolerance"), ("tradeoff", "--budget")), f"{ONE} --tolerance 0.2"),
    **{("calibrate", f"--{name}"): CELL for name in ("cell", "spacing", "hinge", "coefficient")},
}
PLACES = "where the answer goes, and how it looks"
SAME = {  # no number of the answer is another with them, and why
    **dict.fromkeys(
        ("--json", "--out", "--overwrite", "--figure", "--no-pictures", "--quiet", "--verbose", "--export"),
        PLACES,
    ),
    **dict.fromkeys(("--toml", "--animate", "--precision"), PLACES),
    "--large": "lets a model be larger than memory",
    **dict.fromkeys(("--workers", "--scheduler", "--retry"), "how runs are carried out"),
    "--repeats": "times alone",
}
SAME_OF = {
    ("check", "--schema"): "the language of scenes in place of a scene",
    ("calibrate", "--from"): "a code's coefficients in place of a scene",
    ("identify", "--refine"): "what is done unless it is declined",
    ("compare", "--uncertainty"): "for motions, and what is done at rest unless it is declined",
    ("compare", "--branch"): "a stable sheet has no other branch; a note says of what it tells",
    ("score", "--suite"): "a case is of one suite, and no other takes it",
    ("crosscheck", "--judges"): "programs that need not be there",
    ("score", "--case"): "said to be not answered yet",
}
TIMES = ("seconds", "front", "memory", "timings", "settings", "time_order", "spread", "busy", "load_average")
TIMES += ("warnings", "compile")
OPTIONS = [
    (verb, name)
    for verb in BASE
    for option in verb_group((verb,)).commands[verb].params
    for name in (*option.opts[:1], *option.secondary_opts)
    if name.startswith("--") and name not in SAME and (verb, name) not in SAME_OF
]


def numbers(document):
    """Every number by the path to it, but those of the clock and repeated of the question."""
    found = values_of(document, TIMES)
    return {key: one for key, one in found if type(one) in (int, float) and math.isfinite(one)}


def write_inputs(folder):
    """What the commands read: displacements, another set of them, a point cloud, a motion, tensile tests."""
    write_inputs_of_verbs(folder)
    displaced = "x,y,ux,uy,uz\n0.188,0.188,-0.0004,-0.0004,-0.012\n0.094,0.094,0,0,-0.0022\n"
    cloud = "x,y,z\n" + "".join(
        f"{x},{y},{-0.35 * x * y * (x + y)}\n" for x in (0.06, 0.1, 0.15) for y in (0.05, 0.12, 0.17)
    )
    rows = [line.split(",") for line in TENSILE.splitlines()[1:]]
    rows = [(float(stretch), float(pull)) for stretch, pull in rows]
    machine = "extension,force\n" + "".join(f"{0.05 * (stretch - 1.0)},{pull}\n" for stretch, pull in rows)
    softer = "stretch,force\n" + "".join(f"{stretch},{0.8 * pull}\n" for stretch, pull in rows)
    at = [0.1 * 2**n for n in range(10)]
    prony = "frequency,storage,loss\n" + "".join(f"{f},{1e6 * (1 + 0.2 * f / (1 + f))},{1e5}\n" for f in at)
    motion = "time,probe,ux,uy,uz\n0.002,P4,,,-1e-5\n0.01,P4,,,-0.001\n"
    on_edge = load(ONE).replace(gravity={"acceleration": (0.0, -9.81, 0.0)})
    (folder / "edge.toml").write_text(to_toml(on_edge), encoding="utf-8")
    texts = {"other": displaced, "cloud": cloud, "tensile-softer": softer, "machine": machine}
    for name, text in {**texts, "prony": prony, "motion": motion}.items():
        (folder / f"{name}.csv").write_text(text, encoding="utf-8")


@pytest.fixture(scope="module")
def answers():
    return {}


@pytest.fixture
def answered(tmp_path, monkeypatch, capsys, undrawn, few):
    """The exit status and the numbers of a verb's small command with more options."""
    monkeypatch.chdir(tmp_path)
    write_inputs(tmp_path)

    def answered(base, verb, *more):
        words = base.split()
        if more and more[0] in words:  # in the place of what is there
            at = words.index(more[0])
            del words[at : at + 2]
        status = run(verb, *words, *more, "--json")
        said = capsys.readouterr()
        assert "Traceback" not in said.err and status in (0, 2, 3), said.err
        arguments = [*words, *more]
        if status == 2:
            with pytest.raises(BadInput):
                in_python(verb, arguments)
            return said.err
        found = numbers(json.loads(said.out))
        if status == 0 and not {"--tolerance", "--budget"} & {*arguments}:  # which go by times
            assert numbers(in_python(verb, arguments)) == found
        return found

    return answered


@pytest.mark.nightly  # a minute and a half of the processor
@pytest.mark.parametrize(("verb", "option"), OPTIONS)
def test_it_changes_the_answer_or_has_no_effect_and_is_refused(verb, option, answers, answered):
    base = OTHER_BASE.get((verb, option), BASE[verb])
    if (verb, base) not in answers:
        answers[verb, base] = answered(base, verb)
    plain = answers[verb, base]
    assert plain and isinstance(plain, dict), plain
    value = OF_VERB.get((verb, option), VALUES[option])
    found = answered(base, verb, option, *(value or "").split())
    if isinstance(found, str):
        assert "no effect" in found or "do not depend on it" in found, f"{verb} {option}: {found}"
    else:
        assert found != plain, f"{verb} {option}: no effect, and nothing said"

"""Each option of each verb, alone beside a small command: the answer's numbers change, or it is refused.

What is neither is in `SAME` or `SAME_OF`, with the reason. An option that is in no table fails the test: a
new one needs a row.
"""

import json
import math

import pytest
from commands import run
from verbs import write_inputs

from comparisons.cli.app import verb_group

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
    "linearise": f"{SETTLING} --lumped 3 --modes 3",
    "calibrate": f"{ONE} --lumped 3",
    "identify": f"{SEED} --measured measured.csv --lumped 3",
    "tradeoff": f"{ONE} --lumped 3,4 --plate= --shell 2 --solid= --elements 3 --repeats 1 --workers 1",
    "crosscheck": f"{ONE} --lumped 3,4 --plate= --shell 2,3 --solid= --judges= --workers 1",
    "stability": f"{ONE} --lumped 3 --elements 2 --vary load --workers 1",
    "advise": f"{ONE} --tolerance 0.2",
    "homogenise": "equilateral one-edge-clamped",
    "check": ONE,
    "score": "answers.csv --case thick",
    "suite": "--suite modes",
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
    "--measured": "motion.csv",
    "--models": "lumped",
    "--error": "1e-5",
    "--count": "3",
    "--masses": "tributary",
    "--about": "deformed",
    "--modes": "4",
    "--reduce": "balanced:2",
    "--young": "2e6",
    "--poisson": "0.3",
    "--thickness": "0.004",
    "--density": "900",
    "--side": "0.1",
    "--method": "central",
    "--for": "mujoco",
    "--unknown": "poisson",
    "--offset": "0.001",
    "--tensile": "tensile.csv",
    "--up-to": "2",
    "--area": "18mm2",
    "--loss-factor": "0.2",
    "--damping-ratio": "0.1",
    "--log-decrement": "0.3",
    "--quality": "5",
    "--at": "5",
    "--band": "2:8",
    "--prony": "prony.csv",
    "--lumped-pair": "3:4",
    "--plate": "2,3",
    "--shell": "3,4",
    "--solid": "1,2",
    "--repeats": "2",
    "--judges": "felupe",
    "--meshes": "2,3",
    "--vary": "slenderness",
    "--tolerance": "0.02",
    "--budget": "1ms",
    "--spacing": "0.01",
    "--hinge": "angle",
    "--coefficient": "hinge=1e-5",
    "--suite": "curves",
    "--case": "thin",
}
OF_VERB = {
    ("tradeoff", "--lumped"): "3,5",
    ("tradeoff", "--elements"): "4",
    ("crosscheck", "--lumped"): "3,5",
    ("modes", "--reference"): "plate",
    ("linearise", "--about"): "flat",
    ("verify", "--case"): "laws",
    ("suite", "--case"): "thick",
}
PLACES = "where the answer goes, and how it looks"
SAME = {  # no number of the answer is another with them, and why
    **dict.fromkeys(
        ("--json", "--out", "--overwrite", "--figure", "--no-pictures", "--quiet", "--export"), PLACES
    ),
    **dict.fromkeys(("--toml", "--animate"), PLACES),
    "--large": "lets a model be larger than memory",
    **dict.fromkeys(("--workers", "--scheduler", "--wait", "--retry"), "how runs are carried out"),
    "--symmetry": "the same answer, from a part of the mesh",
    "--repeats": "times alone",
}
SAME_OF = {
    ("compare", "--uncertainty"): "for motions, and what is done at rest unless it is declined",
    ("compare", "--branch"): "a stable sheet has no other branch; a note says of what it tells",
    ("score", "--case"): "said to be not answered yet",
}
TIMES = (
    "seconds",
    "memory",
    "timings",
    "settings",
    "time_order",
    "spread",
    "busy",
    "load_average",
    "warnings",
    "compile",
)
OPTIONS = [
    (verb, option.opts[0])
    for verb in BASE
    for option in verb_group((verb,)).commands[verb].params
    if option.opts[0].startswith("--")
    and option.opts[0] not in SAME
    and (verb, option.opts[0]) not in SAME_OF
]


def numbers(found, name=""):
    """Every number of a document with the path to it, but those of the clock and repeated of the question."""
    if isinstance(found, dict):
        for key, value in found.items():
            if not any(word in key for word in TIMES):
                yield from numbers(value, f"{name}.{key}")
    elif isinstance(found, list):
        for i, value in enumerate(found):
            yield from numbers(value, f"{name}.{i}")
    elif type(found) in (int, float) and math.isfinite(found):
        yield name, found


@pytest.fixture(scope="module")
def answers():
    return {}


@pytest.fixture
def answered(tmp_path, monkeypatch, capsys, undrawn, few):
    """The exit status and the numbers of a verb's small command with more options."""
    monkeypatch.chdir(tmp_path)
    write_inputs(tmp_path)

    def answered(verb, *more):
        words = BASE[verb].split()
        if more and more[0] in words and verb != "score":  # in the place of what is there
            at = words.index(more[0])
            del words[at : at + 2]
        status = run(verb, *words, *more, "--json")
        said = capsys.readouterr()
        assert "Traceback" not in said.err and status in (0, 2, 3), said.err
        return status, None if status == 2 else dict(numbers(json.loads(said.out)))

    return answered


@pytest.mark.nightly  # a minute and a half of the processor
@pytest.mark.parametrize(("verb", "option"), OPTIONS)
def test_it_changes_the_answer_or_is_refused(verb, option, answers, answered):
    if verb not in answers:
        answers[verb] = answered(verb)
    status, plain = answers[verb]
    assert status in (0, 3) and plain
    value = OF_VERB.get((verb, option), VALUES[option])
    _, found = answered(verb, *([option] if value is None else [option, value]))
    assert found is None or found != plain, f"{verb} {option}: no effect, and nothing said"

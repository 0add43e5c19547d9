"""Every verb in every pair of its options: scenes, grids, springs, references, outputs; rows cover all pairs.

Fits are met by `calibrate`, on every scene and grid. Left out are `live` and `report --open`.
"""

import csv
from itertools import combinations, product

import pytest
from commands import run
from matrix_options import GRIDS, OUTPUTS, SCENES, SPRINGS
from matrix_rows import named, pairwise

from sheetbench.choices import CALIBRATIONS, INTEGRATORS, MASS_DISTRIBUTIONS, SUITES

OWN = SPRINGS[::2]  # state spaces have the others
LITTLE = (("--json",), ("--out", "{folder}"), ())
EVERY_SCENE = SCENES[1:]
VERBS: dict[str, list[tuple[tuple[str, ...], ...]]] = {
    "compare --elements 2": [
        OWN,
        SCENES,
        (
            (),
            ("--model", "solid:elements=2"),
            ("--model", "plate:elements=2x3", "--model", "shell:elements=2,graded=false"),
            ("--model", "lumped:grid=5,calibration=uniform"),
            ("--model", "lumped:grid=3,k=550"),
            ("--model", "lumped:grid=3,linear=true"),
        ),
        (
            ("--reference", "plate"),
            ("--reference", "shell"),
            ("--reference", "shell", "--law", "biot"),
            ("--reference", "solid", "--law", "neo-hookean"),
        ),
        OUTPUTS,
        GRIDS,
        ((), ("--uncertainty",), ("--no-uncertainty",)),
    ],
    "modes": [
        SPRINGS[::3],
        EVERY_SCENE,
        ((), ("--about", "deformed")),
        ((), *(("--masses", name) for name in MASS_DISTRIBUTIONS)),
        (
            ("--reference", "plate", "--elements", "2"),
            ("--reference", "shell", "--elements", "2x3"),
            ("--reference", "solid", "--elements", "2"),
        ),
        LITTLE,
        (("--grid", "3"), ("--grid", "3x4"), ("--grid", "3x3x3")),
        (("--count", "2"), ("--count", "12")),
    ],
    "modes --state-space": [
        SPRINGS[1::2],
        EVERY_SCENE,
        (("3",), ("0",), ("4", "--reduce", "balanced:2")),
        ((), ("--about", "flat")),
        LITTLE,
        GRIDS[:3],
    ],
    "simulate --duration 0.002": [
        tuple(("--integrator", name) for name in (*INTEGRATORS, "auto", "reduced")),
        EVERY_SCENE,
        SPRINGS[1::3],
        ((), ("--step", "1e-4"), ("--every", "1e-3")),
        OUTPUTS[1:],
        GRIDS[:3],
    ],
    "calibrate --young 1e6 --poisson 0.4 --thickness 0.003": [
        tuple(("--calibration", name) for name in (*CALIBRATIONS, "auto")),
        (("two-edges-clamped",), ("curved-edge",), ("{springs}",), ("{weightless}",), ("--side", "0.1")),
        (("--grid", "3"), ("--grid", "3x4"), ("--grid", "3x3x3")),
        ((), ("--k", "550"), ("--layer-distance", "0.002"), ("--grading", "0.4"), ("--grading", "auto")),
        (*OUTPUTS[1:3], ("--toml",), ("--export", "{export}"), ("--out", "{folder}", "--for", "mujoco")),
    ],
    "tradeoff": [
        (("one-edge-clamped",), ("{weightless}",)),
        (("--tolerance", "0.9"), ("--budget", "5ms")),
        (("--json",), ()),
    ],
    "check": [EVERY_SCENE, LITTLE],
    "compare --duration 0.004 --elements 2": [
        (("two-edges-settling",), ("{pressed}",), ("{natural}",), ("{touching}",)),
        (("--grid", "3"), ("--grid", "3x4")),
        (("--calibration", "hyperelastic"), ("--k", "550")),
        (("--json",), ("--out", "{folder}")),
    ],
    "calibrate --out {folder}": [
        (("--calibration", "neo-hookean"), ("--calibration", "central"), ()),
        (("two-edges-settling",), ("{pressed}",), ("{natural}",), ("{touching}",)),
        tuple(("--for", code) for code in ("mujoco", "sofa", "numpy", "newton")),
        (("--grid", "3"), ("--grid", "3x4")),
    ],
    "report": [
        (("{studies}",), ("{studies}/compare",), ("{export}",)),
        ((), ("--json",), ("--out", "{page}"), ("--quiet",)),
    ],
    "score": [
        tuple((f"{{{name}}}",) for name in (*SUITES, "heights", "nothing")),
        ((), *(("--suite", name) for name in SUITES)),
        ((), ("--case", "thin"), ("--case", "modes-round"), ("--case", "corner-struck")),
        OUTPUTS[:4],
    ],
    "new {folder}.toml --young 1MPa --poisson 0.4": [
        (("--side", "0.1"), ("--side", "12cmx4cm"), ()),
        (("--thickness", "2mm"), ("--thickness", "0.5"), ()),
        ((), ("--clamped", "x0,y1"), ("--clamped", "x0,x1,y0,y1"), ("--clamped", "")),
        ((), ("--density", "1.1g/cm3"), ("--overwrite",)),
    ],
    "check --schema": [((), ("--out", "{folder}")), ((), ("--quiet",))],
    "identify": [
        (("one-edge-clamped",), ("{pressed}",), ("{springs}",), ("{natural}",), ("{touching}",)),
        tuple(("--measured", f"{{{name}}}") for name in ("heights", "displacements", "empty")),
        (("--lumped", "3"), ("--lumped", "3x4"), ("--model", "shell", "--elements", "2")),
        ((), ("--calibration", "hyperelastic"), ("--k", "550"), ("--grading", "auto")),
        tuple(
            ("--unknown", name)
            for name in ("young", "poisson", "tilt_x0", "natural.kxx", "patch1.natural.kxx", "obstacle1.z")
        ),
        OUTPUTS[:3],
    ],
    "compare {touching} --elements 2": [
        (("--lumped", "3"), ("--lumped", "3x4"), ("--lumped", "4", "--grading", "auto")),
        ((), ("--reference", "solid"), ("--branch", "buckled"), ("--reference", "plate")),
        OUTPUTS,
    ],
    "stability {touching} --vary obstacle --lumped 3 --elements 2 --workers 1": [OUTPUTS[:3]],
    "modes {natural} --lumped 3 --elements 2": [
        ((), ("--about", "deformed"), ("--buckling",), ("--state-space", "3", "--about", "deformed")),
        (("--json",), ("--out", "{folder}"), ()),
    ],
    "identify two-edges-settling --measured {motion}": [
        (("--lumped", "3"), ("--lumped", "3x4")),
        (("--unknown", "young"), ("--unknown", "damping_time")),
        OUTPUTS[:3],
    ],
    "tradeoff --repeats 1 --elements 3 --plate 2 --workers 1": [
        (("{pressed}",), ("{weightless}",), ("{natural}",), ("{touching}",)),
        (("--lumped", "3x4,4"), ("--lumped", "")),
        (("--calibration", "hyperelastic"), ("--calibration", "auto"), ("--grading", "auto")),
        (("--shell", "2", "--solid", ""), ("--shell", "", "--solid", "2")),
        OUTPUTS[:3],
    ],
    "tradeoff two-edges-settling --duration 0.004 --plate 1 --shell 1 --elements 2 --solid= --workers 1": [
        (("--lumped", "3x4", "--calibration", "hyperelastic", "--json"), ("--k", "550", "--out", "{folder}")),
    ],
    "sweep --vary sheet.thickness=2mm,3mm --workers 1": [
        (("one-edge-clamped",), ("{pressed}",), ("{weightless}",), ("{touching}",)),
        (("--lumped", "3"), ("--lumped", "3x4")),
        ((), ("--calibration", "hyperelastic"), ("--k", "550")),
        (("--reference", "plate", "--elements", "2"), ("--reference", "", "--model", "shell:elements=2")),
        OUTPUTS[:3],
    ],
    "crosscheck --plate 2,3 --shell 2,3 --judges= --workers 1": [
        (("one-edge-clamped",), ("{pressed}",), ("{natural}",), ("{touching}",)),
        (("--lumped", "3,4,5"), ("--lumped", "3,4")),
        (("--solid", ""), ("--solid", "1,2")),
        (("--calibration", "hyperelastic"), ("--grading", "0.4")),
        OUTPUTS[:3],
    ],
    "stability --elements 2 --workers 1": [
        (("one-edge-clamped",), ("{pressed}",), ("{natural}",), ("{weightless}",)),
        tuple(("--vary", name) for name in ("load", "slenderness", "grid")),
        (("--lumped", "3"), ("--lumped", "3x4")),
        ((), ("--calibration", "hyperelastic"), ("--k", "550"), ("--grading", "auto")),
        OUTPUTS[:3],
    ],
    "calibrate --from": [
        (
            ("newton", "tri_ke=1e3,tri_ka=1e3,edge_ke=10"),
            ("sofa", "youngModulus=2e4,poissonRatio=0.3,bendingStiffness=1e4"),
            ("genesis", "stretch_compliance=1e-7,bending_compliance=1e-5,rho=4"),
            ("pybullet", "springElasticStiffness=40,layers=0.03"),
            ("c-ipc", "E=8210,nu=0.243,thickness=0.318e-3,bendingStiffMult=100"),
        ),
        ((), ("--spacing", "0.1"), ("--spacing", "5mm")),
        ((), ("--cell", "equilateral"), ("--cell", "one-diagonal")),
        ((), ("--density", "1000"), ("--density", "1.1g/cm3")),
        LITTLE,
    ],
    "calibrate --cell": [
        (("equilateral",), ("one-diagonal",), ("alternate-diagonals",)),
        (("one-edge-clamped",), ("{weightless}",)),
        ((), ("--hinge", "angle"), ("--hinge", "height")),
        ((), ("--spacing", "25mm"), ("--spacing", "0")),
        OUTPUTS[:3],
    ],
    "tradeoff --tolerance 0.9": [
        (("one-edge-clamped",), ("{pressed}",)),
        ((), ("--calibration", "uniform"), ("--k", "550"), ("--grading", "auto")),
        OUTPUTS[:3],
    ],
    "stability two-edges-settling --lumped 3 --elements 2 --workers 1": [
        (("--vary", "damping"), ("--vary", "time-step")),
        ((), ("--calibration", "hyperelastic")),
        OUTPUTS[:2],
    ],
}
ROWS = {verb: pairwise(dimensions) for verb, dimensions in VERBS.items()}
DEAR = {("--vary", "time-step"), ("--calibration", "hyperelastic")}  # a fifth of all rows' time


def cases():
    """Return every row under its name."""
    for verb, row in ((verb, row) for verb, rows in ROWS.items() for row in rows):
        rare = set(row) >= DEAR or ("{touching}",) in row or "{touching}" in verb
        marks = [pytest.mark.nightly] if rare else []
        yield pytest.param(verb, row, id=f"{verb} {named(row)}", marks=marks)


@pytest.fixture(scope="module")
def places(places, tmp_path_factory):
    """With studies for a report, and answers to the reference set, every one the same number."""
    folder = tmp_path_factory.mktemp("studies")
    places = {
        **places,
        "studies": str(folder),
        "page": str(folder / "page.html"),
        "nothing": str(folder / "no.csv"),
    }
    small = ("--grid", "3", "--elements", "2", "--no-pictures", "--out")
    for verb in ("compare", "modes"):
        assert run(verb, "one-edge-clamped", *small, str(folder / verb)) == 0
    for suite in SUITES:
        assert run("score", "--suite", suite, "--out", str(folder / "suites" / suite)) == 0
        path = folder / "suites" / suite / f"answers-{suite}.csv"
        with path.open(newline="", encoding="utf-8") as file:
            rows = [[value or "0.001" for value in row] for row in csv.reader(file)]
        with path.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows(rows)
        places[suite] = str(path)
    return places


def test_rows_have_every_pair():
    dimensions, rows = VERBS["compare --elements 2"], ROWS["compare --elements 2"]
    wanted = sum(len(a) * len(b) for a, b in combinations(dimensions, 2))
    assert len({(i, a, j, b) for row in rows for (i, a), (j, b) in combinations(enumerate(row), 2)}) == wanted
    assert len(rows) < 1.5 * len(OWN) * len(SCENES)
    assert {row[:2] for row in rows} == set(product(OWN, SCENES))


@pytest.mark.usefixtures("few")
@pytest.mark.parametrize(("verb", "row"), list(cases()))
def test_verb(verb, row, ends):
    ends(*verb.split(), *(part for one in row for part in one))

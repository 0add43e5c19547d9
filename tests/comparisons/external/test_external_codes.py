"""Other people's programs: what they are given, what is read of them, how they fail, and what they answer."""

import re
from typing import Any

import numpy as np
import pytest
from sheetbench_felupe import LAWS as FELUPE_LAWS
from sheetbench_felupe import MODEL as FELUPE

from comparisons.comparison.comparison import error
from comparisons.external import answer as external
from comparisons.external.answer import ExternalCode
from comparisons.external.calculix import model as results
from comparisons.external.calculix.model import LAWS as CALCULIX_LAWS
from comparisons.external.calculix.model import MODEL as CALCULIX
from comparisons.external.kratos.model import MODEL as KRATOS
from fem_reference.verification.strain_laws import RUBBERS
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.face import solve
from sheetbench.process import Failed, output_of
from sheetbench.scenes import (
    Chain,
    Clamped,
    Curved,
    EdgeLoad,
    EdgeMotion,
    Gravity,
    Held,
    Hinged,
    PointLoad,
    Pressure,
    Scene,
    Sheet,
    Symmetric,
    load,
)

JUDGES: tuple[ExternalCode, ...] = (CALCULIX, KRATOS, FELUPE)
SEED = load("two-edges-clamped")


def needed(judge):
    if judge.version() is None:
        pytest.skip(f"needs {judge.needs}")


DAT = """
 displacements (vx,vy,vz) for set NALL and time  0.5000000E+00

         1  1.0E-03 0.0 0.0
         2  2.0E-03 0.0 0.0

 displacements (vx,vy,vz) for set NALL and time  0.1000000E+01

         1  3.0E-03 1.0E-01 0.0
         2  4.0E-03 0.0 -2.0E+00
"""


def test_the_last_increment_is_read():
    factor, displacements = results.displacements(DAT, 3)
    assert factor == 1.0 and np.isnan(displacements[2]).all()
    np.testing.assert_array_equal(displacements[:2], [[3e-3, 0.1, 0.0], [4e-3, 0.0, -2.0]])
    sta = " SUMMARY OF JOB INFORMATION\n  STEP  INC  ATT  ITRS  TOT TIME  STEP TIME  INC TIME\n"
    assert results.iterations(sta + "  1  1  1  12  0.5E+00  0.5E+00  0.5E+00\n 1 2 1 5 1.0 1.0 0.5\n") == 17
    assert results.iterations("") == 1


@pytest.mark.parametrize(
    "damage", ["", DAT.replace("-2.0E+00", "garbage"), DAT.replace("\n         2", "\n  9")]
)
def test_results_that_cannot_be_read_are_one_line(damage):
    with pytest.raises(Failed, match=r"its \.dat file"):
        results.displacements(damage, 2)


def test_a_program_that_cannot_be_started_says_so_in_a_line(tmp_path):
    with pytest.raises(Failed, match="cannot be started: No such file"):
        output_of([str(tmp_path / "none")], tmp_path, 20.0)


@pytest.mark.parametrize(
    ("script", "said"),
    [
        ("echo '*ERROR in gen3delem: boom'; exit 201", "CalculiX: exit status 201: .*boom"),
        ("echo nonsense > sheet.dat", "CalculiX: its .dat file has no displacements"),
        ("kill -9 $$", "CalculiX: ended by SIGKILL"),
    ],
)
def test_a_judge_that_fails_is_an_answer_with_a_status(tmp_path, monkeypatch, script, said):
    """A `ccx` of one's own is first on the PATH."""
    program = tmp_path / "ccx"
    program.write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    solution = CALCULIX.solve(SEED, {**CALCULIX.settings, "elements": 2})
    assert solution.status is Status.DIVERGED and solution.load_factor == 0.0
    assert np.all(solution.displacement(SEED.probe_points()) == 0.0)
    (note,) = solution.remarks
    assert re.fullmatch(said, note), note


def test_a_judge_that_is_not_here_says_what_it_needs(monkeypatch):
    monkeypatch.setenv("PATH", "")
    assert CALCULIX.version() is None
    with pytest.raises(BadInput, match="calculix-ccx"):
        CALCULIX.solve(SEED, CALCULIX.settings)
    monkeypatch.setattr(type(KRATOS), "version", lambda self: None)
    with pytest.raises(BadInput, match=r"sheetbench\[kratos\]"):
        KRATOS.solve(SEED, KRATOS.settings)


@pytest.mark.parametrize("judge", JUDGES, ids=lambda judge: judge.name)
def test_settings_that_make_no_mesh_are_refused(judge):
    for wrong in (0, 2.5, "many"):
        with pytest.raises(BadInput, match="elements = "):
            judge.solve(SEED, {**judge.settings, "elements": wrong})
    with pytest.raises(BadInput, match="layers = 3"):
        CALCULIX.solve(SEED, {**CALCULIX.settings, "layers": 3})


def test_judges_are_found_among_the_plug_ins():
    assert all(isinstance(judge, ExternalCode) for judge in JUDGES)
    assert {"calculix", "kratos"} <= external.find_codes().keys()
    with pytest.raises(BadInput, match="--judges"):
        external.find_codes(["mujoco"])


PROBES = {"A": (0.094, 0.094), "B": (0.15, 0.05), "C": (0.05, 0.15), "D": (0.188, 0.188)}
SHIFT = EdgeMotion(
    kind="motion",
    edge="x1",
    time=(0.0, 1.0),
    displacement=((0.0, 0.0, 0.0), (0.0, 0.0, 0.005)),
    rotation=((0.0, 0.0, 0.0), (0.1, 0.0, 0.0)),
)
FIBRES = {"kind": "orthotropic", "young_1": 9e6, "young_2": 3e6, "poisson_12": 0.3, "shear_12": 1e6,
          "shear_23": 1e6, "angle": 0.5, "density": 1000.0}  # fmt: skip
DISC = {"circle": {"centre": (0.09, 0.1), "radius": 0.05}}
FIN = [(0.0, 0.0), (0.188, 0.05), (0.188, 0.138), (0.0, 0.188)]
WORDS: dict[str, dict[str, Any]] = {
    "pressure": {"supports": tuple(Hinged(edge=edge) for edge in ("x0", "x1", "y0", "y1")), "gravity": None,
        "loads": (Pressure(value=300.0),)},
    "point": {"supports": (Clamped(edge="x0"), Held(edge="x1", components=("z",))),
        "loads": (PointLoad(at=(0.11, 0.07), force=(0.0, 0.02, 0.2)),)},
    "tilt": {"supports": (Clamped(edge="y1", tilt=0.3),)},
    "edge": {"supports": (Clamped(edge="x0"),),
        "loads": (EdgeLoad(edge="x1", force_per_length=(3.0, 0.0, 0.5)),)},
    "motion": {"supports": (Clamped(edge="x0"),), "actuators": (SHIFT,)},
    "half": {"supports": (Clamped(edge="x0"), Symmetric(edge="y0"))},
    "curved": {"supports": (Curved(edge="x0", curvature=-1.0),)},
    "fin": {"outline": FIN, "taper_x": (0.003, 0.002), "supports": (Clamped(edge="x0"),)},
    "pouch": {"supports": tuple(Clamped(edge=edge) for edge in ("x0", "x1", "y0", "y1")), "gravity": None,
        "loads": (Pressure(value=2000.0, where=DISC),)},
    "fibres": {"outline": FIN, "material": FIBRES, "supports": (Clamped(edge="x0"),),
        "gravity": Gravity((0.0, 0.0, -1.0))},
    "slab": {"patches": [{"shape": {"rectangle": {"x": (0.0, 0.188), "y": (0.0, 0.1)}}, "young": 1e8}]},
}  # fmt: skip
DRAWN = ("fin", "pouch", "fibres", "slab")  # for CalculiX, on 10 elements within 0.5 % of the shell


ROD = Chain(edge="x1", segments=2, bending_stiffness=1.0, line_density=1.0, radius=1e-3)
PLIES = [{"thickness": 0.001, "angle": a} for a in (0.0, 1.0, 0.0)]
UNKNOWN = {  # to every judge, and the word that it says
    "actuator": {"actuators": (ROD,)},
    "moment": {"loads": (EdgeLoad(edge="x1", moment_per_length=0.1),)},
    "patch": {"patches": [{"shape": DISC, "thickness": 0.004}]},
    "layer": {"layers": PLIES, "material": FIBRES},
}


@pytest.mark.parametrize("judge", JUDGES, ids=lambda judge: judge.name)
@pytest.mark.parametrize("word", UNKNOWN)
def test_a_judge_refuses_what_it_cannot_take_in_a_sentence(judge, word):
    needed(judge)
    solution = judge.solve(SEED.replace(**UNKNOWN[word]), {**judge.settings, "elements": 3})
    assert solution.status is Status.REFUSED and len(solution.remarks) == 1
    assert word in solution.message


@pytest.mark.sweep(2)
@pytest.mark.parametrize("word", WORDS)
def test_a_scenes_words_mean_the_same_to_every_judge(word):
    """Within what coarse meshes leave; a curved edge has a narrow layer, 4.4 % with 4 bricks."""
    drawn = word in DRAWN
    scene = SEED.replace(**WORDS[word], probes={} if drawn else PROBES)
    truth = solve(scene, "shell", elements=12 if drawn else 6).displacement(scene.probe_points())
    here = [judge for judge in (JUDGES[:1] if drawn else JUDGES) if judge.version() is not None]
    if not here:
        pytest.skip(f"needs one of {'; '.join(judge.needs for judge in JUDGES)}")
    for judge in here:
        elements, within = (8, 0.04) if judge is KRATOS else (4, 0.05 if word == "curved" else 0.02)
        if drawn:
            elements, within = 10, 0.005
        solution = judge.solve(scene, {**judge.settings, "elements": elements})
        assert solution.status is Status.CONVERGED, (judge.name, solution.message)
        assert error(solution.displacement(scene.probe_points()), truth) < within, judge.name


def pulled_rubber(rubber):
    """A clamped strip pulled by some 60 %."""
    sheet = Sheet(length_x=0.1, length_y=0.05, thickness=0.004)
    pull = EdgeLoad(edge="x1", force_per_length=(0.4 * rubber.young * sheet.thickness, 0.0, 0.0))
    return Scene(name="pulled", sheet=sheet, material=rubber, supports=(Clamped(edge="x0"),), loads=(pull,))


@pytest.mark.parametrize("judge", JUDGES, ids=lambda judge: judge.name)
@pytest.mark.parametrize("rubber", RUBBERS, ids=lambda rubber: rubber.law)
def test_stretched_rubber_is_our_solid_s_or_refused_by_name(judge, rubber):
    """FElupe has our energy; CalculiX' differs by the compressibility, some 0.7 (1 − 2 ν) of the stretch."""
    needed(judge)
    scene = pulled_rubber(rubber.replace(poisson=0.49 if judge is FELUPE else 0.499))
    found = judge.solve(scene, {**judge.settings, "elements": 2})
    known = {"felupe": FELUPE_LAWS, "calculix": CALCULIX_LAWS}.get(judge.name, ())
    if rubber.law not in known:
        assert found.status is Status.REFUSED and f"law '{rubber.law}'" in found.message
        return
    end = np.array([[0.1, 0.025]])
    ours = solve(scene, "solid", elements=2).displacement(end)[0, 0]
    assert found.status is Status.CONVERGED and ours > 0.5 * scene.sheet.length_x
    assert found.displacement(end)[0, 0] == pytest.approx(ours, rel=1e-3 if judge is FELUPE else 3e-3)

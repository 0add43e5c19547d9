"""Other people's programs: the bricks they are given, what is read of them, how they fail and answer."""

import re
from typing import Any

import numpy as np
import pytest
from sheetbench_felupe import LAWS as FELUPE_LAWS
from sheetbench_felupe import MODEL as FELUPE

from comparisons.external import answer as external
from comparisons.external.answer import ExternalCode
from comparisons.external.bricks import Bricks, forces, held, materials
from comparisons.external.calculix import model as results
from comparisons.external.calculix.model import LAWS as CALCULIX_LAWS
from comparisons.external.calculix.model import MODEL as CALCULIX
from comparisons.external.calculix.model import deck
from comparisons.external.kratos.model import MODEL as KRATOS
from comparisons.external.kratos.model import Triangles, problem
from comparisons.external.output import Failed, output_of
from comparisons.sweep.differences import error
from fem_reference.surface.biquadratic import areas
from fem_reference.surface.mesh import plan_of
from fem_reference.verification.strain_laws import RUBBERS
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.face import solve
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
from sheetbench.scenes.meaning.composition import mass_of

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


# ---- bricks
@pytest.fixture(scope="module")
def bricks():
    return Bricks.of(SEED, 4, 2, "edges")


def test_the_mid_surface_of_a_quadratic_field_is_sampled_exactly(bricks):
    def field(at):
        x, y = at[:, 0], at[:, 1]
        return np.column_stack([x * y, x**2 - 3 * y, 2 * y**2 + x + 1])

    points = np.random.default_rng(1).uniform(0.0, 0.188, (50, 2))
    nodes, weights = bricks.weights(points)
    sampled = np.einsum("pk,pkc->pc", weights, field(bricks.positions)[nodes])
    np.testing.assert_allclose(sampled, field(points), atol=1e-14)


def test_forces_add_up_and_act_where_they_should(bricks):
    triangles = Triangles.of(SEED.sheet, 4)
    point = PointLoad(at=(0.11, 0.07), force=(1.0, 2.0, 3.0))
    line = EdgeLoad(edge="x1", force_per_length=(0.0, 0.0, 5.0))
    for load_, total, at in (
        (point, (1.0, 2.0, 3.0), (0.11, 0.07)),
        (line, (0.0, 0.0, 5.0 * 0.188), (0.188, 0.094)),
    ):
        scene = SEED.model_copy(update={"loads": (load_,)})
        pull = forces(scene, bricks)
        np.testing.assert_allclose(pull.sum(axis=0), total, atol=1e-12)
        middle = pull[:, 2] @ bricks.positions / pull[:, 2].sum()
        np.testing.assert_allclose(middle, (*at, 0.0), atol=1e-12)
        np.testing.assert_allclose(problem(scene, triangles, np.ones(1))["force"].sum(axis=0), total)
    first, *others = np.moveaxis(triangles.positions[triangles.elements], 1, 0)
    twice = np.cross(*(other - first for other in others))[:, 2]
    assert twice.min() > 0.0 and twice.sum() / 2.0 == pytest.approx(0.188**2)


SPOT = {"circle": {"centre": (0.12, 0.12), "radius": 0.03}}
ROOT = {"rectangle": {"x": (0.0, 0.05), "y": (0.0, 0.188)}}
COMPOSED = SEED.replace(
    sheet=Sheet(
        0.188, 0.188, 0.003, outline=[(0, 0), (0.188, 0.03), (0.188, 0.16), (0, 0.188)], taper_x=(3e-3, 1e-3)
    ),
    material=FIBRES | {"angle": 0.3},
    cutouts=[{"shape": {"circle": {"centre": (0.05, 0.09), "radius": 0.02}}}],
    patches=[
        {"shape": SPOT, "angle": -0.4},
        {"shape": ROOT, "young": 2e6, "poisson": 0.3, "density": 2000.0},
    ],
    supports=(Clamped(edge="x0"), Hinged(where={"circle": {"centre": (0.15, 0.07), "radius": 0.01}})),
    loads=[
        {"kind": "area", "force_per_area": (0.0, 3.0, 1.0), "where": SPOT},
        {"kind": "pressure", "value": 20.0, "where": SPOT},
        {"kind": "pressure", "value": 4.0},
    ],
)  # fmt: skip


@pytest.fixture(scope="module")
def drawn():
    return Bricks.of(COMPOSED, 8, 2, "edges")


def volumes(bricks):
    """Of the bricks, by the plan's and the thickness in their middles."""
    plan = plan_of(bricks.plan)
    sizes = areas(plan.corners).sum(axis=1) * bricks.taper[plan.elements[:, :8]].mean(axis=1)
    return np.tile(sizes * 0.003 / bricks.layers, bricks.layers)


def test_bricks_of_a_drawn_sheet_fill_it(drawn):
    corners = drawn.positions[drawn.elements]
    along, across, up = (corners[:, i] - corners[:, 0] for i in (1, 3, 4))
    assert np.all(np.einsum("mc,mc->m", np.cross(along, across), up) > 0.0)
    sides = [drawn.positions[drawn.edge(name), 0] for name in ("x0", "x1")]
    assert np.ptp(sides[0]) == np.ptp(sides[1]) == 0.0
    parts = materials(COMPOSED, drawn)
    assert sum(len(on) for _, on in parts) == drawn.plan.nelements == len(drawn.elements) / 2
    assert {(m.kind, m.angle, m.density) for m, _ in parts} == {
        ("orthotropic", 0.3, 1000.0), ("orthotropic", -0.4, 1000.0), ("isotropic", None, 2000.0)
    }  # fmt: skip
    mass = sum(2.0 * m.density * volumes(drawn)[on].sum() for m, on in parts)
    assert mass == pytest.approx(mass_of(COMPOSED), rel=2e-3)  # which has tapers in steps of 1/32
    pull = forces(COMPOSED, drawn)
    np.testing.assert_allclose(pull.sum(axis=0), np.pi * 0.03**2 * np.array([0.0, 3.0, 1.0]), rtol=1e-3)
    np.testing.assert_allclose(pull[:, 2] @ drawn.positions / pull[:, 2].sum(), (0.12, 0.12, 0.0), atol=1e-4)
    rows = held(COMPOSED, drawn)
    assert np.flatnonzero(rows.fixed[:, 0]).tolist() == drawn.edge("x0").tolist()
    bolt = drawn.positions[[tie.nodes[0] for tie in rows.tied], :2] - (0.15, 0.07)
    assert len(bolt) > 20 and np.linalg.norm(bolt, axis=1).max() == pytest.approx(0.01, rel=1e-3)


def test_a_deck_of_a_drawn_sheet_has_its_parts(drawn):
    text = deck(COMPOSED, drawn)
    found = {name: text.count(f"*{name}") for name in ("ELSET,", "MATERIAL", "ORIENTATION", "SOLID SECTION")}
    assert found == {"ELSET,": 3, "MATERIAL": 3, "ORIENTATION": 2, "SOLID SECTION": 3}
    assert text.count("ORIENTATION=FIBRES") == 2
    inside = len(drawn.inside(COMPOSED.loads[1].where))
    assert text.count(", P1, 12.0\n") == text.count(", P2, -12.0\n") == inside > 5
    assert text.count(", P1, 2.0\n") == drawn.plan.nelements - inside

"""Moduli of repeated cells: closed forms, waves on long meshes, the lattice's report; coefficients; verb."""

import json
import re
from math import sqrt

import numpy as np
import pytest
from commands import json_of, one_line, run

import sheetbench as sb
from comparisons.codes.cell import MESHES, Cell, cell_of
from comparisons.codes.cell_moduli import parameters_of
from comparisons.codes.coefficients import limit_errors, moduli_of, nearest
from comparisons.codes.files import WRITERS
from comparisons.codes.inverse import sheet_of
from comparisons.codes.setup import setup
from comparisons.codes.table import CODES
from comparisons.models.context import running
from lumped import moduli
from lumped.lattice import STEPS
from sheetbench.errors import BadInput
from sheetbench.scenes import SpringSet, load

SCENE = sb.load("two-edges-clamped")
MATERIAL, THICKNESS = SCENE.material, SCENE.sheet.thickness
RIGIDITY = MATERIAL.young * THICKNESS**3 / 12 / (1 - MATERIAL.poisson**2)
UNIT = {"lambda_h": 1.0, "mu_h": 1.0, "hinge": 1.0}
ROOT, ROOT_3 = sqrt(2.0), sqrt(3.0)
BENDING = {  # over k l, relaxed: a node between alternate diagonals gives way to curvature
    "one-diagonal": {"D11": 1.0, "D22": 1.0, "D12": 0.0, "D66": (1 + ROOT) / 2, "D16": 0.5, "D26": 0.5},
    "alternate-diagonals": {"D11": (3 - ROOT) / 2, "D12": (1 - ROOT) / 2, "D66": ROOT / 2, "D16": 0.0},
    "equilateral": {"D11": ROOT_3 / 2, "D22": ROOT_3 / 2, "D12": -ROOT_3 / 6, "D66": ROOT_3 / 3, "D16": 0.0},
}


@pytest.mark.parametrize("name", BENDING)
def test_hinges_bend_as_the_closed_form_has_it(name):
    spacing = 0.7
    found = moduli_of(cell_of(name, spacing, 0.0), UNIT).named()
    for modulus, value in BENDING[name].items():
        assert found[modulus] == pytest.approx(spacing * value, abs=1e-10)


@pytest.mark.parametrize("name", MESHES)
def test_triangles_stretch_as_the_sheet_on_any_mesh(name):
    found = moduli_of(cell_of(name, 0.7, 0.0), {"lambda_h": 2.0, "mu_h": 3.0, "hinge": 0.0})
    assert found.membrane == pytest.approx(np.array([[8.0, 2, 0], [2, 8, 0], [0, 0, 3]]), abs=1e-10)


def test_a_lattice_is_a_cell_of_springs():
    sides = (0.02, 0.03, 0.004)
    values = {"axial": 5e3, "diagonal": 2e3, "vertical": 7e4, "cross": 3e3, "cross_diagonal": 9e2}
    springs = SpringSet(**values, layer_distance=sides[2])
    links, coefficients = [], {}
    for family, direction, (i, j, k) in STEPS:
        name = f"{family}{direction}"
        coefficients[name] = values[family]
        layers = [(0, 0), (1, 1)] if k == 0 else [(0, 1)] if k > 0 else [(1, 0)]
        links += [((a, 0, 0), (b, i, j), name) for a, b in layers]
    nodes = np.array([[0.0, 0.0, -0.5 * sides[2]], [0.0, 0.0, 0.5 * sides[2]]])
    cell = Cell("lattice", np.diag(sides[:2]), nodes, springs=tuple(links))
    found, known = moduli_of(cell, coefficients), moduli.of_springs(springs, sides, 2)
    assert found.membrane == pytest.approx(known.membrane, rel=1e-10, abs=1e-8)
    assert found.bending == pytest.approx(known.bending, rel=1e-10, abs=1e-12)
    assert np.diag(found.shear) == pytest.approx(known.shear, rel=1e-10)


def test_a_brick_locks_in_bending_as_its_closed_form_has_it():
    """Corners cannot curve: D11 = (λ + 2μ) h³/12 + G h (l²/12), plane strain and parasitic shear."""
    spacing, thickness = 0.02, 0.003
    found = moduli_of(cell_of("bricks", spacing, thickness), {"lambda": 5.0, "mu": 2.0})
    plane = 5.0 * 2.0 / (5.0 + 4.0) * 2.0  # λ of plane stress
    assert found.membrane[0] == pytest.approx(thickness * np.array([plane + 4.0, plane, 0.0]))
    assert found.bending[0, 0] == pytest.approx(9.0 * thickness**3 / 12 + 2.0 * thickness * spacing**2 / 12)
    assert np.diag(found.shear) == pytest.approx(2.0 * thickness)


def test_the_nearest_hinge_is_nearest():
    best = nearest(cell_of("equilateral", 0.01, 0.0), MATERIAL, THICKNESS)
    nu = MATERIAL.poisson
    target = np.array([1.0, 1.0, nu * ROOT, 1 - nu])  # 11, 22, √2·12, 2·66 in Mandel's norm
    given = np.array([ROOT_3 / 2, ROOT_3 / 2, -ROOT_3 / 6 * ROOT, 2 * ROOT_3 / 3])
    assert best["hinge"] * 0.01 == pytest.approx(RIGIDITY * (target @ given) / (given @ given), rel=1e-6)
    assert best["lambda_h"] == pytest.approx(nu * MATERIAL.young * THICKNESS / (1 - nu**2))


@pytest.mark.parametrize(
    ("name", "share", "off"), [("one-diagonal", 1.0, 0.48), ("alternate-diagonals", 0.5, 0.08)]
)
def test_the_limit_is_that_of_discrete_shells_on_the_published_sheet(name, share, off):
    """Measured on 17 × 17 nodes, near the limit: with hinges k = D/l 48 % off, with half of it 8 %."""
    cell = cell_of(name, 0.188 / 16, 0.0)
    coefficients = nearest(cell, MATERIAL, THICKNESS) | {"hinge": share * RIGIDITY / (0.188 / 16)}
    assert limit_errors(SCENE, 8)(moduli_of(cell, coefficients)) == pytest.approx(off, abs=0.02)


def test_newtons_membrane_is_the_sheet_at_small_strain():
    """Its neo-Hookean energy, as its source has it, twice differentiated by small principal stretches."""
    stretching = {"lambda_h": 3.0, "mu_h": 2.0, "hinge": 1.0}
    own = {p.name: p.value for p in parameters_of(CODES["newton"], stretching, SCENE)}
    mu, lame = own["tri_ke"], own["tri_ka"] + own["tri_ke"]  # the solver adds them
    a, b = 1.0 + 1e-4 * np.array([[-1.0, 0.0, 1.0]]).T, 1.0 + 1e-4 * np.array([[-1.0, 0.0, 1.0]])
    energy = mu / 2 * (a**2 + b**2 - 2) + lame / 2 * (a * b - 1 - mu / lame) ** 2
    assert (energy[2, 1] - energy[0, 1]) / 2e-4 == pytest.approx(0.0, abs=1e-6)
    along = (energy[2, 1] - 2 * energy[1, 1] + energy[0, 1]) / 1e-8
    across = (energy[2, 2] - energy[2, 0] - energy[0, 2] + energy[0, 0]) / 4e-8
    assert (along, across) == pytest.approx((3.0 + 2 * 2.0, 3.0), abs=1e-3)


def test_the_verb_shows_and_writes_a_cell_of_a_file(tmp_path, capsys):
    file = tmp_path / "square.toml"
    file.write_text(
        "periods = [[0.01, 0], [0, 0.01]]\nnodes = [[0, 0]]\nhinge = 'length'\n"
        "triangles = [[[0, 0, 0], [0, 1, 0], [0, 1, 1]], [[0, 0, 0], [0, 1, 1], [0, 0, 1]]]\n"
    )
    found = json_of(capsys, "calibrate", SCENE.name, "--cell", str(file), "--coefficient", "hinge=2")
    assert found["coefficients"]["hinge"] == 2.0 and found["units"]["hinge"] == "N"
    assert {row["name"]: row["got"] for row in found["moduli"]}["D16"] == pytest.approx(0.01)
    assert run("calibrate", SCENE.name, "--cell", str(file), "--quiet") == 0
    said = capsys.readouterr().out
    assert "These coefficients miss D11" in said and "nodes 10 mm apart" in said


@pytest.mark.usefixtures("undrawn")
def test_the_parameter_shown_is_the_best_one_and_calibrates(tmp_path, capsys):
    """The nearest hinge leaves an error of 71 % in this scene; `calibrate --for` has the best one too."""
    other = json_of(capsys, "calibrate", "one-edge-clamped", "--for", "newton")
    shown = ["one-edge-clamped", "--cell", "alternate-diagonals", "--quiet", "--out", str(tmp_path)]
    assert run("calibrate", *shown) == 0
    said = " ".join(capsys.readouterr().out.split())
    (file,) = set(tmp_path.glob("*.json")) - {tmp_path / "manifest.json"}
    found = json.loads(file.read_text(encoding="utf-8"))
    assert found["coefficients"]["hinge"] == pytest.approx(other["coefficients"]["hinge"], rel=1e-9)
    assert found["limit_error"] < 0.02 and found["nearest"]["limit_error"] > 0.5
    assert re.search(r"even an infinitely fine mesh is 1.4 % off.*Coefficients.*edge_ke 8\.36\d+ N ", said)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("periods = [[1, 0], [2, 0]]\nnodes = [[0, 0]]\ntriangles = []", "periods"),
        ("periods = [[1, 0], [0, 1]]\nnodes = [[0, 0]]", "no triangles, springs or bricks"),
        ("periods = [[1, 0], [0, 1]]\nnodes = [[0, 0]]\nsprings = [[[0, 0, 0], [3, 1, 0], 'k']]", "node 3"),
        ("periods = [[1, 0], [0, 1]]\nnodes = [[0, 0]]\nspring = []", "spring"),
        ("nodes = [[0, 0]]", "periods"),
    ],
)
def test_what_is_no_cell_is_refused_with_its_file_or_name(tmp_path, capsys, text, reason):
    file = tmp_path / "cell.toml"
    file.write_text(text)
    assert run("calibrate", SCENE.name, "--cell", str(file)) == 2
    line = one_line(capsys)
    assert reason in line and "cell" in line


def test_every_shell_of_a_search_is_told():
    told = []
    with running(progress=told.append):
        limit_errors(SCENE, 2)(moduli_of(cell_of("equilateral", 0.02, 0.0), UNIT))
    assert told == [f"solving shell, 2 elements along the shorter side: no. {n} …" for n in (1, 2)]


def test_a_mesh_that_is_not_there_and_a_foreign_coefficient_are_refused():
    with pytest.raises(BadInput, match="one of one-diagonal"):
        sb.cell("hexagons", 0.01, 0.001)
    with pytest.raises(BadInput, match="coefficient bend"):
        sb.calibrate(SCENE, cell="equilateral", coefficient={"bend": 1.0})
    with pytest.raises(BadInput, match="no effect on a Cell"):
        sb.calibrate(SCENE, cell=sb.cell("equilateral", 0.01), hinge="angle")


def test_bending_of_codes_that_are_not_run_is_that_of_their_source():
    """With ½ 3 hinge L²/(A₁ + A₂) θ² of ours: SOFA's ½ k/3 L²/(A₁ + A₂), C-IPC's m D/2 · 3 L²/(A₁ + A₂)."""
    own = {"lambda_h": 3.0, "mu_h": 2.0, "hinge": 0.2}
    rigidity = 7.0 * THICKNESS**2 / 12.0
    for code, name, value in (
        ("sofa", "bendingStiffness", 1.8),
        ("c-ipc", "bendingStiffMult", 0.2 / rigidity),
    ):
        keys = {key.name: key.value for key in parameters_of(CODES[code], own, SCENE)}
        assert keys[name] == pytest.approx(value)


@pytest.mark.parametrize("code", [code for code in CODES if code != "discrete-shells"])
def test_the_numbers_of_a_code_are_the_sheet_that_they_were_made_of(code):
    """The table read both ways. Two layers of equal springs have no ν to choose: their D11 comes back."""
    row, thickness, spacing = CODES[code], 0.002, 0.02
    scene = load("two-edges-clamped").replace(young=1e6, poisson=1 / 3, thickness=thickness, density=1200.0)
    if code in WRITERS:
        keys = setup(scene.replace(length_x=0.16, length_y=0.16, probes={}), code, 8, named=False).keys
    else:
        cell = cell_of(row.mesh, spacing, hinge=row.hinge)
        keys = parameters_of(row, nearest(cell, scene.material, thickness), scene)
    found = sheet_of(code, {key.name: key.value for key in keys}, spacing=spacing)
    assert found.bending == pytest.approx(1e6 * thickness**3 / 12 / (1 - 1 / 9), rel=1e-6)
    if code != "pybullet":
        got = [found.young, found.poisson, found.thickness]
        assert got == pytest.approx([1e6, 1 / 3, thickness], rel=1e-6) and not found.impossible
    if any(key.name in ("density", "rho") for key in keys):
        assert (found.density, found.area_density) == pytest.approx((1200.0, 2.4), rel=1e-6)


RECIPES = [  # codes' own examples: E h [N/m], ν, D11 [N·m], and what is said
    ("newton", "tri_ke=1e3,tri_ka=1e3,edge_ke=10", 2666.7, 1 / 3, 1.398, "not thin, 74.8 mm"),
    ("mujoco", "young=3e5,poisson=0,thickness=1e-2", 3000.0, 0.0, 0.03712, ""),
    ("pybullet", "springElasticStiffness=40", 53.33, 1 / 3, None, "its bending stiffness is not given"),
    ("genesis", "stretch_compliance=1e-7,bending_compliance=1e-5", 1.333e7, 1 / 3, 1.125e5, "thin, 300 mm"),
    ("newton", "tri_ke=50,tri_ka=50,edge_ke=10", 133.33, 1 / 3, 1.398, "not thin, 334 mm"),
    (
        "sofa",
        "youngModulus=20000,poissonRatio=0.3,bendingStiffness=10000",
        20000.0,
        0.3,
        6117.4,
        "1.83e+03 mm",
    ),
    (
        "c-ipc",
        "E=8210,nu=0.243,thickness=0.318e-3,density=472.64,bendingStiffMult=100",
        2.6108,
        0.243,
        1.2321e-5,
        "",
    ),
    ("newton", "tri_ke=1e4,tri_ka=1e4,edge_ke=0", 26667.0, 1 / 3, 0.0, "D11 = 0 N·m"),
    (
        "openusd",
        "physics:surfaceStretchStiffness=1e3,physics:surfaceShearStiffness=20",
        78.4,
        0.96,
        None,
        "ν =",
    ),
]


@pytest.mark.parametrize(("code", "numbers", "stretching", "poisson", "bending", "said"), RECIPES)
def test_recipes_are_sheets_or_are_said_to_be_none(capsys, code, numbers, stretching, poisson, bending, said):
    document = json_of(capsys, "calibrate", numbers, "--from", code, "--spacing", "0.1")
    sheet = document["sheet"]
    assert sheet["poisson"] == pytest.approx(poisson, abs=1e-6)
    assert sheet["membrane"] * (1 - poisson**2) == pytest.approx(stretching, rel=1e-3)
    assert sheet["bending"] == (bending if bending is None else pytest.approx(bending, rel=1e-3))
    assert said in document["message"] if said else not document["message"]


@pytest.mark.parametrize(
    ("code", "numbers", "said"),
    [
        ("newton", {"tri_ke": 1e3, "edge_k": 1.0}, "edge_k: Newton 1.8, VBD has tri_ke, tri_ka, edge_ke"),
        ("newton", {"tri_ke": 1e3, "edge_ke": 1.0}, "do not determine lambda_h of the membrane"),
        ("newton", {"tri_ke": 1e3, "tri_ka": 1e3, "edge_ke": 1.0}, "--spacing: the distance"),
        ("arcsim", {f"stretching {n}": 1e3 for n in (1, 2, 3, 4)}, "no isotropic sheet has these"),
        ("newton", {}, "needs its numbers as NAME=VALUE"),
    ],
)
def test_numbers_that_are_no_sheets_are_refused(code, numbers, said):
    with pytest.raises(BadInput, match=said):
        sheet_of(code, numbers)

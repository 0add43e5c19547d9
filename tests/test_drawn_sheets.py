"""Sheets that are not the same all over, or on points, in every model: cut up, in closed form, refused."""

from xml.etree import ElementTree

import numpy as np
import pytest
from cases import calibrated, relative, sheet

import fem_reference
import lumped
from comparisons.codes.lattice import lattice_files
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Lattice
from sheetbench import face
from sheetbench.answers.balance import dead_force
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput, SceneError
from sheetbench.scenes import Point, Scene, Sheet, free_rigid_motions, load
from sheetbench.scenes.meaning.words import in_words

LENGTH, WIDTH, THICK, YOUNG, FORCE = 0.2, 0.02, 3e-3, 5e6, 1e-6
TIP = [[LENGTH, WIDTH / 2.0]]
BOX = {"rectangle": {"x": (0.02, 0.1), "y": (0.0, 0.188)}}
DISC = {"circle": {"centre": (0.1, 0.1), "radius": 0.03}}


def strip(**drawn):
    kept = {
        "sheet": Sheet(LENGTH, WIDTH, THICK),
        "name": "strip",
        "supports": [{"edge": "x0", "kind": "clamped"}],
    }
    pull = {"kind": "edge", "edge": "x1", "force_per_length": (0.0, 0.0, FORCE / WIDTH)}
    return Scene(
        **{**kept, "material": {"young": YOUNG, "poisson": 0.0, "density": 1e3}, "loads": [pull], **drawn}
    )


def deflection(thickness, young):
    """Of its end by bending, F ∫ (L − x)² 12/(E b h³) dx, and by shear, ∫ F/(κ G b h) dx, at midpoints."""
    x = (np.arange(200_000) + 0.5) / 200_000 * LENGTH
    h, e = thickness(x), young(x)
    return FORCE * LENGTH * np.mean(12.0 * (LENGTH - x) ** 2 / (e * WIDTH * h**3) + 2.4 / (e * WIDTH * h))


ROOT = {"shape": {"rectangle": {"x": (0.0, 0.073), "y": (0.0, WIDTH)}}}  # ends within a cell
STRIPS = {
    "tapered": (strip(sheet=Sheet(LENGTH, WIDTH, THICK, taper_x=(THICK, 1e-3))),
        deflection(lambda x: THICK - 2e-3 * x / LENGTH, lambda x: YOUNG)),
    "of two materials": (strip(patches=[{**ROOT, "young": 10.0 * YOUNG}]),
        deflection(lambda x: THICK, lambda x: np.where(x < 0.073, 10.0 * YOUNG, YOUNG))),
    "with a step": (strip(patches=[{**ROOT, "thickness": 2.0 * THICK}]),
        deflection(lambda x: np.where(x < 0.073, 2.0 * THICK, THICK), lambda x: YOUNG)),
}  # fmt: skip


@pytest.mark.sweep(2)
@pytest.mark.parametrize("kind", STRIPS)
@pytest.mark.parametrize(
    ("model", "off"), [("lumped", 0.005), ("plate", 1e-5), ("shell", 1e-5), ("solid", 5e-4)]
)
def test_strips_bend_as_their_closed_forms(kind, model, off):
    """The lattice's error is of second order in its cells; quadratic elements see the integrals."""
    scene, expected = STRIPS[kind]
    if model == "solid":
        if kind == "with a step":
            with pytest.raises(
                ValueError, match=r"patch 1.thickness = 0.006 m: the solid has no steps in its"
            ):
                fem_reference.solve(scene, model, elements=1)
            return
        point = {"kind": "point", "at": TIP[0], "force": (0.0, 0.0, FORCE)}
        scene = scene.replace(loads=[point])  # no followers on a taper
    solution = face.solve(scene, model, **({"grid": (17, 3)} if model == "lumped" else {"elements": 3}))
    assert solution.status is Status.CONVERGED and solution.balance.holds
    assert solution.displacement(TIP)[0, 2] == pytest.approx(expected, rel=off)


PATCHED = strip(sheet=Sheet(0.12, 0.08, THICK), probes={})
PATCHED = PATCHED.replace(material=PATCHED.material.replace(poisson=0.4))
SHAPES = {  # how far the lattice may be off: none of the sides of stiff parts lies on a line of the grid
    "box": ({"rectangle": {"x": (0.037, 0.081), "y": (0.021, 0.057)}}, 0.02),
    "disc": ({"circle": {"centre": (0.06, 0.04), "radius": 0.02}}, 0.04),
    "oblique": ({"polygon": [(0.0, 0.0), (0.06, 0.0), (0.03, 0.08), (0.0, 0.08)]}, 0.04),
}
PLANS = {
    **{n: (PATCHED.replace(patches=[{"shape": s, "young": 10 * YOUNG}]), o) for n, (s, o) in SHAPES.items()},
    **{name: (load(name), 0.02) for name in ("kirigami-strip", "pouch")},
    **{name: (load(name), 0.04) for name in ("ray-fin", "gripper-finger")},  # with rims along no axis
}


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", PLANS)
def test_lattice_and_shell_agree_on_stiff_parts_outlines_and_cutouts(name):
    scene, off = PLANS[name]
    found, shell = face.solve(scene, grid=17), face.solve(scene, "shell", elements=16)
    assert found.status is shell.status is Status.CONVERGED and found.balance.holds
    points = scene.probe_points()
    assert relative(found.displacement(points), shell.displacement(points)) < off


def test_rubber_is_cut_and_patched():
    """In closed form at small strains; a blown sheet with a hole beside the shell."""
    root = {"rectangle": {"x": (0.0, 0.075), "y": (0.0, WIDTH)}}
    two = strip(patches=[{"shape": root, "young": 10.0 * YOUNG}])
    expected = deflection(lambda x: THICK, lambda x: np.where(x < 0.075, 10.0 * YOUNG, YOUNG))
    found = face.solve(two, grid=(17, 3), calibration="hyperelastic")
    assert found.displacement(TIP)[0, 2] == pytest.approx(expected, rel=0.005)
    scene = strip(
        sheet=Sheet(0.12, 0.08, THICK),
        material={"law": "neo-hookean", "young": 2e6, "poisson": 0.4, "density": 1e3},
        supports=[{"edge": edge, "kind": "clamped"} for edge in ("x0", "x1", "y0", "y1")],
        cutouts=[{"shape": {"circle": {"centre": (0.06, 0.04), "radius": 0.01}}}],
        loads=[{"kind": "pressure", "value": 2e3}],
    )
    found, shell = face.solve(scene), face.solve(scene, "shell", elements=6)
    assert found.status is shell.status is Status.CONVERGED and found.balance.holds
    at = [[0.06, 0.06], [0.08, 0.04], [0.03, 0.06]]
    assert relative(found.displacement(at), shell.displacement(at)) < 0.04  # of second order
    with pytest.raises(ValueError, match="needs one thickness all over"):
        lumped.solve(scene.replace(taper_x=(THICK, 2e-3)))


def test_springs_alike_in_all_cells_are_shared_out_where_a_sheet_is_cut(tmp_path):
    """At ν = 1/3, where links alone can be right; SOFA's file has the masses that are there."""
    hole = {"shape": {"rectangle": {"x": (0.04, 0.1), "y": (0.025, 0.055)}}}
    scene = strip(sheet=Sheet(0.12, 0.08, THICK), cutouts=[hole], probes={})
    scene = scene.replace(material=scene.material.replace(poisson=1.0 / 3.0))
    springs = resolve(scene, Lattice((17, 11, 2), "central")).springs
    found, shell = lumped.solve(scene, springs), face.solve(scene, "shell", elements=8)
    points = scene.probe_points()
    assert found.balance.holds and relative(found.displacement(points), shell.displacement(points)) < 0.05
    lattice_files(scene, springs, "sofa")[0]["sofa.scn"](tmp_path / "sofa.scn")
    masses = ElementTree.parse(tmp_path / "sofa.scn").find(".//DiagonalMass").attrib["vertexMass"].split()
    assert list(map(float, masses)) == lumped.describe(scene, springs).mass.tolist()
    assert len(masses) < 17 * 11 * 2


def test_cells_of_a_lattice_know_their_share_of_the_sheet():
    scene = load("one-edge-clamped").replace(cutouts=[{"shape": DISC}])
    mesh = solve(resolve(scene, Lattice(6))).mesh
    share = mesh.cell_data["share"][1]
    assert share.sum() * (0.188 / 5) ** 2 == pytest.approx(2.0 * scene.region.area) and share.min() < 0.9


SHAPED = {
    "sheet.outline": {"sheet": {"outline": [(0, 0), (0.188, 0), (0.1, 0.188), (0, 0.188)]}},
    "cutout": {"cutouts": [{"shape": DISC}]},
    "support.where": {"supports": [{"kind": "clamped", "where": BOX}]},
    "load.where": {"loads": [{"kind": "pressure", "value": 1.0, "where": BOX}]},
    "load.where on an edge": {"loads": [{"kind": "edge", "edge": "x1", "force_per_length": (0.0, 0.0, 1.0),
        "moment_per_length": 0.01} | {"where": {"rectangle": {"x": (0.15, 0.188), "y": (0.0, 0.08)}}}]},
    "mass.where": {"masses": [{"mass": 0.1, "where": BOX}]},
    'load.kind = "area"': {"loads": [{"kind": "area", "force_per_area": (0.0, 0.0, 1.0)}]},
}  # fmt: skip


def test_a_load_on_parts_of_an_edge_is_that_on_the_whole_of_it():
    """But that the edge's tangent, about which its moment turns, is one-sided where parts meet."""
    scene = load("one-edge-clamped")
    pull = {"kind": "edge", "edge": "x1", "force_per_length": (0.3, 0.1, 0.2), "moment_per_length": 0.01}
    parts = [{"rectangle": {"x": (0.1, 0.188), "y": y}} for y in ((0.0, 0.03), (0.03, 0.188))]
    whole, cut = scene.replace(loads=[pull]), scene.replace(loads=[{**pull, "where": part} for part in parts])
    assert np.allclose(dead_force(cut), dead_force(whole))
    springs = lumped.calibrate(scene.sheet, scene.material, 5)
    fields = [lumped.solve(each, springs).mesh.point_data["displacement"] for each in (whole, cut)]
    assert np.allclose(*fields, rtol=0.0, atol=1e-6 * np.abs(fields[0]).max())
    with pytest.raises(ValueError, match=r"load 1.where: .* no part of edge y1 is in it"):
        scene.replace(loads=[{**pull, "edge": "y1", "where": parts[0]}])


@pytest.mark.sweep(2)
@pytest.mark.parametrize("word", SHAPED)
def test_references_agree_on_shapes(word):
    """Of a stiff sheet; the layer at a clamp within it is too narrow for these elements of the solid."""
    scene = load("one-edge-clamped").replace(probes={})
    keys = dict(SHAPED[word])
    scene = scene.replace(**keys.pop("sheet", {}), **keys, material=scene.material.replace(young=54.5e8))
    answers = [fem_reference.solve(scene, model, elements=6) for model in ("shell", "plate", "solid")]
    if word == "load.where on an edge":
        answers.append(face.solve(scene, grid=17))
    found = [each.displacement(scene.probe_points()) for each in answers]
    for each, displacement in zip(answers, found, strict=True):
        off = 0.1 if (each.model, word) == ("solid", "support.where") else 0.02
        assert each.status is Status.CONVERGED and each.balance.holds
        assert np.abs(displacement - found[0]).max() < off * np.abs(found[0]).max()


THREE = (
    Point(at=(0.05, 0.05)),
    Point(at=(0.15, 0.05), components=("y", "z")),
    Point(at=(0.1, 0.15), components=("z",)),
)


def scene(supports=THREE):
    return sheet(0.2, 0.2, 0.002, weight=0.02, supports=supports, probes={"corner": [0.2, 0.2]})


def solved(of, model):
    return face.solve(of, model, **({"grid": 9} if model == "lumped" else {"elements": 4}))


@pytest.mark.parametrize("model", ["lumped", "plate", "shell", "solid"])
def test_three_points_carry_the_weight_as_statics_say(model):
    """Moments about the first two: the third carries half."""
    found = solved(scene(), model)
    assert found.succeeded and not free_rigid_motions(scene())
    whole = 1e3 * 0.2 * 0.2 * 0.002 * 0.02
    shares = [found.reactions[f"support {n}"][2] / whole for n in (1, 2, 3)]
    np.testing.assert_allclose(shares, [0.25, 0.25, 0.5], rtol=1e-4)
    held = found.displacement([[0.05, 0.05], [0.15, 0.05], [0.1, 0.15]])
    assert np.abs(held[:, 2]).max() < 1e-7 and np.abs(held[0]).max() < 1e-7  # solid: the mean is held


def test_what_is_missing_or_nowhere_is_said():
    two = scene(THREE[:2])
    assert any("rotation" in motion for motion in free_rigid_motions(two))
    with pytest.raises(SceneError, match="nothing stops"):
        solved(two, "shell")
    with pytest.raises(BadInput, match=r"at = \[0.05, 0.05\]: no mass"):
        lumped.solve(scene(), lumped.calibrate(scene().sheet, scene().material, (8, 8, 2)))
    with pytest.raises(SceneError, match="off the sheet"):
        scene((Point(at=(0.3, 0.1)), *THREE[1:]))


def round_sheet(**support):
    """A disc of radius 0.1 about (0.1, 0.1), pressed a little."""
    return Scene(
        name="disc",
        sheet=Sheet(0.2, 0.2, 0.002, outline="disc"),
        material={"young": 1e6, "poisson": 0.3, "density": 1e3},
        supports=({"where": "rim", **support},),
        loads=({"kind": "pressure", "value": 0.01},),
        probes={"middle": (0.1, 0.1)},
    )


@pytest.mark.parametrize("kind", ["clamped", "hinged"])
def test_a_round_rim_is_held_in_closed_form(kind):
    """w = q a⁴/64 D, and (5 + ν)/(1 + ν) times that with a hinge; the disc's area but for 0.01 %."""
    scene = round_sheet(kind=kind)
    rigidity = 1e6 * 0.002**3 / 12 / (1 - 0.3**2)
    exact = 0.01 * 0.1**4 / 64 / rigidity * (5.3 / 1.3 if kind == "hinged" else 1.0)
    shell = fem_reference.solve(scene, "shell", elements=8)
    assert shell.displacement(scene.probe_points())[0, 2] == pytest.approx(exact, rel=0.02)
    assert shell.balance.holds and not free_rigid_motions(scene)
    assert sum(shell.reactions.values())[2] == pytest.approx(-0.01 * np.pi * 0.1**2, rel=1e-3)
    if kind == "hinged":
        with pytest.raises(
            BadInput, match=r"support 1\.where: the lattice can only clamp .* rims: its masses .* slope"
        ):
            lumped.solve(scene, calibrated(scene, 9))
        return
    assert scene.region.area == pytest.approx(np.pi * 0.1**2, rel=1.01e-4)
    for masses, off in ((9, 0.065), (17, 0.04)):
        lattice = lumped.solve(scene, calibrated(scene, masses))
        assert lattice.displacement(scene.probe_points())[0, 2] == pytest.approx(exact, rel=off + 0.005)
        assert lattice.balance.holds


def test_a_disc_is_one_word_in_a_file_too(tmp_path):
    """Round in the rectangle of its sides, an ellipse where these differ."""
    text = 'name = "d"\n[sheet]\nlength_x = "3 cm"\nlength_y = 0.02\nthickness = 1e-3\noutline = "disc"\n'
    text += "[gravity]\nacceleration = [0.0, 0.0, -9.81]\n"
    text += "[material]\nyoung = 1e6\npoisson = 0.3\ndensity = 1000.0\n"
    (tmp_path / "d.toml").write_text(text + '[[support]]\nkind = "clamped"\nwhere = "rim"\n')
    found = load(str(tmp_path / "d.toml"))
    assert found.region.area == pytest.approx(np.pi * 0.015 * 0.01, rel=1.01e-4)
    assert "(an ellipse)" in dict(in_words(found))["sheet"]
    assert Scene.model_validate(found.document()) == found
    with pytest.raises(SceneError, match="mesh_scale: for a file"):
        found.replace(outline="disc", mesh_scale=1e-3)


def test_rims_are_edges_or_holes_by_their_numbers():
    plain = load("two-edges-clamped")
    rim = plain.replace(supports=({"kind": "clamped", "where": "rim"},))
    assert [support.edge for support in rim.supports] == ["x0", "x1", "y0", "y1"]
    held = {"kind": "clamped", "where": {"hole": 1}}
    pierced = plain.replace(cutouts=({"shape": DISC},), supports=(held,))
    assert pierced.supports[0].where == pierced.cutouts[0].shape and not free_rigid_motions(pierced)
    shell = fem_reference.solve(pierced.replace(probes={"P": (0.1, 0.131)}), "plate", elements=8)
    assert shell.balance.holds
    with pytest.raises(SceneError, match=r"support 1\.where: hole = 2: the sheet has 1"):
        pierced.replace(supports=({"kind": "clamped", "where": {"hole": 2}},))
    with pytest.raises(SceneError, match="cutout 1: rim and hole are for a support's where"):
        plain.replace(cutouts=({"shape": {"hole": 1}},))
    assert Scene.model_validate(pierced.document()) == pierced

"""Meshes of one's own from files: what they cover, what is refused, and that a scene keeps them; files of
another person: formats that have ends, nothing read but the file, numbers that hold."""

from time import perf_counter

import meshio
import numpy as np
import pytest

from sheetbench.choices import ELEMENTS
from sheetbench.scenes import Scene, SceneError, Sheet, load
from sheetbench.scenes.meaning.words import in_words
from sheetbench.scenes.objects import plan_mesh
from sheetbench.scenes.objects.grid import elements_of

SCENE = """
name = "own"
sheet = {{ length_x = {length}, length_y = {width}, thickness = 0.002, mesh = "{file}" }}
material = {{ young = 1e6, poisson = 0.3, density = 1000.0 }}
gravity = {{ acceleration = [0.0, 0.0, -9.81] }}
[[support]]
edge = "x0"
kind = "clamped"
"""


def square(left=0.0, low=0.0, side=0.1):
    return [(left, low), (left + side, low), (left + side, low + side), (left, low + side)]


def frame(high=0.0):
    """Eight squares around a hole, the last of two triangles; points (n, 3), and corners by kind of cell."""
    at = [(i, j) for j in range(3) for i in range(3) if (i, j) != (1, 1)]
    places = np.concatenate([square(0.1 * i, 0.1 * j) for i, j in at]).round(3)
    points, which = np.unique(places, axis=0, return_inverse=True)
    quads = which.reshape(-1, 4)
    last = quads[-1]
    unused = [[7.0, 7.0, 0.0]]
    points = np.concatenate([np.column_stack([points, np.full(len(points), high)]), unused])
    return points, {"quad": quads[:-1], "triangle": np.array([last[:3], last[[0, 2, 3]]])}


def written(folder, points, cells, file="own.msh", width=0.3):
    points = np.asarray(points, float)
    points = points if points.shape[1] == 3 else np.column_stack([points, np.zeros(len(points))])
    kind = "gmsh22" if file.endswith(".msh") else None
    meshio.write(folder / file, meshio.Mesh(points, list(cells.items())), kind)
    return beside(folder, file, width=width)


def beside(folder, file, text="", length=0.3, width=0.3):
    """A scene beside a mesh file of another's, or of this text."""
    if text:
        (folder / file).write_text(text)
    (folder / "own.toml").write_text(SCENE.format(length=length, width=width, file=file))
    return folder / "own.toml"


@pytest.mark.sweep
@pytest.mark.parametrize("file", ["own.msh", "own.vtu", "own.inp"])
def test_the_boundary_of_a_mesh_is_the_outline_with_its_holes(tmp_path, file):
    points, cells = frame()
    scene = load(written(tmp_path, points, cells, file))
    assert scene.region.area == pytest.approx(0.08) and len(scene.region.interiors) == 1
    assert len(scene.region.exterior.coords) == len(scene.region.interiors[0].coords) == 5
    assert len(scene.sheet.mesh.quads) == 7 * 4 + 2 * 3  # one cut into three cuts the others into four
    assert scene.probes["P1"] != (0.15, 0.15) and scene.shaped_by == "sheet.mesh"
    assert "a mesh of 34 quadrilaterals in it, 800 cm² in all" in dict(in_words(scene))["sheet"]
    (tmp_path / file).unlink()  # a scene keeps the numbers
    scene.save(tmp_path / "kept.toml")
    assert load(tmp_path / "kept.toml") == scene == Scene.model_validate(scene.document())
    assert scene.replace(thickness=0.001).sheet.mesh == scene.sheet.mesh


def test_sixteen_elements_are_the_mesh():
    points, cells = frame()
    mesh = {"points": [tuple(p) for p in points[:-1, :2]], "quads": cells["quad"].tolist()}
    sheet = Sheet(0.3, 0.3, 0.002, mesh=mesh)
    assert [elements_of(sheet, n) for n in (ELEMENTS, 2 * ELEMENTS, 8)] == [(3, 3), (6, 6), (2, 2)]


GRID, QUAD = [*square(), *square(0.1)], {"quad": np.array([[0, 1, 2, 3], [4, 5, 6, 7]])}
WRONG = {
    "lines": (GRID, {"line": np.array([[0, 1]])}, "no triangles and no quadrilaterals; its cells: line"),
    "off the plane": (*frame(high=0.01), "a point lies 0.01 m off the plane z = 0"),
    "two pieces": ([*square(), *square(0.2, 0.2)], QUAD, "sheet.mesh: it covers 2 parts"),
    "at a point": ([*square(), *square(0.1, 0.1)], QUAD, "sheet.mesh: it covers 2 parts that are connected"),
    "crossing": (square(), {"quad": np.array([[0, 2, 1, 3]])}, "crosses itself, or is not convex"),
    "over each other": ([*square(), *square(0.05)], QUAD, "elements lie over each other"),
    "unmerged": (GRID, QUAD, "touch without sharing corners"),
    "another box": (square(side=0.2), {"quad": np.array([[0, 1, 2, 3]])},
                    r"its corners are at 0 ≤ x ≤ 0.2 m; they have to reach from 0 to length_x = 0.3 m"),
}  # fmt: skip


@pytest.mark.sweep(2)
@pytest.mark.parametrize("kind", WRONG)
def test_what_is_no_mesh_of_a_sheet_is_refused(tmp_path, kind):
    points, cells, said = WRONG[kind]
    path = written(tmp_path, points, cells, width=0.3 if kind != "at a point" else 0.2)
    if kind == "at a point":
        path.write_text(path.read_text().replace("length_x = 0.3", "length_x = 0.2"))
    with pytest.raises(SceneError, match=said) as refused:
        load(path)
    assert str(refused.value).startswith(f"{path}: ") and "mesh" in str(refused.value)


def test_files_that_are_no_meshes_are_refused(tmp_path, capsys):
    path = written(tmp_path, *frame())
    capsys.readouterr()  # meshio warns as it writes
    for broken in ("no mesh at all", None):
        (tmp_path / "own.msh").unlink() if broken is None else (tmp_path / "own.msh").write_text(broken)
        with pytest.raises(SceneError, match=r"own.toml: sheet.mesh: .*own.msh: (meshio cannot|no such)"):
            load(path)
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("own", "said"),
    [
        ({"outline": [(0, 0), (0.1, 0), (0.1, 0.1), (0, 0.1)]}, "outline and mesh: give one"),
        ({"mesh": {"points": square(), "quads": [(0, 1, 2, 4)]}}, "corner 4 is beyond the last of 4 points"),
        ({"mesh": 3}, "mesh = 3: must be"),
    ],
)
def test_a_mesh_in_numbers_is_refused_likewise(own, said):
    with pytest.raises(SceneError, match=said):
        Sheet(0.1, 0.1, 0.001, **{"mesh": {"points": square(), "quads": [(0, 1, 2, 3)]}, **own})


def test_a_cutout_beside_a_mesh_is_refused(tmp_path):
    path = written(tmp_path, *frame())
    cutout = "[[cutout]]\nshape = { circle = { centre = [0.1, 0.1], radius = 0.01 } }\n"
    path.write_text(path.read_text() + cutout)
    with pytest.raises(SceneError, match=r"cutout 1: beside sheet\.mesh"):
        load(path)


NODES = "4 3 0 0\n0 0 0 0\n1 .12 0 0\n2 .12 .08 0\n3 0 .08 0\n"
OBJ = "v 0 0 0\nv .12 0 0\nv .12 .08 0\nv 0 .08 0\n"
OFF = "OFF\n4 1 0\n0 0 0\n.12 0 0\n.12 .08 0\n0 .08 0\n"
ENDLESS = "*NODE\n1,0.,0.,0.\n*INCLUDE, INPUT=/dev/zero\n"
FAR = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
1
2000000000 0 0 0
$EndNodes
$Elements
1
1 2 0 2000000000 2000000000 2000000000
$EndElements
"""
STL = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid a\n"
KNOWN = r"a mesh file's name ends in one of \.bdf, .*, \.vtu"


@pytest.mark.sweep(2)
@pytest.mark.parametrize(
    ("file", "text", "said"),
    [
        ("m.ele", "# x\n", KNOWN),  # TetGen, Tecplot, WKT: meshio's readers do not end
        ("m.tec", 'VARIABLES = "X", "Y"\nZONE NODES=4, ELEMENTS=1', KNOWN),
        ("m.wkt", "TIN (((0 0 0, 0 0 1", KNOWN),
        ("m.inp", ENDLESS, r"\*INCLUDE: other files are not read"),
        ("m.inp", ENDLESS.replace("*INCLUDE, ", " include,"), r"\*INCLUDE: other files are not read"),
        ("m.inp", "*NODE\n1,0.\n*ELEMENT,TYPE=S3\n1,1,1,1\n", "a point has two or three coordinates"),
        ("m.inp", "*NODE\n1,0.,0.\n*ELEMENT,TYPE=S3\n1,1,7,8\n", "it names 7, which the file does not have"),
        ("m.obj", OBJ + "f 1 2 3 99\n", "a quad has point 98, counted from 0; the file has 4 points"),
        ("m.obj", OBJ + "f 1 2 3 -1\n", "a quad has point -2, counted from 0"),
        ("m.obj", OBJ.replace(".08", "nan") + "f 1 2 3 4\n", "a corner of a quad is no finite number"),
        ("m.stl", STL, "meshio cannot read it: Error"),  # after a warning of NumPy's
        ("m.off", OFF + "3 0 1 -3\n", "a triangle has point -3"),
        ("m.off", OFF + "3 0 1 999999999999\n", "a triangle has point 999999999999"),
    ],
)
def test_a_damaged_mesh_file_is_refused_by_name_and_fault(tmp_path, file, text, said):
    (tmp_path / "m.node").write_text(NODES)
    with pytest.raises(SceneError, match=rf"own\.toml: sheet\.mesh: .*{file}: {said}"):
        load(beside(tmp_path, file, text))


def test_reading_has_limits_of_time_and_memory(tmp_path, monkeypatch):
    (tmp_path / "m.node").write_text(NODES)
    endless = beside(tmp_path, "m.ele", "# x\n")
    monkeypatch.setitem(plan_mesh.FORMATS, ".ele", "tetgen")
    monkeypatch.setattr(plan_mesh, "SECONDS", 1.0)
    started = perf_counter()
    with pytest.raises(SceneError, match=r"m.ele: it cannot be read: no answer within 1 s"):
        load(endless)
    assert perf_counter() - started < 30.0
    monkeypatch.setattr(plan_mesh, "SECONDS", 20.0)
    with pytest.raises(SceneError, match=r"m\.msh: reading it takes more memory than a mesh may"):
        load(beside(tmp_path, "m.msh", FAR))


def test_a_sound_file_is_read_beside_modules_of_other_names(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "numpy.py").write_text("raise SystemExit('not the one')")
    read = load(beside(tmp_path, "m.obj", OBJ + "f 1 2 3 4\n", 0.12, 0.08))
    assert len(read.sheet.mesh.quads) == 1

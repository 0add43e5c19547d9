"""Meshes of one's own from files: what they cover, what is refused, and that a scene keeps them; files of
another person: formats that have ends, nothing read but the file, numbers that hold."""

from itertools import pairwise

import meshio
import numpy as np
import pytest

from sheetbench.choices import ELEMENTS
from sheetbench.scenes import Scene, SceneError, Sheet, load
from sheetbench.scenes.meaning.words import in_words
from sheetbench.scenes.objects import mesh_reader, plan_mesh
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
    quads, unused = which.reshape(-1, 4), [[7.0, 7.0, 0.0]]
    last = quads[-1]
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
    assert f"a mesh of 34 quadrilaterals in it ({file}), 800 cm² in all" in dict(in_words(scene))["sheet"]
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
    "a body": (frame()[0] + np.eye(17)[0][:, None] * [0, 0, 0.1], frame()[1],
               "it is no flat sheet: its points reach over 0.3, 0.3, 0.1 along x, y and z"),
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
    with pytest.raises(SceneError, match=r"cutout 1: not with sheet\.mesh"):
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
        ("m.obj", OBJ + "f 1 2 3 -6\n", "a quad has point -2, counted from 0"),
        ("m.obj", OBJ + "f 1 2 x\n", "line 5: 'f 1 2 x' is no f of Wavefront OBJ"),
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


def obj(places, faces, before="", corner="{}", between=""):
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in places]
    faces = [" ".join(corner.replace("{}", str(n)) for n in face) for face in faces]
    return "\n".join([before, *lines, between, *(f"f {face}" for face in faces)]) + "\n"


def cloth(turn=lambda x, y: (x, y, 0.0), n=3):
    """Nine places of a square of side 1 about the origin in a plane, and its four squares."""
    line = np.linspace(-0.5, 0.5, n)
    places = [turn(x, y) for y in line for x in line]
    return places, [(i + 1, i + 2, i + 5, i + 4) for i in (0, 1, 3, 4)]


def triangles(faces):
    return [corners for a, b, c, d in faces for corners in ((a, b, c), (a, c, d))]


UP, YUP, ONE_NORMAL = cloth(), cloth(lambda x, y: (x, 0.0, -y)), "vn 0 0 1\nvn 0 0 -1"
FOUR_TEXTURES = "".join(f"vt {x} {y}\n" for x in (0, 1) for y in (0, 1))
MAKERS = {
    "blender": obj(*YUP, "mtllib a.mtl\no Plane", "{}/1/1", FOUR_TEXTURES + ONE_NORMAL + "\nusemtl a\ns off"),
    "blender quads, no texture": obj(*UP, "o Grid", "{}//1", ONE_NORMAL),
    "blender triangles, lifted": obj([(x, y, 2.0) for x, y, _ in UP[0]], triangles(UP[1]), "", "{}/2"),
    "blender n-gon": obj([UP[0][n] for n in (0, 1, 2, 8, 6)], [(1, 2, 3, 4, 5)]),
    "bullet z up": obj(UP[0], triangles(UP[1]), "g cloth", "{}/1/1", "vt 0 0\nvn 0 0 1"),
    "bullet y up": obj(YUP[0], triangles(YUP[1]), "# 9 vertices", "{}/1", "vt 0 0"),
    "sofa quads": obj(*cloth(lambda x, y: (0.0, x, y)), "g square", "{}"),
    "sofa triangles, counted back": obj(UP[0], np.array(triangles(UP[1])) - 10, "", "{}"),
    "sofa groups, colours": obj(*UP, "g a", "{}//1", "vn 0 0 1\ns 1").replace(" 0.000000\n", " 0.0 1 0 0\n"),
}  # fmt: skip
TURNED = {"blender": "xz", "bullet y up": "xz", "sofa quads": "yz"}


@pytest.mark.parametrize("maker", MAKERS)
def test_obj_files_are_read_as_their_makers_write_them(tmp_path, maker):
    path = beside(tmp_path, "m.obj", MAKERS[maker], 0.25, 0.25)
    path.write_text(path.read_text().replace('"m.obj"', '"m.obj", mesh_scale = 0.25, mesh_shift = "corner"'))
    scene = load(path)
    assert scene.region.bounds == (0.0, 0.0, 0.25, 0.25) and scene.region.area == pytest.approx(0.0625)
    turned, said = TURNED.get(maker), dict(in_words(scene))["sheet"]
    assert f"turned from its {turned} plane" in said if turned else "turned" not in said
    assert "1 unit of it is 250 mm, moved by 125, 125 mm" in said
    assert Scene.model_validate(scene.document()) == scene


def test_a_mesh_is_scaled_and_moved_by_two_keys_that_refusals_name(tmp_path):
    path = beside(tmp_path, "m.obj", MAKERS["sofa quads"], 0.25, 0.25)
    with pytest.raises(SceneError, match=r"mesh_scale = 0\.25 times what it is makes it as long"):
        load(path)
    path.write_text(path.read_text().replace('"m.obj"', '"m.obj", mesh_scale = 0.25'))
    with pytest.raises(SceneError, match='mesh_shift = "corner" puts them there'):
        load(path)
    meshes, text = [], path.read_text()
    for shift in ('"corner"', '"centre"', "[0.125, 0.125]"):
        path.write_text(text.replace("mesh_scale", f"mesh_shift = {shift}, mesh_scale"))
        meshes.append(load(path).sheet.mesh)
    assert meshes[0].points[0] == (0.0, 0.0) and meshes[1:] == 2 * meshes[:1]


def test_a_mesh_is_as_precise_as_its_file(tmp_path):
    """A sheet of a third of a metre has its edges where its sides say, though six digits do not."""
    points = [(x / 3, y / 3, 0.0) for x in (0, 1) for y in (0, 1)]
    scene = load(beside(tmp_path, "m.obj", obj(points, [(1, 3, 4, 2)]), 1 / 3, 1 / 3))
    assert scene.region.bounds == (0.0, 0.0, 1 / 3, 1 / 3)
    with pytest.raises(SceneError, match="mesh_scale: for a file of mesh or outline"):
        scene.replace(mesh_scale=0.1)


def test_a_flat_stl_is_a_sheet(tmp_path):
    ends = ((0, 0), (0.3, 0), (0.3, 0.1)), ((0, 0), (0.3, 0.1), (0, 0.1))
    facet = "facet normal 0 1 0\nouter loop\n{}\nendloop\nendfacet"
    text = "\n".join(facet.format("\n".join(f"vertex {x} 7 {-y}" for x, y in one)) for one in ends)
    scene = load(beside(tmp_path, "m.stl", f"solid a\n{text}\nendsolid a\n", 0.3, 0.1))
    assert scene.region.bounds == (0.0, 0.0, 0.3, 0.1) and "xz plane" in scene.sheet.drawn_from


SVG = """<svg xmlns="http://www.w3.org/2000/svg" width="200mm" height="100mm" viewBox="0 0 200 100">
<g transform="translate(10 20)"><path d="M 0 0 H 60 V 30 Q 30 50 0 30 Z"/><circle cx="20" cy="15" r="6"/>
<text x="0" y="0">a fin</text></g></svg>"""


@pytest.mark.parametrize("kind", ["svg", "dxf", pytest.param("dxf of lines", marks=pytest.mark.nightly)])
def test_an_outline_with_holes_is_read_from_a_drawing(tmp_path, kind):
    """60 × 40 mm: a rectangle of 60 × 30 and a parabola of height 10; a hole of radius 6."""
    pytest.importorskip("svgelements" if kind == "svg" else "ezdxf")
    file = tmp_path / f"fin.{kind[:3]}"
    if kind == "svg":
        file.write_text(SVG)
    else:
        import ezdxf

        drawing = ezdxf.new(units=4)  # mm
        space = drawing.modelspace()
        corners = [(10, 70), (10, 100), (70, 100), (70, 70)]
        if kind == "dxf":
            space.add_lwpolyline(corners)
        else:
            for first, second in pairwise(corners):
                space.add_line(second, first)
        space.add_open_spline([(70, 70), (50, 170 / 3), (30, 170 / 3), (10, 70)])
        space.add_circle((30, 85), 6)
        space.add_text("a fin")
        drawing.saveas(file)
    path = tmp_path / "own.toml"
    path.write_text(SCENE.format(length=0.06, width=0.04, file=file.name).replace("mesh", "outline"))
    scene = load(path)
    hole = scene.cutouts[0].shape.area
    assert scene.region.area + hole.area == pytest.approx(0.06 * 0.03 + 2 / 3 * 0.06 * 0.01, rel=1e-4)
    assert hole.area == pytest.approx(np.pi * 0.006**2, rel=1e-3) and len(scene.cutouts) == 1
    assert hole.centroid.coords[0] == pytest.approx((0.02, 0.025), abs=1e-7)
    assert 30 < len(scene.sheet.outline) < 300
    assert f"(fin.{kind[:3]}, 1 unit of it is " in dict(in_words(scene))["sheet"]
    scene.save(tmp_path / "kept.toml")
    assert load(tmp_path / "kept.toml") == scene
    with pytest.raises(SceneError, match="holes are cutouts"):
        Sheet(0.06, 0.04, 0.001, outline=str(file))


def test_drawings_that_are_no_sheet_are_refused(tmp_path, monkeypatch):
    pytest.importorskip("svgelements")
    path = tmp_path / "own.toml"
    path.write_text(SCENE.format(length=0.06, width=0.04, file="m.svg").replace("mesh", "outline"))
    begin = '<svg xmlns="http://www.w3.org/2000/svg">'
    for inside, said in (
        ('<path d="M 0 0 L 9 0 L 9 9"/>', "its lines enclose nothing"),
        ('<rect width="9" height="9"/><rect x="20" width="9" height="9"/>', "it encloses several parts"),
        ("<text>a</text>", "it draws no lines"),
    ):
        (tmp_path / "m.svg").write_text(f"{begin}{inside}</svg>")
        with pytest.raises(SceneError, match=rf"own\.toml: sheet\.outline: .*m\.svg: {said}"):
            load(path)
    (tmp_path / "m.svg").write_text("no drawing")
    with pytest.raises(SceneError, match=r"m\.svg: svgelements cannot read it"):
        load(path)


def test_a_reader_that_is_missing_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(
        mesh_reader.DRAWINGS, "svg", ("svgelements", lambda path: __import__("no_such_reader"))
    )
    with pytest.raises(ValueError, match=r"svgelements: pip install 'sheetbench\[drawings\]'"):
        mesh_reader.read(tmp_path / "m.svg", "svg")


def test_reading_has_limits_of_time_and_memory(tmp_path, monkeypatch):
    (tmp_path / "m.node").write_text(NODES)
    endless = beside(tmp_path, "m.ele", "# x\n")
    monkeypatch.setitem(plan_mesh.FORMATS, ".ele", "tetgen")
    monkeypatch.setattr(plan_mesh, "SECONDS", 1.0)
    with pytest.raises(SceneError, match=r"m.ele: it cannot be read: no answer within 1 s"):
        load(endless)
    monkeypatch.setattr(plan_mesh, "SECONDS", 20.0)
    with pytest.raises(SceneError, match=r"m\.msh: reading it takes more memory than a mesh may"):
        load(beside(tmp_path, "m.msh", FAR))


def test_a_sound_file_is_read_beside_modules_of_other_names(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "numpy.py").write_text("raise SystemExit('not the one')")
    read = load(beside(tmp_path, "m.obj", OBJ + "f 1 2 3 4\n", 0.12, 0.08))
    assert len(read.sheet.mesh.quads) == 1

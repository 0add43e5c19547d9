"""Meshes of one's own from files: what they cover, what is refused, and that a scene keeps them."""

import meshio
import numpy as np
import pytest

from sheetbench.choices import ELEMENTS
from sheetbench.scenes import Scene, SceneError, Sheet, load
from sheetbench.scenes.meaning.words import in_words
from sheetbench.scenes.objects.grid import elements_of

SCENE = """
name = "own"
sheet = {{ length_x = 0.3, length_y = {width}, thickness = 0.002, mesh = "{file}" }}
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
    (folder / "own.toml").write_text(SCENE.format(width=width, file=file))
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

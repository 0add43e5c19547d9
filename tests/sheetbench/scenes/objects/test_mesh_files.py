"""Mesh files of another person: formats that have ends, nothing read but the file, numbers that hold."""

from time import perf_counter

import pytest

from comparisons.cli import main
from sheetbench.scenes import Implausible, SceneError, load
from sheetbench.scenes.objects import plan_mesh

SCENE = """
name = "own"
sheet = {{ length_x = 0.12, length_y = 0.08, thickness = 0.003, mesh = "{file}" }}
material = {{ young = 1e6, poisson = 0.4, density = 1e3 }}
[[support]]
edge = "x0"
kind = "clamped"
"""
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
KNOWN = r"a mesh file's name ends in one of \.bdf, .*, \.vtu"


def written(folder, file, text):
    (folder / file).write_text(text)
    (folder / "own.toml").write_text(SCENE.format(file=file))
    return folder / "own.toml"


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
        ("m.off", OFF + "3 0 1 -3\n", "a triangle has point -3"),
        ("m.off", OFF + "3 0 1 999999999999\n", "a triangle has point 999999999999"),
    ],
)
def test_a_damaged_mesh_file_is_refused_by_name_and_fault(tmp_path, file, text, said):
    (tmp_path / "m.node").write_text(NODES)
    with pytest.raises(SceneError, match=rf"own\.toml: sheet\.mesh: .*{file}: {said}"):
        load(written(tmp_path, file, text))


def test_the_command_refuses_it_in_a_line(tmp_path, capsys):
    path = written(tmp_path, "m.obj", OBJ + "f 1 2 3 99\n")
    with pytest.raises(SystemExit, match="2"):
        main(["check", str(path)])
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_reading_has_limits_of_time_and_memory(tmp_path, monkeypatch):
    (tmp_path / "m.node").write_text(NODES)
    endless = written(tmp_path, "m.ele", "# x\n")
    monkeypatch.setitem(plan_mesh.FORMATS, ".ele", "tetgen")
    monkeypatch.setattr(plan_mesh, "SECONDS", 1.0)
    started = perf_counter()
    with pytest.raises(SceneError, match=r"m.ele: it cannot be read: no answer within 1 s"):
        load(endless)
    assert perf_counter() - started < 30.0
    monkeypatch.setattr(plan_mesh, "SECONDS", 20.0)
    with pytest.raises(SceneError, match=r"m\.msh: reading it takes more memory than a mesh may"):
        load(written(tmp_path, "m.msh", FAR))


def test_a_sound_file_is_read_beside_modules_of_other_names(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "numpy.py").write_text("raise SystemExit('not the one')")
    with pytest.warns(Implausible, match="nothing moves the sheet"):
        read = load(written(tmp_path, "m.obj", OBJ + "f 1 2 3 4\n"))
    assert len(read.sheet.mesh.quads) == 1

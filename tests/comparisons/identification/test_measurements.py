"""Measured displacements and surfaces from files, as people and cameras write them, and what is refused."""

import sys

import numpy as np
import pytest
import pyvista
from commands import run

from comparisons.identification import point_files as c3d
from comparisons.identification.measurements import Displacements, Surface, read
from sheetbench import scenes
from sheetbench.scenes import BadInput

pytestmark = pytest.mark.smoke

SCENE = scenes.load("two-edges-clamped")

AS_PEOPLE_WRITE_THEM = {
    "comments and blank lines": (
        "# camera 2\n\nx,y,ux,uy,uz\n0.1,0.15,,,-0.004\n# glare\n0.188,0.188,,nan,-0.013\n"
    ),
    "deflections alone": "x,y,uz\n0.1,0.15,-0.004\n0.188,0.188,-0.013\n",
    "semicolons": "x;y;ux;uy;uz\n0.1;0.15;;;-0.004\n0.188;0.188;NaN;;-0.013\n",
    "decimal commas": "x;y;uz\n0,1;0,15;-4e-3\n,188;0,188;-1,3e-2\n",
    "tabs": "X\tY\tuz [m]\n0.1\t0.15\t-0.004\n0.188\t0.188\t-0.013\n",
    "a BOM, CRLF, blanks, more columns": (
        "\ufeffnote, x, y, uz\r\na, 0.1, 0.15, -0.004\r\n,,,\r\nb, 0.188, 0.188, -0.013\r\n"
    ),
    "probes": "probe,uz,x9\nmark,-0.004,1\nP4,-0.013,2\n",
    "units in the header": "x [mm],y [cm],uz [ µm ]\n100,15,-4e3\n188,18.8,-13e3\n",
}


@pytest.mark.parametrize("way", AS_PEOPLE_WRITE_THEM)
def test_files_are_read_as_people_write_them(way, tmp_path):
    path = tmp_path / "measured.csv"
    path.write_bytes(AS_PEOPLE_WRITE_THEM[way].encode())
    scene = SCENE.model_copy(update={"probes": {"mark": (0.1, 0.15), "P4": (0.188, 0.188)}})
    found = read(path, scene)
    assert isinstance(found, Displacements)
    np.testing.assert_allclose(found.points, [[0.1, 0.15], [0.188, 0.188]])
    np.testing.assert_allclose(found.displacement[:, 2], [-0.004, -0.013])
    assert np.isnan(found.displacement[:, :2]).all()


def test_a_height_map_is_a_surface(tmp_path):
    path, points = tmp_path / "heights.csv", np.array([[0.0, 0.1, -0.004], [0.188, 0.188, -0.013]])
    lines = ["x;y;z", *(";".join(map(str, point)) for point in points), "0.1;0.1;NaN"]
    path.write_text("\n".join(lines).replace(".", ","))
    measured = read(path, SCENE)
    assert isinstance(measured, Surface)
    np.testing.assert_array_equal(measured.points, points)


BAD = {
    "empty": ("", ["column x, y, ux, uy, uz missing"]),
    "no rows": ("x,y,ux,uy,uz\n", ["no displacement"]),
    "missing column": ("x,y,ux,uz\n0,0,0,0\n", ["column uy missing"]),
    "a word": ("x,y,ux,uy,uz\n0.1,0.1,0,0,low\n", ["line 2", "uz = 'low'"]),
    "no number where one is needed": ("x,y,uz\n0.1,nan,-1e-3\n", ["line 2", "y = 'nan'", "needed"]),
    "infinite": ("x,y,ux,uy,uz\n0.1,0.1,0,inf,0\n", ["line 2", "uy = 'inf'"]),
    "too late": ("time,x,y,uz\n1e300,0.1,0.1,-0.01\n", ["line 2: time = '1e300': must be 1e+15 or less"]),
    "too large": ("x,y,uz\n0.1,0.1,1e999\n", ["line 2", "uz = '1e999'"]),
    "huge cell": ("x,y,uz\n0.1,0.1," + "9" * 200_000 + "\n", ["line 2", "131072"]),
    "long cell": ("x,y,uz\n0.1,0.1," + "9" * 100_000 + "\n", ["line 2", "uz = '9999", "…'"]),
    "underscore": ("x,y,uz\n0.1,0.1,1_0\n", ["line 2", "uz = '1_0'"]),
    "both marks": ("x;y;uz\n0,1;0,1;-0.001\n", ["decimal commas (line 2)", "points (line 2)"]),
    "twice": ("x,y,uz,uz\n0.1,0.1,1e-3,1e-3\n", ["column uz is there twice"]),
    "elbows in the header": ("x,y,uz [elbow]\n0.1,0.1,1\n", ["uz [elbow]", "no known unit"]),
    "seconds of a length": ("x,y,uz [ms]\n0.1,0.1,1\n", ["uz [ms]", "a time; a length is needed"]),
    "a moving surface": ("time,x,y,z\n0.1,0.1,0.1,1e-3\n", ["column time"]),
    "no heights": ("x,y,z\n0.1,0.1,nan\n", ["no points"]),
    "flat": ("x,y,z\n0.1,0.1,0\n", ["nothing moved"]),
    "heights in millimetres": ("x,y,z\n94,94,-6\n", ["in metres"]),
    "off the sheet": ("x,y,ux,uy,uz\n0.1,0.1,0,0,1e-3\n94,94,0,0,1e-3\n", ["line 3", "off the sheet"]),
    "millimetres": ("x,y,ux,uy,uz\n0.1,0.1,0,0,-6.02\n", ["line 2", "metres"]),
    "still": ("x,y,ux,uy,uz\n0.1,0.1,0,0,0\n", ["nothing moved"]),
    "no deviation": ("x,y,uz,sd [mm]\n0.1,0.1,-1e-3,0\n", ["line 2: sd = '0': must be greater than 0"]),
    "off by more than rounding": ("x,y,uz\n0.18804,0.1,-1e-3\n", ["line 2", "off the sheet"]),
    "begins elsewhere": (
        "time,probe,ux,uy,uz\n0,P4,0,0,-2e-3\n0.1,P4,0,0,-6e-3\n",
        ["bad.csv: uz = -0.002 m at time = 0: a run begins with the flat sheet at rest; up to 0.0006 m"],
    ),
    "probe": ("probe,ux,uy,uz\nP9,0,0,-1e-3\n", ["line 2", "P9", "P1, P2, P3, P4"]),
}


@pytest.mark.parametrize("fault", BAD)
def test_bad_file_leaves_with_2_and_one_line(fault, tmp_path, capsys):
    text, named = BAD[fault]
    path = tmp_path / "bad.csv"
    path.write_text(text)
    assert run("identify", SCENE.name, "--measured", str(path)) == 2
    said = capsys.readouterr().err.splitlines()[-1]
    assert said.startswith("sheetbench: ") and all(part in said for part in named)


@pytest.mark.parametrize("suffix", [".ply", ".vtp"])
def test_bad_clouds(suffix, tmp_path):
    path, millimetres = tmp_path / f"cloud{suffix}", pyvista.PolyData(np.array([[94.0, 94.0, -6.0]]))
    makers = (lambda path: None, lambda path: path.write_text("not a point cloud"), millimetres.save)
    for make, said in zip(makers, ("no such file", "cloud", "in metres"), strict=True):
        make(path)
        with pytest.raises(BadInput, match=said):
            read(path, SCENE)


HEADER = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
DAMAGED = {
    "no end of the header": HEADER,
    "cut short": HEADER + "end_header\n0.1 0.1 0.0\n",
    "no vertices": "ply\nformat ascii 1.0\nelement face 1\nend_header\n0 0 0\n",
    "a word": HEADER + "end_header\n0.1 0.1 0.0\n0.1 0.1 low\n",
    "a list": HEADER.replace("float z", "list uchar int z") + "end_header\n0.1 0.1 0.0\n0.1 0.1 0\n",
    "no format": HEADER.replace("ascii", "braille") + "end_header\n",
    "endless": HEADER.replace("2", "-9" * 9) + "end_header\n",
}


@pytest.mark.parametrize("fault", DAMAGED)
def test_damaged_ply_files_are_refused(fault, tmp_path):
    path = tmp_path / "scan.ply"
    path.write_text(DAMAGED[fault])
    with pytest.raises(BadInput, match="PLY"):
        read(path, SCENE)


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_ply_files_with_more_than_positions(form, tmp_path):
    """A camera's element before the points, colours beside them, faces after."""
    points = np.array([[0.1, 0.1, -0.01], [0.15, 0.05, -0.02], [0.188, 0.0, -0.03]])
    header = (
        f"ply\nformat {form} 1.0\ncomment scan\nelement camera 1\nproperty double t\nelement vertex 3\n"
        "property uchar red\nproperty double x\nproperty double y\nproperty double z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    )
    if form == "ascii":
        body = ("0.5\n" + "".join(f"7 {x} {y} {z}\n" for x, y, z in points) + "3 0 1 2\n").encode()
    else:
        order = "<" if form == "binary_little_endian" else ">"
        row = np.dtype([("red", "u1"), ("p", order + "f8", 3)])
        rows = np.array([(7, point) for point in points], dtype=row)
        body = np.array(0.5, order + "f8").tobytes() + rows.tobytes() + b"\3" + bytes(12)
    path = tmp_path / "scan.ply"
    path.write_bytes(header.encode() + body)
    np.testing.assert_array_equal(read(path, SCENE).points, points)


@pytest.fixture
def reader(tmp_path, monkeypatch):
    """Puts a module in the place of ezc3d, for the program that reads with it too; a function of its text."""
    folder = tmp_path / "modules"
    folder.mkdir()
    monkeypatch.syspath_prepend(folder)
    monkeypatch.setenv("PYTHONPATH", str(folder))
    (tmp_path / "capture.c3d").write_bytes(b"")

    def put(text):
        (folder / "ezc3d.py").write_text(text)
        return tmp_path / "capture.c3d"

    return put


def capture(labels):
    """An ezc3d whose files have frames of markers that sink by a millimetre each."""
    return f"""
import numpy as np
print("as ezc3d prints")
def c3d(path):
    points = np.zeros((4, {len(labels)}, 5))
    points[2] = -1.0 * np.arange(5)
    value = dict(LABELS={labels}, RATE=[100.0], UNITS=["mm"])
    point = dict((key, dict(value=content)) for key, content in value.items())
    return dict(parameters=dict(POINT=point), data=dict(points=points))
"""


def test_markers_with_names_of_probes_are_displacements(reader, monkeypatch):
    file = reader(capture(["Base", "p 4"]))
    found = read(file, SCENE)
    assert isinstance(found, Displacements) and found.time is not None
    assert found.time == pytest.approx([0.0, 0.01, 0.02, 0.03, 0.04])
    assert found.displacement[:, 2] == pytest.approx([0.0, -1e-3, -2e-3, -3e-3, -4e-3])
    assert found.points[0].tolist() == list(SCENE.probes["P4"])
    reader(capture(["Base"]) + "# other than before, to Python's cache too")
    with pytest.raises(BadInput, match=r"markers Base; none has the name of a probe.*P1, P2, P3, P4"):
        read(file, SCENE)
    monkeypatch.setitem(sys.modules, "ezc3d", None)
    with pytest.raises(BadInput, match="need ezc3d"):
        read(file, SCENE)


@pytest.mark.parametrize(
    ("does", "message"),
    [
        ("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)", "ended by SIGSEGV"),
        ("import time; time.sleep(60)", "no answer within 1 s"),
        ("raise ValueError('access the frame 0 of 0')", "cannot be read as C3D: access the frame 0 of 0"),
        ("return dict(parameters={}, data={})", "cannot be read as C3D: 'POINT'"),
    ],
)
def test_a_damaged_capture_is_refused_whatever_ezc3d_does(reader, monkeypatch, does, message):
    """Of 200 damaged files ezc3d ended by a signal on 7, did not end on 2, raised ValueError on 15."""
    monkeypatch.setattr(c3d, "SECONDS", 1.0 if "sleep" in does else 20.0)
    with pytest.raises(BadInput, match=message):
        read(reader(f"def c3d(path): {does}"), SCENE)

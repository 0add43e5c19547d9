"""Material from a measured decay: E and loss factor at once, branches, markers of a motion capture."""

import sys

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import fem_reference
from comparisons.identification import point_files as c3d
from comparisons.identification.identification import identify
from comparisons.identification.measurements import Displacements, read
from sheetbench.errors import BadInput
from sheetbench.scenes import Relaxation, load
from sheetbench.scenes.meaning.parameters import parameter, put

TRUTH = load("one-edge-clamped").replace(loss_factor=0.12, frequency=3.0)


def decay(run, end, noise, seed, rows=100):
    """Deflections of P4 with noise, a share of the largest."""
    at = np.linspace(0.01, end, rows)
    clean = CubicSpline(run.time, run.probes["P4"])(at)
    found = clean + noise * np.abs(clean).max() * np.random.default_rng(seed).standard_normal(clean.shape)
    found[:, :2] = np.nan
    return Displacements(np.tile(TRUTH.probes["P4"], (rows, 1)), found, at)


def test_a_reference_follows_a_measured_motion():
    """Within what a hundred steps a period leave, against finer ones."""
    run = fem_reference.simulate(TRUTH, "shell", 0.15, elements=1, step=1e-3)
    found = identify(
        TRUTH.replace(young=50e6), decay(run, 0.15, 0.0, 0, 20), "young", model="shell", elements=1
    )
    assert found.unknowns["young"].value == pytest.approx(54.5e6, rel=5e-3)
    assert found.settings["elements"] == [1, 1]


def test_branches_are_parameters():
    scene = load("one-edge-clamped").replace(relaxation=(Relaxation(0.2, 0.1), Relaxation(0.1, 1.0)))
    assert parameter(scene, "time_2").value == 1.0
    assert put(scene, "share_1", 0.3).material.relaxation[0].share == 0.3
    still = Displacements(np.array([[0.1, 0.1]] * 3), np.full((3, 3), -1e-3))
    for name, said in (
        ("share_3", "share_3"),
        ("loss_factor", "loss_factor"),
        ("share_1", "does not depend"),
    ):
        with pytest.raises(BadInput, match=said):
            identify(scene, still, name)


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
    found = read(file, TRUTH)
    assert isinstance(found, Displacements) and found.time is not None
    assert found.time == pytest.approx([0.0, 0.01, 0.02, 0.03, 0.04])
    assert found.displacement[:, 2] == pytest.approx([0.0, -1e-3, -2e-3, -3e-3, -4e-3])
    assert found.points[0].tolist() == list(TRUTH.probes["P4"])
    reader(capture(["Base"]) + "# other than before, to Python's cache too")
    with pytest.raises(BadInput, match=r"markers Base; none has the name of a probe.*P1, P2, P3, P4"):
        read(file, TRUTH)
    monkeypatch.setitem(sys.modules, "ezc3d", None)
    with pytest.raises(BadInput, match="need ezc3d"):
        read(file, TRUTH)


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
        read(reader(f"def c3d(path): {does}"), TRUTH)

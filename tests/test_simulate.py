"""`sheetbench simulate`: its document and files, measured histories, resuming after a kill, memory."""

import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
import tracemalloc
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import meshio
import numpy as np
import pytest
from dynamic_cases import scene, springs
from limits import at_most

import lumped
from comparisons.cli import main
from comparisons.motion import history as histories
from sheetbench.files import only_writer
from sheetbench.scenes import BadInput

HERE = Path(__file__).parent
RUN = ["simulate", "two-edges-settling", "--lumped", "4", "--duration", "0.1"]


def leaves_with(code, arguments):
    try:
        main(arguments)
    except SystemExit as stop:
        return (stop.code or 0) == code
    return code == 0


def test_json_has_the_promised_keys_and_enough_samples(capsys):
    assert leaves_with(0, [*RUN, "--json"])
    document = json.loads(capsys.readouterr().out)
    assert {"time", "probes", "energy", "status", "steps", "solve_seconds"} <= set(document)
    assert document["status"] == "converged" and document["steps"] > 0
    count = len(document["time"])
    assert np.shape(document["probes"]["P4"]) == (count, 3) and len(document["energy"]) == count
    assert np.shape(document["reactions"]["x0"]) == (count, 3)
    asked = scene("two-edges-settling")
    lowest = lumped.modes(asked, springs(asked, 4), 1).frequencies[0]
    assert count - 1 >= 100 * 0.1 * lowest
    assert document["time"][-1] == pytest.approx(0.1)


def test_files_of_a_run(tmp_path, capsys):
    measured = tmp_path / "measured.csv"
    measured.write_text("time,probe,ux,uy,uz\n0.01,P4,,,-0.001\n0.05,P4,,,-0.02\n")
    assert leaves_with(0, [*RUN, "--every", "0.005", "--out", str(tmp_path), "--measured", str(measured)])
    out = capsys.readouterr().out
    assert "off by" in out
    document = json.loads((tmp_path / "history.json").read_text())
    assert 0.0 < document["measured_errors"]["P4"] < 1.0
    lines = (tmp_path / "history.csv").read_text().splitlines()
    assert len(lines) == 22 and lines[0].startswith("time [s],P1.ux [m]") and "balance [J]" in lines[0]
    assert (tmp_path / "history.png").stat().st_size > 10_000
    series = ElementTree.parse(tmp_path / "frames.pvd").getroot().findall("Collection/DataSet")
    last = series[-1].attrib
    assert float(last["timestep"]) == pytest.approx(0.1)
    mesh = meshio.read(tmp_path / last["file"])
    corner = np.flatnonzero(np.linalg.norm(mesh.points[:, :2] - 0.188, axis=1) < 1e-9)
    found = mesh.point_data["displacement"][corner].mean(axis=0)
    assert found == pytest.approx(document["probes"]["P4"][-1], rel=1e-9)


@pytest.mark.parametrize(
    "options, said",
    [
        (["--integrator", "verlet", "--step", "0.1"], "stability limit of verlet"),
        (["--integrator", "rk4"], "choose from"),
        (["--duration", "-1"], "duration = -1 s"),
        (["--measured", "nowhere.csv"], "nowhere.csv"),
        (["--animate"], "--animate: needs --out"),
    ],
)
def test_bad_input_leaves_with_2_in_one_line(options, said, capsys):
    assert leaves_with(2, [*RUN, *options])
    error = capsys.readouterr().err
    assert said in error.splitlines()[-1]


@pytest.mark.parametrize(
    "text, said",
    [
        ("t,probe,ux,uy,uz\n", "the header must be"),
        ("time,probe,ux,uy,uz\n0.1,P9,0,0,0\n", "line 2"),
        ("time,probe,ux,uy,uz\n0.1,P1,0,0,zero\n", "not a number"),
        ("time,probe,ux,uy,uz\n0.1,P1,0,0,inf\n", "line 2: uz = 'inf'"),
        ("time,probe,ux,uy,uz\n,P1,0,0,0\n", "line 2: time = ''"),
    ],
)
def test_measured_files_are_checked(tmp_path, text, said):
    path = tmp_path / "measured.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=said):
        histories.read_measured(path, ["P1"])


def test_measured_times_beyond_the_run_are_said(tmp_path, capsys):
    path = tmp_path / "measured.csv"
    path.write_text("time,probe,ux,uy,uz\n0.05,P4,,,-0.02\n0.2,P4,,,-0.01\n0.3,P4,,,-0.01\n")
    assert leaves_with(0, [*RUN, "--every", "0.02", "--measured", str(path)])
    said = " ".join(capsys.readouterr().err.split())
    assert "P4: 2 of 3 measured times left out, for the run is from 0 to 0.1 s" in said
    path.write_text("time,probe,ux,uy,uz\n0.2,P4,,,-0.02\n0.3,P1,,,-0.01\n")
    assert leaves_with(2, [*RUN, "--every", "0.02", "--measured", str(path)])
    said = capsys.readouterr().err
    assert "no time within the run of 0.1 s (--duration), but from 0.2 to 0.3 s" in said
    assert "simulated" not in said


def test_measured_error_is_relative_to_the_largest_measured_component():
    asked = scene()
    history = lumped.simulate(asked, springs(asked, 4), 0.05, every=0.005)
    exact = history.probes["P4"][2:8]
    measured = histories.Measured(history.time[2:8], exact.copy())
    assert histories.error(history, "P4", measured) == pytest.approx(0.0, abs=1e-12)
    measured.displacement[:, 0] = np.nan
    measured.displacement[3, 2] *= 1.1
    expected = abs(0.1 * exact[3, 2]) / np.nanmax(np.abs(measured.displacement))
    assert histories.error(history, "P4", measured) == pytest.approx(expected)


KILLED = """
import os, signal, sys
from pathlib import Path
sys.path.insert(0, {here!r})
import lumped
from dynamic_cases import scene, springs
from limits import at_most
store, after = Path(sys.argv[1]), []
def kill(time):
    after.extend([time] if (store / "checkpoint.npz").exists() else [])
    if len(after) > 3:  # samples after the checkpoint, to be dropped
        os.kill(os.getpid(), signal.SIGKILL)
asked = scene("one-edge-clamped", {actuators}, damping_time=1e-3)
options = dict(integrator={name!r}, every=0.002, frames=20)
lumped.simulate(asked, springs(asked, 4), {duration}, store=store, progress=kill, **options)
"""
DURATION = 0.25  # s, two checkpoints
RUNS = {"generalised-alpha": [], "verlet": [], "midpoint": [{"segments": 2, "curvature": 3.0}]}


@pytest.mark.parametrize("name", RUNS)
def test_a_killed_run_resumes_to_the_last_digit(tmp_path, name):
    actuators, duration = RUNS[name], DURATION
    code = KILLED.format(here=str(HERE), actuators=actuators, duration=duration, name=name)
    killed = subprocess.run([sys.executable, "-c", code, str(tmp_path / "killed")])
    assert killed.returncode == -signal.SIGKILL
    samples = tmp_path / "killed" / "samples.bin"
    asked = scene("one-edge-clamped", actuators, damping_time=1e-3)
    options = {"integrator": name, "every": 0.002, "frames": 20}
    whole = lumped.simulate(asked, springs(asked, 4), duration, store=tmp_path / "whole", **options)
    killed_at = samples.stat().st_size
    resumed = lumped.simulate(asked, springs(asked, 4), duration, store=tmp_path / "killed", **options)
    for file in ("samples.bin", "frames.bin"):
        assert (tmp_path / "killed" / file).read_bytes() == (tmp_path / "whole" / file).read_bytes()
    assert killed_at < samples.stat().st_size
    assert resumed.steps == whole.steps and np.array_equal(resumed.time, whole.time)
    assert 0.0 < resumed.resumed_from < duration and whole.resumed_from == 0.0


STILL = {"integrator": "verlet", "every": 0.002, "frames": 5}
LENGTH = 0.11  # s, one checkpoint


@pytest.fixture(scope="module")
def run_kept(tmp_path_factory):
    folder = tmp_path_factory.mktemp("kept") / "run"
    asked = scene(damping_time=1e-3)
    return folder, lumped.simulate(asked, springs(asked, 3), LENGTH, store=folder, **STILL)


@pytest.fixture
def kept(run_kept, tmp_path):
    """A folder with a finished run, and how to run it again."""
    folder, history = tmp_path / "run", run_kept[1]
    shutil.copytree(run_kept[0], folder)
    asked = scene(damping_time=1e-3)

    def again(duration=LENGTH, **other):
        return lumped.simulate(asked, springs(asked, 3), duration, store=folder, **{**STILL, **other})

    return folder, history, again


def test_a_longer_duration_goes_on_with_the_run(kept, tmp_path):
    """To the last bit what a run of that length gives; frames go on at their distance."""
    folder, _, again = kept
    longer = again(2.0 * LENGTH)
    asked = scene(damping_time=1e-3)
    at_once = lumped.simulate(asked, springs(asked, 3), 2.0 * LENGTH, store=tmp_path / "at once", **STILL)
    assert longer.resumed_from == pytest.approx(50 * 0.002)
    assert (folder / "samples.bin").read_bytes() == (tmp_path / "at once" / "samples.bin").read_bytes()
    assert longer.time[-1] == pytest.approx(2.0 * LENGTH) and longer.steps == at_once.steps
    assert np.allclose(longer.extra["frame_times"], 0.002 * np.array([0, 14, 28, 41, 55, 69, 82, 96, 110]))
    assert len(longer.extra["frames"]) == 9
    with pytest.raises(BadInput, match=r"duration = 0.11 s: the run that is kept there is one of 0.22 s"):
        again()


def test_another_run_in_the_folder_is_refused_by_what_differs(kept):
    folder, _, again = kept
    before = (folder / "run.json").read_bytes()
    with pytest.raises(BadInput, match=r"holds another run \(of another every, step\)"):
        again(step=1e-5, every=0.001)
    assert (folder / "run.json").read_bytes() == before


@pytest.mark.parametrize("name", ["samples.bin", "frames.bin"])
@pytest.mark.parametrize("left", [0, 0.5, None])
def test_files_shorter_than_the_checkpoint_says_are_refused(kept, name, left):
    """They were filled up with zeros, and the run was said to be converged."""
    folder, _, again = kept
    path = folder / name
    if left is None:
        path.unlink()
    else:
        os.truncate(path, int(left * path.stat().st_size) - 3 * (left > 0))
    before = {file.name: file.read_bytes() for file in folder.iterdir()}
    with pytest.raises(BadInput, match=rf"{name}: holds .* that the checkpoint counts; remove the folder"):
        again()
    assert {file.name: file.read_bytes() for file in folder.iterdir()} == before


@pytest.mark.parametrize("name", ["samples.bin", "frames.bin"])
def test_files_of_the_right_length_that_were_changed_are_refused(kept, name):
    """They went unnoticed into the history."""
    folder, _, again = kept
    path = folder / name
    content = bytearray(path.read_bytes())
    content[len(content) // 3] ^= 1
    path.write_bytes(content)
    before = {file.name: file.read_bytes() for file in folder.iterdir()}
    with pytest.raises(BadInput, match=rf"{name}: is not what the run wrote: .*; remove the folder"):
        again()
    assert {file.name: file.read_bytes() for file in folder.iterdir()} == before


@pytest.mark.parametrize(
    "name, content, said",
    [
        ("run.json", b"", "run.json: is damaged"),
        ("run.json", b"{}", "run.json: is damaged"),
        ("run.json", b"[1]", "run.json: is damaged"),
        ("run.json", b"\xff\xfe", "run.json: is damaged"),
        ("run.json", None, "run.json: is missing beside a checkpoint"),
        ("checkpoint.npz", b"not a checkpoint", "checkpoint.npz: is damaged"),
        ("checkpoint.npz", b"", "checkpoint.npz: is damaged"),
        ("checkpoint.npz", 0.5, "checkpoint.npz: is damaged"),
    ],
)
def test_damaged_files_are_refused_in_a_line_with_the_remedy(kept, name, content, said):
    folder, history, again = kept
    path = folder / name
    if content is None:
        path.unlink()
    else:
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2] if content == 0.5 else content)
    with pytest.raises(BadInput, match=rf"{said}.*; remove the folder {folder}"):
        again()
    shutil.rmtree(folder)
    assert np.array_equal(again().probes["P4"], history.probes["P4"])


def test_a_run_has_one_writer(kept):
    """Two at once left rows of both in one file, which no command could read again."""
    folder, history, again = kept
    with (
        only_writer(folder),
        pytest.raises(BadInput, match=f"{folder}: another process writes here; wait until it has ended"),
    ):
        again()
    assert np.array_equal(again().probes["P4"], history.probes["P4"])


def test_a_second_writer_is_refused_before_it_touches_the_folder(tmp_path, capsys):
    """It rewrote the manifest of the first."""
    manifest = tmp_path / "manifest.json"
    assert leaves_with(0, [*RUN, "--every", "0.02", "--out", str(tmp_path)])
    before = manifest.read_bytes()
    with only_writer(tmp_path):
        assert leaves_with(2, [*RUN, "--every", "0.02", "--out", str(tmp_path)])
    assert "another process writes here" in capsys.readouterr().err
    assert manifest.read_bytes() == before


@pytest.mark.parametrize("name", ["run.json", "samples.bin", "frames.bin", "checkpoint.npz", ".lock"])
def test_a_planted_link_is_never_written_through(tmp_path, name):
    victim, folder = tmp_path / "victim", tmp_path / "run"
    victim.write_text("mine")
    folder.mkdir()
    (folder / name).symlink_to(victim)
    asked = scene(damping_time=1e-3)
    with contextlib.suppress(BadInput):
        lumped.simulate(asked, springs(asked, 3), LENGTH, store=folder, **STILL)
    assert victim.read_text() == "mine"


def test_a_full_disk_is_said_and_the_run_goes_on_when_there_is_room(tmp_path, run_kept):
    """A limit on file sizes stands for the disk: frames.bin fits, then samples.bin is full, at any place."""
    folder, history = tmp_path / "run", run_kept[1]
    asked = scene(damping_time=1e-3)

    def start():
        return lumped.simulate(asked, springs(asked, 3), LENGTH, store=folder, **STILL)

    full = (run_kept[0] / "samples.bin").stat().st_size
    for most in (10, full // 2, full - 10):
        with at_most(most), pytest.raises(BadInput, match=r"run\S*: cannot be written, file too large: "):
            start()
    assert np.array_equal(start().probes["P4"], history.probes["P4"])


def test_memory_does_not_grow_with_the_duration(tmp_path):
    asked = scene(damping_time=1e-3)

    def peak(duration):
        tracemalloc.start()
        options = {"integrator": "midpoint", "step": 1e-3, "every": 1e-3}
        lumped.simulate(asked, springs(asked, 4), duration, store=tmp_path / str(duration), **options)
        found = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return found

    peak(0.1)
    assert peak(1.6) < peak(0.2) + 20_000  # bytes; 1400 more samples are 370 kB
    assert (tmp_path / "1.6" / "samples.bin").stat().st_size > 300_000


def test_chains_are_in_the_files_of_a_run(tmp_path):
    """Their axes are lines after the lattice's points; they move with the edge that they hold."""
    arguments = ["simulate", "actuated-edge", "--lumped", "5", "--duration", "0.1", "--every", "0.02"]
    assert leaves_with(0, [*arguments, "--out", str(tmp_path)])
    history = json.loads((tmp_path / "history.json").read_text())
    mesh = meshio.read(sorted((tmp_path / "frames").glob("*.vtu"))[-1])
    axis = mesh.point_data["actuator"] == 1
    assert axis.sum() == 9 and np.sum(mesh.point_data["actuator"] == 0) == 50
    assert mesh.points[axis] == pytest.approx(np.array([[0.188, 0.188 * i / 8, 0.0] for i in range(9)]))
    moved = mesh.point_data["displacement"][axis]
    for probe, points in (("P4", [-1]), ("P3", [4])):
        assert moved[points].mean(axis=0) == pytest.approx(history["probes"][probe][-1], abs=2e-6)
    lines = np.vstack([cells.data for cells in mesh.cells if cells.type == "line"])
    ends = lines[np.isin(lines, np.flatnonzero(axis)).all(axis=1)]
    places = (mesh.points + mesh.point_data["displacement"])[ends]
    assert np.linalg.norm(np.diff(places, axis=1)[:, 0], axis=1) == pytest.approx(8 * [0.188 / 8], rel=1e-6)

"""`sheetbench simulate`: its document and files, measured histories, chains in its files."""

import json
import xml.etree.ElementTree as ElementTree

import meshio
import numpy as np
import pytest
from commands import json_of, run
from dynamic_cases import make_scene, springs

import lumped
from comparisons.comparison import measured as histories
from comparisons.comparison.frames import frames
from sheetbench.answers.history import Measured
from sheetbench.scenes import load
from sheetbench.scenes.language.toml import to_toml

RUN = ["simulate", "two-edges-settling", "--lumped", "4", "--duration", "0.1"]


def test_json_has_the_promised_keys_and_enough_samples(capsys):
    document = json_of(capsys, *RUN)
    assert {"time", "probes", "energy", "status", "steps", "solve_seconds"} <= set(document)
    assert document["status"] == "converged" and document["steps"] > 0
    count = len(document["time"])
    assert np.shape(document["probes"]["P4"]) == (count, 3) and len(document["energy"]) == count
    assert np.shape(document["reactions"]["x0"]) == (count, 3)
    scene = make_scene("two-edges-settling")
    lowest = lumped.modes(scene, springs(scene, 4), 1, "tributary").frequencies[0]
    assert count - 1 >= 100 * 0.1 * lowest
    assert document["time"][-1] == pytest.approx(0.1)


def test_files_of_a_run(tmp_path, capsys):
    measured = tmp_path / "measured.csv"
    measured.write_text("time,probe,ux,uy,uz\n0.01,P4,,,-0.001\n0.05,P4,,,-0.02\n")
    assert run(*RUN, "--every", "0.005", "--out", str(tmp_path), "--measured", str(measured)) == 0
    out = capsys.readouterr().out
    assert "difference" in out
    document = json.loads((tmp_path / "history.json").read_text())
    assert 0.0 < document["measured_errors"]["P4"] < 1.0
    lines = (tmp_path / "history.csv").read_text().splitlines()
    assert len(lines) == 22 and lines[0].startswith("time [s],P1.ux [m]") and "balance [J]" in lines[0]
    ours = histories.read_measured(tmp_path / "displacements.csv", ["P1", "P2", "P3", "P4"])
    assert [len(one.time) for one in ours.values()] == [21] * 4
    assert ours["P4"].displacement.tolist() == document["probes"]["P4"]
    assert (tmp_path / "history.png").stat().st_size > 10_000
    series = ElementTree.parse(tmp_path / "frames.pvd").getroot().findall("Collection/DataSet")
    last = series[-1].attrib
    assert float(last["timestep"]) == pytest.approx(0.1)
    mesh = meshio.read(tmp_path / last["file"])
    corner = np.flatnonzero(np.linalg.norm(mesh.points[:, :2] - 0.188, axis=1) < 1e-9)
    found = mesh.point_data["displacement"][corner].mean(axis=0)
    assert found == pytest.approx(document["probes"]["P4"][-1], rel=1e-9)


@pytest.mark.parametrize("text, said", [
    ("t,probe,ux,uy,uz\n", "the header must be"),
    ("time,probe,ux,uy,uz\n0.1,P9,0,0,0\n", "line 2"),
    ("time,probe,ux,uy,uz\n0.1,P1,0,0,zero\n", "not a number"),
    ("time,probe,ux,uy,uz\n0.1,P1,0,0,inf\n", "line 2: uz = 'inf'"),
    ("time,probe,ux,uy,uz\n,P1,0,0,0\n", "line 2: time = ''"),
    ("time,probe,ux,uy,uz\n0,P1,,,-0.02\n1,P1,,,-0.04", "uz = -0.02 m at time = 0: a run begins with the"),
])  # fmt: skip
def test_measured_files_are_checked(tmp_path, text, said):
    path = tmp_path / "measured.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=said):
        histories.read_measured(path, ["P1"])


def test_a_run_that_cannot_go_on_keeps_what_it_has_and_is_three(tmp_path, capsys):
    """A pressure that no sheet withstands turns cells inside out."""
    torn = tmp_path / "torn.toml"
    torn.write_text(to_toml(load("one-edge-clamped")) + "[[load]]\nkind = 'pressure'\nvalue = 5e5\n")
    out = tmp_path / "out"
    arguments = ("--lumped", "3", "--duration", "0.01", "--every", "0.001", "--no-pictures")
    assert run("simulate", str(torn), *arguments, "--out", str(out)) == 3
    assert "inverted: at 0.003 s the cell at" in capsys.readouterr().err
    assert len((out / "history.csv").read_text().splitlines()) > 2


def test_measured_times_beyond_the_run_are_said(tmp_path, capsys):
    path = tmp_path / "measured.csv"
    path.write_text("time,probe,ux,uy,uz\n0.05,P4,,,-0.02\n0.2,P4,,,-0.01\n0.3,P4,,,-0.01\n")
    assert run(*RUN, "--every", "0.02", "--measured", str(path)) == 0
    said = " ".join(capsys.readouterr().err.split())
    assert "P4: 2 of 3 measured times left out, for the run is from 0 to 0.1 s" in said
    path.write_text("time,probe,ux,uy,uz\n0.2,P4,,,-0.02\n0.3,P1,,,-0.01\n")
    assert run(*RUN, "--every", "0.02", "--measured", str(path)) == 2
    said = capsys.readouterr().err
    assert "no time within the run of 0.1 s (--duration), but from 0.2 to 0.3 s" in said
    assert "simulated" not in said


def test_measured_error_is_relative_to_the_largest_measured_component():
    scene = make_scene()
    history = lumped.simulate(scene, springs(scene, 4), 0.05, every=0.005)
    exact = history.probes["P4"][2:8]
    measured = Measured(history.time[2:8], exact.copy())
    assert measured.error(history.time, history.probes["P4"]) == pytest.approx(0.0, abs=1e-12)
    measured.displacement[:, 0] = np.nan
    measured.displacement[3, 2] *= 1.1
    expected = abs(0.1 * exact[3, 2]) / np.nanmax(np.abs(measured.displacement))
    assert measured.error(history.time, history.probes["P4"]) == pytest.approx(expected)


@pytest.mark.parametrize("grading", [0.0, 0.8])
def test_a_frames_mid_surface_is_that_of_the_runs_lattice(grading):
    scene = load("two-edges-settling")
    graded = lumped.calibrate(scene.sheet, scene.material, (5, 4), grading=grading)
    history = lumped.simulate(scene, graded, 0.01, every=0.005, frames=3)
    for number, (_, frame) in enumerate(frames(history)):
        probed = np.array([history.probes[name][number] for name in scene.probes])
        np.testing.assert_allclose(frame.displacement(scene.probe_points()), probed, atol=1e-15)


def test_a_run_says_which_integrator_it_chose_and_why(capsys):
    assert run(*RUN) == 0
    assert "integrator esdirk: least time at equal error\n" in capsys.readouterr().out


def test_an_explicit_run_names_its_largest_stable_step(capsys):
    assert run(*RUN, "--integrator", "verlet", "--duration", "0.005") == 0
    assert "the largest stable one is" in capsys.readouterr().out
    scene = make_scene("two-edges-settling")
    history = lumped.simulate(scene, springs(scene, 4), 1e-3, integrator="verlet")
    limit = lumped.INTEGRATORS["verlet"].limit(
        lumped.System(scene, lumped.build_problem(scene, springs(scene, 4))), np.zeros((32, 3))
    )
    assert history.settings["largest_step"] == pytest.approx(limit.step)
    assert history.settings["step"] <= limit.step

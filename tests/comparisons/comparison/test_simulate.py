"""`sheetbench simulate`: its document and files, chains in its files."""

import json
import xml.etree.ElementTree as ElementTree

import meshio
import numpy as np
import pytest
from commands import json_of, run
from dynamic_cases import make_scene, springs

import lumped
from comparisons.comparison.frames import frames
from comparisons.identification import measurements
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


def test_files_of_a_run(tmp_path):
    assert run(*RUN, "--every", "0.005", "--out", str(tmp_path)) == 0
    document = json.loads((tmp_path / "history.json").read_text())
    lines = (tmp_path / "history.csv").read_text().splitlines()
    assert len(lines) == 22 and lines[0].startswith("time [s],P1.ux [m]") and "balance [J]" in lines[0]
    ours = measurements.read(tmp_path / "displacements.csv", load("two-edges-settling"))
    assert np.concatenate(list(document["probes"].values())) == pytest.approx(ours.displacement, abs=1e-15)
    assert (tmp_path / "history.png").stat().st_size > 10_000
    series = ElementTree.parse(tmp_path / "frames.pvd").getroot().findall("Collection/DataSet")
    last = series[-1].attrib
    assert float(last["timestep"]) == pytest.approx(0.1)
    mesh = meshio.read(tmp_path / last["file"])
    corner = np.flatnonzero(np.linalg.norm(mesh.points[:, :2] - 0.188, axis=1) < 1e-9)
    found = mesh.point_data["displacement"][corner].mean(axis=0)
    assert found == pytest.approx(document["probes"]["P4"][-1], rel=1e-9)


def test_a_run_that_cannot_go_on_keeps_what_it_has_and_is_three(tmp_path, capsys):
    """A pressure that no sheet withstands turns cells inside out."""
    torn = tmp_path / "torn.toml"
    torn.write_text(to_toml(load("one-edge-clamped")) + "[[load]]\nkind = 'pressure'\nvalue = 5e5\n")
    out = tmp_path / "out"
    arguments = ("--lumped", "3", "--duration", "0.01", "--every", "0.001", "--no-pictures")
    assert run("simulate", str(torn), *arguments, "--out", str(out)) == 3
    assert "inverted: at 0.003 s the cell at" in capsys.readouterr().err
    assert len((out / "history.csv").read_text().splitlines()) > 2


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

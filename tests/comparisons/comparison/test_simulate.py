"""`sheetbench simulate`: its document and files, chains in its files."""

import xml.etree.ElementTree as ElementTree

import meshio
import numpy as np
import pytest
from commands import run
from dynamic_cases import make_scene, springs

import lumped
import sheetbench as sb
from comparisons.comparison.frames import frames
from comparisons.identification import measurements
from sheetbench.scenes import load
from sheetbench.scenes.language.toml import to_toml


def test_it_has_enough_samples():
    document = sb.simulate("two-edges-settling", grid=4, duration=0.1).document()
    count = len(document["time"])
    assert document["status"] == "converged" and document["steps"] > 0 and document["solve_seconds"] > 0.0
    assert np.shape(document["probes"]["P4"]) == (count, 3) and len(document["energy"]) == count
    assert np.shape(document["reactions"]["x0"]) == (count, 3)
    scene = make_scene("two-edges-settling")
    lowest = lumped.modes(scene, springs(scene, 4), 1, "tributary").frequencies[0]
    assert count - 1 >= 100 * 0.1 * lowest
    assert document["time"][-1] == pytest.approx(0.1)


def test_files_of_a_run(kept):
    found = kept("simulate")
    document, folder = found.document, found.folder
    lines = (folder / "history.csv").read_text().splitlines()
    assert len(lines) == 7 and lines[0].startswith("time [s],P1.ux [m]") and "balance [J]" in lines[0]
    ours = measurements.read(folder / "displacements.csv", load("two-edges-settling"))
    assert np.concatenate(list(document["probes"].values())) == pytest.approx(ours.displacement, abs=1e-15)
    series = ElementTree.parse(folder / "frames.pvd").getroot().findall("Collection/DataSet")
    last = series[-1].attrib
    assert float(last["timestep"]) == pytest.approx(0.02)
    mesh = meshio.read(folder / last["file"])
    corner = np.flatnonzero(np.linalg.norm(mesh.points[:, :2] - 0.188, axis=1) < 1e-9)
    moved = mesh.point_data["displacement"][corner].mean(axis=0)
    assert moved == pytest.approx(document["probes"]["P4"][-1], rel=1e-9)
    assert "integrator esdirk: least time at equal error\n" in found.shown(100)


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


def test_an_explicit_run_names_its_largest_stable_step():
    scene = make_scene("two-edges-settling")
    answer = sb.simulate(scene, grid=4, duration=1e-3, integrator="verlet")
    assert "the largest stable one is" in answer.report().to_markdown()
    system = lumped.System(scene, lumped.build_problem(scene, springs(scene, 4)))
    limit = lumped.INTEGRATORS["verlet"].limit(system, np.zeros((32, 3)))
    assert answer.settings["largest_step"] == pytest.approx(limit.step)
    assert answer.settings["step"] <= limit.step

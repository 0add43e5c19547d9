"""Motions: where they start, a plucked beam, what runs say of themselves; `simulate` and its files."""

import xml.etree.ElementTree as ElementTree

import meshio
import numpy as np
import pytest
import scipy.optimize
from commands import run
from dynamic_cases import make_scene, moved, springs

import lumped
import sheetbench as sb
from comparisons.comparison.frames import frames
from comparisons.identification import measurements
from sheetbench.answers.solution import Status
from sheetbench.errors import NoEquilibrium
from sheetbench.face import solve
from sheetbench.runs.run import SampleChecks
from sheetbench.scenes import Scene, load
from sheetbench.scenes.language.toml import to_toml

SHEET = {"length_x": 0.15, "length_y": 0.03, "thickness": 0.003}
MATERIAL = {"young": 6e6, "poisson": 0.0, "density": 1100.0}
CLAMP = {"edge": "x0", "kind": "clamped"}
BETA = 1.8751040687  # cosh β cos β = −1
TIP, MESH = (0.15, 0.015), (8, 2)
PULL = {"kind": "edge", "edge": "x1", "force_per_length": [0.0, 0.0, 0.02], "hold": True}
MODELS = ("lumped", "plate", "shell", "solid")
DAILY = ("lumped", "plate", "shell", pytest.param("solid", marks=pytest.mark.nightly))


def strip(**more):
    scene = {"name": "plucked", "sheet": SHEET, "material": MATERIAL, "supports": [CLAMP], "loads": [PULL]}
    scene |= {"initial": {"shape": "static"}, "probes": {"tip": TIP}}
    return Scene.model_validate(scene | more)


def at_rest(scene, model):
    return solve(scene, model, **({"grid": 5} if model == "lumped" else {"elements": MESH}))


@pytest.mark.parametrize("model", DAILY)
def test_a_rod_bent_out_of_reach_is_no_start(model):
    """At κ = 200 1/m statics end inverted, or beyond the linear theory; motions began with 638 J for 10."""
    sheet = {"length_x": 0.188, "length_y": 0.188, "thickness": 0.003}
    rod = {"edge": "x0", "kind": "curved", "curvature": 200.0}
    scene = Scene.model_validate({"name": "rod", "sheet": sheet, "material": MATERIAL, "supports": [rod]})
    with pytest.raises(NoEquilibrium, match=f"start from no stable equilibrium: {model}: .*:"):
        moved(scene, model, 0.01, 1)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("model", MODELS)
def test_a_motion_starts_from_the_equilibrium_that_statics_find(model):
    """The held load is in the statics; let go, the energy at the start is the elastic one, and is kept."""
    scene = strip()
    history, still = moved(scene, model, 0.01, MESH), at_rest(scene, model)
    assert np.allclose(history.probes["tip"][0], still.displacement([TIP])[0], atol=1e-9)
    assert history.energies["kinetic"][0] == 0.0
    assert history.energies["elastic"][0] == pytest.approx(sum(still.energies.values()), rel=1e-6)
    assert np.abs(history.balance - history.balance[0]).max() < 2e-3 * history.energies["elastic"][0]


@pytest.mark.sweep(2)
@pytest.mark.parametrize("model", ["lumped", "shell"])
def test_a_plucked_strip_swings_and_decays_as_a_beam(model):
    """f₁ = β²/2π √(EI/ρA L⁴), 12/β⁴ of the deflection in the first mode, e^(−αt/2)."""
    alpha = 0.5
    scene = strip(material=MATERIAL | {"damping_rate": alpha})
    omega = BETA**2 * np.sqrt(6e6 * 0.003**2 / 12.0 / 1100.0) / 0.15**2
    period = 2.0 * np.pi / omega
    history = moved(scene, model, 3.25 * period, MESH, every=period / 80.0)
    t, z = history.time, history.probes["tip"][:, 2]
    assert z[0] == pytest.approx(0.02 * 0.15**3 / (3.0 * 6e6 * 0.003**3 / 12.0), rel=0.01)

    def swing(amplitude, rate, decay):
        turn = rate * omega * t
        damped = np.cos(turn) + decay / (rate * omega) * np.sin(turn)
        return amplitude * z[0] * damped * np.exp(-decay * t)

    start = [0.9, 1.0, 0.4 * alpha]
    fitted = scipy.optimize.least_squares(lambda p: (swing(*p) - z) / z[0], start).x
    assert fitted == pytest.approx([12.0 / BETA**4, 1.0, 0.5 * alpha], rel=0.01)


def test_a_held_load_wants_a_start_and_no_history():
    with pytest.raises(ValueError, match=r"load 1.hold = true: has no effect without \[initial\]"):
        strip(initial=None)
    history = {"time": [0.0, 1.0], "factor": [0.0, 1.0]}
    with pytest.raises(ValueError, match="hold = true: it acts in full until t = 0"):
        strip(loads=[PULL | {"history": history}])


def test_a_start_under_loads_takes_histories_and_supports_as_they_are_then():
    """A factor of ½ at t = 0, and a support already 1 mm up."""
    half = PULL | {"hold": False, "history": {"time": [0.0, 1.0], "factor": [0.5, 1.0]}}
    lifted = CLAMP | {"motion": {"time": [0.0, 1.0], "displacement": [[0.0, 0.0, 1e-3], [0.0, 0.0, 2e-3]]}}
    scene = strip(loads=[half], supports=[lifted])
    for model in MODELS:
        full = at_rest(strip(), model).displacement([TIP])[0, 2]
        assert moved(scene, model, 0.001, MESH).probes["tip"][0, 2] == pytest.approx(
            1e-3 + 0.5 * full, rel=2e-3
        )


SOFT = {
    "name": "soft",
    "sheet": {"length_x": 0.2, "length_y": 0.1, "thickness": 0.003},
    "material": {"young": 2e4, "poisson": 0.3, "density": 1000.0},
    "supports": [CLAMP],
    "gravity": {"acceleration": [0.0, 0.0, -9.81]},
}


@pytest.mark.parametrize("model", DAILY)
def test_a_sheet_too_heavy_for_its_law_is_outside_the_model_in_motion_too(model):
    history = moved(Scene.model_validate(SOFT), model, 0.01, 1)
    assert history.status is Status.STRAIN_OUTSIDE_MODEL
    assert "ρ g a/E = 0.0981" in history.message and "from 0 s on" in history.message
    assert history.time[-1] == 0.01


@pytest.mark.sweep(2)
@pytest.mark.parametrize("model", ["lumped", "solid", "shell"])
def test_an_edge_torn_away_is_outside_the_model_from_when_it_is(model):
    """Pulled by three quarters of its length in 0.2 s: by more than half after about two thirds of it."""
    edge = {"edge": "x1", "kind": "clamped"}
    edge["motion"] = {"time": [0.0, 0.2], "displacement": [[0.0, 0.0, 0.0], [0.15, 0.0, 0.0]]}
    supports = [CLAMP, edge]
    material = SOFT["material"] | {"young": 2e6, "damping_time": 0.02}
    scene = Scene.model_validate(SOFT | {"supports": supports, "material": material, "gravity": None})
    history = moved(scene, model, 0.2, 3)
    assert history.status is Status.STRAIN_OUTSIDE_MODEL
    since = float(history.message.split(" s on")[0].removeprefix("from "))
    assert 0.05 < since < 0.18


@pytest.mark.sweep
@pytest.mark.parametrize("model", ["shell", "lumped", "solid"])
def test_what_turns_inside_out_ends_a_run(model):
    """An edge pushed through the other."""
    edge = {"edge": "x1", "kind": "held", "components": ["x", "z"]}
    edge["motion"] = {"time": [0.0, 0.2], "displacement": [[0.0, 0.0, 0.0], [-0.5, 0.0, 0.0]]}
    scene = Scene.model_validate(SOFT | {"supports": [CLAMP, edge], "gravity": None})
    history = moved(scene, model, 0.2, 3)
    assert history.status in (Status.INVERTED, Status.DIVERGED)
    assert "inside out" in history.message or model == "solid"
    assert history.time[-1] < 0.2


def test_a_growth_is_told_from_a_hundredth_and_ends_a_run_from_a_tenth():
    """A kinetic energy of 1 J and an elastic one that grows out of nothing, or is lost."""
    time = np.arange(4.0)
    for change, grown in ((0.002, False), (0.05, False), (0.2, True), (-0.2, False)):
        rows = np.column_stack([time, np.ones(4), change * time / 3.0, np.zeros((4, 3))])
        watch = SampleChecks()
        sound, gained = watch.take(rows)
        assert (sound < 4) == (gained > 0.1) == grown
        status, message = watch.ending("")
        assert status is Status.CONVERGED
        assert ("off by" in message) == (abs(change) > 0.01)
        assert SampleChecks.restore(watch.memory()).ending("") == (status, message)


def test_what_the_rule_takes_is_an_energy_of_its_own():
    """With it the account closes; in JSON, CSV and arrays."""
    shaken = CLAMP | {"motion": {"time": [0.0, 0.05], "displacement": [[0.0, 0.0, 0.0], [0.0, 0.0, 0.03]]}}
    wide = {"length_x": 0.15, "length_y": 0.075, "thickness": 0.004}
    scene = strip(sheet=wide, supports=[shaken], loads=[], initial=None)
    history = lumped.simulate(scene, lumped.calibrate(scene.sheet, scene.material, grid=9), 0.15)
    energies = history.document()["energies"]
    total = sum(energies[name] for name in ("kinetic", "elastic", "potential", "dissipated", "numerical"))
    assert np.allclose(total - energies["work"], history.balance[0], atol=1e-12)
    assert energies["numerical"][-1] > 0.01 * energies["work"].max()
    assert "the energy balance is off by" in history.message and history.status is Status.CONVERGED
    assert history.to_pandas()["numerical [J]"].iloc[-1] == pytest.approx(energies["numerical"][-1])


# ---- the verb
def test_its_document_has_the_promised_keys_sample_by_sample():
    document = sb.simulate("two-edges-settling", grid=4, duration=0.1).document()
    count = len(document["time"])
    assert document["status"] == "converged" and document["steps"] > 0 and document["solve_seconds"] > 0.0
    assert np.shape(document["probes"]["P4"]) == (count, 3) and len(document["energy"]) == count
    assert np.shape(document["reactions"]["x0"]) == (count, 3)
    assert document["time"][-1] == pytest.approx(0.1)


def test_files_of_a_run_agree_with_its_document(kept):
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

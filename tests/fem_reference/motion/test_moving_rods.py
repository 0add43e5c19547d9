"""Chains in motion: rods with their own inertia, dampers and commands, on plate, shell and solid."""

import numpy as np
import pytest

import fem_reference
import lumped
from fem_reference.sheets import SHEETS
from sheetbench.scenes import load
from sheetbench.scenes.objects.actuators import CurvatureTable

RAMP = CurvatureTable(time=(0.0, 0.3), value=(0.0, 3.0))


def driven(**chain):
    """The catalogue's driven edge, off the mid-surface, heavily damped."""
    scene = load("actuated-edge")
    (own,) = scene.actuators
    return scene.replace(actuators=(own.replace(**chain),))


@pytest.mark.parametrize("model", SHEETS)
def test_a_chain_thrown_has_its_own_mass(model):
    scene = driven(face="top")
    energies = []
    for case in (scene, scene.replace(actuators=())):
        moving = SHEETS[model](case, (2, 2), moving=True)
        v = np.zeros(moving.mass.shape[0])
        moving.displacement(v)[:] = 0.0, 0.0, 2.0
        energies.append(0.5 * v @ (moving.mass @ v))
    mass = scene.actuators[0].line_density * scene.sheet.length_y
    assert energies[0] - energies[1] == pytest.approx(0.5 * mass * 4.0, rel=1e-9)


def test_a_chain_that_spins_about_the_edge_has_its_rotary_inertia():
    """½ m (c² + 2 a²/4) ω²: of its axis at the height c, and of both directors of a round section."""
    scene, omega = driven(face="top"), 3.0
    (chain,) = scene.actuators
    energies = []
    for case in (scene, scene.replace(actuators=())):
        moving = SHEETS["shell"](case, (2, 2), moving=True)
        v = np.zeros((moving.mass.shape[0] // 3, 3))
        v[moving.nodes : 2 * moving.nodes, 0], v[2 * moving.nodes :, 2] = omega, -omega
        energies.append(0.5 * v.ravel() @ (moving.mass @ v.ravel()))
    square = chain.axis_height(scene.sheet.thickness) ** 2 + chain.radius**2 / 2.0
    mass = chain.line_density * scene.sheet.length_y
    assert energies[0] - energies[1] == pytest.approx(0.5 * mass * square * omega**2, rel=1e-9)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("model", ["plate", "shell"])
def test_a_driven_edge_comes_to_rest_where_statics_have_it(model):
    scene = driven(curvature=RAMP, damping_time=0.02).replace(damping_rate=25.0)
    motion = fem_reference.simulate(scene, model, 0.8, elements=2, every=0.1)
    options = {"graded": motion.settings["graded"]} if model == "plate" else {}
    rest = fem_reference.solve(scene, model, elements=2, **options)
    truth = rest.displacement(scene.probe_points())
    ends = np.array([u[-1] for u in motion.probes.values()])
    assert np.abs(ends - truth).max() < 2e-3 * np.abs(truth).max()
    for name, wrench in rest.actuators.items():
        force, moment = (np.abs(motion.actuators[name][-1] - wrench)[:, of] for of in (slice(3), slice(3, 6)))
        assert force.max() < 5e-3 * np.abs(wrench[:, :3]).max()
        assert moment.max() < 5e-3 * np.abs(wrench[:, 3:]).max()
    spread = np.ptp(motion.balance) / max(float(np.abs(e).max()) for e in motion.energies.values())
    assert spread < 5e-3 and motion.energies["work"][-1] > 0.0


@pytest.mark.nightly
def test_a_chain_in_motion_pulls_at_shell_and_lattice_alike():
    """The force on the sheet, inertia of the chain in it: within what two elements leave uncertain."""
    scene = driven(curvature=RAMP, damping_time=0.02).replace(damping_rate=25.0)
    fine, coarse = (
        fem_reference.simulate(scene, "shell", 0.1, elements=n, every=0.05).actuators["x1"].sum(axis=1)
        for n in (3, 2)
    )
    springs = lumped.calibrate(scene.sheet, scene.material, grid=9)
    ours = lumped.simulate(scene, springs, 0.1, every=0.05).actuators["x1"].sum(axis=1)
    for component in (0, 2):
        uncertain = np.abs(coarse - fine)[1:, component].max()
        assert uncertain < 0.05 * np.abs(fine[:, :3]).max()
        assert np.abs(ours - fine)[1:, component].max() < uncertain


def test_samples_of_a_chain_keep_the_energy():
    """Steps end at samples. A cubic between would store 0.28 of the kinetic energy in the rod."""
    motion = fem_reference.simulate("actuated-edge", "shell", 0.2, elements=2, every=0.02)
    assert np.abs(motion.balance - motion.balance[0]).max() < 1e-3 * motion.energies["kinetic"].max()

"""Maxwell branches of the lattice in motion: tangent, energy, the shell's motion."""

from dataclasses import replace

import numpy as np
import pytest
from dynamic_cases import run, springs
from ring_down import BRANCHES, damping_ratio, pulled

import fem_reference
import lumped
from comparisons.modes.damping import mode_damping
from lumped.dynamics.implicit.esdirk import Esdirk
from lumped.dynamics.runs.initial import initial_state
from sheetbench import scenes
from sheetbench.scenes import Material, PerDirection


@pytest.mark.parametrize("law", [None, "neo-hookean"])
def test_the_tangent_is_the_forces_derivative(law):
    """In a step at large strain, with stresses left from the steps before."""
    strip = pulled(Material(1e6, 0.4, 1e3, damping_time=1e-3, law=law, relaxation=BRANCHES), 0.01, 0.01)
    lattice = lumped.calibrate(strip.sheet, strip.material, (3, 3), "hyperelastic" if law else "consistent")
    system = lumped.System(strip, lumped.build_problem(strip, lattice))
    start, draw = initial_state(system, lattice, "tributary"), np.random.default_rng(1).standard_normal
    u, step = 2e-3 * draw(start.u.shape), draw(start.u.shape)
    state, _ = system.relaxed(start, replace(start, time=0.01, u=u))
    system = system.for_step(state, 0.005)
    there = u + 1e-3 * draw(u.shape)
    blocks = system.matrix(there, np.zeros_like(u), 0.015, 0.0, 0.0, 1.0)
    found = system.problem.system.apply(blocks, step)
    sides = [
        system.internal(there + sign * 1e-7 * step, 0.0 * step, 0.015, damped=False)[2]
        for sign in (1.0, -1.0)
    ]
    assert found == pytest.approx((sides[0] - sides[1]) / 2e-7, abs=1e-6 * np.abs(found).max())


@pytest.fixture(scope="module")
def shell():
    scene = scenes.load("one-edge-clamped").replace(relaxation=BRANCHES)
    return fem_reference.simulate(scene, "shell", 0.2, elements=4, every=0.01, error=1e-4)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", ["esdirk", "verlet"])
def test_a_relaxing_sheet_moves_as_the_shell(shell, name):
    scene = scenes.load("one-edge-clamped").replace(relaxation=BRANCHES)
    run = lumped.simulate(scene, springs(scene, 9), 0.2, integrator=name, every=0.01)
    difference = max(np.abs(run.probes[p] - shell.probes[p]).max() for p in scene.probes)
    assert difference < 0.01 * max(np.abs(probe).max() for probe in shell.probes.values())
    assert run.energies["dissipated"][-1] == pytest.approx(shell.energies["dissipated"][-1], rel=0.02)


def test_models_without_branches_refuse_them():
    scene = scenes.load("one-edge-clamped").replace(relaxation=BRANCHES)
    unlike = springs(scene, 3).springs.replace(axial=PerDirection(x=1e3, y=1e3, z=1.0))
    without_energy = replace(springs(scene, 3), springs=unlike)
    with pytest.raises(scenes.BadInput, match=r"material\.relaxation: .* no energy, and no Maxwell branches"):
        lumped.simulate(scene, without_energy, 0.01)


@pytest.mark.parametrize("damped", [{"frequency": 6.0}, {"band": (1.0, 60.0)}])
def test_modes_ring_down_at_their_poles(damped):
    """The first three of a lattice, let go alone and small, within 1 % of ζ."""
    scene = scenes.load("one-edge-clamped").replace(gravity=None, loss_factor=0.12, **damped)
    found = lumped.modes(scene, springs(scene), 3, "gregory")
    system = lumped.System(scene, lumped.build_problem(scene, springs(scene)))
    start = initial_state(system, springs(scene), "tributary")
    for shape, ratio in zip(found.shapes, mode_damping(scene.material, found.frequencies), strict=True):
        u = 1e-7 * shape
        memory = None if system.maxwell is None else system.maxwell.at_rest(u)
        state = replace(start, u=u, memory=memory)
        state = replace(state, a=system.accelerate(system.for_step(state).unbalanced(u, state.v, 0.0)))
        step = 1.0 / (40.0 * ratio.frequency_hz)
        states, _ = run(Esdirk(system, step), state, step, 100)
        swing = np.array([np.sum(system.lattice_mass[:, None] * shape * state.u) for state in states])
        assert damping_ratio(swing, 40.0) == pytest.approx(ratio.got, rel=0.01)

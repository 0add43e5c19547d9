"""Maxwell branches of the lattice in motion: relaxation, tangent, energy, the shell's motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from dynamic_cases import run, springs
from ring_down import damping_ratio

import fem_reference
import lumped
from comparisons.modes.damping import mode_damping
from lumped.dynamics.implicit.esdirk import Esdirk
from lumped.dynamics.runs.initial import initial_state
from sheetbench import scenes
from sheetbench.answers.solution import Status
from sheetbench.scenes import Clamped, Held, Material, Motion, PerDirection, Relaxation, Scene, Sheet

BRANCHES = (Relaxation(0.25, 0.02), Relaxation(0.15, 0.3))


def pulled(material, by, within):
    """A strip whose end is pulled and then held."""
    pull = Motion(time=(0.0, within), displacement=((0.0, 0.0, 0.0), (by, 0.0, 0.0)))
    supports = (Clamped("x0"), Held("x1", ("x", "y", "z"), motion=pull))
    return Scene("strip", Sheet(0.1, 0.04, 0.002), material, supports=supports, probes={"P": (0.05, 0.0)})


@pytest.mark.parametrize("name", ["generalised-alpha", "esdirk"])
def test_a_held_strain_relaxes_as_its_prony_series(name):
    """A strip of next to no mass, beside its own force at rest: R = R∞ (1 + Σ a g e^(−(t−T)/τ)), g of the
    ramp. Generalised-α damps what rings by then; midpoint and verlet, held to esdirk below, never do."""
    ramp = 0.01
    strip = pulled(Material(1e6, 0.0, 1e-3, relaxation=BRANCHES), 1e-9, ramp)
    lattice = lumped.calibrate(strip.sheet, strip.material, (4, 3))
    run = lumped.simulate(strip, lattice, 0.2, integrator=name, step=1e-3, every=0.01)
    assert run.status is Status.CONVERGED
    held, material = run.time > 4.5 * ramp, strip.material.branches
    fading = [t / ramp * -np.expm1(-ramp / t) * np.exp(-(run.time - ramp) / t) for t in material.times]
    series = 1.0 + np.array(material.stiffness) @ fading
    at_rest = lumped.solve(strip, lattice).reactions["x1"][0]
    assert run.reactions["x1"][held, 0] == pytest.approx(at_rest * series[held], rel=1e-6)


@pytest.mark.parametrize("law", [None, "neo-hookean"])
def test_the_tangent_is_the_forces_derivative(law):
    """In a step at large strain, with stresses left from the steps before."""
    strip = pulled(Material(1e6, 0.4, 1e3, damping_time=1e-3, law=law, relaxation=BRANCHES), 0.01, 0.01)
    lattice = lumped.calibrate(strip.sheet, strip.material, (3, 3), "hyperelastic" if law else "consistent")
    system = lumped.System(strip, lumped.build_problem(strip, lattice))
    start, draw = initial_state(system, lattice, "tributary"), np.random.default_rng(1).standard_normal
    u, step = 2e-3 * draw(start.u.shape), draw(start.u.shape)
    state, _ = system.relaxed(start, replace(start, time=0.01, u=u))
    system = system.within(state, 0.005)
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


def test_what_takes_no_branches_says_so():
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
        state = replace(state, a=system.accelerate(system.within(state).unbalanced(u, state.v, 0.0)))
        step = 1.0 / (40.0 * ratio.frequency_hz)
        states, _ = run(Esdirk(system, step), state, step, 100)
        swing = np.array([np.sum(system.lattice_mass[:, None] * shape * state.u) for state in states])
        assert damping_ratio(swing, 40.0) == pytest.approx(ratio.got, rel=0.01)

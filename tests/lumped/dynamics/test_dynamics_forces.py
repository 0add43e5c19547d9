"""Dampers: potential → force → tangents by finite differences; discrete gradients: energy and momentum."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lattice_cases import ALL, assembly_of, dense, derivative, state

from lumped.springs.all_families import AllFamilies
from lumped.springs.packed_forces import add_forces
from lumped.springs.packing import pack, scratch

pytestmark = pytest.mark.smoke

GRIDS = [(3, 4, 2), (3, 3, 3)]


def dampers_of(assembly):
    return assembly.all_families.damped(1.0)


def damper_force(assembly, u, v):
    force, packing = np.zeros_like(u), pack(assembly.lattice, assembly.springs, dampers_of(assembly))
    return add_forces(u, v, False, True, packing, scratch(packing), force)[1], force


@pytest.mark.sweep(2)
@pytest.mark.parametrize("grid", GRIDS)
def test_damper_force_and_tangent_are_derivatives(grid):
    assembly = assembly_of(grid, **ALL)
    u, v = state(assembly), state(assembly, seed=3)
    power, force = damper_force(assembly, u, v)
    potential = derivative(lambda w: 0.5 * damper_force(assembly, u, w)[0], v)
    assert np.allclose(potential.ravel(), force.ravel(), atol=1e-7 * np.abs(force).max())
    assert power == pytest.approx(np.sum(force * v), rel=1e-12)
    by_velocity = AllFamilies(dampers_of(assembly), assembly.pattern).tangent(u, share=0.0, scale=0.5)
    numeric = derivative(lambda w: damper_force(assembly, u, w)[1], v)
    assert np.allclose(2.0 * dense(assembly, by_velocity), numeric, atol=1e-7 * np.abs(numeric).max())


@settings(max_examples=20)
@given(seed=st.integers(0, 10**6), size=st.floats(1e-9, 0.1))
def test_average_forces_give_back_the_energy_and_conserve_momentum(seed, size):
    assembly = assembly_of(**ALL)
    start = state(assembly, seed=seed)
    end = start + state(assembly, size=size, seed=seed + 1)
    force = assembly.average_force(start, end)
    stored = assembly.force(end)[0] - assembly.force(start)[0]
    moved = np.sum(force * (end - start))
    assert moved == pytest.approx(stored, abs=1e-12 * max(assembly.force(end)[0], assembly.force(start)[0]))
    scale = np.abs(force).max()
    assert np.abs(force.sum(axis=0)).max() < 1e-12 * scale * len(force)
    middle = assembly.lattice.positions + 0.5 * (start + end)
    assert np.abs(np.cross(middle, force).sum(axis=0)).max() < 1e-12 * scale * len(force)


@pytest.mark.parametrize("grid", GRIDS)
def test_average_force_of_equal_states_is_the_force(grid):
    assembly = assembly_of(grid, **ALL)
    u = state(assembly)
    assert np.allclose(assembly.average_force(u, u), assembly.force(u)[1], atol=1e-11)


@settings(max_examples=20)
@given(seed=st.integers(0, 10**6), turn=st.tuples(*[st.floats(-3.0, 3.0)] * 3))
def test_dampers_only_take_energy_and_spare_rigid_motions(seed, turn):
    assembly = assembly_of(**ALL)
    u, v = state(assembly, seed=seed), state(assembly, seed=seed + 1)
    power, force = damper_force(assembly, u, v)
    assert power >= 0.0
    x = assembly.lattice.positions + u
    assert np.abs(np.cross(x, force).sum(axis=0)).max() < 1e-12 * np.abs(force).max() * len(force)
    rigid = np.cross(turn, x) + np.array([1.0, -2.0, 0.5])
    assert np.abs(damper_force(assembly, u, rigid)[1]).max() < 1e-11 * 100.0

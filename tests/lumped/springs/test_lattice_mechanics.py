"""Energy → force → tangent of every spring family, by differences; invariants."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lattice_cases import ALL, MATERIAL, SHEET, TERMS, assembly_of, dense, derivative, state
from scipy.spatial.transform import Rotation

from lumped.lattice import STEPS
from lumped.loads import Loads
from lumped.springs.all_families import extrapolated
from sheetbench.scenes import Clamped, EdgeLoad, PerDirection, Pressure, Scene

pytestmark = pytest.mark.smoke


@pytest.mark.parametrize("grid", [(3, 4, 2), (3, 3, 3)])
@pytest.mark.parametrize("term", TERMS)
def test_force_and_tangent_are_derivatives_of_the_energy(term, grid):
    assembly = assembly_of(grid, **{term: 100.0})
    u = state(assembly)
    force = assembly.force(u)[1]
    tangent = dense(assembly, assembly.tangent(u))
    assert np.abs(force).max() > 0.01
    assert np.allclose(derivative(lambda v: assembly.force(v)[0], u).ravel(), force.ravel(), atol=1e-7)
    numeric = derivative(lambda v: assembly.force(v)[1], u)
    assert np.allclose(numeric, tangent, atol=2e-7 * np.abs(tangent).max())
    assert np.abs(tangent - tangent.T).max() <= 1e-13 * np.abs(tangent).max()


def test_extrapolated_stresses_are_the_linearisation():
    assembly = assembly_of(**ALL)
    u, direction = state(assembly), state(assembly, seed=2)

    springs = assembly.all_families.springs

    def flat(at, step):
        return np.concatenate([stress.ravel() for stress in extrapolated(at, step, springs)])

    h, rest = 1e-6, np.zeros_like(u)
    slope = (flat(u + h * direction, rest) - flat(u - h * direction, rest)) / (2 * h)
    change = flat(u, direction) - flat(u, rest)
    assert np.allclose(change, slope, atol=1e-6 * np.abs(slope).max())
    at_once = assembly.tangent(u, extrapolated(u, rest, springs), extrapolated=True)
    assert np.allclose(at_once, assembly.tangent(u), rtol=0.0, atol=1e-12 * np.abs(at_once).max())


def test_energies_by_name_add_up_to_the_energy():
    assembly = assembly_of(**ALL)
    u = state(assembly)
    energies = assembly.survey(u).energies
    assert energies.keys() >= {"axial", "cross", "diagonal", "cells"}
    assert sum(energies.values()) == pytest.approx(assembly.force(u)[0], rel=1e-12)


def test_per_direction_springs_follow_the_seeds_law_and_their_tangent_is_unsymmetric():
    k = PerDirection(x=100.0, y=50.0, z=200.0)
    assembly = assembly_of(axial=k, cross=k)
    assert not assembly.conservative
    u = state(assembly)
    force = np.zeros_like(u)
    links = assembly.lattice.links
    own = np.array([name in ("axial", "cross") for name, *_ in STEPS])[links.step]
    a, b = links.nodes[own].T
    gap = links.offset[own] + u[b] - u[a]
    pull = gap * (1 - links.rest_length[own] / np.linalg.norm(gap, axis=1))[:, None]
    pull = links.shares[:, own].sum(axis=0)[:, None] * np.array([100.0, 50.0, 200.0]) * pull
    np.add.at(force, a, -pull)
    np.add.at(force, b, pull)
    assert np.allclose(assembly.force(u)[1], force, atol=1e-12)
    tangent = dense(assembly, assembly.tangent(u))
    numeric = derivative(lambda v: assembly.force(v)[1], u)
    assert np.allclose(numeric, tangent, atol=2e-7 * np.abs(tangent).max())
    assert np.abs(tangent - tangent.T).max() > 0.05 * np.abs(tangent).max()


def test_equal_per_direction_stiffness_is_the_central_spring():
    central = assembly_of(axial=100.0)
    triple = assembly_of(axial=PerDirection(x=100.0, y=100.0, z=100.0))
    u = state(central)
    assert triple.conservative
    assert np.array_equal(central.force(u)[1], triple.force(u)[1])


def test_absent_families_are_not_assembled():
    assembly = assembly_of(diagonal=100.0)
    assert len(assembly.links) == 2 * 2 * 3 * 2 and not any(map(len, assembly.springs[1:]))


@settings(max_examples=25)
@given(
    seed=st.integers(0, 10**6),
    turn=st.tuples(*[st.floats(-3.0, 3.0)] * 3),
    shift=st.tuples(*[st.floats(-1.0, 1.0)] * 3),
    size=st.sampled_from([0.0, 0.02]),
)
def test_energy_and_force_move_with_the_sheet(seed, turn, shift, size):
    """And a rigid motion costs nothing."""
    assembly = assembly_of(**ALL)
    u = state(assembly, size, seed)
    x = assembly.lattice.positions.copy()  # a rotation takes no array that is not to be written to
    rotation = Rotation.from_rotvec(turn)
    energy, force = assembly.force(u)
    moved_energy, moved_force = assembly.force(rotation.apply(x + u) + np.array(shift) - x)
    assert moved_energy == pytest.approx(energy, rel=1e-10, abs=1e-13)
    assert np.allclose(moved_force, rotation.apply(force), atol=1e-9 * (np.abs(force).max() or 1.0))
    assert np.abs(force.sum(axis=0)).max() <= 1e-11 * np.abs(force).sum()


def test_pressure_pushes_up_and_moment_turns_the_far_edge_up():
    assembly = assembly_of(**ALL)
    rest = np.zeros((assembly.lattice.mass_count, 3))

    def force_of(load):
        scene = Scene(name="s", sheet=SHEET, material=MATERIAL, supports=(Clamped(edge="x0"),), loads=(load,))
        return Loads(scene, assembly).force(rest)

    assert force_of(Pressure(value=30.0)).sum(axis=0) == pytest.approx(
        [0.0, 0.0, 30.0 * 0.2 * 0.3], abs=1e-14
    )
    for edge, axis in (("x1", -1), ("x0", 1)):  # rotation vector about y
        force = force_of(EdgeLoad(edge=edge, moment_per_length=2.0))
        moment = np.cross(assembly.lattice.positions, force).sum(axis=0)
        assert force.sum(axis=0) == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)
        assert moment == pytest.approx([0.0, axis * 2.0 * 0.3, 0.0], abs=1e-12)
    for edge, axis in (("y1", 1), ("y0", -1)):
        moment = np.cross(assembly.lattice.positions, force_of(EdgeLoad(edge=edge, moment_per_length=2.0)))
        assert moment.sum(axis=0) == pytest.approx([axis * 2.0 * 0.2, 0.0, 0.0], abs=1e-12)

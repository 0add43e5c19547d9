"""The chain alone: Lagrangian → force → tangent by finite differences, its mass, the elastica."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from lumped.actuators import Drive
from lumped.actuators.chain import Chain
from lumped.lattice import build
from scenes import Chain as ChainData
from scenes import Sheet

SHEET = Sheet(length_x=0.2, length_y=0.3, thickness=0.01)
LATTICE = build(SHEET, (4, 7, 2), 0.008)
ROD = dict(edge="x1", segments=4, bending_stiffness=0.02, line_density=0.05, radius=2e-3)
PLANES, BASES = ("normal", "inplane", "spatial"), ("free", "start", "middle", "end")


def chain_of(*changes, lattice=LATTICE, sheet=SHEET, **common):
    data = [ChainData(**{**ROD, **common, **change}) for change in (changes or ({},))]
    masses = lattice.edge_columns(data[0].edge).ravel()
    return Chain(data, tuple(map(str, range(len(data)))), sheet, lattice, masses, scale=1e3)


def disturbed(chain, size=5e-3, seed=0):
    return np.where(chain.free, size * np.random.default_rng(seed).standard_normal((chain.rows, 3)), 0.0)


def derivative(function, y, h=1e-6):
    columns = []
    for i in range(y.size):
        step = np.zeros(y.size)
        step[i] = h
        step = step.reshape(y.shape)
        columns.append((np.ravel(function(y + step)) - np.ravel(function(y - step))) / (2 * h))
    return np.stack(columns, axis=-1)


@pytest.mark.parametrize("segments", [3, 4])
@pytest.mark.parametrize("base", BASES)
@pytest.mark.parametrize("plane", PLANES)
def test_chain_force_and_tangents_are_derivatives(plane, base, segments):
    chain = chain_of(plane=plane, base=base, segments=segments, curvature=3.0, damping_time=0.1)
    y, v, drive = disturbed(chain), disturbed(chain, seed=1), Drive(0.7)
    frames, length = chain.frames, chain.frames.length

    def lagrangian(z):
        residual = chain.force(z, drive)[1][frames.coordinates :]
        return chain.force(z, drive)[0] + np.sum(z[frames.coordinates :] * residual)

    force, tangent = chain.force(y, drive)[1], chain.tangent(y, drive).reshape(y.size, y.size)
    scale = 1e3 * length
    assert_allclose(derivative(lagrangian, y).ravel(), force.ravel(), atol=1e-7 * scale)
    numeric = derivative(lambda z: chain.force(z, drive)[1], y)
    assert_allclose(numeric, tangent, atol=1e-7 * np.abs(tangent).max())
    assert_allclose(tangent, tangent.T, atol=1e-13 * np.abs(tangent).max())
    outside = ~np.repeat(np.repeat(chain.pairs, 3, axis=0), 3, axis=1)
    assert not tangent[outside].any() and not chain.mass[~chain.pairs].any()
    power, damping = chain.damping_force(y, v)
    assert power == pytest.approx(np.sum(damping * v)) and power > 0.0
    by_velocity = chain.damping_tangent(y).reshape(y.size, y.size)
    assert not by_velocity[outside].any()
    assert_allclose(by_velocity @ v.ravel(), damping.ravel(), atol=1e-10 * np.abs(damping).max())
    command = (chain.force(y, Drive(0.7 + 1e-6))[1] - chain.force(y, Drive(0.7 - 1e-6))[1]) / 2e-6
    assert_allclose(chain.command_force(y, drive), command, atol=1e-7 * np.abs(command).max())


@pytest.mark.parametrize("plane", PLANES)
def test_average_force_gives_back_the_joints_energy(plane):
    chain = chain_of(plane=plane, curvature=3.0)
    start, end, drive = disturbed(chain), disturbed(chain, seed=1), Drive()
    start[chain.frames.coordinates :] = end[chain.frames.coordinates :] = 0.0
    force = chain.average_force(start, end, drive)
    stored = chain.force(end, drive)[0] - chain.force(start, drive)[0]
    moved = np.sum((force * (end - start))[: chain.frames.coordinates])
    assert moved == pytest.approx(stored, rel=1e-11)


def test_the_chain_has_the_mass_and_inertia_of_its_rods():
    chain = chain_of(segments=5)
    total = 0.05 * 0.3
    rigid = np.zeros((chain.rows, 3))
    rigid[: chain.frames.points, 2] = 1.0
    assert np.sum(rigid * (chain.mass @ rigid)) == pytest.approx(total)
    assert chain.weight(np.array([0.0, 0.0, -9.81])).sum(axis=0) == pytest.approx([0.0, 0.0, -9.81 * total])
    x = chain.frames.rest
    for axis, inertia in (
        ([1.0, 0.0, 0.0], total * (0.3**2 / 12 + 2e-3**2 / 4)),  # across the rod
        ([0.0, 1.0, 0.0], total * 2e-3**2 / 2),  # about its axis
    ):
        turned = np.zeros((chain.rows, 3))
        middle = x[: chain.frames.points].mean(axis=0)
        turned[: chain.frames.points] = np.cross(axis, x[: chain.frames.points] - middle)
        turned[chain.frames.points : chain.frames.coordinates] = np.cross(axis, x[chain.frames.points :])
        assert np.sum(turned * (chain.mass @ turned)) == pytest.approx(inertia)

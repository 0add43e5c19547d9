"""A chain on an edge whose end is a corner that another support holds: closed form, the shell, forces."""

from functools import partial

import numpy as np
import pytest
from cases import CLAMP, GRAVITY, RUBBER, SHEET, WEIGHT, equilibrium, sheet
from numpy.testing import assert_allclose
from rod_cases import chain as rod

from sheetbench.scenes import Clamped, Curved, Scene

OWN = 0.05 * 0.188 * 9.81  # N, of a chain
chain = partial(rod, edge="y0", segments=8, bending_stiffness=0.02)
POINTS = np.random.default_rng(0).uniform(0.0, 0.188, (60, 2))


RIGIDITY = 0.02 + 1e6 * 0.01 * 0.002**3 / 12.0  # N·m², of the chain and of the strip, which has 3e-4 of it


def cantilever(segments, corner):
    """A chain along a narrow strip that is clamped at its short edge, deflecting by 5e-5 of its length."""
    one = chain(edge="y0", segments=segments, radius=1e-3)
    return sheet(0.2, 0.01, 0.002, 1e6, 0.0, held=corner, weight=0.01, actuators=(one,))


@pytest.mark.parametrize(("corner", "tip"), [("x0", (0.2, 0.0)), ("x1", (0.0, 0.0))])
def test_a_chain_that_starts_at_a_clamp_is_a_cantilever(corner, tip):
    """q L⁴/8(EI + EI_strip); the error is that of the trapezoidal rule, 1/parts²: as many as cells, as few as
    segments, 24 on finer grids."""
    exact = -(1000.0 * 0.01 * 0.002 + 0.05) * 0.01 * 0.2**4 / 8.0 / RIGIDITY
    shell = equilibrium(cantilever(8, corner), "shell", 0, (16, 1))
    assert shell.displacement([tip])[0, 2] == pytest.approx(exact, rel=1e-4)
    errors = {}
    for segments, cells, parts in ((2, 6, 6), (3, 12, 12), (2, 64, 24), (32, 64, 32)):
        found = equilibrium(cantilever(segments, corner), "lumped", (cells + 1, 3), 0)
        errors[parts] = found.displacement([tip])[0, 2] / exact - 1.0
        assert 0.0 < errors[parts] < 1.0 / parts**2
    assert np.log2(errors[6] / errors[24]) / 2.0 == pytest.approx(2.0, abs=0.15)


CASES = {
    "weight": ((CLAMP,), (chain(),)),
    "bent": ((CLAMP,), (chain(curvature=4.0),)),
    "far end": ((Clamped(edge="x1"),), (chain(curvature=4.0),)),
    "on a face": ((CLAMP,), (chain(curvature=4.0, face="top"),)),
    "in space": ((CLAMP,), (chain(curvature=4.0, plane="spatial"),)),
    "in the plane": ((CLAMP,), (chain(curvature=0.05, plane="inplane", bending_stiffness=20.0),)),
    "by joint": ((CLAMP,), (chain(curvature=tuple(np.linspace(-5.0, 8.0, 7))),)),
    "two": ((CLAMP,), (chain(curvature=4.0), chain(edge="y1"))),
    "tilted": ((Clamped(edge="x0", tilt=0.2),), (chain(),)),
    "curved": ((Curved(edge="x0", curvature=2.0),), (chain(),)),
}


CARRIED = ("bent", "on a face", "far end", "in space", "two")


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", CASES)
def test_the_coarse_lattice_agrees_with_the_shell_and_the_clamp_carries_all(name):
    """Within 1.0 to 6.3 %; a share counts to the clamp, and to the first segment as the shell counts it."""
    supports, actuators = CASES[name]
    scene = Scene("corner", SHEET, RUBBER, GRAVITY, supports, actuators=actuators)
    lattice, shell = (equilibrium(scene, model, (17, 9), 8) for model in ("lumped", "shell"))
    truth = shell.displacement(POINTS)
    assert np.abs(lattice.displacement(POINTS) - truth).max() < 0.07 * np.abs(truth).max()
    for support in supports:
        force, expected = lattice.reactions[support.edge], shell.reactions[support.edge]
        assert_allclose(force[2], expected[2], atol=0.1 * WEIGHT)
        if name in CARRIED:
            assert_allclose(force, [0.0, 0.0, WEIGHT + len(actuators) * OWN], atol=1e-6 * WEIGHT)
    for edge, wrenches in lattice.actuators.items() if name in CARRIED else ():
        assert_allclose(wrenches[:, :3].sum(axis=0), [0.0, 0.0, -OWN], atol=1e-6 * WEIGHT)
        if edge == "y0" and name == "bent":
            size = np.abs(shell.actuators[edge][0, :3]).max()
            assert_allclose(wrenches[0, :3], shell.actuators[edge][0, :3], atol=0.07 * size)

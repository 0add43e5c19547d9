"""Elastic rods on the solid: as on the shell, with columns that follow their directors."""

import numpy as np
import pytest
from cases import SHEET
from rod_cases import CHAINS, chain, driven, shell

import fem_reference
from fem_reference.solid.statics import discretise
from fem_reference.solid.structure import State
from fem_reference.solid.supports import into_forces, vectors
from fem_reference.surface.mesh import rectangle
from sheetbench.scenes import Curved, Hinged, Status


def solid(scene, elements=8, layers=1):
    return fem_reference.solve(scene, model="solid", elements=elements, layers=layers)


@pytest.mark.parametrize("name", CHAINS)
def test_the_solid_agrees_with_the_shell(name):
    """Displacements within 0.2 %, the rod's energy within 1 %; forces balance."""
    scene = driven(chain(**CHAINS[name]))
    points = scene.probe_points()
    answer, expected = solid(scene), shell(scene)
    assert answer.status is Status.CONVERGED
    truth = expected.displacement(points)
    assert np.abs(answer.displacement(points) - truth).max() < 2e-3 * np.abs(truth).max()
    assert answer.energies["rod"] == pytest.approx(expected.energies["rod"], rel=1e-2)
    sheet, own = 1678.0 * 0.003 * 0.188**2 * 9.81, 0.05 * 0.188 * 9.81
    np.testing.assert_allclose(answer.reactions["x0"], [0.0, 0.0, sheet + own], atol=1e-8)
    np.testing.assert_allclose(answer.actuators["x1"].sum(axis=0)[:3], [0.0, 0.0, -own], atol=1e-8)
    moment, agreed = (each.actuators["x1"][:, 3:] for each in (answer, expected))
    np.testing.assert_allclose(moment[8:16], agreed[8:16], atol=0.02 * np.abs(agreed).max())


@pytest.mark.parametrize("edges", [("y1",), ("x1", "y1"), ("y0", "y1")])
def test_rods_that_meet_each_other_and_a_clamp(edges):
    """They end at corners whose column the clamp holds or the other rod turns too."""
    scene = driven(*(chain(edge=edge, curvature=-4.0, bending_stiffness=0.02) for edge in edges))
    points = np.random.default_rng(0).uniform(0.0, 0.188, (50, 2))
    answer, expected = solid(scene), shell(scene)
    assert answer.status is expected.status is Status.CONVERGED
    truth = expected.displacement(points)
    assert np.abs(answer.displacement(points) - truth).max() < 2e-3 * np.abs(truth).max()


@pytest.mark.parametrize("base", ["start", "middle", "end"])
def test_a_base_holds_the_solid(base):
    scene = driven().model_copy(update={"supports": (), "actuators": (chain(edge="y0", base=base),)})
    answer, expected = solid(scene), shell(scene)
    assert answer.status is Status.CONVERGED
    points = scene.probe_points()
    truth = expected.displacement(points)
    assert np.abs(answer.displacement(points) - truth).max() < 1e-3 * np.abs(truth).max()
    sheet, own = 1678.0 * 0.003 * 0.188**2 * 9.81, 0.05 * 0.188 * 9.81
    np.testing.assert_allclose(answer.reactions["y0 base"], [0.0, 0.0, sheet + own], atol=1e-7)
    np.testing.assert_allclose(answer.actuators["y0"].sum(axis=0)[:3], [0.0, 0.0, sheet], atol=1e-7)


@pytest.mark.parametrize("layers", [1, 2])
def test_the_tangent_of_the_rodded_solid_is_the_derivative_of_the_force(layers):
    """Rods on two edges that share a corner, beside a hinged and a curved edge."""
    supports = (Curved(edge="x0", kind="curved", curvature=0.8), Hinged(edge="y1"))
    scene = driven(chain(face="top", curvature=3.0, plane="spatial"), chain(edge="y0", base="start"))
    scene = scene.model_copy(update={"supports": supports})
    structure = discretise(rectangle(SHEET, 2), scene, layers)
    rng = np.random.default_rng(1)
    bases = structure.supports.bases(0.7)
    u = structure.supports.target(0.7) + 2e-4 * rng.normal(size=structure.free.shape)
    own = structure.rods.own
    free = np.repeat(~structure.rods.held[:, None], 3, axis=1)
    aside = np.where(free, 0.1 * rng.normal(size=own.shape), 0.0)
    step, count = rng.normal(size=structure.unknowns), int(structure.free.sum())
    local, turn = np.zeros(structure.free.shape), np.zeros(own.shape)
    local[structure.free], turn[free] = step[:count], step[count:]
    direction = vectors(bases, local)

    def rows(t):
        forces = structure.forces(State(u + t * direction, aside + t * turn), 0.7)
        on_columns = into_forces(bases, forces.residual)[structure.free]
        return np.concatenate([on_columns, forces.aside[free]])

    state = State(u, aside)
    matrix, _ = structure.system(state, structure.forces(state, 0.7), 0.7, mixed=False)
    assert abs(matrix - matrix.T).max() < 1e-9 * abs(matrix).max()
    difference = (rows(1e-6) - rows(-1e-6)) / 2e-6
    np.testing.assert_allclose(matrix @ step, difference, atol=1e-6 * np.abs(difference).max())

"""Chains are divided as finely as the grid: few segments and many give one answer, the elastic rod's."""

import numpy as np
import pytest
from cases import elastica_tip, sheet

import lumped
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Lattice
from sheetbench.scenes import load

LENGTH, WIDTH, THICK, YOUNG, CURVATURE, RIGIDITY = 0.2, 0.016, 2e-3, 2e7, 9.0, 3e-3
PER_LENGTH = 1200.0 * WIDTH * THICK + 2 * 0.03  # [kg/m]


@pytest.mark.sweep
@pytest.mark.parametrize("segments", [6, 24])
@pytest.mark.parametrize(
    "grid", [(25, 3), (37, 3), (49, 3), *(pytest.param(n, marks=pytest.mark.nightly) for n in (9, 17))]
)
def test_a_strip_between_two_chains_is_the_composite_elastica(grid, segments):
    """Cells as long as parts, shorter by halves, and by no whole number: 0.04, 0.04 and 0.05 % off."""
    chain = {"segments": segments, "bending_stiffness": RIGIDITY, "line_density": 0.03, "radius": 0.0015,
             "curvature": CURVATURE, "base": "start"}  # fmt: skip
    chains = [{**chain, "edge": edge} for edge in ("y0", "y1")]
    strip = sheet(LENGTH, WIDTH, THICK, YOUNG, 0.0, 1200.0, weight=9.81, actuators=chains)
    solution = solve(resolve(strip, Lattice(grid=grid)))
    assert solution.balance.holds
    tip = solution.displacement([[LENGTH, 0.0]])[0]
    whole = 2.0 * RIGIDITY + YOUNG * WIDTH * THICK**3 / 12.0  # of both chains and the strip, ν = 0
    bent = 2.0 * RIGIDITY * CURVATURE / whole
    x, z = elastica_tip(whole, LENGTH, weight=PER_LENGTH * 9.81, curvature=bent)
    assert np.abs(tip - [x - LENGTH, 0.0, z]).max() < 1e-3 * z


@pytest.mark.sweep
@pytest.mark.parametrize("base", ["free", "start", "middle", "end"])
@pytest.mark.parametrize("segments", [1, 2, 3, 6])
def test_parts_keep_curvatures_and_forces_of_the_segments(base, segments):
    """A curvature a joint, held against the same pieces written out for a chain of as many segments as parts;
    forces and moments of segments, against those of the parts about the segment's middle."""
    scene = load("actuated-edge").replace(gravity=None)
    chain = scene.actuators[0].replace(base=base, segments=segments)
    chain = chain.replace(curvature=tuple(1.0 + np.arange(chain.joints)))
    whole = lattice_answer(scene, chain)
    parts = 4 if (base, segments) == ("middle", 3) else -(-8 // segments)  # a joint is in the middle
    finer = chain.replace(segments=parts * segments, curvature=0.0)
    ends = joint_lengths(finer)
    bounds, values = parts * chain.pieces(), chain.curvatures().at()
    samples = np.linspace(ends[:-1], ends[1:], 1001)[:-1] + 0.5 * np.diff(ends) / 1000
    each = values[np.clip(np.searchsorted(bounds, samples) - 1, 0, len(values) - 1)].mean(axis=0)
    divided = lattice_answer(scene, finer.replace(curvature=tuple(each)))
    points = scene.probe_points()
    np.testing.assert_allclose(whole.displacement(points), divided.displacement(points), atol=1e-8)
    (found,), (small,) = whole.actuators.values(), divided.actuators.values()
    assert found.shape == (segments, 6)
    np.testing.assert_allclose(found[:, :3], small[:, :3].reshape(segments, parts, 3).sum(axis=1), atol=1e-6)


def lattice_answer(scene, chain):
    springs = lumped.calibrate(scene.sheet, scene.material, 9)
    return lumped.solve(scene.replace(actuators=(chain,)), springs)


def joint_lengths(chain):
    """Bounds of the lengths that lie nearest to each joint, in segments: those between two middles, but for
    halves beside a base."""
    inner = np.arange(chain.segments) + 0.5
    whole = float(chain.segments)
    held = {"start": [0.0], "end": [whole], "middle": [0.5 * whole], "free": []}
    return np.unique([*inner, *held[chain.base]])

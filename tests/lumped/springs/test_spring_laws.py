"""Laws of springs: energy → stress → stiffness by differences, for cells of any rest shape."""

import numpy as np
import pytest
from lattice_cases import derivative

from lumped.springs import cells
from lumped.springs.cells import CellArrays
from lumped.springs.law_table import AREA_AND_STRAINS, LAWS, AreaAndStrains, mean_stress
from lumped.springs.laws import area_and_strains, of_stiffness

SIDES = {
    "square": np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
    "long": np.array([[0.4, 0.0, 0.0], [0.0, 1.3, 0.0]]),
    "oblique": np.array([[1.0, 0.1, 0.0], [0.5, 0.9, 0.0]]),
}
STIFFNESS = np.array([[-30.0, 200.0, 150.0, 80.0]])
F = np.array([[1.3, 0.2, 0.0], [-0.1, 0.9, 0.0], [0.3, 0.1, 1.0]])  # a large homogeneous deformation


def gram(sides):
    a, b = sides
    return np.array([a @ a, b @ b, a @ b])


def law(sides, now):
    """Energy, t and A², and S of a cell with these sides at rest and now."""
    area = float(np.linalg.norm(np.cross(*sides)))
    q = tuple(of_stiffness(STIFFNESS, sides[None], np.array([area]))[0].tolist())
    g = gram(sides)
    return area_and_strains((*(gram(now) - g), 0.0), tuple(g), area, q), area, q  # the last: no warp


@pytest.mark.parametrize("name", SIDES)
def test_the_energy_is_that_of_the_change_of_area_and_of_green_strains(name):
    sides = SIDES[name]
    now = sides @ F.T
    (energy, *_), area, _ = law(sides, now)
    (aa, bb, ab), (gaa, gbb, gab) = gram(now), gram(sides)
    strains = np.array(
        [
            np.linalg.norm(np.cross(*now)) / area - 1.0,
            0.5 * (aa / gaa - 1.0),
            0.5 * (bb / gbb - 1.0),
            (ab - gab) / np.sqrt(gaa * gbb),
        ]
    )
    assert energy == pytest.approx(0.5 * area * STIFFNESS[0] @ strains**2, rel=1e-13)


ROWS = [(law, n) for law in LAWS for n in range(len(law.examples))]


@pytest.mark.parametrize(("law", "n"), ROWS, ids=[f"{law.respond.__name__}-{n}" for law, n in ROWS])
def test_every_law_of_cells_is_the_derivative_of_its_energy_and_does_its_work(law, n):
    """At a large strain; and M at rest is what dampers in proportion take."""
    rest, h, k, n = (1.0, 1.0, 0.0), 1e-5, tuple(map(float, law.examples[n])), law.measures
    start, end = np.array([-0.1, 0.4, 0.2, 0.1])[:n], np.array([0.7, -0.2, 0.3, 0.4])[:n]

    def measured(change):
        return tuple(np.append(change, np.zeros(4 - n)))

    def at(change):
        found = law.respond(measured(change), rest, 1.0, k)
        return found[0], np.array(found[-1])[:n]

    def full(change, share):
        memory = law.respond(measured(change), rest, 1.0, k)[1]
        six, more = law.stiffness(measured(change), rest, 1.0, memory, share, k)
        square = np.array([[six[0], six[3], six[4]], [six[3], six[1], six[5]], [six[4], six[5], six[2]]])
        return np.block([[square, np.array(more[:3])[:, None]], [np.array(more)[None]]])[:n, :n]

    stress, scale = at(end)[1], np.abs(full(end, 1.0)).max()
    for i, unit in enumerate(np.eye(n)):
        up, down = at(end + h * unit), at(end - h * unit)
        # a central difference: h² of derivatives of order one
        assert (up[0] - down[0]) / (2 * h) == pytest.approx(stress[i], rel=1e-7, abs=1e-7 * scale)
        assert np.allclose((up[1] - down[1]) / (2 * h), full(end, 1.0)[i], atol=1e-7 * scale)
    mean = np.array(mean_stress(law.tag(None), measured(start), measured(end), rest, 1.0, k))[:n]
    assert mean @ (end - start) == pytest.approx(at(end)[0] - at(start)[0], rel=1e-12)
    assert at(np.zeros(n))[0] == 0.0 and not np.any(at(np.zeros(n))[1])
    tiny = 1e-9 * end  # no digits are lost where strains are small
    assert np.allclose(at(tiny)[1], full(np.zeros(n), 1.0) @ tiny, rtol=1e-8)
    springs = np.zeros((n, n))
    springs[:3, :3] = np.diag([k[1], k[2], k[3]])
    springs[:2, :2] += 0.25 * k[0]
    if law is AREA_AND_STRAINS:
        springs[[0, 0, 1], [1, 2, 2]] += k[4:]
        springs[[1, 2, 2], [0, 0, 1]] += k[4:]
    assert np.allclose(full(np.zeros(n), 0.0), springs, rtol=1e-14)


def _corners(sides):
    """Of a parallelogram about the origin, whose diagonals are a + b and b - a."""
    a, b = sides
    return 0.5 * np.array([-a - b, a - b, a + b, b - a])


@pytest.mark.parametrize("natural", [False, True])
@pytest.mark.parametrize("name", SIDES)
def test_forces_of_cells_of_any_rest_shape_are_the_energys_gradient(name, natural):
    """Whatever the angle between a cell's sides at rest, and where that is not free of stress."""
    sides = SIDES[name]
    area = np.array([np.linalg.norm(np.cross(*sides))])
    q, rest = of_stiffness(STIFFNESS, sides[None], area), np.array([area, *np.zeros((3, 1))])
    if natural:
        grown = sides @ np.array([[1.1, 0.05, 0.0], [0.05, 0.9, 0.0], [0.0, 0.0, 1.0]])
        first, second = sides[[0, 1, 0]], sides[[0, 1, 1]]
        change = (grown[[0, 1, 0]] * grown[[0, 1, 1]] - first * second).sum(axis=1)
        rest = np.array([[np.linalg.norm(np.cross(*grown))], *change[:, None]])
    nodes = np.arange(4).reshape(1, 4, 1)
    rng = np.random.default_rng(1)
    u = 0.1 * rng.standard_normal((4, 3))
    force = np.zeros_like(u)
    slots = np.arange(16, dtype=np.int32).reshape(1, 4, 4)
    cell = CellArrays(nodes, sides[None], rest, AreaAndStrains(q), slots)
    cells.add_forces(u, cell, force)

    def energy(v):
        return cells.add_forces(v, cell, np.zeros_like(v))

    def pulls(v):
        out = np.zeros_like(v)
        cells.add_forces(v, cell, out)
        return out

    if natural:  # grown as it is naturally, it has no energy
        assert energy(_corners(grown) - _corners(sides)) < 1e-28 < energy(0.0 * u)
    assert np.allclose(
        derivative(energy, u).ravel(), force.ravel(), rtol=1e-6, atol=1e-7 * np.abs(force).max()
    )
    blocks = np.zeros((16, 3, 3))
    cells.add_tangent(u, cell, np.empty((0, 4)), False, 1.0, blocks)  # on and below the diagonal
    below = blocks.reshape(4, 4, 3, 3).transpose(0, 2, 1, 3).reshape(12, 12)
    tangent = np.tril(below) + np.tril(below, -1).T
    numeric = derivative(pulls, u)
    assert np.allclose(tangent, numeric, atol=1e-6 * np.abs(numeric).max())


@pytest.mark.parametrize(("law", "n"), ROWS, ids=[f"{law.respond.__name__}-{n}" for law, n in ROWS])
def test_every_law_of_cells_has_the_derivative_of_its_power_by_its_constants(law, n):
    rest, k = np.array([1.1, 0.9, 0.1]), np.array(law.examples[n])
    if law is not AREA_AND_STRAINS:
        rest[2] = 0.0
    change, rate = (0.3, -0.2, 0.3, 0.4), (0.7, 0.3, -0.5, 0.2)

    def power(k, natural=(0.0, 0.0, 0.0)):
        g, d = rest + natural, (*(change[:3] - np.array(natural)), change[3])
        stress = law.respond(d, tuple(g), float(np.sqrt(g[0] * g[1] - g[2] ** 2)), tuple(k))[-1]
        return np.dot(stress[: law.measures], rate[: law.measures])

    area = float(np.sqrt(rest[0] * rest[1] - rest[2] ** 2))
    memory = law.respond(change, tuple(rest), area, tuple(k))[1]
    found = np.zeros(law.count + 3)
    law.by_constants(change, tuple(rest), area, memory, tuple(k), rate, found)
    strain_springs = 0 if law is AREA_AND_STRAINS else 4  # of these laws M alone has them
    for i in range(strain_springs, law.count):
        if k[i] == 0.0 and law.count == 13 and i in (6, 7, 9):
            continue  # of another material
        h = 1e-6 * max(abs(k[i]), 1.0) * np.eye(law.count)[i]
        assert found[i] == pytest.approx((power(k + h) - power(k - h)) / (2 * h[i]), rel=2e-8, abs=1e-8)
    if law is AREA_AND_STRAINS:
        for found_by, h in zip(found[-3:], 1e-6 * np.eye(3), strict=True):
            assert found_by == pytest.approx((power(k, h) - power(k, -h)) / 2e-6, rel=1e-8, abs=1e-6)
    assert not found[:strain_springs].any()

"""The solid's element: laws, bricks, zero modes, patch tests, the tangent of the bent structure."""

from functools import partial
from itertools import product

import numpy as np
import pytest
from cases import distorted, sheet
from rubbers import material
from skfem import ElementHex2

from fem_reference.solid.discrete import DiscreteSolid
from fem_reference.solid.element import Bricks, reference, shape, tangent
from fem_reference.solid.materials import LAWS, lame
from fem_reference.surface.biquadratic import IN_SPACE
from fem_reference.surface.mesh import rectangle

pytestmark = pytest.mark.smoke


def block(thickness=0.4, poisson=0.3):
    return sheet(1.0, 1.0, thickness, 1e6, poisson, held="")


@pytest.fixture
def rng():
    return np.random.default_rng(5)


def warped(rng):
    """A thin brick with straight edges but no parallel faces, (1, 27, 3)."""
    x, y, z = ElementHex2.doflocs.T
    corner = np.array([2.0 * x, y, 0.2 * z])
    twist = np.array([0.2 * x * y + 0.1 * y * z, 0.15 * x * y * z, 0.03 * x * y])
    return (corner + twist).T[None]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("part", ["distortion", "volume"])
def test_laws_are_triads(law, part, rng):
    function, strain, step = getattr(LAWS[law], part), 0.1 * rng.normal(size=(4, 6)), 1e-6
    if part == "distortion":
        function = partial(function, material(law))
    _, first, second = function(strain)
    for i, direction in enumerate(np.eye(6)):
        up, down = function(strain + step * direction), function(strain - step * direction)
        np.testing.assert_allclose((up.value - down.value) / (2 * step), first[:, i], atol=1e-7)
        np.testing.assert_allclose((up.first - down.first) / (2 * step), second[:, :, i], atol=1e-6)


def test_laws_agree_at_small_strain():
    """No value, no stress and the stiffness of linear elasticity at rest in all."""
    rest = np.zeros((1, 6))
    for name, law in LAWS.items():
        of = material(name, 0.4)
        distortion, volume = law.distortion(of, rest), law.volume(rest)
        for part in (distortion.value, distortion.first, volume.value):
            np.testing.assert_allclose(part, 0.0, atol=1e-15)
        moduli = distortion.second + law.bulk(of) * volume.first[..., None] * volume.first[:, None]
        first, second = lame(of)
        expected = second * np.diag([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
        expected[:3, :3] += first
        np.testing.assert_allclose(moduli[0], expected, rtol=1e-12, atol=1e-12 * first)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("poisson", [0.3, 0.4999])
def test_brick_energy_residual_tangent(law, poisson, rng):
    bricks = Bricks.build(warped(rng), LAWS[law], material(law, poisson, 1.0))
    u = 0.02 * rng.normal(size=(1, 27, 3)) * [1.0, 1.0, 0.2]
    direction, step = rng.normal(size=u.shape) * [1.0, 1.0, 0.2], 1e-7

    def energy(u):
        return sum(bricks.energies(bricks.strain(u)).values())

    def residual(u):
        return bricks.forces(bricks.operator(u), bricks.stress(bricks.strain(u)))

    slope = (energy(u + step * direction) - energy(u - step * direction)) / (2 * step)
    assert slope == pytest.approx(np.sum(residual(u) * direction), rel=1e-5)
    strain = bricks.strain(u)
    full = tangent(bricks.gradient(u), bricks.moduli(strain), bricks.stress(strain))
    exact = np.einsum("eicjd,ejd->eic", full, direction)
    difference = (residual(u + step * direction) - residual(u - step * direction)) / (2 * step)
    np.testing.assert_allclose(difference, exact, atol=1e-5 * np.abs(exact).max())


# Of the six covariant strains, along which of ξ, η, ζ only linear functions are kept.
LINEAR = {"ξξ": (0,), "ηη": (1,), "ζζ": (), "ξη": (0, 1), "ηζ": (1,), "ξζ": (0,)}


@pytest.mark.parametrize("component", LINEAR)
def test_assumed_strains_keep_what_does_not_lock(component):
    """Along a direction of two Gauss points s² is taken for 1/3, its value there; powers up to the second are
    kept otherwise. The shear in the plane is known at three: what is dropped of it is the rest."""
    ref, number = reference(), list(LINEAR).index(component)
    points = 2.0 * ref.points - 1.0
    for powers in product(range(3), repeat=3):
        whole = np.prod([x**power for x, power in zip(points, powers, strict=True)], axis=0)
        linear = [power == 2 and axis in LINEAR[component] for axis, power in enumerate(powers)]
        parts = zip(points, powers, linear, strict=True)
        taken = np.prod([np.full_like(x, 1.0 / 3.0) if cut else x**power for x, power, cut in parts], axis=0)
        samples = np.concatenate([np.prod(at**powers, axis=1) for at in sites()])
        np.testing.assert_allclose(ref.assumed[:, number] @ samples, taken, atol=1e-13)
        rest = whole - taken if component == "ξη" else 0.0
        np.testing.assert_allclose(ref.omitted[:, number] @ samples, rest, atol=1e-13)


def test_samples_are_green_s_strains_at_the_sites(rng):
    """½ (x,a · x,b − X,a · X,b), the shears twice, at two or three Gauss points a direction."""
    bricks = Bricks.build(warped(rng), LAWS["st-venant-kirchhoff"], material("st-venant-kirchhoff"))
    change = rng.uniform(-0.1, 0.1, bricks.positions.shape)
    expected = []
    for at, (a, b) in zip(sites(), IN_SPACE, strict=True):
        _, slope = shape((at.T + 1.0) / 2.0)
        flat = bricks.positions
        then, now = (np.einsum("ic,idt->tdc", x[0], slope) for x in (flat, flat + change))
        green = [0.5 * np.einsum("tc,tc->t", x[:, a], x[:, b]) for x in (now, then)]
        expected.append((1.0 if a == b else 2.0) * (green[0] - green[1]))
    np.testing.assert_allclose(bricks.strain(change)[0], np.concatenate(expected), atol=1e-14)


def sites():
    """Where each covariant strain is sampled, (k, 3) in [−1, 1]³: at two points along what locks, else three;
    but the shear in the plane at three, and it is projected."""
    two, three = np.array([-1.0, 1.0]) / np.sqrt(3.0), np.array([-1.0, 0.0, 1.0]) * np.sqrt(0.6)
    along = [[two, three], [three, two], [three, three], [three, three], [three, two], [two, three]]
    return [np.array(list(product(*plan, three))) for plan in along]


@pytest.mark.parametrize("stretched", [1.0, 20.0])
def test_constant_strain_is_exact_in_a_warped_brick(stretched, rng):
    """A homogeneous finite deformation gives its Green–Lagrange strain at every Gauss point."""
    bricks = Bricks.build(warped(rng) * [stretched, 1.0, 1.0], LAWS["neo-hookean"], material("neo-hookean"))
    f = np.eye(3) + 0.2 * rng.normal(size=(3, 3))
    strain = 0.5 * (f.T @ f - np.eye(3))
    samples = bricks.strain(bricks.positions @ (f - np.eye(3)).T)
    voigt = [strain[0, 0], strain[1, 1], strain[2, 2], 2 * strain[0, 1], 2 * strain[1, 2], 2 * strain[0, 2]]
    np.testing.assert_allclose(bricks.to_strain[0] @ samples[0] - voigt, 0.0, atol=1e-12 * stretched)
    ratio = bricks.volume_ratio(bricks.positions @ (f - np.eye(3)).T)
    np.testing.assert_allclose(ratio, np.linalg.det(f))


@pytest.mark.parametrize(("thickness", "layers"), [(1.0, 1), (0.01, 1), (0.2, 2)])
@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.4999])
@pytest.mark.parametrize("mesh", ["one", "distorted"])
def test_six_zero_modes(thickness, layers, poisson, mesh):
    plan = distorted(block().sheet) if mesh == "distorted" else rectangle(block().sheet, 1)
    sheet = DiscreteSolid(plan, block(thickness, poisson), layers)
    rest = np.zeros(sheet.size)
    stiffness = sheet.tangent(sheet.shape(rest, 0.0), rest, 0.0, 0.0)
    values = np.linalg.eigvalsh(stiffness.toarray()) / (1.0e6 * thickness)
    assert np.sum(np.abs(values) < 1e-8) == 6
    assert values[6] > 2e-3 * thickness**2

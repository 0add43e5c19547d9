"""The solid: laws, bricks, zero modes, patch tests, agreement with the shell and closed forms, no locking."""

from __future__ import annotations

import numpy as np
import pytest
from skfem import ElementHex2, MeshQuad

from fem_reference.shell import statics as shell
from fem_reference.solid import statics as solid
from fem_reference.solid.element import Bricks, geometric, reference, shape
from fem_reference.solid.materials import LAWS, lame
from fem_reference.solid.structure import State
from fem_reference.solid.supports import into_forces, vectors
from fem_reference.solving.linear import solve_free
from fem_reference.surface.mesh import rectangle
from sheetbench import scenes
from sheetbench.scenes import Material, Scene, Sheet, Status

TABLE = {  # probe → component → millimetres: this project's own, converged; P4 of the first is CalculiX's too
    "two-edges-clamped": {"P1": {2: -2.456}, "P2": {2: -6.102}, "P4": {0: -0.405, 1: -0.405, 2: -13.504}},
    "one-edge-clamped": {
        "P1": {2: -17.10},
        "P2": {2: -16.51},
        "P3": {0: -7.19, 2: -48.04},
        "P4": {2: -47.64},
    },
}


def relative(u: np.ndarray, reference: np.ndarray) -> float:
    """The design's error: largest difference over the largest component."""
    return float(np.abs(u - reference).max() / np.abs(reference).max())


def with_poisson(name: str, poisson: float) -> Scene:
    scene = scenes.load(name)
    return scene.model_copy(update={"material": scene.material.model_copy(update={"poisson": poisson})})


def block(thickness: float = 0.4, poisson: float = 0.3, supports=(), loads=()) -> Scene:
    return Scene(
        name="block",
        sheet=Sheet(length_x=1.0, length_y=1.0, thickness=thickness),
        material=Material(young=1.0e6, poisson=poisson, density=1000.0),
        supports=supports,
        loads=loads,
    )


def distorted() -> MeshQuad:
    mesh = MeshQuad.init_tensor(*2 * [np.linspace(0.0, 1.0, 4)])
    mesh = mesh.with_boundaries(rectangle(block().sheet, 3).boundaries)
    moved, inner = mesh.p.copy(), mesh.interior_nodes()
    moved[:, inner] += np.random.default_rng(3).uniform(-0.08, 0.08, (2, len(inner)))
    return MeshQuad(moved, mesh.t).with_boundaries(mesh.boundaries)


@pytest.fixture
def rng():
    return np.random.default_rng(5)


def warped(rng) -> np.ndarray:
    """A thin brick with straight edges but no parallel faces, (1, 27, 3)."""
    x, y, z = ElementHex2.doflocs.T
    corner = np.array([2.0 * x, y, 0.2 * z])
    twist = np.array([0.2 * x * y + 0.1 * y * z, 0.15 * x * y * z, 0.03 * x * y])
    return (corner + twist).T[None]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("part", ["distortion", "volume"])
def test_laws_are_triads(law, part, rng):
    """Stress is the slope of energy, tangent the slope of stress."""
    function, strain, step = getattr(LAWS[law], part), 0.1 * rng.normal(size=(4, 6)), 1e-6
    _, first, second = function(strain)
    for i, direction in enumerate(np.eye(6)):
        up, down = function(strain + step * direction), function(strain - step * direction)
        np.testing.assert_allclose((up.value - down.value) / (2 * step), first[:, i], atol=1e-7)
        np.testing.assert_allclose((up.first - down.first) / (2 * step), second[:, :, i], atol=1e-6)


def test_laws_agree_at_small_strain():
    """Value, stress and stiffness at rest are those of linear elasticity in both."""
    rest = np.zeros((1, 6))
    green, neo = LAWS["st-venant-kirchhoff"], LAWS["neo-hookean"]
    for part in ("distortion", "volume"):
        one, other = getattr(green, part)(rest), getattr(neo, part)(rest)
        np.testing.assert_allclose(one.value, other.value)
        np.testing.assert_allclose(one.first, other.first)
    np.testing.assert_allclose(green.distortion(rest).second, neo.distortion(rest).second)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("poisson", [0.3, 0.4999])
def test_brick_energy_residual_tangent(law, poisson, rng):
    bricks = Bricks.build(warped(rng), LAWS[law], lame(Material(young=1.0, poisson=poisson, density=1.0)))
    u = 0.02 * rng.normal(size=(1, 27, 3)) * [1.0, 1.0, 0.2]
    direction, step = rng.normal(size=u.shape) * [1.0, 1.0, 0.2], 1e-7

    def energy(u):
        return sum(bricks.energies(bricks.strain(u)))

    def residual(u):
        return np.einsum("ekic,ek->eic", bricks.gradient(u), bricks.stress(bricks.strain(u)))

    slope = (energy(u + step * direction) - energy(u - step * direction)) / (2 * step)
    assert slope == pytest.approx(np.sum(residual(u) * direction), rel=1e-5)
    gradient = bricks.gradient(u)
    strain = np.einsum("ekic,eic->ek", gradient, direction)
    pull = np.einsum("ekl,el->ek", bricks.stiffness(bricks.strain(u)), strain)
    exact = np.einsum("ekic,ek->eic", gradient, pull) + geometric(bricks.stress(bricks.strain(u))) @ direction
    difference = (residual(u + step * direction) - residual(u - step * direction)) / (2 * step)
    np.testing.assert_allclose(difference, exact, atol=1e-5 * np.abs(exact).max())


@pytest.mark.parametrize("stretched", [1.0, 20.0])
def test_constant_strain_is_exact_in_a_warped_brick(stretched, rng):
    """A homogeneous finite deformation gives its Green–Lagrange strain at every Gauss point."""
    bricks = Bricks.build(warped(rng) * [stretched, 1.0, 1.0], LAWS["neo-hookean"], (1.0, 1.0))
    f = np.eye(3) + 0.2 * rng.normal(size=(3, 3))
    strain = 0.5 * (f.T @ f - np.eye(3))
    samples = bricks.strain(bricks.positions @ (f - np.eye(3)).T)
    voigt = [strain[0, 0], strain[1, 1], strain[2, 2], 2 * strain[0, 1], 2 * strain[1, 2], 2 * strain[0, 2]]
    np.testing.assert_allclose(bricks.to_strain[0] @ samples[0] - voigt, 0.0, atol=1e-12 * stretched)
    ratio = bricks.volume_ratio(bricks.positions @ (f - np.eye(3)).T)
    np.testing.assert_allclose(ratio, np.linalg.det(f))


@pytest.mark.parametrize("law", LAWS)
def test_rigid_motion_costs_nothing(law, rng):
    structure = solid.discretise(distorted(), block(0.05, poisson=0.49), law=law)
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    rotation *= np.sign(np.linalg.det(rotation))
    x = structure.columns.positions
    state = State(x @ rotation.T - x + [0.3, -0.2, 0.1])
    assert max(abs(e) for e in structure.energies(state).values()) < 1e-10  # J, of a sheet with E V = 5e4 J
    assert np.abs(structure.forces(state, 1.0).residual).max() < 1e-7  # N, with E h a = 5e4 N


@pytest.mark.parametrize(("thickness", "layers"), [(1.0, 1), (0.01, 1), (0.2, 2)])
@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.4999])
@pytest.mark.parametrize("mesh", ["one", "distorted"])
def test_six_zero_modes(thickness, layers, poisson, mesh):
    """The free solid has six rigid motions and no spurious mode."""
    plan = distorted() if mesh == "distorted" else rectangle(block().sheet, 1)
    structure = solid.discretise(plan, block(thickness, poisson), layers)
    rest = structure.rest()
    stiffness, _ = structure.system(rest, structure.forces(rest, 0.0), 0.0)
    values = np.linalg.eigvalsh(stiffness.toarray()) / (1.0e6 * thickness)
    assert np.sum(np.abs(values) < 1e-8) == 6
    assert values[6] > 2e-3 * thickness**2


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.4999])
@pytest.mark.parametrize("layers", [1, 2])
def test_patch_of_plane_stress(poisson, layers):
    """Uniaxial stress prescribed on the rim of a distorted mesh is found inside, faces free."""
    structure = solid.discretise(distorted(), block(0.1, poisson), layers)
    exact = structure.columns.positions * [1e-3, -1e-3 * poisson, -1e-3 * poisson]
    exact[..., 0] += 4e-4 * structure.columns.positions[..., 1]  # and a rotation with shear
    exact[..., 1] += 4e-4 * structure.columns.positions[..., 0]
    rest = structure.rest()
    stiffness, _ = structure.system(rest, structure.forces(rest, 0.0), 0.0)
    free = np.ones(exact.shape, dtype=bool)
    free[structure.columns.plan.get_dofs().flatten()] = False
    free = np.flatnonzero(free)
    u = solve_free(stiffness, np.zeros(exact.size), exact.ravel(), free)
    np.testing.assert_allclose(u, exact.ravel(), atol=1e-9 * np.abs(exact).max())


@pytest.mark.parametrize("layers", [1, 2])
@pytest.mark.parametrize("law", LAWS)
def test_tangent_of_the_loaded_and_bent_structure(layers, law, rng):
    """Residual and tangent with pressure, edge moment, weight and a bent rod, against finite differences."""
    scene = Scene(
        name="all",
        sheet=Sheet(length_x=1.0, length_y=0.8, thickness=0.1),
        material=Material(young=1e4, poisson=0.4, density=10.0),
        gravity={"acceleration": [0.0, 1.0, -9.81]},
        supports=[
            {"edge": "x0", "kind": "curved", "curvature": 0.8},
            {"edge": "x1", "kind": "held", "components": ["x"]},
        ],
        loads=[
            {"kind": "pressure", "value": 40.0},
            {"kind": "edge", "edge": "y1", "force_per_length": (1.0, 2.0, 3.0), "moment_per_length": 2.0},
            {"kind": "point", "at": (0.4, 0.3), "force": (1.0, -1.0, 0.5)},
        ],
    )
    structure = solid.discretise(rectangle(scene.sheet, (2, 2), graded=True), scene, layers, law)
    bases = structure.supports.bases(0.7)
    u = structure.supports.target(0.7) + 2e-3 * rng.normal(size=structure.free.shape)
    step, local = 1e-6, np.zeros(structure.free.shape)
    local[structure.free] = rng.normal(size=structure.unknowns)
    direction = vectors(bases, local)

    def rows(u):
        forces = structure.forces(State(u), 0.7)
        return into_forces(bases, forces.residual)[structure.free]

    difference = (rows(u + step * direction) - rows(u - step * direction)) / (2 * step)
    forces = structure.forces(State(u), 0.7)
    matrix, _ = structure.system(State(u), forces, 0.7, mixed=False)
    exact = matrix @ local[structure.free]
    np.testing.assert_allclose(difference, exact, atol=2e-6 * np.abs(exact).max())


@pytest.mark.parametrize("name", TABLE)
def test_seed_scenes(name):
    """Within 0.3 % of the published figures and of the shell, probe by probe; reactions balance to 1e-8."""
    scene = scenes.load(name)
    points = scene.probe_points()
    answer = solid.solve(scene, 16)
    assert answer.status is Status.CONVERGED and answer.iterations < 12
    u = answer.displacement(points)
    for row, probe in enumerate(scene.probes):
        for component, millimetres in TABLE[name].get(probe, {}).items():
            assert u[row, component] * 1e3 == pytest.approx(millimetres, rel=3e-3)
    assert relative(u, shell.solve(scene, 16).displacement(points)) < 3e-3
    weight = 0.188**2 * 0.003 * 1678.0 * 9.81
    np.testing.assert_allclose(sum(answer.reactions.values()), [0.0, 0.0, weight], atol=1e-8 * weight)


@pytest.mark.parametrize("name", ["curved-edge", "curved-edge-down"])
def test_curved_edge(name):
    """The face follows the rod's director, free in thickness; the rest agrees with the shell."""
    scene = scenes.load(name)
    points = scene.probe_points()
    answer = solid.solve(scene, 12)
    assert answer.status is Status.CONVERGED
    assert relative(answer.displacement(points), shell.solve(scene, 16).displacement(points)) < 3e-3
    kappa = scene.supports[0].curvature
    x, u = answer.mesh.points, answer.mesh.point_data["displacement"]
    face = np.abs(x[:, 0]) < 1e-12
    angle = kappa * (x[face, 1] - 0.094)
    rod = np.column_stack([0 * angle, 0.094 + np.sin(angle) / kappa, (1 - np.cos(angle)) / kappa])
    director = np.column_stack([0 * angle, -np.sin(angle), np.cos(angle)])
    off = x[face] + u[face] - rod
    along = np.einsum("nc,nc->n", off, director)
    np.testing.assert_allclose(off - along[:, None] * director, 0.0, atol=1e-12)
    np.testing.assert_allclose(along, x[face, 2], atol=2e-4 * 0.003 + 2e-2 * np.abs(x[face, 2]).max())
    mid = np.abs(x[face, 2]) < 1e-12
    np.testing.assert_allclose(along[mid], 0.0, atol=1e-12)
    weight = 0.188**2 * 0.003 * 1678.0 * 9.81
    np.testing.assert_allclose(answer.reactions["x0"], [0.0, 0.0, weight], atol=1e-7 * weight)


@pytest.mark.parametrize("poisson", [0.3, 0.48, 0.499, 0.4999])
def test_no_volumetric_locking(poisson):
    """At every ν the 8×8 mesh is within 1 % of the converged answer, and the graded full clamp too."""
    scene = with_poisson("two-edges-clamped", poisson)
    points = scene.probe_points()
    coarse, fine = (solid.solve(scene, n).displacement(points) for n in (8, 16))
    assert relative(coarse, fine) < 2e-3


@pytest.mark.slow
@pytest.mark.parametrize("clamp", ["shell-like", "full"])
@pytest.mark.parametrize("poisson", [0.3, 0.48, 0.499, 0.4999])
def test_no_volumetric_locking_against_a_fine_mesh(poisson, clamp):
    scene = with_poisson("two-edges-clamped", poisson)
    points = scene.probe_points()
    coarse, fine = (solid.solve(scene, n, clamp=clamp).displacement(points) for n in (8, 24))
    assert relative(coarse, fine) < 1e-2


@pytest.mark.slow
def test_one_layer_is_enough():
    """A second layer of bricks moves the seed's probes by less than 0.1 %."""
    scene = scenes.load("two-edges-clamped")
    points = scene.probe_points()
    one, two = (solid.solve(scene, 16, layers=layers).displacement(points) for layers in (1, 2))
    assert relative(one, two) < 1e-3


def test_neo_hookean_is_close_at_small_strain_and_converges_as_fast():
    scene = with_poisson("one-edge-clamped", 0.4999)
    points = scene.probe_points()
    one, other = (solid.solve(scene, 4, law=law) for law in LAWS)
    assert other.status is Status.CONVERGED and other.iterations < 15
    assert relative(one.displacement(points), other.displacement(points)) < 2e-3


def cantilever(**load) -> Scene:
    """Sze, Liu & Lo (2004): 3.1 is 10 × 1 × 0.1 (here), 3.2 is 12 long."""
    length = load.pop("length")
    return Scene(
        name="cantilever",
        sheet=Sheet(length_x=length, length_y=1.0, thickness=0.1),
        material=Material(young=1.2e6, poisson=0.0, density=1.0),
        supports=[{"edge": "x0", "kind": "clamped"}],
        loads=[{"kind": "edge", "edge": "x1", **load}],
    )


@pytest.mark.parametrize(("share", "shortening", "rise"), [(0.25, 0.563, 3.015), (1.0, 3.286, 6.698)])
def test_cantilever_end_shear(share, shortening, rise):
    """Published to three decimals, within 0.5 %."""
    scene = cantilever(length=10.0, force_per_length=(0.0, 0.0, 4.0 * share))
    u = solid.solve(scene, (16, 1), grading="uniform").displacement([[10.0, 0.5]])[0]
    np.testing.assert_allclose([-u[0], u[2]], [shortening, rise], rtol=5e-3)


def test_convergence_of_the_bent_cantilever():
    """End shear, 6.7 of 10 up: the tip is within 1e-3 on 8 elements, 1e-4 on 16, and gains faster than h³."""
    scene = cantilever(length=10.0, force_per_length=(0.0, 0.0, 4.0))
    tips = [
        solid.solve(scene, (n, 1), grading="uniform").displacement([[10.0, 0.5]])[0, 2]
        for n in (4, 8, 16, 64)
    ]
    errors = np.abs(np.array(tips[:-1]) / tips[-1] - 1.0)
    assert np.all(errors < [1e-2, 1e-3, 1e-4]), errors
    assert np.all(np.log2(errors[:-1] / errors[1:]) > 3.0), errors


@pytest.mark.parametrize("poisson", [0.3, 0.4999])
def test_order_of_convergence(poisson):
    """Manufactured, linear, isochoric: u = curl(sin πx sin πy cos z e_z), f = μ (2π² + 1) u; L² like h³."""

    def exact(x):
        s, c = np.sin(np.pi * x), np.cos(np.pi * x)
        u = [s[..., 0] * c[..., 1], -c[..., 0] * s[..., 1], 0.0 * s[..., 2]]
        return np.pi * np.stack(u, axis=-1) * np.cos(x[..., 2:])

    errors = []
    for layers in (1, 2, 4):
        scene = block(0.5, poisson)
        structure = solid.discretise(rectangle(scene.sheet, 2 * layers), scene, layers)
        values, _ = shape(reference().points)
        at = np.einsum("aq,eac->eqc", values, structure.bricks.positions)
        body = lame(scene.material)[1] * (2 * np.pi**2 + 1) * exact(at)
        force = np.einsum("eq,aq,eqc->eac", structure.bricks.volumes, values, body)
        places = np.concatenate([structure.columns.stacks[:, place] for place in structure.columns.places])
        load = np.zeros(structure.unknowns)
        np.add.at(load, 3 * places[:, :, None] + np.arange(3), force)
        rest = structure.rest()
        stiffness, _ = structure.system(rest, structure.forces(rest, 0.0), 0.0)
        free = np.ones(structure.free.shape, dtype=bool)
        free[structure.columns.plan.get_dofs().flatten()] = False
        free[:, [0, -1]] = False
        free = np.flatnonzero(free)
        u = solve_free(stiffness, load, exact(structure.columns.positions).ravel(), free)
        gap = np.einsum("aq,eac->eqc", values, u.reshape(-1, 3)[places]) - exact(at)
        errors.append(np.sqrt(np.einsum("eq,eqc->", structure.bricks.volumes, gap**2)))
    errors = np.array(errors) / np.pi
    np.testing.assert_allclose(np.log2(errors[:-1] / errors[1:]), 3.0, atol=0.15)
    assert errors[-1] < 3e-4


def test_cantilever_end_moment():
    """A quarter of the roll-up moment, against the elastica: 0.02 %."""
    moment = 50.0 * np.pi / 3.0 / 4.0
    u = solid.solve(cantilever(length=12.0, moment_per_length=moment), (16, 1), grading="uniform")
    curvature = moment / (1.2e6 * 0.1**3 / 12)
    exact = [np.sin(12 * curvature) / curvature - 12.0, 0.0, (1 - np.cos(12 * curvature)) / curvature]
    assert relative(u.displacement([[12.0, 0.5]])[0], np.array(exact)) < 2e-4


def test_pressure_agrees_with_the_shell():
    scene = scenes.load("one-edge-clamped").model_copy(
        update={"gravity": None, "loads": (scenes.Pressure(value=60.0),)}
    )
    points = scene.probe_points()
    got, expected = (model.solve(scene, 8).displacement(points) for model in (solid, shell))
    assert relative(got, expected) < 3e-3


@pytest.mark.parametrize("hinged", [["x0", "x1"], ["x0", "x1", "y0", "y1"]])
def test_hinges_agree_with_the_shell(hinged):
    """Hinged edges, also where stretching carries the load; reactions balance it."""
    scene = scenes.load("one-edge-clamped").model_copy(
        update={"supports": tuple(scenes.Hinged(edge=edge) for edge in hinged)}
    )
    answer, expected = (model.solve(scene, 8) for model in (solid, shell))
    points = scene.probe_points()[:1]
    assert relative(answer.displacement(points), expected.displacement(points)) < 3e-3
    weight = 0.188**2 * 0.003 * 1678.0 * 9.81
    np.testing.assert_allclose(sum(answer.reactions.values()), [0.0, 0.0, weight], atol=1e-8 * weight)


def test_full_clamp_is_stiffer():
    """It stops the Poisson contraction of the face as well: a little less deflection, the same reactions."""
    scene = scenes.load("one-edge-clamped")
    points = scene.probe_points()
    full, like_a_shell = (solid.solve(scene, 8, clamp=clamp) for clamp in ("full", "shell-like"))
    ratio = full.displacement(points)[2, 2] / like_a_shell.displacement(points)[2, 2]
    assert 0.98 < ratio < 1.0
    np.testing.assert_allclose(full.reactions["x0"], like_a_shell.reactions["x0"], atol=1e-7)


def test_symmetry_of_test_1():
    answer = solid.solve(scenes.load("two-edges-clamped"), 6)
    a, b = answer.displacement([[0.05, 0.14], [0.14, 0.05]])
    np.testing.assert_allclose(a, b[[1, 0, 2]], rtol=1e-8)
    np.testing.assert_allclose(answer.reactions["x0"], answer.reactions["y0"][[1, 0, 2]], rtol=1e-7)


def test_a_compressed_flat_sheet_is_unstable():
    """Beyond Euler's load the flat sheet is an equilibrium, but not a stable one."""
    sheet = Sheet(length_x=0.2, length_y=0.05, thickness=0.002)
    material = Material(young=1e6, poisson=0.0, density=1000.0)
    euler = np.pi**2 * material.young * sheet.thickness**3 / 12 / (2 * sheet.length_x) ** 2
    for share, status in ((0.9, Status.CONVERGED), (1.1, Status.UNSTABLE)):
        scene = Scene(
            name="strut",
            sheet=sheet,
            material=material,
            supports=[{"edge": "x0", "kind": "clamped"}],
            loads=[{"kind": "edge", "edge": "x1", "force_per_length": (-share * euler, 0.0, 0.0)}],
        )
        assert solid.solve(scene, (8, 2), grading="uniform").status is status


@pytest.mark.parametrize(
    ("elements", "grading"), [((24, 1), "edges"), ((48, 1), "edges"), ((90, 1), "uniform")]
)
def test_slices_much_longer_than_wide_are_as_stable_as_the_sheet(elements, grading):
    """Strips bent to a surface strain of 0.04: no slice buckles by shear that its samples do not see."""
    scene = cantilever(length=10.0, force_per_length=(0.0, 0.0, 16.0))
    answer, coarse = solid.solve(scene, elements, grading=grading), solid.solve(scene, (12, 1))
    assert answer.status is Status.CONVERGED
    assert relative(answer.displacement([[10.0, 0.5]]), coarse.displacement([[10.0, 0.5]])) < 3e-3


def test_a_load_beyond_reach_keeps_the_last_equilibrium():
    scene = scenes.load("one-edge-clamped")
    pulled = scene.model_copy(update={"loads": (scenes.Pressure(value=-1e9),)})
    answer = solid.solve(pulled, 2)
    assert answer.status not in (Status.CONVERGED, Status.UNSTABLE)
    assert answer.load_factor < 1.0 and answer.message
    assert np.all(np.isfinite(answer.displacement(scene.probe_points())))


def test_field_mesh_has_every_node():
    answer = solid.solve(scenes.load("two-edges-clamped"), 2, layers=2)
    (kind, cells), points = answer.mesh.cells[0], answer.mesh.points
    assert kind == "hexahedron" and cells.shape == (2 * 2 * 4 * 4, 8)
    assert len(points) == 5 * 5 * 5 and answer.mesh.point_data["displacement"].shape == points.shape
    a, b, c, d = (points[cells[:, i]] for i in (0, 1, 3, 4))
    volumes = np.einsum("nc,nc->n", np.cross(b - a, c - a), d - a)
    assert np.all(volumes > 0.0) and volumes.sum() == pytest.approx(0.188**2 * 0.003)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"law": "hooke"}, "law = 'hooke'"),
        ({"clamp": "glued"}, "clamp = 'glued'"),
        ({"grading": "random"}, "grading = 'random'"),
        ({"layers": 0}, "layers = 0"),
    ],
)
def test_misuse(options, said):
    with pytest.raises(ValueError, match=said):
        solid.solve(scenes.load("two-edges-clamped"), 2, **options)


def test_refuses_a_sheet_that_nothing_holds():
    with pytest.raises(scenes.SceneError, match="nothing stops"):
        solid.solve(block())

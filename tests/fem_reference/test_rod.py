"""The actuator as an elastic rod on the shell: closed forms, rigid limits, the lumped chain, forces."""

from itertools import product

import numpy as np
import pytest
from cases import WEIGHT, equilibrium
from rod_cases import CHAINS, STRIP, chain, driven, free_rod, shell

import fem_reference
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.surface.mesh import rectangle
from fem_reference.verification.strips import HEAVY
from sheetbench.answers.solution import Status
from sheetbench.scenes import Gravity


@pytest.mark.parametrize("load", [1.0, 5.0, 20.0])
def test_a_rod_under_its_own_weight_is_the_heavy_elastica(load):
    scene = free_rod(Gravity(acceleration=(0.0, 0.0, -load)), base="start")
    tip = shell(scene, (1, 16)).displacement([[0.0, 1.0]])[0]
    assert [-tip[2], -tip[1]] == pytest.approx(HEAVY[load], rel=2e-3)


@pytest.mark.parametrize(
    ("plane", "curvature"), [("inplane", 1.0), *product(("normal", "spatial"), (1.0, 2 * np.pi, -3.0))]
)
def test_intrinsic_curvature_bends_a_free_rod_into_an_arc(plane, curvature):
    """Ends go up ("normal", "spatial") or outwards; in the plane the floppy strip wrinkles, which is said."""
    solution = shell(free_rod(curvature=curvature, plane=plane), (1, 16))
    assert solution.load_factor == 1.0
    assert solution.status is (Status.UNSTABLE if plane == "inplane" else Status.CONVERGED)
    angle = curvature / 2.0
    shortening, rise = np.sin(angle) / curvature - 0.5, (1.0 - np.cos(angle)) / curvature
    expected = [0.0, shortening, rise] if plane != "inplane" else [-rise, shortening, 0.0]
    far, near = solution.displacement([[0.0, 1.0], [0.0, 0.0]])
    np.testing.assert_allclose(far, expected, atol=2e-4)
    np.testing.assert_allclose(near, np.array(expected) * [1.0, -1.0, 1.0], atol=2e-4)
    assert solution.energies["rod"] < 1e-3 * curvature**2 / 2.0  # of the straight rod, EI and length being 1


@pytest.mark.parametrize("name", ["normal", "spatial", "inplane"])
def test_a_sheet_with_a_rod_takes_few_more_factorisations_than_without(name):
    """Stresses of rods are extrapolated with the sheet's; without that a stiff rod takes a hundred."""
    bare, bent = (shell(driven(*rods), 4) for rods in ((), (chain(**CHAINS[name]),)))
    assert bent.status is Status.CONVERGED and bent.iterations <= 2 * bare.iterations


def test_one_curvature_a_joint_and_a_table():
    """Straight, then an arc: 16 segments from the start have 16 joints, the first of half a segment."""
    joints = (0.0,) * 8 + (2.0,) * 8
    bend = free_rod(base="start", curvature=joints).actuators[0].pieces()[8] / 16
    tip = shell(free_rod(base="start", curvature=joints), (1, 16)).displacement([[0.0, 1.0]])[0]
    angle = 2.0 * (1.0 - bend)
    expected = [0.0, bend + np.sin(angle) / 2.0 - 1.0, (1.0 - np.cos(angle)) / 2.0]
    np.testing.assert_allclose(tip, expected, atol=3e-4)
    table = shell(free_rod(curvature={"time": [0.0, 1.0], "value": [9.0, 1.0]}), (1, 16))
    constant = shell(free_rod(curvature=1.0), (1, 16))
    np.testing.assert_allclose(
        table.displacement([[0.0, 1.0]]), constant.displacement([[0.0, 1.0]]), atol=1e-9
    )


@pytest.mark.parametrize("face", ["top", "bottom"])
def test_a_rod_on_a_face_stretches_the_edge(face):
    """Its axis keeps its length at the height c, so the edge lies on an arc of radius 1/κ + c."""
    thick, curvature = STRIP.model_copy(update={"thickness": 0.01}), 2.0
    height = (0.006 if face == "top" else -0.006) * 1.0
    radius = 1.0 / curvature + height
    far = shell(free_rod(sheet=thick, curvature=curvature, face=face), (1, 16)).displacement([[0.0, 1.0]])[0]
    angle = curvature / 2.0
    expected = [0.0, radius * np.sin(angle) - 0.5, radius * (1.0 - np.cos(angle))]
    np.testing.assert_allclose(far, expected, atol=2e-4)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", CHAINS)
def test_agrees_with_a_chain_of_many_segments_on_a_fine_lattice(name):
    """Two derivations that share nothing; what is left is the lattice's and the chain's discretisation."""
    scene = driven(chain(**CHAINS[name]))
    reference, lattice = (equilibrium(scene, model, 17, 12) for model in ("shell", "lumped"))
    points = scene.probe_points()
    truth = reference.displacement(points)
    assert np.abs(lattice.displacement(points) - truth).max() < 8e-3 * np.abs(truth).max()
    force, expected = reference.actuators["x1"], lattice.actuators["x1"]
    assert force.shape == expected.shape == (24, 6)
    np.testing.assert_allclose(force.sum(axis=0)[:3], expected.sum(axis=0)[:3], atol=1e-6)


@pytest.mark.parametrize("model", ["plate", "shell", "solid"])
def test_modes_are_those_of_the_sheet_alone(model):
    with_rod = fem_reference.modes(driven(chain()), model, 3, count=3)
    without = fem_reference.modes(driven(), model, 3, count=3)
    np.testing.assert_allclose(with_rod.frequencies, without.frequencies, rtol=1e-12)


def test_a_straight_rod_of_intrinsic_curvature_stores_what_straightening_takes():
    """½ EI κ₀² L at full load, a quarter at half; EI and the length are 1."""
    sheet = DiscreteShell(rectangle(STRIP, (1, 4), graded=False), free_rod(curvature=2.0))
    for share, stored in ((1.0, 2.0), (0.5, 0.5)):
        assert sheet.rods.energy(np.zeros(sheet.size), share) == pytest.approx(stored, rel=1e-9)


def small(scene, factor=1e-3):
    """The scene's weight and intrinsic curvature scaled down."""
    (one,) = scene.actuators
    scaled = one.replace(curvature=np.multiply(one.curvature, factor).tolist())
    weight = Gravity(acceleration=(0.0, 0.0, -9.81 * factor))
    return scene.replace(gravity=weight, actuators=(scaled,))


@pytest.mark.sweep
@pytest.mark.parametrize("base", ["free", "middle"])
@pytest.mark.parametrize("name", CHAINS)
def test_the_plate_is_the_limit_of_small_deflections(name, base):
    settings = dict(CHAINS[name])
    if base == "middle" and name == "list":
        settings["curvature"] = (*settings["curvature"], 2.0)
    scene = small(driven(chain(**settings, base=base)))
    points = np.random.default_rng(0).uniform(0.0, 0.188, (50, 2))
    plate, expected = (fem_reference.solve(scene, model, elements=12) for model in ("plate", "shell"))
    truth = expected.displacement(points)
    assert np.abs(plate.displacement(points) - truth).max() < 3e-3 * np.abs(truth).max()
    assert plate.energies["rod"] == pytest.approx(expected.energies["rod"], rel=3e-3)
    own, sheet = 1e-3 * ROD_WEIGHT, 1e-3 * WEIGHT
    total = plate.actuators["x1"].sum(axis=0)[:3]
    held = sum(plate.reactions.values())
    np.testing.assert_allclose(held, [0.0, 0.0, sheet + own], atol=1e-5 * sheet)
    np.testing.assert_allclose(total + plate.reactions["x0"], [0.0, 0.0, sheet], atol=1e-5 * sheet)
    assert np.all(plate.mesh.point_data["actuator_line_force"][plate.mesh.points[:, 0] < 0.187] == 0.0)


MET = {edges: [chain(edge=e, curvature=-4.0, bending_stiffness=0.02) for e in edges] for edges in
       (("y1",), ("x1", "y1"), ("y0", "y1"))}  # fmt: skip
ROD_WEIGHT = 0.05 * 0.188 * 9.81
ON_SOLIDS = {  # scene, how far apart; rods that meet end at corners that a clamp holds or another rod turns
    **{name: (driven(chain(**settings)), 2e-3) for name, settings in CHAINS.items()},
    **{" and ".join(edges): (driven(*rods), 2e-3) for edges, rods in MET.items()},
    **{f"held at its {base}": (driven().replace(supports=(), actuators=(chain(edge="y0", base=base),)), 1e-3)
       for base in ("start", "middle", "end")},
}  # fmt: skip


@pytest.mark.sweep(3)
@pytest.mark.parametrize("name", ON_SOLIDS)
def test_the_solid_agrees_with_the_shell(name):
    """Displacements, rods' energy within 1 %; forces balance."""
    scene, within = ON_SOLIDS[name]
    points = np.random.default_rng(0).uniform(0.0, 0.188, (50, 2))
    answer, expected = fem_reference.solve(scene, model="solid", elements=8), shell(scene)
    assert answer.status is expected.status is Status.CONVERGED
    truth = expected.displacement(points)
    assert np.abs(answer.displacement(points) - truth).max() < within * np.abs(truth).max()
    carried = [0.0, 0.0, WEIGHT + ROD_WEIGHT * len(scene.actuators)]
    np.testing.assert_allclose(sum(answer.reactions.values()), carried, atol=1e-7)
    if name in CHAINS:
        assert answer.energies["rod"] == pytest.approx(expected.energies["rod"], rel=1e-2)
        np.testing.assert_allclose(answer.actuators["x1"].sum(axis=0)[:3], [0.0, 0.0, -ROD_WEIGHT], atol=1e-8)
        moment, agreed = (each.actuators["x1"][:, 3:] for each in (answer, expected))
        np.testing.assert_allclose(moment[8:16], agreed[8:16], atol=0.02 * np.abs(agreed).max())
    if not scene.supports:
        taken = answer.actuators["y0"].sum(axis=0)[:3]
        np.testing.assert_allclose(taken, [0.0, 0.0, WEIGHT], atol=1e-7)

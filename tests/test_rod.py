"""The actuator as an elastic rod on every reference: closed forms, rigid limits, the lumped chain, forces."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import fem_reference
import lumped
from fem_reference.shell.rods import RoddedShell, RodState, with_rods
from fem_reference.shell.statics import discretise
from fem_reference.solid.rods import RoddedSolid
from fem_reference.solid.rods import RodState as SolidRodState
from fem_reference.solid.statics import discretise as discretise_solid
from fem_reference.solid.supports import into_forces, vectors
from fem_reference.surface import rod
from fem_reference.surface.mesh import rectangle
from sheetbench import scenes
from sheetbench.scenes import (
    Chain,
    Clamped,
    Curved,
    EdgeMotion,
    Gravity,
    Hinged,
    Material,
    Scene,
    Sheet,
    Solution,
    Status,
)

SHEET = Sheet(length_x=0.188, length_y=0.188, thickness=0.003)
RUBBER = Material(young=54.5e6, poisson=0.48, density=1678.0)
GRAVITY = Gravity(acceleration=(0.0, 0.0, -9.81))
STRIP = Sheet(length_x=0.02, length_y=1.0, thickness=0.0005)
FLOPPY = Material(young=1e2, poisson=0.0, density=1e-3)  # a sheet that the rod does not feel
PUBLISHED = {1.0: (0.12347, 0.00875), 5.0: (0.49591, 0.15334), 20.0: (0.82988, 0.55477)}


def chain(**asked: Any) -> Chain:
    values = {"edge": "x1", "segments": 24, "bending_stiffness": 0.2, "line_density": 0.05, "radius": 1.5e-3}
    return Chain(**{**values, **asked})


def alone(gravity: Gravity | None = None, sheet: Sheet = STRIP, **asked: Any) -> Scene:
    """A rod of length 1, EI = 1 and 1 kg/m along a floppy strip."""
    values = {"edge": "x0", "segments": 16, "bending_stiffness": 1.0, "line_density": 1.0, "radius": 1e-3}
    only = Chain(**{**values, "base": "middle", **asked})
    return Scene(name="rod", sheet=sheet, material=FLOPPY, gravity=gravity, actuators=(only,))


def driven(*actuators: Any, gravity: Gravity | None = GRAVITY) -> Scene:
    supports = (Clamped(edge="x0"),)
    return Scene(
        name="s", sheet=SHEET, material=RUBBER, gravity=gravity, supports=supports, actuators=actuators
    )


def shell(scene: Scene, elements: int | tuple[int, int] = 8) -> Solution:
    return fem_reference.solve(scene, model="shell", elements=elements)


@pytest.mark.parametrize("name", ["curved-edge", "curved-edge-down"])
def test_a_stiff_rod_held_at_its_middle_is_the_curved_support(name: str) -> None:
    rigid = scenes.load(name)
    curvature = rigid.supports[0].curvature
    stiff = chain(edge="x0", bending_stiffness=1e3, line_density=1e-6, curvature=curvature, base="middle")
    elastic = rigid.model_copy(update={"supports": (), "actuators": (stiff,)})
    points = np.random.default_rng(0).uniform(0.0, 0.188, (100, 2))
    bent, expected = shell(elastic), shell(rigid)
    assert bent.status is Status.CONVERGED
    truth = expected.displacement(points)
    assert np.abs(bent.displacement(points) - truth).max() < 1e-3 * np.abs(truth).max()
    np.testing.assert_allclose(bent.reactions["x0 base"], expected.reactions["x0"], rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize("load", PUBLISHED)
def test_a_rod_under_its_own_weight_is_the_heavy_elastica(load: float) -> None:
    scene = alone(Gravity(acceleration=(0.0, 0.0, -load)), base="start")
    tip = shell(scene, (1, 16)).displacement([[0.0, 1.0]])[0]
    assert [-tip[2], -tip[1]] == pytest.approx(PUBLISHED[load], rel=2e-3)


@pytest.mark.parametrize("plane", ["normal", "spatial", "inplane"])
@pytest.mark.parametrize("curvature", [1.0, 2 * np.pi, -3.0])
def test_intrinsic_curvature_bends_a_free_rod_into_an_arc(plane: str, curvature: float) -> None:
    """Ends go up ("normal", "spatial") or outwards; in the plane the floppy strip wrinkles, which is said."""
    solution = shell(alone(curvature=curvature, plane=plane), (1, 16))
    assert solution.load_factor == 1.0
    assert solution.status is Status.CONVERGED or plane == "inplane"
    angle = curvature / 2.0
    shortening, rise = np.sin(angle) / curvature - 0.5, (1.0 - np.cos(angle)) / curvature
    expected = [0.0, shortening, rise] if plane != "inplane" else [-rise, shortening, 0.0]
    far, near = solution.displacement([[0.0, 1.0], [0.0, 0.0]])
    np.testing.assert_allclose(far, expected, atol=2e-4)
    np.testing.assert_allclose(near, np.array(expected) * [1.0, -1.0, 1.0], atol=2e-4)


def test_one_curvature_a_joint_and_a_table() -> None:
    """Straight, then an arc: 16 segments from the start have 16 joints, the first of half a segment."""
    joints = (0.0,) * 8 + (2.0,) * 8
    bounds, values = rod.pieces(alone(base="start", curvature=joints).actuators[0], 1.0)
    assert len(values) == 16 and bounds[1] == pytest.approx(0.5 / 16)
    bend = bounds[8]
    tip = shell(alone(base="start", curvature=joints), (1, 16)).displacement([[0.0, 1.0]])[0]
    angle = 2.0 * (1.0 - bend)
    expected = [0.0, bend + np.sin(angle) / 2.0 - 1.0, (1.0 - np.cos(angle)) / 2.0]
    np.testing.assert_allclose(tip, expected, atol=3e-4)
    table = shell(alone(curvature={"time": [0.0, 1.0], "value": [9.0, 1.0]}), (1, 16))
    constant = shell(alone(curvature=1.0), (1, 16))
    np.testing.assert_allclose(
        table.displacement([[0.0, 1.0]]), constant.displacement([[0.0, 1.0]]), atol=1e-9
    )


@pytest.mark.parametrize(("base", "joints"), [("free", 5), ("start", 6), ("end", 6), ("middle", 6)])
def test_pieces_cover_the_edge(base: str, joints: int) -> None:
    values = tuple(float(i) for i in range(joints))
    bounds, found = rod.pieces(chain(segments=6, base=base, curvature=values), 0.6)
    assert len(found) == joints and len(bounds) == joints + 1
    assert bounds[0] == 0.0 and bounds[-1] == 0.6 and np.all(np.diff(bounds) > 0.0)


@pytest.mark.parametrize("face", ["top", "bottom"])
def test_a_rod_on_a_face_stretches_the_edge(face: str) -> None:
    """Its axis keeps its length at the height c, so the edge lies on an arc of radius 1/κ + c."""
    thick, curvature = STRIP.model_copy(update={"thickness": 0.01}), 2.0
    height = (0.006 if face == "top" else -0.006) * 1.0
    radius = 1.0 / curvature + height
    far = shell(alone(sheet=thick, curvature=curvature, face=face), (1, 16)).displacement([[0.0, 1.0]])[0]
    angle = curvature / 2.0
    expected = [0.0, radius * np.sin(angle) - 0.5, radius * (1.0 - np.cos(angle))]
    np.testing.assert_allclose(far, expected, atol=2e-4)


CHAINS = {
    "normal": {"curvature": 4.0},
    "top": {"curvature": 4.0, "face": "top"},
    "bottom": {"curvature": -3.0, "face": "bottom"},
    "spatial": {"curvature": 4.0, "plane": "spatial"},
    "inplane": {"curvature": 0.05, "plane": "inplane", "bending_stiffness": 20.0},
    "list": {"curvature": tuple(np.linspace(-5.0, 8.0, 23))},
}


@pytest.mark.parametrize("name", CHAINS)
def test_agrees_with_a_chain_of_many_segments_on_a_fine_lattice(name: str) -> None:
    """Two derivations that share nothing; what is left is the lattice's and the chain's discretisation."""
    scene = driven(chain(**CHAINS[name]))
    reference = shell(scene, 12)
    springs = lumped.calibrate(SHEET, RUBBER, grid=(17, 17), method="consistent")
    lattice = lumped.solve(scene, springs)
    assert reference.status is lattice.status is Status.CONVERGED
    points = scene.probe_points()
    truth = reference.displacement(points)
    assert np.abs(lattice.displacement(points) - truth).max() < 8e-3 * np.abs(truth).max()
    force, expected = reference.actuators["x1"], lattice.actuators["x1"]
    assert force.shape == expected.shape == (24, 6)
    np.testing.assert_allclose(force.sum(axis=0)[:3], expected.sum(axis=0)[:3], atol=1e-6)


def test_forces_balance() -> None:
    scene = driven(chain(curvature=4.0))
    solution = shell(scene)
    sheet, own = 1678.0 * 0.003 * 0.188**2 * 9.81, 0.05 * 0.188 * 9.81
    np.testing.assert_allclose(solution.reactions["x0"], [0.0, 0.0, sheet + own], atol=1e-8)
    np.testing.assert_allclose(solution.actuators["x1"].sum(axis=0)[:3], [0.0, 0.0, -own], atol=1e-8)
    line = solution.mesh.point_data["actuator_line_force"]
    off = solution.mesh.points[:, 0] < 0.188 - 1e-9
    assert np.all(line[off] == 0.0) and np.abs(line[~off]).max() > 0.0
    held = shell(driven().model_copy(update={"supports": (), "actuators": (chain(edge="y0", base="end"),)}))
    np.testing.assert_allclose(held.reactions["y0 base"], [0.0, 0.0, sheet + own], atol=1e-7)
    np.testing.assert_allclose(held.actuators["y0"].sum(axis=0)[:3], [0.0, 0.0, sheet], atol=1e-7)


def test_a_pair_is_one_rod_on_the_mean_axis() -> None:
    pair = driven(chain(face="top", curvature=6.0), chain(face="bottom", curvature=2.0))
    single = driven(chain(bending_stiffness=0.4, line_density=0.1, curvature=4.0))
    points = pair.probe_points()
    together = shell(pair)
    np.testing.assert_allclose(
        together.displacement(points), shell(single).displacement(points), rtol=1e-6, atol=1e-12
    )
    assert list(together.actuators) == ["x1.1", "x1.2"]


def random_state(structure: RoddedShell) -> RodState:
    rng = np.random.default_rng(1)
    change = 0.02 * rng.uniform(-1.0, 1.0, (2, structure.count, 3))
    director = np.array([0.0, 0.0, 1.0]) + 20.0 * change[1]
    change[1] = director / np.linalg.norm(director, axis=1, keepdims=True) - [0.0, 0.0, 1.0]
    asides = []
    for one in structure.rods:
        aside = one.reference[0, 6] + 0.3 * rng.uniform(-1.0, 1.0, (len(one.line), 3))
        asides.append(aside / np.linalg.norm(aside, axis=1, keepdims=True) - one.reference[0, 6])
    return RodState(change, None, tuple(asides))


def test_the_tangent_is_the_derivative_of_the_force() -> None:
    """Along the spheres of both directors, with rods on two edges that share a corner."""
    scene = Scene(
        name="t", sheet=SHEET, material=RUBBER, gravity=GRAVITY, probes={"A": (0, 0)},
        actuators=(chain(face="top", curvature=3.0, plane="spatial"), chain(edge="y0", base="start")),
    )  # fmt: skip
    structure, _ = discretise(rectangle(SHEET, 2), scene)
    assert isinstance(structure, RoddedShell)
    state = random_state(structure)
    forces = structure.forces(state, 1.0)
    matrix, _ = structure.system(state, forces, 1.0, mixed=False)
    assert abs(matrix - matrix.T).max() < 1e-9 * abs(matrix).max()
    frames, aside_frames = structure._frames(state.change), structure._aside_frames(state)
    step = np.random.default_rng(2).uniform(-1.0, 1.0, structure.unknowns)

    def turned(vector: np.ndarray, rest: np.ndarray, frame: np.ndarray, by: np.ndarray) -> np.ndarray:
        moved = vector + rest + np.einsum("nck,nk->nc", frame, by)
        return moved / np.linalg.norm(moved, axis=1, keepdims=True) - rest

    def force(t: float) -> np.ndarray:
        full = np.where(structure.number >= 0, step[structure.number], 0.0) * t
        change = state.change.copy()
        change[0] += full[:, :3]
        up = np.array([0.0, 0.0, 1.0])
        change[1] = turned(change[1], up, frames, full[:, 3:])
        asides = tuple(
            turned(aside, one.reference[0, 6], frame, np.where(number >= 0, step[number], 0.0) * t)
            for aside, one, frame, number in zip(
                state.aside, structure.rods, aside_frames, structure.aside_number, strict=True
            )
        )
        found = with_rods(structure.forces(RodState(change, None, asides), 1.0))
        out = np.zeros(structure.unknowns)

        def put(residual: np.ndarray, vector: np.ndarray, frame: np.ndarray, number: np.ndarray) -> None:
            along = np.einsum("nc,nc->n", residual, vector)[:, None] * vector
            turning = np.einsum("nc,nck->nk", residual - along, frame)
            out[number[number >= 0]] = turning[number >= 0]

        free = structure.number[:, :3] >= 0
        out[structure.number[:, :3][free]] = found.residual[0][free]
        put(found.residual[1], change[1] + up, frames, structure.number[:, 3:])
        for residual, aside, one, frame, number in zip(
            found.aside, asides, structure.rods, aside_frames, structure.aside_number, strict=True
        ):
            put(residual, aside + one.reference[0, 6], frame, number)
        return out

    difference = (force(1e-6) - force(-1e-6)) / 2e-6
    np.testing.assert_allclose(matrix @ step, difference, rtol=1e-5, atol=1e-5 * np.abs(difference).max())


def test_an_edge_moved_rigidly_takes_a_free_sheet_with_it() -> None:
    motion = EdgeMotion(
        kind="motion", edge="y1", time=(0.0, 1.0),
        displacement=((0, 0, 0), (0.01, -0.02, 0.03)), rotation=((0, 0, 0), (0.5, -0.3, 0.2)),
    )  # fmt: skip
    scene = driven(gravity=None).model_copy(update={"supports": (), "actuators": (motion,)})
    solution = shell(scene, 4)
    assert solution.status is Status.CONVERGED
    assert sum(solution.energies.values()) < 1e-12
    corners = solution.displacement([[0.0, 0.0], [0.188, 0.0], [0.0, 0.188]])
    flat = np.array([[0.0, 0.0, 0.0], [0.188, 0.0, 0.0], [0.0, 0.188, 0.0]])
    assert np.linalg.norm(np.diff(flat + corners, axis=0), axis=1) == pytest.approx(
        np.linalg.norm(np.diff(flat, axis=0), axis=1), rel=1e-9
    )
    middle = solution.displacement([[0.094, 0.188]])[0]
    np.testing.assert_allclose(middle, [0.01, -0.02, 0.03], atol=1e-12)


def test_an_edge_moved_rigidly_agrees_with_the_lattice() -> None:
    motion = EdgeMotion(
        kind="motion", edge="x1", time=(0.0, 1.0),
        displacement=((0, 0, 0), (0.0, 0.0, 0.01)), rotation=((0, 0, 0), (0.1, -0.1, 0.02)),
    )  # fmt: skip
    scene = driven(motion).model_copy(update={"probes": {"P1": (0.094, 0.094), "P2": (0.094, 0.188)}})
    reference = shell(scene, 12)
    lattice = lumped.solve(scene, lumped.calibrate(SHEET, RUBBER, grid=(17, 17), method="consistent"))
    points = scene.probe_points()
    truth = reference.displacement(points)
    assert np.abs(lattice.displacement(points) - truth).max() < 5e-3 * 0.011
    assert reference.actuators["x1"].shape == (1, 6)
    np.testing.assert_allclose(
        reference.actuators["x1"][0, :3], lattice.actuators["x1"][0, :3], rtol=0.03, atol=0.02
    )


def small(scene: Scene, factor: float = 1e-3) -> Scene:
    """The scene's weight and intrinsic curvature scaled down."""
    (one,) = scene.actuators
    curved = np.multiply(one.curvature, factor).tolist()
    weight = Gravity(acceleration=(0.0, 0.0, -9.81 * factor))
    scaled = Chain(**{**one.model_dump(), "curvature": curved})
    return scene.model_copy(update={"gravity": weight, "actuators": (scaled,)})


@pytest.mark.parametrize("base", ["free", "middle"])
@pytest.mark.parametrize("name", CHAINS)
def test_the_plate_is_the_limit_of_small_deflections(name: str, base: str) -> None:
    asked = dict(CHAINS[name])
    if base == "middle" and name == "list":
        asked["curvature"] = (*asked["curvature"], 2.0)
    scene = small(driven(chain(**asked, base=base)))
    points = np.random.default_rng(0).uniform(0.0, 0.188, (50, 2))
    plate = fem_reference.solve(scene, model="plate", elements=12)
    expected = fem_reference.solve(scene, model="shell", elements=12, graded=False)
    truth = expected.displacement(points)
    assert np.abs(plate.displacement(points) - truth).max() < 3e-3 * np.abs(truth).max()
    assert plate.energies["rod"] == pytest.approx(expected.energies["rod"], rel=3e-3)
    own = 0.05 * 0.188 * 9.81e-3
    sheet = 1678.0 * 0.003 * 0.188**2 * 9.81e-3
    total = plate.actuators["x1"].sum(axis=0)[:3]
    held = sum(plate.reactions.values())
    np.testing.assert_allclose(held, [0.0, 0.0, sheet + own], atol=1e-5 * sheet)
    np.testing.assert_allclose(total + plate.reactions["x0"], [0.0, 0.0, sheet], atol=1e-5 * sheet)
    assert np.all(plate.mesh.point_data["actuator_line_force"][plate.mesh.points[:, 0] < 0.187] == 0.0)


@pytest.mark.parametrize("name", ["curved-edge", "curved-edge-down"])
def test_on_the_plate_too_a_stiff_rod_is_the_curved_support(name: str) -> None:
    rigid = scenes.load(name)
    curvature = rigid.supports[0].curvature
    stiff = chain(edge="x0", bending_stiffness=1e3, line_density=1e-6, curvature=curvature, base="middle")
    elastic = rigid.model_copy(update={"supports": (), "actuators": (stiff,)})
    points = np.random.default_rng(0).uniform(0.0, 0.188, (100, 2))
    bent, expected = (fem_reference.solve(scene, model="plate", elements=8) for scene in (elastic, rigid))
    truth = expected.displacement(points)
    assert np.abs(bent.displacement(points) - truth).max() < 1e-3 * np.abs(truth).max()
    np.testing.assert_allclose(bent.reactions["x0 base"], expected.reactions["x0"], rtol=1e-4, atol=1e-6)


def test_on_the_plate_an_edge_moves_rigidly() -> None:
    """A small motion, as the shell has it; a free sheet is taken along without strain."""
    motion = EdgeMotion(
        kind="motion", edge="x1", time=(0.0, 1.0),
        displacement=((0, 0, 0), (0.0, 1e-6, 1e-5)), rotation=((0, 0, 0), (1e-4, -1e-4, 2e-6)),
    )  # fmt: skip
    scene = driven(motion, gravity=Gravity(acceleration=(0.0, 0.0, -1e-2)))
    points = np.random.default_rng(0).uniform(0.0, 0.188, (50, 2))
    plate = fem_reference.solve(scene, model="plate", elements=12)
    expected = fem_reference.solve(scene, model="shell", elements=12, graded=False)
    truth = expected.displacement(points)
    assert np.abs(plate.displacement(points) - truth).max() < 3e-3 * np.abs(truth).max()
    wrench = expected.actuators["x1"]
    np.testing.assert_allclose(plate.actuators["x1"], wrench, atol=5e-3 * np.abs(wrench).max())
    free = fem_reference.solve(scene.model_copy(update={"supports": (), "gravity": None}), model="plate")
    assert sum(free.energies.values()) < 1e-20
    turned = np.cross([1e-4, -1e-4, 2e-6], [-0.188, -0.094, 0.0])
    np.testing.assert_allclose(free.displacement([[0.0, 0.0]])[0] - turned, [0.0, 1e-6, 1e-5], atol=1e-12)


def solid(scene: Scene, elements: int | tuple[int, int] = 8, layers: int = 1) -> Solution:
    return fem_reference.solve(scene, model="solid", elements=elements, layers=layers)


@pytest.mark.parametrize("name", CHAINS)
def test_the_solid_agrees_with_the_shell(name: str) -> None:
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
def test_rods_that_meet_each_other_and_a_clamp(edges: tuple[str, ...]) -> None:
    """They end at corners whose column the clamp holds or the other rod turns too."""
    scene = driven(*(chain(edge=edge, curvature=-4.0, bending_stiffness=0.02) for edge in edges))
    points = np.random.default_rng(0).uniform(0.0, 0.188, (50, 2))
    answer, expected = solid(scene), shell(scene)
    assert answer.status is expected.status is Status.CONVERGED
    truth = expected.displacement(points)
    assert np.abs(answer.displacement(points) - truth).max() < 2e-3 * np.abs(truth).max()


@pytest.mark.parametrize("layers", [1, 2])
@pytest.mark.parametrize("name", ["curved-edge", "curved-edge-down"])
def test_on_the_solid_too_a_stiff_rod_is_the_curved_support(name: str, layers: int) -> None:
    rigid = scenes.load(name)
    curvature = rigid.supports[0].curvature
    stiff = chain(edge="x0", bending_stiffness=1e3, line_density=1e-6, curvature=curvature, base="middle")
    elastic = rigid.model_copy(update={"supports": (), "actuators": (stiff,)})
    points = np.random.default_rng(0).uniform(0.0, 0.188, (50, 2))
    bent, expected = (solid(scene, 4, layers) for scene in (elastic, rigid))
    assert bent.status is Status.CONVERGED
    truth = expected.displacement(points)
    assert np.abs(bent.displacement(points) - truth).max() < 1e-3 * np.abs(truth).max()
    np.testing.assert_allclose(bent.reactions["x0 base"], expected.reactions["x0"], rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize("base", ["start", "middle", "end"])
def test_a_base_holds_the_solid(base: str) -> None:
    scene = driven().model_copy(update={"supports": (), "actuators": (chain(edge="y0", base=base),)})
    answer, expected = solid(scene), shell(scene)
    assert answer.status is Status.CONVERGED
    points = scene.probe_points()
    truth = expected.displacement(points)
    assert np.abs(answer.displacement(points) - truth).max() < 1e-3 * np.abs(truth).max()
    sheet, own = 1678.0 * 0.003 * 0.188**2 * 9.81, 0.05 * 0.188 * 9.81
    np.testing.assert_allclose(answer.reactions["y0 base"], [0.0, 0.0, sheet + own], atol=1e-7)
    np.testing.assert_allclose(answer.actuators["y0"].sum(axis=0)[:3], [0.0, 0.0, sheet], atol=1e-7)


def test_on_the_solid_an_edge_moves_rigidly() -> None:
    motion = EdgeMotion(
        kind="motion", edge="x1", time=(0.0, 1.0),
        displacement=((0, 0, 0), (0.0, 0.0, 0.01)), rotation=((0, 0, 0), (0.1, -0.1, 0.02)),
    )  # fmt: skip
    scene = driven(motion)
    points = np.random.default_rng(0).uniform(0.0, 0.188, (50, 2))
    answer, expected = solid(scene), shell(scene)
    assert answer.status is Status.CONVERGED
    truth = expected.displacement(points)
    assert np.abs(answer.displacement(points) - truth).max() < 3e-3 * np.abs(truth).max()
    wrench = expected.actuators["x1"]
    np.testing.assert_allclose(answer.actuators["x1"], wrench, atol=2e-2 * np.abs(wrench).max())
    free = solid(scene.model_copy(update={"supports": (), "gravity": None}), 2)
    assert sum(free.energies.values()) < 1e-12


@pytest.mark.parametrize("layers", [1, 2])
def test_the_tangent_of_the_rodded_solid_is_the_derivative_of_the_force(layers: int) -> None:
    """Rods on two edges that share a corner, beside a hinged and a curved edge."""
    supports = (Curved(edge="x0", kind="curved", curvature=0.8), Hinged(edge="y1"))
    scene = driven(chain(face="top", curvature=3.0, plane="spatial"), chain(edge="y0", base="end"))
    scene = scene.model_copy(update={"supports": supports})
    structure = discretise_solid(rectangle(SHEET, 2), scene, layers)
    assert isinstance(structure, RoddedSolid)
    rng = np.random.default_rng(1)
    bases = structure.supports.bases(0.7)
    u = structure.supports.target(0.7) + 2e-4 * rng.normal(size=structure.free.shape)
    asides = [0.1 * rng.normal(size=(len(one.line), 3, 3)) for one in structure.rods]
    for aside, one in zip(asides, structure.rods, strict=True):
        aside[slice(0, 0) if one.base is None else one.base] = 0.0
    step = rng.normal(size=structure.unknowns)
    local = np.zeros(structure.free.shape)
    local[structure.free] = step[: structure.solid_unknowns]
    direction = vectors(bases, local)

    def rows(t: float) -> np.ndarray:
        turned = tuple(
            aside + t * np.where(number >= 0, step[number], 0.0)
            for aside, number in zip(asides, structure.aside_number, strict=True)
        )
        forces = structure.forces(SolidRodState(u + t * direction, aside=turned), 0.7)
        on_m = [f[n >= 0] for f, n in zip(forces.aside, structure.aside_number, strict=True)]
        return np.concatenate([into_forces(bases, forces.residual)[structure.free], *on_m])

    state = SolidRodState(u, aside=tuple(asides))
    matrix, _ = structure.system(state, structure.forces(state, 0.7), 0.7, mixed=False)
    assert abs(matrix - matrix.T).max() < 1e-9 * abs(matrix).max()
    difference = (rows(1e-6) - rows(-1e-6)) / 2e-6
    np.testing.assert_allclose(matrix @ step, difference, atol=1e-6 * np.abs(difference).max())


@pytest.mark.parametrize("model", ["plate", "shell", "solid"])
def test_modes_are_those_of_the_sheet_alone(model: str) -> None:
    with_rod = fem_reference.modes(driven(chain()), model, 3, count=3)
    without = fem_reference.modes(driven(), model, 3, count=3)
    np.testing.assert_allclose(with_rod.frequencies, without.frequencies, rtol=1e-12)

"""The shell beyond its limit points: where it snaps, to what, and that nothing else has changed."""

from dataclasses import dataclass, replace

import cases
import numpy as np
import pytest
from scipy.integrate import simpson
from scipy.optimize import minimize_scalar

import fem_reference
import lumped
from comparisons.sweep.differences import error
from fem_reference.discrete.items import DeadLoad
from fem_reference.discrete.static import Static, StaticState
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.surface.loads import spread
from fem_reference.surface.location import shares
from fem_reference.surface.mesh import rectangle
from fem_reference.surface.supports import PrescribedEdge
from sheetbench import scenes
from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation import pseudo_transient
from sheetbench.numerics.continuation.path import LoadStepFailed, Path
from sheetbench.numerics.continuation.pseudo_transient import relax
from sheetbench.numerics.continuation.trace import trace_path
from sheetbench.numerics.direct import DirectSolver, SingularMatrixError
from sheetbench.scenes import Chain, Curved, Hinged
from sheetbench.scenes.meaning.kinematics import Displaced
from studies.stability import scenes as stability_scenes

SIDE, WIDTH, THICKNESS, YOUNG = 1.0, 0.1, 0.002, 1e7
SHORTER = 0.002  # shortening of the strip
RIGIDITY = YOUNG * WIDTH * THICKNESS**3 / 12.0  # E I; ν = 0: a beam


def push_of(theta, at=0.5):
    """Push F [N] at x = at · L on a hinged strip that is buckled, as a function of kL = 2θ.

    E I w'' + P w = −M, M the push's moment in a simple beam, k² = P/E I: with c = L − a, for x < a,

        w = F/P (sin kc sin kx/(k sin kL) − c x/L),

    and beyond a the same from the other end. The ends are closer by Δ = ∫ ½ w'² dx + P L/E A, which is given
    (Timoshenko & Gere 1961, §1.3). θ = π/2 is the unloaded arch; pushed in the middle, the antisymmetric
    mode branches off at θ = π, where F = 4 (4 π²) E I/L² √(Δ/3L).
    """
    k, force = 2.0 * theta / SIDE, 4.0 * theta**2 * RIGIDITY / SIDE**2
    square = 0.0
    for near, far in ((at * SIDE, (1 - at) * SIDE), ((1 - at) * SIDE, at * SIDE)):
        x = np.linspace(0.0, near, 2001)
        share = 0.5 / np.cos(theta) if at == 0.5 else np.sin(k * far) / np.sin(k * SIDE)
        square += float(simpson((share * np.cos(k * x) - far / SIDE) ** 2, x=x))
    bent = SHORTER - force * SIDE / (YOUNG * WIDTH * THICKNESS)
    return force * float(np.sqrt(2.0 * bent / square))


def limit(at=0.5):
    """The largest push [N] on the path that the arch takes without branching."""
    last = 4.5 if at == 0.5 else 0.999 * np.pi
    return -float(minimize_scalar(lambda t: -push_of(t, at), bounds=(1.8, last), method="bounded").fun)


BRANCHING, LIMIT = push_of(np.pi), limit()


@dataclass(frozen=True)
class Shortening:
    """The strip's ends brought closer, at every load factor."""

    shorter: float

    def displaced(self, points, load_factor, time=None):
        out = np.zeros((len(points), 3))
        out[:, 0] = -0.5 * self.shorter * np.sign(points[:, 0] - SIDE / 2)
        return Displaced(out, np.zeros((3, 3)))


class Strip(Static):
    """A strip between hinges, shortened, that sets out from a given state."""

    start = None

    def rest(self):
        return self.start or super().rest()

    def from_state(self, start):
        found = Strip(self.sheet)
        found.start = start
        return found


def height(shorter):
    """Of the buckled strip: w = b sin πx/L, b² = 4 L Δ/π², but for what it is compressed."""
    return 2.0 / np.pi * float(np.sqrt((shorter - np.pi**2 * THICKNESS**2 / (12.0 * SIDE)) * SIDE))


def strip(at=0.5, shorter=SHORTER, bent=0.0):
    """Pushed down at x = at, with 1.5 times the limit load at load factor 1; pressed together, bent by so
    much of the buckled shape."""
    hinges = (Hinged(edge="x0"), Hinged(edge="x1"))
    scene = cases.sheet(SIDE, WIDTH, THICKNESS, YOUNG, 0.0, supports=hinges)
    sheet = DiscreteShell(rectangle(scene.sheet, (12, 1), graded=False), scene)
    nodes = sheet.plan.nodes
    ends = np.flatnonzero(sheet.supports.position.any(axis=1))
    closer = PrescribedEdge(ends, nodes[ends], Shortening(shorter), np.ones(len(ends)))
    sheet.supports = replace(sheet.supports, turning=(closer,))
    point = np.array([at * SIDE, WIDTH / 2])
    element, value = shares(sheet.plan.mesh, point[None])
    dead = spread(sheet.plan, sheet.plan.elements[element], value, np.array([0.0, 0.0, -1.5 * LIMIT]))
    sheet.items.append(DeadLoad(sheet.on_coordinates(dead), float))
    moved, turned = np.zeros((2, len(nodes), 3))
    moved[:, 0] = -shorter * (nodes[:, 0] / SIDE - 0.5)
    phase, high = np.pi * nodes[:, 0] / SIDE, bent * height(shorter)
    moved[:, 2] = high * np.sin(phase)
    slope = np.arctan(high * np.pi / SIDE * np.cos(phase))
    turned[:, 0], turned[:, 2] = -np.sin(slope), np.cos(slope) - 1.0
    return Strip(sheet).from_state(StaticState(sheet.of_vectors(moved, turned)))


def heights(state):
    """z (n,) of a strip's nodes."""
    return state.q.reshape(2, -1, 3)[0, :, 2]


@pytest.fixture(scope="module")
def arch():
    """The strip buckled upwards."""
    bent = strip(bent=1.0)
    return relax(Path(bent, DirectSolver(), bent.start), 0.0)


def mirrored(state):
    """The same on the other side of z = 0."""
    change = state.q.reshape(2, -1, 3)
    return StaticState((change * np.array([[[1.0, 1.0, -1.0]], [[-1.0, -1.0, 1.0]]])).ravel())


def pushed(arch, at=0.5, settles=True):
    structure, solver = strip(at).from_state(arch), DirectSolver()
    return structure, trace_path(structure, solver, settle=relax if settles else None)


def left_at(path):
    """The load factor of a path's one snap."""
    (found,) = path.snaps
    return found


def test_the_arch_is_the_elastica(arch):
    assert heights(arch).max() == pytest.approx(height(SHORTER), rel=2e-3)


def test_a_matrix_that_is_singular_ends_the_creep_with_that_status(arch, monkeypatch):
    def factor(self, *matrix):
        raise SingularMatrixError("the matrix is singular")

    monkeypatch.setattr(DirectSolver, "factor", factor)
    with pytest.raises(LoadStepFailed) as caught:
        relax(Path(strip().from_state(arch), DirectSolver(), arch), 0.5)
    assert caught.value.status is Status.SINGULAR


def test_a_compressed_strip_leaves_the_saddle_for_the_buckled_state():
    shorter = 1.5 * np.pi**2 * THICKNESS**2 / (12.0 * SIDE)
    flat = strip(shorter=shorter)
    path = Path(flat, DirectSolver(), flat.start)
    buckled = relax(path, 0.0)
    assert np.abs(heights(buckled)).max() == pytest.approx(height(shorter), rel=5e-3)
    assert 0 < path.factorisations < 100


def test_a_saddle_that_no_push_leaves_is_told(monkeypatch):
    monkeypatch.setattr(pseudo_transient._Creep, "_push", lambda creep, state, step: state)
    flat = strip(shorter=1.5 * np.pi**2 * THICKNESS**2 / (12.0 * SIDE))
    with pytest.raises(LoadStepFailed, match="ends at a saddle point"):
        relax(Path(flat, DirectSolver(), flat.start), 0.0)


def test_a_buckled_strip_snaps_at_its_limit_load_to_the_mirrored_state(arch):
    """Pushed in the middle it stays symmetric past the branching, as the path does, up to the limit load."""
    _, stopped = pushed(arch, settles=False)
    assert stopped.status is Status.STEP_LIMIT
    _, path = pushed(arch)
    assert path.status is Status.CONVERGED and path.load_factor == 1.0
    assert left_at(path) == pytest.approx(stopped.load_factor, rel=1e-3)
    assert 1.5 * LIMIT * left_at(path) == pytest.approx(LIMIT, rel=0.01)
    assert path.notes == [
        f"unstable before it snapped at load factor {left_at(path):.4g}: "
        "the tangent has 1 negative eigenvalues"
    ]
    assert LIMIT > 1.4 * BRANCHING
    _, other = pushed(mirrored(arch))
    assert not other.snaps and not other.notes and other.status is Status.CONVERGED
    assert path.state.q == pytest.approx(other.state.q, abs=1e-7)
    assert len(path.history) >= path.factorisations / 2


def test_pushed_beside_its_middle_a_stable_path_snaps_at_its_limit_load(arch):
    _, path = pushed(arch, at=0.6)
    assert path.status is Status.CONVERGED
    assert 1.5 * LIMIT * left_at(path) == pytest.approx(limit(0.6), rel=0.01)
    assert not path.notes  # stable until then
    assert heights(path.state).min() < -0.9 * heights(arch).max()


def rod_scene(turn, load_number):
    """A sheet on a rod bent to a share of a circle, under its weight."""
    rod = Curved(edge="x0", curvature=float(2.0 * np.pi * turn / stability_scenes.SIDE))
    return stability_scenes.sheet(0.008, load_number, supports=(rod,))


def chained():
    scene = scenes.load("one-edge-clamped")
    rod = Chain(
        edge="x1", segments=8, bending_stiffness=2e-3, line_density=0.05, radius=1.5e-3, curvature=4.0
    )
    return scene.model_copy(update={"actuators": (rod,)})


@pytest.fixture(scope="module")
def taped():
    """Bent down to a quarter of a circle, under a weight that folds it."""
    return rod_scene(-0.25, 10.0)


def test_a_tape_spring_snaps_as_the_lattice_does(taped):
    ours = lumped.solve(taped, lumped.calibrate(taped.sheet, taped.material, (17, 17)))
    truth = fem_reference.solve(taped, "shell", elements=6)
    assert truth.status is Status.CONVERGED and truth.load_factor == 1.0
    assert list(truth.snaps) == pytest.approx(list(ours.snaps), rel=0.05)
    points = taped.probe_points()
    assert error(ours.displacement(points), truth.displacement(points)) < 0.05
    assert truth.iterations <= len(truth.history) + 40


@pytest.mark.parametrize("scene", [rod_scene(0.1, 3.0), chained()], ids=["shell", "rods"])
def test_the_potential_is_that_of_the_residual_and_a_drag_begins_with_none(scene):
    """Along free positions, by central differences; a creep step begins with the forces of the sheet."""
    sheet = DiscreteShell(rectangle(scene.sheet, (3, 3), graded=True), scene)
    generator, factor, structure = np.random.default_rng(3), 0.7, Static(sheet)
    free = ~sheet.supports.position
    q, way = np.zeros((2, sheet.size))
    q[: 6 * sheet.nodes] = generator.normal(0.0, 1e-3, 6 * sheet.nodes)
    sheet.displacement(way)[free] = generator.normal(0.0, 1.0, int(free.sum()))
    step = 1e-6
    ahead, behind = (
        structure.potential(StaticState(q + sign * step * way), factor)[0] for sign in (1.0, -1.0)
    )
    state = StaticState(q)
    residual = structure.forces(state, factor).residual
    assert (ahead - behind) / (2.0 * step) == pytest.approx(residual @ way, rel=1e-6)
    slow = structure.creep_step(state, factor, 3.0).forces(state, factor).residual
    assert slow == pytest.approx(residual, rel=1e-9, abs=1e-9 * np.abs(residual).max())


@pytest.mark.parametrize("name", ["curved-edge", "two-edges-clamped"])
def test_a_path_that_reaches_the_full_load_is_the_same_to_the_last_digit(name):
    scene = scenes.load(name)
    structure = Static(DiscreteShell(rectangle(scene.sheet, (4, 4), graded=True), scene))
    with_it = trace_path(structure, DirectSolver(), settle=relax)
    without = trace_path(structure, DirectSolver())
    assert np.array_equal(with_it.state.q, without.state.q)
    assert with_it.factorisations == without.factorisations
    assert (with_it.status, with_it.snaps, with_it.notes) == (Status.CONVERGED, [], [])

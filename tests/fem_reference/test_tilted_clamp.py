"""A clamp turned about its edge: rigid turns, beams with turned ends, the models' agreement, refusals."""

import numpy as np
import pytest
from cases import GRAVITY, OBLONG, SILICONE, relative

import fem_reference
import lumped
from sheetbench.answers.solution import Status
from sheetbench.scenes import EDGES, Clamped, Curved, Held, Hinged, Scene, Symmetric

CUTS = (Symmetric(edge="y0"), Symmetric(edge="y1"))


def make_scene(*supports, gravity=None, **changes):
    return Scene(name="tilted", sheet=OBLONG, material=SILICONE, support=supports, gravity=gravity, **changes)


def solve(scene, model, size=(8, 4)):
    """size: elements, or cells of the lattice, along x and y; the shell's are even, the solid's graded."""
    if model.startswith("lumped"):
        springs = lumped.calibrate(scene.sheet, scene.material, (size[0] + 1, size[1] + 1))
        found = lumped.solve(scene, springs, linear=model == "lumped, linear")
    elif model.startswith("solid"):
        clamp = "full" if model == "solid, full" else "shell-like"
        found = fem_reference.solve(scene, model="solid", elements=size, clamp=clamp)
    else:
        even = {"graded": False} if model == "shell" else {}
        found = fem_reference.solve(scene, model=model, elements=size, **even)
    assert found.status is Status.CONVERGED, found.message
    return found


def points_of(sheet):
    return np.random.default_rng(2).uniform(0.0, 1.0, (40, 2)) * sheet.lengths


def rigid(edge, tilt, points):
    """Of a sheet that turns with its clamp, (n, 3): u = −r (n (cos τ − 1) + e_z sin τ), r from the edge."""
    at = EDGES[edge]
    inside = np.abs(points[:, at.normal_axis] - (OBLONG.lengths[at.normal_axis] if at.far_end else 0.0))
    turned = (np.cos(tilt) - 1.0) * np.array(at.outward) + np.sin(tilt) * np.array([0.0, 0.0, 1.0])
    return -inside[:, None] * turned


@pytest.mark.parametrize("model", ["lumped", "shell", "solid", "solid, full"])
@pytest.mark.parametrize(
    ("edge", "tilt", "more"),
    [("x0", 0.05, ()), ("x1", -0.6, ()), ("y0", 1.2, ()), ("y1", 1.5, ()), ("x0", 0.4, CUTS)],
)
def test_a_weightless_sheet_turns_with_its_clamp(model, edge, tilt, more):
    """Planes of symmetry let the clamp between them turn."""
    found = solve(make_scene(Clamped(edge=edge, tilt=tilt), *more), model, (4, 2))
    points = points_of(OBLONG)
    assert np.abs(found.displacement(points) - rigid(edge, tilt, points)).max() < 1e-9 * max(OBLONG.lengths)


@pytest.mark.parametrize("edge", EDGES)
def test_the_plate_turns_by_small_angles(edge):
    found = solve(make_scene(Clamped(edge=edge, tilt=0.3)), "plate", (4, 2))
    points = points_of(OBLONG)
    small = 1e6 * rigid(edge, 0.3e-6, points) * [0.0, 0.0, 1.0]
    assert np.abs(found.displacement(points) - small).max() < 1e-9 * max(OBLONG.lengths)


SMALL = 1e-5  # rad: the answers' own nonlinearity is 2 (τ L/h)² = 3e-7 of them


def bent_beam(first, second, x, shear=0.0):
    """Deflection of a beam of the sheet's length with ends clamped at slopes −first and +second, w = 0 there.

    Equal tilts bend it to a constant curvature, w = −τ x (1 − x/L); opposite ones (τ, −τ) to the cubic
    −τ x (1 − x/L)(1 − 2x/L)/(1 + Φ), Φ = 12 D/(κ G h L²) the beam's shear (Timoshenko 1921).
    """
    length = OBLONG.length_x
    alike, opposite, s = (first + second) / 2.0, (first - second) / 2.0, x / length
    w: np.ndarray = -x * (1.0 - s) * (alike + opposite * (1.0 - 2.0 * s) / (1.0 + shear))
    return w


SHEAR = (OBLONG.thickness / OBLONG.length_x) ** 2 / (1.0 - 0.3**2) * 2.0 * (1.0 + 0.3) / (5.0 / 6.0)


ENDS = [  # second tilt in τ, cells, sheet's shear, models with how far off
    (1.0, (8, 4), 0.0, {"plate": 1e-9, "shell": 2e-6, "solid": 2e-6, "lumped": 2e-6}),
    (-1.0, (16, 2), SHEAR, {"plate": 1e-8, "shell": 1e-8, "solid": 1e-3, "lumped": 5e-3}),
]


@pytest.mark.parametrize(
    ("model", "within", "second", "size", "shear"),
    [(model, within, *rest) for *rest, models in ENDS for model, within in models.items()],
)
def test_ends_tilted_alike_and_opposite_bend_the_strip_to_one_curvature_and_to_the_cubic(
    model, within, second, size, shear
):
    clamps = Clamped(edge="x0", tilt=SMALL), Clamped(edge="x1", tilt=second * SMALL)
    x = np.linspace(0.0, OBLONG.length_x, 17)
    found = solve(make_scene(*clamps, *CUTS), model, size)
    w = found.displacement(np.column_stack([x, 0.0 * x + 0.05]))[:, 2]
    exact = bent_beam(SMALL, second * SMALL, x, shear)
    assert w == pytest.approx(exact, abs=within * np.abs(exact).max())


@pytest.mark.sweep(2)
@pytest.mark.parametrize("other", [Hinged(edge="y0"), Held(edge="y0", components=("z",))])
def test_a_corner_shared_with_a_hinge_obeys_both(other):
    scene = make_scene(Clamped(edge="x0", tilt=0.2), other, gravity=GRAVITY)
    points = points_of(OBLONG)
    shell = solve(scene, "shell", (8, 4)).displacement(points)
    assert relative(solve(scene, "solid", (6, 3)).displacement(points), shell) < 0.02
    assert relative(solve(scene, "lumped", (24, 12)).displacement(points), shell) < 0.02


@pytest.mark.parametrize("support", [Clamped(edge="x0", tilt=0.3), Curved(edge="x0", curvature=4.0)])
def test_motion_starts_in_the_shape_of_the_supports_alone(support):
    scene, springs = make_scene(support), lumped.calibrate(OBLONG, SILICONE, (5, 3))
    run = lumped.simulate(scene.replace(gravity=GRAVITY), springs, 1e-3)
    still = lumped.solve(scene, springs).displacement(scene.probe_points())
    first = np.array([values[0] for values in run.probes.values()])
    assert np.abs(first - still).max() < 1e-6 * np.abs(still).max()


@pytest.mark.parametrize(
    "other",
    [
        Clamped(edge="y0"),
        Clamped(edge="y1", tilt=0.1),
        Curved(edge="y0", curvature=0.0),
        Curved(edge="y1", curvature=1.0),
    ],
)
def test_what_holds_the_director_otherwise_at_a_corner_is_refused(other):
    tilted = Clamped(edge="x0", tilt=0.1)
    for pair in ((tilted, other), (other, tilted)):
        with pytest.raises(ValueError, match="corner") as said:
            make_scene(*pair)
        assert "x0" in str(said.value) and other.edge in str(said.value)
    upright = other.model_copy(update={"tilt": 0.0} if isinstance(other, Clamped) else {"curvature": 0.0})
    make_scene(Clamped(edge="x0"), upright)

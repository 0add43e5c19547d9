"""Sensitivities of the lattice against differences of whole solutions, and the adjoint against them."""

import numpy as np
import pytest
from cases import calibrated, with_material

import lumped
from sheetbench import scenes
from sheetbench.scenes import Clamped, EdgeLoad, Mass
from sheetbench.scenes.meaning.parameters import parameter, put
from sheetbench.scenes.objects.patches import Patch

GRID = (7, 7)
DRAWN = {
    "sheet": scenes.Sheet(0.188, 0.188, 0.003, taper_x=(0.003, 0.002)),
    "patches": (
        Patch(shape={"circle": {"centre": (0.1, 0.1), "radius": 0.05}}, young=9e7, density=900.0),
        Patch(shape={"rectangle": {"x": (0.0, 0.03), "y": (0.0, 0.188)}}, thickness=0.004, poisson=0.3),
    ),
}
OF_PATCHES = ("patch1.young", "patch1.density", "patch2.thickness", "patch2.poisson")
BODY = Mass(at=(0.188, 0.094), mass=5e-3)
MOMENT = EdgeLoad(edge="x1", moment_per_length=0.2)  # follows the sheet


def scene_of(name, **changes):
    return scenes.load(name).model_copy(update=changes)


def assert_close(mine, theirs, within=2e-5):
    assert np.abs(theirs).max() > 0.0
    assert np.abs(mine - theirs).max() < within * np.abs(theirs).max()


@pytest.mark.parametrize("grid", [(7, 7), (5, 9)])
def test_every_spring_constant(grid):
    scene = scene_of("two-edges-clamped")
    springs = calibrated(scene, grid)
    names = [*springs.constants.names(), "layer_distance"]
    assert len(names) >= 8
    found = lumped.sensitivity(scene, springs, names)
    for name in names:
        value = springs.constants.value(name)

        up, down = (
            lumped.solve(scene, springs.with_constant(name, value + h)).displacement(scene.probe_points())
            for h in (1e-4 * value, -1e-4 * value)
        )
        expected = (up - down) / (2e-4 * value)
        scale = np.abs(found.displacement).max() / abs(value)
        assert np.abs(found.derivatives[name] - expected).max() < 2e-7 * scale, name


@pytest.mark.parametrize(
    "base, changes, name, h",
    [
        *(("one-edge-clamped", {}, name, None) for name in ("young", "poisson", "density", "thickness")),
        ("curved-edge", {}, "curvature_x0", 1e-3),
        *(
            ("one-edge-clamped", {"supports": (Clamped(edge="x0", tilt=tilt),)}, "tilt_x0", 1e-3)
            for tilt in (0.0, 0.1, -0.7)
        ),
        ("one-edge-clamped", {"gravity": None, "loads": (MOMENT,)}, "young", None),
        *(("one-edge-clamped", {"masses": (BODY,)}, name, None) for name in ("mass1", "young")),
        *(("one-edge-clamped", DRAWN, name, None) for name in (*OF_PATCHES, "thickness")),
    ],
)
def test_parameters_of_a_scene(base, changes, name, h):
    scene = scene_of(base, **changes)
    found = lumped.sensitivity(scene, calibrated(scene, GRID), [name])
    value = parameter(scene, name).value
    h = h or 1e-4 * value
    changed = [put(scene, name, at) for at in (value + h, value - h)]
    up, down = (lumped.solve(at, calibrated(at, GRID)).displacement(scene.probe_points()) for at in changed)
    assert_close(found.derivatives[name], (up - down) / (2 * h))


def test_at_a_bound_the_difference_is_one_sided():
    slopes = []
    for poisson in (0.4999, 0.4999 - 1e-3):
        scene = with_material(scene_of("one-edge-clamped"), poisson=poisson)
        found = lumped.sensitivity(scene, calibrated(scene, 3), ["poisson"])
        slopes.append(found.derivatives["poisson"])
    assert_close(*slopes, within=1e-2)


def test_the_tilt_of_one_of_two_clamps_that_share_a_corner_is_refused():
    scene = scene_of("two-edges-clamped")
    with pytest.raises(ValueError, match=r"tilt_x0.*corner"):
        lumped.sensitivity(scene, calibrated(scene, GRID), ["tilt_x0"])

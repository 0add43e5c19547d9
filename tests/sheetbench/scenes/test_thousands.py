"""Scenes of a thousand parts: the cost of reading them grows about in proportion to their number."""

from time import process_time

import numpy as np
import pytest

from sheetbench.scenes import Scene, SceneError, free_rigid_motions
from sheetbench.scenes.meaning.composition import mass_of

SIDE = 0.5
GROWTH = 9.0  # of the processor's time for four times as many parts; one shape at a time takes 14 to 18
ROOT = {"kind": "clamped", "edge": "x0"}


def scene(**parts):
    keys = {"sheet": {"length_x": SIDE, "length_y": SIDE, "thickness": 0.002}, "support": [ROOT], **parts}
    material = {"young": 1e6, "poisson": 0.4, "density": 1000.0}
    return Scene(name="many", material=material, gravity={"acceleration": (0.0, 0.0, -9.81)}, **keys)


def circles(count, share, shift=0.0):
    """So many circles on a square grid, of a share of its spacing as their radius."""
    across = int(np.ceil(np.sqrt(count)))
    places = 0.02 + shift + 0.46 * np.arange(across) / across
    centres = [(x, y) for y in places for x in places][:count]
    return [{"circle": {"centre": at, "radius": share * 0.46 / across}} for at in centres]


def row(count):
    """So many circles, each moved a little beside the one before."""
    return [{"circle": {"centre": (0.1 + 0.3 * i / count, 0.2), "radius": 0.01}} for i in range(count)]


def hold(shapes, **more):
    return [{"kind": "clamped", "where": shape, **more} for shape in shapes]


LIFTED = {"motion": {"time": [0.0, 1.0], "displacement": [[0.0, 0.0, 0.0], [0.0, 0.0, 0.001]]}}


def beside_cutouts(count):
    between = circles(count, 0.1, shift=0.23 / int(np.ceil(np.sqrt(count))))
    cutouts = [{"shape": shape} for shape in circles(count, 0.2)]
    return scene(cutout=cutouts, support=[*hold(between[::2]), *hold(between[1::2], **LIFTED)])


MANY = {
    "cutouts": lambda n: scene(cutout=[{"shape": shape} for shape in circles(n, 0.3)]),
    "cutouts upon each other": lambda n: scene(cutout=[{"shape": shape} for shape in row(n)]),
    "supports upon each other": lambda n: scene(support=[ROOT, *hold(row(3 * n))]),
    "supports beside cutouts": beside_cutouts,
    "patches": lambda n: scene(patch=[{"shape": shape, "young": 2e6} for shape in circles(n, 0.3)]),
}


@pytest.mark.nightly
@pytest.mark.parametrize("parts", MANY)
def test_cost_of_a_scene_grows_less_than_quadratically(parts):
    times = []
    for count in (100, 250, 1000):  # the first loads what is imported at its use
        began = process_time()
        many = MANY[parts](count)
        assert not free_rigid_motions(many) and mass_of(many) > 0.0
        times.append(process_time() - began)
    assert times[2] < GROWTH * times[1]


def test_of_many_the_first_that_is_wrong_is_named():
    shapes = circles(100, 0.3)
    with pytest.raises(SceneError, match=r"cutout 101\.shape: circle .* no part of it is on what is left"):
        scene(cutout=[{"shape": shape} for shape in [*shapes, shapes[50]]])
    small = [{"rectangle": {"x": (0.1 + a, 0.1 + b), "y": (0.1, 0.2)}} for a, b in ((0, 0.05), (0.05, 0.1))]
    both = {"rectangle": {"x": (0.12, 0.18), "y": (0.12, 0.18)}}
    with pytest.raises(SceneError, match=r"cutout 3\.shape"):  # within the two before it
        scene(cutout=[{"shape": shape} for shape in (*small, both)])
    assert scene(cutout=[{"shape": shape} for shape in (both, *small)]).region.area == pytest.approx(0.24)
    with pytest.raises(SceneError, match="support 7 and support 101 move the same part of the sheet"):
        scene(support=[*hold(shapes), *hold([shapes[6]], **LIFTED)])
    with pytest.raises(SceneError, match="support 1 and x0 move the same part of the sheet"):
        edge = {"rectangle": {"x": (0.0, 0.1), "y": (0.0, 0.1)}}
        scene(support=[*hold([edge], **LIFTED), ROOT])

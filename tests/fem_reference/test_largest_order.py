"""The largest order of a scene's meshes: what makes its solution less smooth."""

import pytest

from fem_reference.uncertainty import largest_order
from sheetbench.scenes import Scene

INNER = {"rectangle": {"x": (0.05, 0.1), "y": (0.03, 0.06)}}
STRIP = {"rectangle": {"x": (0.0, 0.05), "y": (0.0, 0.1)}}
CORNER = {"rectangle": {"x": (0.1, 0.15), "y": (0.0, 0.05)}}
DISC = {"circle": {"centre": (0.07, 0.05), "radius": 0.02}}
HINGE = {"kind": "hinged", "edge": "x0"}
PLACES = (0.01, 0.01), (0.14, 0.01), (0.07, 0.09)


def points(*components):
    return [
        {"kind": "point", "at": at, "components": list(c)} for at, c in zip(PLACES, components, strict=False)
    ]


def ball(kind="sphere", **more):
    return {"kind": kind, "position": (0.07, 0.05, -0.1), **more}


@pytest.mark.parametrize(
    ("order", "changes"),
    [
        (3.0, {}),
        (1.5, {"obstacle": [ball(radius=0.05)]}),
        (1.5, {"obstacle": [ball("box", size=(0.1, 0.1, 0.1), radius=0.01)]}),
        (2.0, {"obstacle": [ball("cylinder", axis=(1.0, 0.0, 0.0), radius=0.05)]}),
        (2.0, {"cutout": [{"shape": DISC}]}),
        (1.5, {"cutout": [{"shape": INNER}]}),
        (1.5, {"cutout": [{"shape": CORNER}]}),
        (1.5, {"patch": [{"shape": INNER, "young": 1e8}]}),
        (3.0, {"patch": [{"shape": STRIP, "young": 1e8}]}),
        (3.0, {"patch": [{"shape": INNER, "natural": {"strain": (0.1, 0.0, 0.0)}}]}),
        (1.0, {"support": [{"kind": "clamped", "where": INNER}]}),
        (3.0, {"support": [{"kind": "clamped", "where": STRIP}]}),
        (1.5, {"support": points("xyz", "yz", "z")}),
        (0.7, {"support": points("xyz", "xyz", "z")}),
        (1.5, {"support": [HINGE, *points("z")]}),
        (0.7, {"support": [HINGE, *points("xyz")]}),
    ],
)
def test_the_largest_order_is_by_the_least_smooth_part(order, changes):
    sheet = {"length_x": 0.15, "length_y": 0.1, "thickness": 0.001}
    base = {"name": "a", "sheet": sheet, "material": {"young": 1e6, "poisson": 0.3, "density": 1e3}}
    assert largest_order(Scene.model_validate({**base, "support": [HINGE], **changes})) == order

"""Scenes of the transfer study: two training scenes for springs, and test scenes.

All are Habibi et al.'s sheet or a change of it. The linear pair is the training pair under a thousandth of
its weight: there a calibration's wrong limit is one of bending alone.
"""

from collections.abc import Mapping
from typing import Any

from sheetbench.scenes import Scene, load

TRAINING = ("one-edge-clamped", "two-edges-clamped")
LINEAR = ("one-edge-linear", "two-edges-linear")
MODAL = (*TRAINING, "opposite-edges-clamped", "three-edges-clamped", "opposite-edges-hinged")
HELD_OUT = (*TRAINING, "opposite-edges-clamped", "three-edges-clamped")  # of the leave-one-out study


def transfer_scenes() -> dict[str, Scene]:
    """Return every scene of the study by name, the training scenes first."""
    one_edge, two_edges = (load(name) for name in TRAINING)

    def changed(base: Scene, name: str, **changes: Any) -> Scene:
        data = base.model_dump(by_alias=True, exclude_none=True) | {"name": name, "title": ""} | changes
        return Scene.model_validate(_without_none(data))

    def clamped(*edges: str) -> list[dict[str, str]]:
        return [{"edge": edge, "kind": "clamped"} for edge in edges]

    def hinged(*edges: str) -> list[dict[str, str]]:
        return [{"edge": edge, "kind": "hinged"} for edge in edges]

    def sheet(factor: float) -> dict[str, float]:
        return two_edges.sheet.model_dump() | {"thickness": factor * two_edges.sheet.thickness}

    soft = two_edges.material.model_dump() | {"young": two_edges.material.young / 10.0}
    feather = {"acceleration": [0.0, 0.0, -9.81e-3]}
    corner = [{"kind": "point", "at": [0.188, 0.188], "force": [0.0, 0.0, 0.1]}]
    off_centre = [{"kind": "point", "at": [0.141, 0.047], "force": [0.0, 0.0, -0.05]}]
    blown = [{"kind": "pressure", "value": 200.0}]
    scenes = [
        one_edge,
        two_edges,
        changed(one_edge, LINEAR[0], gravity=feather),
        changed(two_edges, LINEAR[1], gravity=feather),
        changed(two_edges, "opposite-edges-clamped", support=clamped("x0", "x1"), probes={}),
        changed(two_edges, "three-edges-clamped", support=clamped("x0", "x1", "y0"), probes={}),
        changed(two_edges, "opposite-edges-hinged", support=hinged("x0", "x1"), probes={}),
        changed(two_edges, "four-edges-hinged", support=hinged("x0", "x1", "y0", "y1"), probes={}),
        changed(two_edges, "point-load-at-corner", load=corner, gravity=None),
        changed(one_edge, "point-load-off-centre", load=off_centre, gravity=None),
        load("curved-edge"),
        load("curved-edge-down"),
        changed(two_edges, "half-thickness", sheet=sheet(0.5)),
        changed(two_edges, "double-thickness", sheet=sheet(2.0)),
        changed(two_edges, "tenth-of-young", material=soft),
        changed(one_edge, "tenth-of-young-one-edge", material=soft),
        changed(two_edges, "pressure", load=blown, gravity=None),
    ]
    return {scene.name: scene for scene in scenes}


def _without_none(data: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in data.items() if value is not None}

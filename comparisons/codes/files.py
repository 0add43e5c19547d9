"""The files of a sheet of triangles, by code: sheet.json, a script that needs the code and NumPy alone, and
what else the code reads. `Problem` is what every writer starts from.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.resources import files as resources
from typing import Any

import numpy as np

from comparisons.codes.mujoco import sheet_mjcf
from comparisons.codes.sheet_mesh import SheetMesh

Keys = Mapping[str, float]
OBJ, JSON = "sheet.obj", "sheet.json"


@dataclass(frozen=True)
class Problem:
    """A mesh, the code's parameters by name, and the membrane's C11 [N/m], which bounds the steps.
    clamp: factor of hinges that lie on a clamp."""

    mesh: SheetMesh
    keys: Keys
    stretching: float
    tetrahedra: np.ndarray | None = None
    clamp: float = 1.0


def _script(code: str) -> str:
    return (resources("comparisons.codes") / "scripts" / f"run_{code}.py").read_text(encoding="utf-8")


def _json(value: Any) -> str:
    return json.dumps(value, indent=1) + "\n"


def _numbers(values: Any) -> str:
    return " ".join(map(repr, np.asarray(values).ravel().tolist()))


def python_files(code: str, of: Problem) -> dict[str, str]:
    """sheet.json and the code's script."""
    document = {
        **of.mesh.document(),
        "parameters": dict(of.keys),
        "stretching": of.stretching,
        "clamp": of.clamp,
    }
    return {JSON: _json(document), f"run_{code}.py": _script(code)}


def obj(mesh: SheetMesh) -> str:
    """Wavefront OBJ."""
    lines = [f"v {_numbers(place)}" for place in mesh.vertices]
    lines += ["f " + " ".join(str(1 + v) for v in t) for t in mesh.triangles.tolist()]
    return "\n".join(lines) + "\n"


def mujoco(of: Problem) -> dict[str, str]:
    """MJCF, sheet.json and the script."""
    return {"mujoco.xml": sheet_mjcf(of.mesh, of.keys), **python_files("mujoco", of)}


def pybullet(of: Problem) -> dict[str, str]:
    """VTK of tetrahedra, whose sides are the springs, beside sheet.json and the script."""
    assert of.tetrahedra is not None
    lines = ["# vtk DataFile Version 2.0", "sheet", "ASCII", "DATASET UNSTRUCTURED_GRID"]
    lines += [f"POINTS {len(of.mesh.vertices)} double", *map(_numbers, of.mesh.vertices)]
    lines += [f"CELLS {len(of.tetrahedra)} {of.tetrahedra.size + len(of.tetrahedra)}"]
    lines += [f"4 {_numbers(cell)}" for cell in of.tetrahedra]
    lines += [f"CELL_TYPES {len(of.tetrahedra)}", *["10"] * len(of.tetrahedra)]
    return {"sheet.vtk": "\n".join(lines) + "\n", **python_files("pybullet", of)}


def genesis(of: Problem) -> dict[str, str]:
    """OBJ, sheet.json and the script."""
    return {OBJ: obj(of.mesh), **python_files("genesis", of)}


OWN_MASSES = ("newton", "mujoco", "genesis")  # those whose files give each vertex a mass of its own
OBSTACLES = ("newton", "mujoco")  # those whose files have them
WRITERS: Mapping[str, Callable[[Problem], dict[str, str]]] = {
    "newton": lambda of: python_files("newton", of),
    "mujoco": mujoco,
    "pybullet": pybullet,
    "genesis": genesis,
}

"""The question: sheet, material, supports, loads, probes, the catalogue; no solver, no answer."""

from importlib import import_module
from typing import TYPE_CHECKING

from sheetbench.errors import BadInput, Implausible, SceneError
from sheetbench.scenes.files import AnyScene, catalogue, load, scene_of
from sheetbench.scenes.meaning.composition import require_plain, require_uniform
from sheetbench.scenes.meaning.region import require_rectangle
from sheetbench.scenes.meaning.rigid_motions import free_rigid_motions, require_static
from sheetbench.scenes.meaning.strains import outside_model, weight_strain
from sheetbench.scenes.objects.actuators import Actuator, Chain, CurvatureTable, EdgeMotion
from sheetbench.scenes.objects.air import Air
from sheetbench.scenes.objects.cells import Cells, Constants
from sheetbench.scenes.objects.cutouts import Cutout
from sheetbench.scenes.objects.layers import Layer
from sheetbench.scenes.objects.loads import AreaLoad, EdgeLoad, Load, PointLoad, Pressure
from sheetbench.scenes.objects.masses import Mass
from sheetbench.scenes.objects.material import Material, require_no_branches
from sheetbench.scenes.objects.obstacles import Cylinder, Plane, Sphere
from sheetbench.scenes.objects.patches import Patch
from sheetbench.scenes.objects.relaxation import Branches, Relaxation
from sheetbench.scenes.objects.sheet import EDGES, Edge, Gravity, Sheet
from sheetbench.scenes.objects.springs import DamperSet, PerDirection, SpringSet, SpringTable
from sheetbench.scenes.objects.supports import (
    Clamped,
    Curved,
    Held,
    Hinged,
    Motion,
    Point,
    Support,
    Symmetric,
    encloses_volume,
    held_axes,
    holds_director,
    holds_tilt,
)
from sheetbench.scenes.objects.tables import FactorTable, PiecewiseLinear
from sheetbench.scenes.scene import Scene

if TYPE_CHECKING:
    from sheetbench.answers.balance import Balance, dead_force
    from sheetbench.answers.history import History
    from sheetbench.answers.solution import About, FieldMesh, Iteration, Solution, Status, comparable

__all__ = [
    "EDGES",
    "About",
    "Actuator",
    "Air",
    "AnyScene",
    "AreaLoad",
    "BadInput",
    "Balance",
    "Branches",
    "Cells",
    "Chain",
    "Clamped",
    "Constants",
    "CurvatureTable",
    "Curved",
    "Cutout",
    "Cylinder",
    "DamperSet",
    "Edge",
    "EdgeLoad",
    "EdgeMotion",
    "FactorTable",
    "FieldMesh",
    "Gravity",
    "Held",
    "Hinged",
    "History",
    "Implausible",
    "Iteration",
    "Layer",
    "Load",
    "Mass",
    "Material",
    "Motion",
    "Patch",
    "PerDirection",
    "PiecewiseLinear",
    "Plane",
    "Point", "PointLoad",
    "Pressure",
    "Relaxation",
    "Scene",
    "SceneError",
    "Sheet",
    "Solution",
    "Sphere",
    "SpringSet",
    "SpringTable",
    "Status",
    "Support",
    "Symmetric",
    "catalogue",
    "comparable",
    "dead_force",
    "encloses_volume",
    "free_rigid_motions",
    "held_axes",
    "holds_director",
    "holds_tilt",
    "load",
    "outside_model",
    "require_no_branches",
    "require_plain",
    "require_rectangle",
    "require_static",
    "require_uniform",
    "scene_of",
    "weight_strain",
]  # fmt: skip

_ANSWERS = {  # imported from here too; they import the scenes themselves
    "balance": "Balance dead_force",
    "history": "History",
    "solution": "About FieldMesh Iteration Solution Status comparable",
}
_ANSWER_OF = {name: room for room, names in _ANSWERS.items() for name in names.split()}


def __getattr__(name: str) -> object:
    if name not in _ANSWER_OF:
        raise AttributeError(f"module 'sheetbench.scenes' has no attribute {name!r}")
    return getattr(import_module(f"sheetbench.answers.{_ANSWER_OF[name]}"), name)

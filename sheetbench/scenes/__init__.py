"""The problem: sheet, material, supports, loads, probes, the catalogue, published figures; no solver."""

from sheetbench.errors import BadInput, Implausible, SceneError
from sheetbench.scenes.actuators import Actuator, Chain, CurvatureTable, EdgeMotion
from sheetbench.scenes.air import Air
from sheetbench.scenes.balance import Balance, dead_force
from sheetbench.scenes.cells import Cells, Constants
from sheetbench.scenes.contact import ContactState
from sheetbench.scenes.files import AnyScene, catalogue, load, scene_of
from sheetbench.scenes.history import History
from sheetbench.scenes.layers import Layer
from sheetbench.scenes.loads import AreaLoad, EdgeLoad, Load, PointLoad, Pressure
from sheetbench.scenes.masses import Mass
from sheetbench.scenes.material import Material, require_no_branches
from sheetbench.scenes.obstacles import Cylinder, Plane, Sphere
from sheetbench.scenes.patches import Patch, require_plain, require_uniform
from sheetbench.scenes.region import Cutout, require_rectangle
from sheetbench.scenes.relaxation import Branches, Relaxation
from sheetbench.scenes.rigid_motions import free_rigid_motions, require_static
from sheetbench.scenes.scene import Scene
from sheetbench.scenes.sheet import EDGES, Edge, Gravity, Sheet
from sheetbench.scenes.solution import About, FieldMesh, Iteration, Solution, Status, comparable
from sheetbench.scenes.springs import DamperSet, PerDirection, SpringSet, SpringTable
from sheetbench.scenes.strains import outside_model, weight_strain
from sheetbench.scenes.supports import (
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
from sheetbench.scenes.tables import FactorTable, PiecewiseLinear

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
    "ContactState",
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

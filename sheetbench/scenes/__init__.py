"""The question to a model: sheet, material, supports, loads, probes, the catalogue; no solver, no answer."""

from sheetbench.errors import BadInput, Implausible, SceneError
from sheetbench.scenes.files import AnyScene, catalogue, load, scene_of
from sheetbench.scenes.meaning.composition import require_plain, require_rectangle, require_uniform
from sheetbench.scenes.meaning.rigid_motions import free_rigid_motions, require_static
from sheetbench.scenes.meaning.strains import outside_model, weight_strain
from sheetbench.scenes.objects.actuators import Chain, CurvatureTable, EdgeMotion
from sheetbench.scenes.objects.air import Air
from sheetbench.scenes.objects.cells import Cells, Constants
from sheetbench.scenes.objects.cutouts import Cutout
from sheetbench.scenes.objects.layers import Layer
from sheetbench.scenes.objects.loads import AreaLoad, EdgeLoad, Initial, Load, PointLoad, Pressure
from sheetbench.scenes.objects.masses import Mass
from sheetbench.scenes.objects.material import Material, require_no_branches
from sheetbench.scenes.objects.natural import Natural, Temperature
from sheetbench.scenes.objects.obstacles import Box, Cylinder, Plane, Sphere
from sheetbench.scenes.objects.patches import Patch
from sheetbench.scenes.objects.relaxation import Branches, Relaxation
from sheetbench.scenes.objects.shapes import Circle, Rectangle, Shape
from sheetbench.scenes.objects.sheet import EDGES, Gravity, Sheet
from sheetbench.scenes.objects.springs import DamperSet, PerDirection, SpringSet
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
    tilt_axes,
)
from sheetbench.scenes.objects.tables import FactorTable, PiecewiseCurve
from sheetbench.scenes.scene import Scene

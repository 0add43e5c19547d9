"""Names of `import sheetbench` for type checkers: made by `make stubs`, not by hand."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, overload

from comparisons.models.spec import Spec
from sheetbench import scenes as scenes
from sheetbench.scenes.objects.grading import Grading

from comparisons.calibration.calibrate import SheetCalibration
from comparisons.codes.cell import Cell as Cell
from comparisons.codes.cell import cell_of as cell
from comparisons.codes.cell_moduli import CellModuli
from comparisons.codes.inverse import SheetOfCode
from comparisons.codes.setup import CodeSetup
from comparisons.comparison.answer import Comparison
from comparisons.comparison.crosscheck_answer import Crosscheck
from comparisons.comparison.motion_answer import MotionComparison
from comparisons.comparison.simulation import Simulation
from comparisons.identification.answer import Identification
from comparisons.identification.field import FieldIdentification
from comparisons.identification.measurements import Displacements as Displacements
from comparisons.identification.tensile.tensile import TensileFit
from comparisons.models.catalogue import Catalogue
from comparisons.models.catalogue import Schema
from comparisons.models.check import Check
from comparisons.models.spec import Elements as Elements
from comparisons.models.spec import External as External
from comparisons.models.spec import Lattice as Lattice
from comparisons.modes.answer import Spectra
from comparisons.modes.state_space import Linearisation
from comparisons.scoring.score import Score
from comparisons.scoring.suite import Suite
from comparisons.stability.answer import Stability
from comparisons.sweep.differences import error as error
from comparisons.sweep.variation import Variation
from comparisons.tradeoff.advice import Advice
from comparisons.tradeoff.answer import DynamicTradeoff
from comparisons.tradeoff.answer import Tradeoff
from fem_reference.verification.cases import Verification
from sheetbench.answers.history import History as History
from sheetbench.answers.solution import Solution as Solution
from sheetbench.answers.solution import Status as Status
from sheetbench.face import solve as solve
from sheetbench.face import study as study
from sheetbench.scenes import Air as Air
from sheetbench.scenes import AreaLoad as AreaLoad
from sheetbench.scenes import BadInput as BadInput
from sheetbench.scenes import Box as Box
from sheetbench.scenes import Chain as Chain
from sheetbench.scenes import Circle as Circle
from sheetbench.scenes import Clamped as Clamped
from sheetbench.scenes import CurvatureTable as CurvatureTable
from sheetbench.scenes import Curved as Curved
from sheetbench.scenes import Cutout as Cutout
from sheetbench.scenes import Cylinder as Cylinder
from sheetbench.scenes import DamperSet as Dampers
from sheetbench.scenes import EdgeLoad as EdgeLoad
from sheetbench.scenes import EdgeMotion as EdgeMotion
from sheetbench.scenes import FactorTable as FactorTable
from sheetbench.scenes import Gravity as Gravity
from sheetbench.scenes import Held as Held
from sheetbench.scenes import Hinged as Hinged
from sheetbench.scenes import Implausible as Implausible
from sheetbench.scenes import Initial as Initial
from sheetbench.scenes import Layer as Layer
from sheetbench.scenes import Mass as Mass
from sheetbench.scenes import Material as Material
from sheetbench.scenes import Motion as Motion
from sheetbench.scenes import Natural as Natural
from sheetbench.scenes import Patch as Patch
from sheetbench.scenes import PerDirection as PerDirection
from sheetbench.scenes import Plane as Plane
from sheetbench.scenes import Point as Point
from sheetbench.scenes import PointLoad as PointLoad
from sheetbench.scenes import Pressure as Pressure
from sheetbench.scenes import Rectangle as Rectangle
from sheetbench.scenes import Relaxation as Relaxation
from sheetbench.scenes import Scene as Scene
from sheetbench.scenes import SceneError as SceneError
from sheetbench.scenes import Shape as Shape
from sheetbench.scenes import Sheet as Sheet
from sheetbench.scenes import Sphere as Sphere
from sheetbench.scenes import SpringSet as Springs
from sheetbench.scenes import Symmetric as Symmetric
from sheetbench.scenes import Temperature as Temperature
from sheetbench.scenes import catalogue as catalogue
from sheetbench.scenes import load as load

def new(file: str | Path, *, young: float | str | None = ..., poisson: float | str | None = ..., thickness: float | str | None = ..., density: float | str | None = ..., side: float | Sequence[float] | str | None = ..., clamped: Sequence[str] | str | None = ..., overwrite: bool = ...) -> Path: ...
def check(scene: Scene | str | Path | None = ..., *, schema: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ...) -> Check | Catalogue | Schema: ...
@overload
def compare(scene: Scene | str | Path, lattice: Lattice | None = ..., reference: Spec | str = ..., *, grid: int | Sequence[int] | str | None = ..., calibration: str | None = ..., k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., elements: int | Sequence[int] | str | None = ..., law: str | None = ..., model: Sequence[Spec | str] | Spec | str | None = ..., uncertainty: bool | None = ..., branch: str | None = ..., settle: bool = ..., sensitivity: Sequence[str] | str | None = ..., duration: None = ..., every: float | str | None = ..., animate: bool = ..., large: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: int | Sequence[int] | str | None = ...) -> Comparison: ...
@overload
def compare(scene: Scene | str | Path, lattice: Lattice | None = ..., reference: Spec | str = ..., *, grid: int | Sequence[int] | str | None = ..., calibration: str | None = ..., k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., elements: int | Sequence[int] | str | None = ..., law: str | None = ..., model: Sequence[Spec | str] | Spec | str | None = ..., uncertainty: bool | None = ..., branch: str | None = ..., settle: bool = ..., sensitivity: Sequence[str] | str | None = ..., duration: float | str, every: float | str | None = ..., animate: bool = ..., large: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: int | Sequence[int] | str | None = ...) -> MotionComparison: ...
def simulate(scene: Scene | str | Path, duration: float | str = ..., *, lattice: Lattice | None = ..., grid: int | Sequence[int] | str | None = ..., calibration: str | None = ..., k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., step: float | str | None = ..., error: float | str | None = ..., integrator: str = ..., every: float | str | None = ..., animate: bool = ..., large: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: int | Sequence[int] | str | None = ...) -> Simulation: ...
def sweep(scene: Scene | str | Path, vary: Mapping[str, Any] | Sequence[str] | str, lattice: Lattice | None = ..., *, grid: int | Sequence[int] | str | None = ..., calibration: str | None = ..., k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., reference: Spec | str = ..., elements: int | Sequence[int] | str | None = ..., law: str | None = ..., model: Sequence[Spec | str] | Spec | str | None = ..., large: bool = ..., workers: int | None = ..., scheduler: str | None = ..., retry: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: int | Sequence[int] | str | None = ...) -> Variation: ...
@overload
def tradeoff(scene: Scene | str | Path, lattice: Lattice | None = ..., *, k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., tolerance: None = ..., budget: None = ..., grid: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., calibration: Sequence[str] | str | None = ..., plate: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., shell: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., solid: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., model: Sequence[Spec | str] | Spec | str | None = ..., elements: int | Sequence[int] | str | None = ..., repeats: int | None = ..., duration: None = ..., integrator: Sequence[str] | str | None = ..., large: bool = ..., workers: int | None = ..., scheduler: str | None = ..., retry: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ...) -> Tradeoff: ...
@overload
def tradeoff(scene: Scene | str | Path, lattice: Lattice | None = ..., *, k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., tolerance: None = ..., budget: None = ..., grid: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., calibration: Sequence[str] | str | None = ..., plate: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., shell: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., solid: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., model: Sequence[Spec | str] | Spec | str | None = ..., elements: int | Sequence[int] | str | None = ..., repeats: int | None = ..., duration: float | str, integrator: Sequence[str] | str | None = ..., large: bool = ..., workers: int | None = ..., scheduler: str | None = ..., retry: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ...) -> DynamicTradeoff: ...
@overload
def tradeoff(scene: Scene | str | Path, lattice: Lattice | None = ..., *, k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., tolerance: float | str, budget: float | str | None = ..., grid: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., calibration: Sequence[str] | str | None = ..., plate: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., shell: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., solid: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., model: Sequence[Spec | str] | Spec | str | None = ..., elements: int | Sequence[int] | str | None = ..., repeats: int | None = ..., duration: None = ..., integrator: Sequence[str] | str | None = ..., large: bool = ..., workers: int | None = ..., scheduler: str | None = ..., retry: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ...) -> Advice: ...
@overload
def tradeoff(scene: Scene | str | Path, lattice: Lattice | None = ..., *, k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., tolerance: float | str | None = ..., budget: float | str, grid: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., calibration: Sequence[str] | str | None = ..., plate: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., shell: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., solid: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., model: Sequence[Spec | str] | Spec | str | None = ..., elements: int | Sequence[int] | str | None = ..., repeats: int | None = ..., duration: None = ..., integrator: Sequence[str] | str | None = ..., large: bool = ..., workers: int | None = ..., scheduler: str | None = ..., retry: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ...) -> Advice: ...
def stability(scene: Scene | str | Path, lattice: Lattice | None = ..., *, grid: int | Sequence[int] | str | None = ..., calibration: str | None = ..., k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., vary: Sequence[str] | str | None = ..., reference: Spec | str = ..., elements: int | Sequence[int] | str = ..., large: bool = ..., workers: int | None = ..., scheduler: str | None = ..., retry: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: int | Sequence[int] | str | None = ...) -> Stability: ...
def crosscheck(scenes: Sequence[Scene | str | Path] | Scene | str | Path, lattice: Lattice | None = ..., *, k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., grid: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., calibration: str | None = ..., plate: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., shell: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., solid: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., judges: Sequence[str] | str | None = ..., meshes: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ..., large: bool = ..., workers: int | None = ..., scheduler: str | None = ..., retry: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: Sequence[int | Sequence[int] | str] | int | Sequence[int] | str | None = ...) -> Crosscheck: ...
@overload
def calibrate(scene: Scene | str | Path | None = ..., *, young: float | str | None = ..., poisson: float | str | None = ..., thickness: float | str | None = ..., density: float | str | None = ..., side: float | Sequence[float] | str | None = ..., lattice: Lattice | None = ..., grid: int | Sequence[int] | str | None = ..., calibration: str | None = ..., k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., toml: bool = ..., export: str | Path | None = ..., for_: None = ..., precision: str | None = ..., from_: None = ..., cell: None = ..., spacing: float | str | None = ..., hinge: str | None = ..., coefficient: Mapping[str, Any] | Sequence[str] | str | None = ..., loss_factor: float | str | None = ..., at: float | str | None = ..., band: tuple[float, float] | None = ..., prony: str | Path | None = ..., large: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: int | Sequence[int] | str | None = ...) -> SheetCalibration: ...
@overload
def calibrate(scene: Scene | str | Path | None = ..., *, young: float | str | None = ..., poisson: float | str | None = ..., thickness: float | str | None = ..., density: float | str | None = ..., side: float | Sequence[float] | str | None = ..., lattice: Lattice | None = ..., grid: int | Sequence[int] | str | None = ..., calibration: str | None = ..., k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., toml: bool = ..., export: str | Path | None = ..., for_: str, precision: str | None = ..., from_: None = ..., cell: None = ..., spacing: float | str | None = ..., hinge: str | None = ..., coefficient: Mapping[str, Any] | Sequence[str] | str | None = ..., loss_factor: float | str | None = ..., at: float | str | None = ..., band: tuple[float, float] | None = ..., prony: str | Path | None = ..., large: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: int | Sequence[int] | str | None = ...) -> SheetCalibration | CodeSetup: ...
@overload
def calibrate(scene: Scene | str | Path | None = ..., *, young: float | str | None = ..., poisson: float | str | None = ..., thickness: float | str | None = ..., density: float | str | None = ..., side: float | Sequence[float] | str | None = ..., lattice: Lattice | None = ..., grid: int | Sequence[int] | str | None = ..., calibration: str | None = ..., k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., toml: bool = ..., export: str | Path | None = ..., for_: None = ..., precision: str | None = ..., from_: str, cell: None = ..., spacing: float | str | None = ..., hinge: str | None = ..., coefficient: Mapping[str, Any] | Sequence[str] | str | None = ..., loss_factor: float | str | None = ..., at: float | str | None = ..., band: tuple[float, float] | None = ..., prony: str | Path | None = ..., large: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: int | Sequence[int] | str | None = ...) -> SheetOfCode: ...
@overload
def calibrate(scene: Scene | str | Path | None = ..., *, young: float | str | None = ..., poisson: float | str | None = ..., thickness: float | str | None = ..., density: float | str | None = ..., side: float | Sequence[float] | str | None = ..., lattice: Lattice | None = ..., grid: int | Sequence[int] | str | None = ..., calibration: str | None = ..., k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., toml: bool = ..., export: str | Path | None = ..., for_: None = ..., precision: str | None = ..., from_: None = ..., cell: Cell | str, spacing: float | str | None = ..., hinge: str | None = ..., coefficient: Mapping[str, Any] | Sequence[str] | str | None = ..., loss_factor: float | str | None = ..., at: float | str | None = ..., band: tuple[float, float] | None = ..., prony: str | Path | None = ..., large: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: int | Sequence[int] | str | None = ...) -> CellModuli: ...
@overload
def identify(scene: Scene | str | Path | None = ..., measured: Displacements | str | Path | None = ..., unknown: Sequence[str] | str | None = ..., *, lattice: Lattice | None = ..., grid: int | Sequence[int] | str | None = ..., calibration: str | None = ..., k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., tensile: None = ..., up_to: float | str | None = ..., area: float | str | None = ..., gauge: float | str | None = ..., model: Spec | str | None = ..., elements: int | Sequence[int] | str | None = ..., law: str | None = ..., offset: float | str | None = ..., uncertainty: float | str | None = ..., refine: bool = ..., large: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: int | Sequence[int] | str | None = ...) -> Identification: ...
@overload
def identify(scene: Scene | str | Path | None = ..., measured: Displacements | str | Path | None = ..., unknown: Sequence[str] | str | None = ..., *, lattice: Lattice | None = ..., grid: int | Sequence[int] | str | None = ..., calibration: str | None = ..., k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., tensile: Mapping[str, Any] | Sequence[str | Path] | str | Path, up_to: float | str | None = ..., area: float | str | None = ..., gauge: float | str | None = ..., model: Spec | str | None = ..., elements: int | Sequence[int] | str | None = ..., law: str | None = ..., offset: float | str | None = ..., uncertainty: float | str | None = ..., refine: bool = ..., large: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: int | Sequence[int] | str | None = ...) -> TensileFit: ...
@overload
def modes(scene: Scene | str | Path, lattice: Lattice | None = ..., *, grid: int | Sequence[int] | str | None = ..., calibration: str | None = ..., k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., count: int = ..., masses: str | None = ..., reference: Sequence[Spec | str] | Spec | str | None = ..., elements: int | Sequence[int] | str = ..., about: str | None = ..., buckling: bool = ..., state_space: None = ..., reduce: str | None = ..., large: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: int | Sequence[int] | str | None = ...) -> Spectra: ...
@overload
def modes(scene: Scene | str | Path, lattice: Lattice | None = ..., *, grid: int | Sequence[int] | str | None = ..., calibration: str | None = ..., k: float | str | None = ..., layer_distance: float | str | None = ..., grading: Grading | float | str | None = ..., count: int = ..., masses: str | None = ..., reference: Sequence[Spec | str] | Spec | str | None = ..., elements: int | Sequence[int] | str = ..., about: str | None = ..., buckling: bool = ..., state_space: int, reduce: str | None = ..., large: bool = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ..., lumped: int | Sequence[int] | str | None = ...) -> Linearisation: ...
@overload
def score(answers: None = ..., *, suite: str | None = ..., case: Sequence[str] | str | None = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ...) -> Suite: ...
@overload
def score(answers: str | Path, *, suite: str | None = ..., case: Sequence[str] | str | None = ..., out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ...) -> Score: ...
def verify(case: Sequence[str] | str | None = ..., *, out: str | Path | None = ..., overwrite: bool = ..., figure: Sequence[str] | str | None = ..., no_pictures: bool = ..., progress: Callable[[Any], object] | None = ...) -> Verification: ...
def report(folder: str | Path, *, out: str | Path | None = ..., open_: bool = ...) -> Path: ...

__version__: str
__all__ = [
    "Air",
    "AreaLoad",
    "BadInput",
    "Box",
    "Cell",
    "Chain",
    "Circle",
    "Clamped",
    "CurvatureTable",
    "Curved",
    "Cutout",
    "Cylinder",
    "Dampers",
    "Displacements",
    "EdgeLoad",
    "EdgeMotion",
    "Elements",
    "External",
    "FactorTable",
    "Gravity",
    "Held",
    "Hinged",
    "History",
    "Implausible",
    "Initial",
    "Lattice",
    "Layer",
    "Mass",
    "Material",
    "Motion",
    "Natural",
    "Patch",
    "PerDirection",
    "Plane",
    "Point",
    "PointLoad",
    "Pressure",
    "Rectangle",
    "Relaxation",
    "Scene",
    "SceneError",
    "Shape",
    "Sheet",
    "Solution",
    "Sphere",
    "Springs",
    "Status",
    "Symmetric",
    "Temperature",
    "calibrate",
    "catalogue",
    "cell",
    "check",
    "compare",
    "crosscheck",
    "error",
    "identify",
    "load",
    "modes",
    "new",
    "report",
    "scenes",
    "score",
    "simulate",
    "solve",
    "stability",
    "study",
    "sweep",
    "tradeoff",
    "verify",
]

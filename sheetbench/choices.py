"""Choices by name: calibrations, integrators, references; a line on each, and the default.

The module has names and words alone, so that the command line's help need not import solvers:
`lumped.INTEGRATORS` and `fem_reference.MODELS` make their entries of its names.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

Option = Literal["k", "layer_distance", "grading", "targets", "cells"]


@dataclass(frozen=True)
class Method:
    """A calibration method: a line on it, and the options that it takes."""

    summary: str
    takes: tuple[Option, ...] = ("layer_distance",)

    @property
    def fitted(self) -> bool:
        """Return whether the method is fitted to targets."""
        return "targets" in self.takes


CALIBRATION = "consistent"  # unless requested another
AUTO = "auto"  # a calibration or a grading that suits the scene
GRADED: tuple[Option, ...] = ("layer_distance", "grading")
CELL_BY_CELL: tuple[Option, ...] = (*GRADED, "cells")
CALIBRATIONS: dict[str, Method] = {
    "consistent": Method("matches every modulus, and corrects the twist at free edges", CELL_BY_CELL),
    "consistent-interior": Method("matches every modulus, edges not corrected", CELL_BY_CELL),
    "consistent-membrane": Method(
        "consistent, and matches the bending of cells in their plane", CELL_BY_CELL
    ),
    "consistent-oblique": Method("consistent, and waves oblique to the grid are second order", CELL_BY_CELL),
    "neo-hookean": Method("hyperelastic, of a material without a law or with this one", CELL_BY_CELL),
    "hyperelastic": Method(
        "layers as membranes of the material's law, neo-Hooke's where it has none, for any strain",
        CELL_BY_CELL,
    ),
    "moduli": Method("bounded least squares on the moduli"),
    "fit-static": Method("fitted to displacements", (*GRADED, "targets")),
    "fit-modal": Method("fitted to natural frequencies", ("layer_distance", "targets")),
    "uniform": Method("one k for all links, given or matched to D11", ("k", "layer_distance")),
    "cauchy": Method("the isotropic central-force lattice, ν = 1/3; square cells", ()),
    "central": Method("links only, for simulators without area springs: least error at this ν", ()),
    "axial": Method("every link a bar, k = E A/L"),
    "van-gelder": Method("Van Gelder's areas over squared lengths, in each layer"),
    "lloyd": Method("off-diagonal stiffness of the bilinear element at ν = 1/3, in each layer"),
}
# methods that match the moduli of every cell: answers converge to the sheet's with smaller cells
EXTRAPOLATED = tuple(name for name, method in CALIBRATIONS.items() if method.takes == CELL_BY_CELL)

MASS_DISTRIBUTIONS = {
    "higher-order": "inertia of edges corrected, coupled between neighbours",
    "tributary": "the area around each node, as for its weight",
    "gregory": "Gregory's end-corrected weights, as in motion",
}

BRANCHES = {
    "path": "the equilibrium on the load path, stable or not",
    "buckled": "where that is unstable, the stable one found along its buckling mode",
}

INTEGRATOR = AUTO  # esdirk, or generalised-alpha where the sheet has chains
INTEGRATORS = {
    "generalised-alpha": "implicit, second order, steps chosen by error",
    "esdirk": "implicit, fifth order, long steps chosen by error, no chains",
    "verlet": "explicit, steps below the stability limit",
    "midpoint": "implicit, conserves energy",
}

REFERENCE = "shell"
REFERENCES = {
    "plate": "linear Mindlin plate",
    "shell": "nonlinear Reissner–Mindlin shell",
    "solid": "nonlinear three-dimensional solid",
}
STRAIN_LAW = "st-venant-kirchhoff"
STRAIN_LAWS = {
    "st-venant-kirchhoff": "linear in Green's strain",
    "biot": "of the shell: linear in the elongation, as the lattice's springs are",
    "neo-hookean": "compressible, for rubbers and silicones",
}
FUNCTIONS = (  # the verbs that are functions too
    *("new", "check", "compare", "simulate", "sweep", "tradeoff", "stability", "crosscheck", "calibrate"),
    *("identify", "modes", "score", "verify", "report"),
)
VERBS = (*FUNCTIONS, "live", "study")
SUITES = ("statics", "motion", "modes", "curves", "natural", "contact")  # of the reference set
VARIED = {  # of a scene's stability
    "load": "loads, times the scene's",
    "slenderness": "thickness, times the scene's",
    "young": "E, times the scene's",
    "obstacle": "distance of obstacles, times the scene's",
    "grid": "cells along the shorter side",
    "damping": "damping ratio of the lowest mode",
    "time-step": "time step [ms]",
}
ELEMENTS = 16  # along the shorter side


def method_of(calibration: str | None, k: float | None) -> str:
    """Return the requested calibration: the named one, else `uniform` if k is given, else the default. `auto`
    has the options of the default."""
    named = CALIBRATION if calibration == AUTO else calibration
    return named or ("uniform" if k is not None else CALIBRATION)


def listed(names: Iterable[str], link: str = "or") -> str:
    """Return a list of names as text: "a, b or c"."""
    *first, last = names
    return f"{', '.join(first)} {link} {last}" if first else last

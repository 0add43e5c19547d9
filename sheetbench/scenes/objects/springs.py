"""Spring constants of a lattice, as data: the optional [springs] and [dampers] tables of a scene.

Only the lumped model reads them. Links are Habibi et al.'s ka, kd, kz, kdT and kddT; area and strain springs,
energy ½ k ε² a0 of a cell's mean strain, add stiffness that links cannot have. edge_shear and strip_shear
change the twisting stiffness of the cells along an edge whose director nothing holds, not their membrane
stiffness: energy ½ k (γ + r ε)² a0 on every layer's cell, ε its strain along the edge and r the
edge_coupling, and the sum over all layers with the other sign on the mid-surface's cell. The rim_ springs do
so at the rims of outlines and cutouts, cell by cell.

On a graded grid every cell has springs of its own: a constant is then a table of cells, a list of rows from
y0 to y1, each from x0 to x1. A link takes half the value of each neighbouring cell, a vertical link a quarter
of each of four. edge_shear, strip_shear and edge_coupling are a list along the edges x0 and y0; if the cells
along x1 and y1 differ, the keys that begin with far_ are their lists.
"""

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field, Strict

from sheetbench.scenes.objects.grading import Graded, through, towards
from sheetbench.scenes.objects.quantities import (
    Finite,
    Forms,
    Frozen,
    NonNegative,
    Number,
    Positive,
    Real,
    Unit,
)
from sheetbench.scenes.objects.sheet import EdgeName

AnySign = Annotated[Number | tuple[tuple[Number, ...], ...], Forms()]
Links = Annotated[NonNegative | tuple[tuple[NonNegative, ...], ...], Forms()]
AlongEdge = Annotated[Number | tuple[Number, ...], Forms()]


class PerDirection(Frozen):
    """One value per direction: along x, y and, for springs across the thickness, z."""

    x: Links
    """For springs along x."""
    y: Links
    """For springs along y."""
    z: NonNegative | None = None
    """For springs along z."""


class Either(Frozen):
    """A value of either sign for the edges along each direction."""

    x: AlongEdge
    """Along the edges x0 and x1."""
    y: AlongEdge
    """Along the edges y0 and y1."""


Stiffness = Annotated[NonNegative | tuple[tuple[NonNegative, ...], ...] | PerDirection, Forms(), Unit("N/m")]
EdgeStiffness = Annotated[Number | Either, Forms(), Unit("N/m")]
EdgeCoupling = Annotated[Number | Either, Forms()]
Damping = Annotated[NonNegative | PerDirection, Forms(), Unit("N·s/m")]

Masses = Annotated[int, Strict(), Field(ge=2)]
Distribution = Literal["tributary", "gregory"]


class SpringSet(Frozen):
    """The [springs] table of a scene: spring constants, and the lattice that they belong to."""

    axial: Stiffness
    """Links along x and y within a layer (ka)."""
    diagonal: Stiffness
    """Diagonals of a layer's cells (kd)."""
    vertical: Stiffness
    """Links between the layers, across the thickness (kz)."""
    cross: Stiffness
    """Links between the layers along x and y (kdT): diagonals of the upright faces."""
    cross_diagonal: Stiffness
    """Space diagonals of the cells (kddT)."""
    area: Annotated[AnySign, Unit("N/m")] = 0.0
    """Area springs of a layer's cells, energy ½ k (a/a0 − 1)² a0; < 0 is allowed while the cell is stable."""
    mid_area: Annotated[AnySign, Unit("N/m")] = 0.0
    """Area springs of the mid-surface's cells."""
    shear: Annotated[Links, Unit("N/m")] = 0.0
    """Strain springs against the in-plane shear of a layer's cells, energy ½ k γ² a0."""
    stretch: Stiffness = 0.0
    """Strain springs against the stretching of a layer's cells along x and y."""
    mid_shear: Annotated[AnySign, Unit("N/m")] = 0.0
    """Strain springs against the in-plane shear of the mid-surface's cells."""
    mid_stretch: Stiffness = 0.0
    """Strain springs against the stretching of the mid-surface along x and y."""
    coupling_xy: Annotated[AnySign, Unit("N/m")] = 0.0
    """Coupling of a layer's cells with fibres, energy k ε1 ε2 a0 of their strains along x and y."""
    coupling_x: Annotated[AnySign, Unit("N/m")] = 0.0
    """Coupling of a layer's cells with oblique fibres, energy k ε1 γ a0 of their strain along x and shear."""
    coupling_y: Annotated[AnySign, Unit("N/m")] = 0.0
    """Coupling of a layer's cells with oblique fibres, energy k ε2 γ a0 of their strain along y and shear."""
    mid_coupling_xy: Annotated[AnySign, Unit("N/m")] = 0.0
    """Coupling of the mid-surface's cells as coupling_xy."""
    mid_coupling_x: Annotated[AnySign, Unit("N/m")] = 0.0
    """Coupling of the mid-surface's cells as coupling_x."""
    mid_coupling_y: Annotated[AnySign, Unit("N/m")] = 0.0
    """Coupling of the mid-surface's cells as coupling_y."""
    neo_hookean_shear: Annotated[Links, Unit("N/m")] = 0.0
    """Cells of a layer as a rubber membrane instead of area and stretch: 2 f'(0) of its energy's f(I1 - 3),
    neo-Hooke's shear modulus, times its thickness. Axial links then resist only the bending of cells in
    their plane."""
    neo_hookean_volume: Annotated[Links, Unit("N/m")] = 0.0
    """That membrane's Λ, of ½ ln² J, times its thickness; neo-Hooke's is Lamé's λ."""
    mooney_rivlin: Annotated[AnySign, Unit("N/m")] = 0.0
    """That membrane's coefficient of I2 - 3 times its thickness."""
    yeoh_square: Annotated[AnySign, Unit("N/m")] = 0.0
    """That membrane's coefficient of (I1 - 3)² times its thickness."""
    yeoh_cube: Annotated[Links, Unit("N/m")] = 0.0
    """That membrane's coefficient of (I1 - 3)³ times its thickness."""
    gent_limit: Links = 0.0
    """Gent's limit of I1 - 3 of that membrane; 0 for none."""
    face_shear: Stiffness = 0.0
    """Strain springs against the shear of the cells' upright faces, energy ½ k γ² a0, a0 the cell's area and
    γ the angle between mean chord and mean director."""
    face_diagonal_shear: Annotated[Links, Unit("N/m")] = 0.0
    """Strain springs as face_shear in the upright planes over a cell's two diagonals."""
    face_coupling: Annotated[AnySign, Unit("N/m")] = 0.0
    """Strain springs as face_shear over one diagonal alone, which couple the shears along x and y: if > 0 the
    diagonal from the corner of least x and y, if < 0 the other one."""
    edge_shear: EdgeStiffness = 0.0
    """Correction of the twist in the cells along a free, hinged or held edge whose facing edge is clamped."""
    strip_shear: EdgeStiffness = 0.0
    """Strain springs as edge_shear if the opposite edge is free, hinged or held too."""
    edge_coupling: EdgeCoupling = 0.0
    """Coupling of cells with fibres at an angle: edge_shear and strip_shear resist γ + edge_coupling ε, ε the
    strain along the edge."""
    far_edge_shear: EdgeStiffness | None = None
    """Value of edge_shear for the edges x1 and y1; as for x0 and y0 unless given."""
    far_strip_shear: EdgeStiffness | None = None
    """Value of strip_shear for the edges x1 and y1; as for x0 and y0 unless given."""
    far_edge_coupling: EdgeCoupling | None = None
    """Value of edge_coupling for the edges x1 and y1; as for x0 and y0 unless given."""
    rim_shear: Annotated[AnySign, Unit("N/m")] = 0.0
    """Value of edge_shear for the cells at rims of outlines and cutouts: energy ½ k γ² a0 of every layer's
    cell, and the sum over the layers with the other sign on the mid-surface's cell, as all rim_ springs."""
    rim_stretch_x: Annotated[AnySign, Unit("N/m")] = 0.0
    """Rim springs of cells with oblique fibres or rims, energy ½ k ε1² a0 of the strain along x."""
    rim_stretch_y: Annotated[AnySign, Unit("N/m")] = 0.0
    """Rim springs as rim_stretch_x, energy ½ k ε2² a0 of the strain along y."""
    rim_coupling_xy: Annotated[AnySign, Unit("N/m")] = 0.0
    """Rim springs as rim_stretch_x, energy k ε1 ε2 a0."""
    rim_coupling_x: Annotated[AnySign, Unit("N/m")] = 0.0
    """Rim springs as rim_stretch_x, energy k ε1 γ a0."""
    rim_coupling_y: Annotated[AnySign, Unit("N/m")] = 0.0
    """Rim springs as rim_stretch_x, energy k ε2 γ a0."""
    upward_axial_x: Annotated[AnySign, Unit("N/m")] = 0.0
    """Increase of the stiffness of the links along x from each layer to the next one above, in sheets that
    are not symmetric about the middle."""
    upward_axial_y: Annotated[AnySign, Unit("N/m")] = 0.0
    """Increase from layer to layer of the stiffness of the links along y."""
    upward_diagonal: Annotated[AnySign, Unit("N/m")] = 0.0
    """Increase from layer to layer of the stiffness of the diagonals."""
    upward_area: Annotated[AnySign, Unit("N/m")] = 0.0
    """Increase from layer to layer of the area springs."""
    upward_stretch_x: Annotated[AnySign, Unit("N/m")] = 0.0
    """Increase from layer to layer of the strain springs along x."""
    upward_stretch_y: Annotated[AnySign, Unit("N/m")] = 0.0
    """Increase from layer to layer of the strain springs along y."""
    upward_shear: Annotated[AnySign, Unit("N/m")] = 0.0
    """Increase from layer to layer of shear."""
    upward_coupling_xy: Annotated[AnySign, Unit("N/m")] = 0.0
    """Increase from layer to layer of coupling_xy."""
    upward_coupling_x: Annotated[AnySign, Unit("N/m")] = 0.0
    """Increase from layer to layer of coupling_x."""
    upward_coupling_y: Annotated[AnySign, Unit("N/m")] = 0.0
    """Increase from layer to layer of coupling_y."""
    layer_distance: Annotated[Positive, Unit("m")] = Field(kw_only=True)
    """Distance of neighbouring layers; of two layers, about the sheet's thickness."""

    grid: tuple[Masses, Masses, Masses] | None = Field(default=None, kw_only=True)
    """Masses along x and y, and layers, of the lattice that the springs belong to: it is solved unless a grid
    is requested; another grid is refused."""
    grading: Annotated[float, Real(ge=0, le=1)] = Field(default=0.0, kw_only=True)
    """How much smaller that lattice's cells are at the edges: 0, all alike, to 1; another one is refused."""
    graded_edges: tuple[EdgeName, ...] | None = Field(default=None, kw_only=True)
    """The edges towards which cells are smaller; all four unless given."""
    lines_at: Annotated[tuple[tuple[Finite, ...], tuple[Finite, ...]] | None, Unit("m")] = Field(
        default=None, kw_only=True
    )
    """Places x and y that lines of that lattice were moved to: the sides of a drawn sheet's shapes."""
    masses: Distribution = Field(default="tributary", kw_only=True)
    """Distribution of the mass for frequencies: as usual (tributary), or as in a fit to them (gregory)."""

    def _faults(self) -> Iterator[object]:
        both = "neo_hookean_shear: the same cells cannot have area, stretch and shear springs"
        membranes = self.neo_hookean_shear or self.mooney_rivlin
        yield membranes and (self.area or self.stretch or self.shear) and both
        towards(self.grading, self.graded_edges)  # raises BadInput for an invalid grading

    def graded(self, sides: tuple[float, float]) -> Graded:
        """Return the grading of the lattice's lines on a sheet with sides [m]."""
        return through(self.lines_at, sides) if self.lines_at else towards(self.grading, self.graded_edges)


LATTICE = {"grid", "grading", "graded_edges", "lines_at", "masses"}  # keys of the lattice of the springs
CONSTANTS = [name for name in SpringSet.model_fields if name not in LATTICE]


class DamperSet(Frozen):
    """The [dampers] table of a scene: damping of each family of links [N·s/m]."""

    axial: Damping = 0.0
    """Dampers along the links along x and y within a layer."""
    diagonal: Damping = 0.0
    """Dampers along the diagonals of a layer's cells."""
    vertical: Damping = 0.0
    """Dampers along the links between the layers."""
    cross: Damping = 0.0
    """Dampers along the diagonals of the upright faces."""
    cross_diagonal: Damping = 0.0
    """Dampers along the space diagonals."""

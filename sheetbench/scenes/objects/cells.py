"""Material constants and thickness of a sheet, each a number or an array over points or a grid's cells."""

from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from sheetbench.errors import BadInput
from sheetbench.scenes.objects.grid import Grid
from sheetbench.scenes.objects.material import Material
from sheetbench.scenes.objects.orthotropy import Ply
from sheetbench.scenes.objects.sheet import Sheet

NUMBERS = ("thickness", "young", "poisson", "density")


@dataclass(frozen=True, eq=False)
class Constants:
    """Thickness and material constants of a sheet.

    thickness [m], young [Pa], poisson [-], density [kg/m³]: numbers, or arrays of one shape: of plan cells
    (rows, columns) from y0 to y1, each row from x0 to x1. plies: of an orthotropic sheet, from its lower face
    up, in place of young and poisson.

    >>> import numpy as np
    >>> from sheetbench.scenes import Cells, load
    >>> scene = load("two-edges-clamped")
    >>> Cells.of(scene.sheet, scene.material).replace(thickness=np.array([[0.003, 0.001]])).per_area
    array([[5.034, 1.678]])
    """

    thickness: Any
    young: Any
    poisson: Any
    density: Any
    plies: tuple[Ply, ...] = ()

    @classmethod
    def of(cls, sheet: Sheet, material: Material) -> Self:
        """Return the constants of a homogeneous sheet."""
        plies = (material.ply,) if material.kind == "orthotropic" else ()
        return cls(sheet.thickness, material.young, material.poisson, material.density, plies)

    def arrays(self, shape: tuple[int, ...]) -> Self:
        """Return a copy with arrays of this shape in place of numbers, to write into."""

        def full(value: Any) -> np.ndarray:
            return np.array(np.broadcast_to(value, shape), dtype=float)

        plies = tuple(Ply(p.low, p.high, *map(full, p[2:])) for p in self.plies)
        values = {name: full(getattr(self, name)) for name in NUMBERS}
        return replace(self, plies=plies, **values)

    def by_name(self) -> dict[str, Any]:
        """Return every constant by its name; of a sheet of several plies thickness and density alone."""
        if not self.plies:
            return {name: getattr(self, name) for name in NUMBERS}
        ply = self.plies[0]._asdict() if len(self.plies) == 1 else {}
        elastic = {name: value for name, value in ply.items() if name not in ("low", "high", "density")}
        return {"thickness": self.thickness, "density": self.per_area / self.thickness, **elastic}

    def replace(self, **values: Any) -> Self:
        """Return a copy with other values for some constants."""
        return replace(self, **values)

    @property
    def per_area(self) -> Any:
        """Return the mass per area [kg/m²]."""
        if self.plies:
            return sum(ply.density * (ply.high - ply.low) for ply in self.plies) * self.thickness
        return self.density * self.thickness

    @property
    def moment_per_area(self) -> Any:
        """Return the first moment of the mass about the mid-surface, per area [kg/m], 0 without plies."""
        each = (ply.density * (ply.high**2 - ply.low**2) / 2.0 for ply in self.plies)
        return sum(each, 0.0) * self.thickness**2

    @property
    def stretching(self) -> Any:
        """Return E h [N/m], with E = √(E₁ E₂) for plies: a measure of the membrane's stiffness."""
        if self.plies:
            each = ((ply.young_1 * ply.young_2) ** 0.5 * (ply.high - ply.low) for ply in self.plies)
            return sum(each) * self.thickness
        return self.young * self.thickness

    @property
    def rotary_per_area(self) -> Any:
        """Return the rotary inertia of the normal per area [kg]."""
        if self.plies:
            return sum(p.density * (p.high**3 - p.low**3) / 3.0 for p in self.plies) * self.thickness**3
        return self.per_area * self.thickness**2 / 12.0

    def require_grid(self, grid: Grid) -> None:
        """Raise BadInput unless every constant is a number or an array over the grid's cells."""
        rows, columns = grid[1] - 1, grid[0] - 1
        for name in NUMBERS:
            shape = np.shape(getattr(self, name))
            if shape not in ((), (rows, columns)):
                raise BadInput(
                    f"cells.{name}: {' × '.join(map(str, shape))} values; {grid[0]}x{grid[1]} masses "
                    f"have {rows} rows of {columns} cells"
                )


Cells = Constants  # name of the public interface, for arrays over the plan cells of a grid

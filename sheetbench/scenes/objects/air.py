"""Still air around a sheet in motion: a quadratic drag against the velocity along its normal.

On both faces together, per current area,

    t = −½ ρ c_d |v_n| v_n n,     v_n = v·n,

with the air's density ρ and the drag coefficient c_d of a plate across a stream (1.2 of a square one, 2 of a
long strip; more if the sheet swings by less than its own width). Friction of the air along the surface is
left out: a laminar layer has 1.3/√Re, some hundredths of c_d. So are the mass of air that moves along with
the sheet, per area up to π/4 ρ b for a strip of width b, and lift: they need a fluid. Statics have no drag.

Source: Hoerner, Fluid-Dynamic Drag (1965), 3-16; Keulegan and Carpenter (1958) for small swings.
"""

from math import pi

from sheetbench.scenes.objects.quantities import Density, Frozen, Positive
from sheetbench.scenes.objects.sheet import Sheet


class Air(Frozen):
    """Still air, a drag against motion of the sheet along its normal; equilibria do not depend on it."""

    drag: Positive
    """Coefficient c_d: a force ½ · density · drag · v² per area against the velocity v along the current
    normal; about 1.2 for a square sheet, 2 for a long strip."""
    density: Density = 1.2
    """Density of the air; its value at 20 °C unless given."""

    @property
    def coefficient(self) -> float:
        """Return ½ ρ c_d [kg/m³]."""
        return 0.5 * self.density * self.drag

    def carried_along(self, sheet: Sheet) -> float:
        """Return the largest mass per area [kg/m²] of air that moves along with the sheet: not modelled."""
        return pi / 4.0 * self.density * min(sheet.lengths)

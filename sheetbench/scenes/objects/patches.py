"""Patches: parts of a sheet with a thickness, a material or a natural state of their own."""

from collections.abc import Iterator

from pydantic import Field

from sheetbench.scenes.objects.material import Material
from sheetbench.scenes.objects.natural import Natural
from sheetbench.scenes.objects.quantities import Angle, Density, Frozen, Length, Modulus, PoissonRatio
from sheetbench.scenes.objects.shapes import Shape
from sheetbench.scenes.objects.sheet import Sheet

CONSTANTS = ("thickness", "young", "poisson", "density", "angle")


class Patch(Frozen):
    """A part of the sheet with a thickness or material constants of its own."""

    shape: Shape
    """The part: a rectangle, a circle or a polygon."""
    thickness: Length | None = None
    """Thickness, half of it above and half below the mid-surface; the sheet's unless given."""
    young: Modulus | None = None
    """Young's modulus; the material's unless given."""
    poisson: PoissonRatio | None = None
    """Poisson's ratio; the material's unless given."""
    density: Density | None = None
    """Density; the material's unless given."""
    angle: Angle | None = Field(default=None, kw_only=True)
    """Angle of an orthotropic material's axis 1 from x towards y; the material's unless given."""
    natural: Natural | None = Field(default=None, kw_only=True)
    """Natural strain and curvature of the part, in place of the sheet's."""

    def _faults(self) -> Iterator[object]:
        yield not self.own and not self.natural and f"needs one of {', '.join((*CONSTANTS, 'natural'))}"
        whole = "natural.pretension: for a whole sheet only; give strain"
        yield self.natural and self.natural.pretension and whole

    @property
    def own(self) -> dict[str, float]:
        """Return the constants that the patch gives itself."""
        return self.given(CONSTANTS)


def misplaced(patches: tuple[Patch, ...], sheet: Sheet) -> str:
    """Return the reason why a patch is off the sheet or too thick, "" if no patch is."""
    import shapely

    plan = shapely.box(0.0, 0.0, *sheet.lengths)
    for number, patch in enumerate(patches, start=1):
        if patch.shape.area.intersection(plan).area <= 0.0:
            return (
                f"patch {number}.shape: {patch.shape.in_words()}: no part of it is on the sheet, "
                f"0 ≤ x ≤ {1e3 * sheet.length_x:.4g}, 0 ≤ y ≤ {1e3 * sheet.length_y:.4g} mm"
            )
        if patch.thickness is not None and patch.thickness > min(sheet.lengths):
            return f"patch {number}.thickness = {patch.thickness:g} m is more than the sheet's shorter side"
    return ""


def mismatched(patches: tuple[Patch, ...], material: Material) -> str:
    """Return the reason why a patch's constants do not suit the sheet's kind of material, "" if all do."""
    for number, patch in enumerate(patches, start=1):
        if material.kind == "isotropic" and patch.angle is not None:
            return f"patch {number}.angle = {patch.angle:g}: for a material of kind = 'orthotropic' only"
        if material.kind == "orthotropic" and (patch.young is None) != (patch.poisson is None):
            given = "poisson" if patch.young is None else "young"
            return (
                f"patch {number}.{given} = {getattr(patch, given):g}: young and poisson together make a part "
                "of an orthotropic sheet isotropic; give both, or neither"
            )
    return ""

"""Choice of a law of rubber, and its constants, from a tensile test: `sheetbench identify --tensile`."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Annotated, Any

import numpy as np

from comparisons.identification.tensile.curves import Curve, read, require_loading
from comparisons.identification.tensile.laws import LAWS, POISSON, Fit, chosen, fit
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture
from sheetbench.answers.table import MEGAPASCALS, NUMBER, PERCENT, Column, Table, TableUnit, number, unit
from sheetbench.errors import BadInput
from sheetbench.scenes import Material


@dataclass(frozen=True)
class ConstantRow:
    """A constant of a law with its 95 % interval."""

    law: str
    constant: str
    unit: TableUnit
    value: Annotated[float, NUMBER(".4g")]
    low: Annotated[float, NUMBER(".4g", "from")]
    high: Annotated[float, NUMBER(".4g", "to")]


@dataclass(frozen=True)
class MisfitRow:
    """Misfits of a law over the largest stress; remark: the choice, or the reason against the law."""

    law: str
    young: Annotated[float, MEGAPASCALS(".4g", "E at small strain")]
    rms: Annotated[float, PERCENT(".2f", "misfit")]
    largest: Annotated[float, PERCENT(".2f")]
    remark: Annotated[str, Column(prose=True)]


@dataclass(frozen=True, repr=False)
class TensileFit(Answer):
    """Fits of all laws to measured curves; law: the chosen one, None if no law fits stably."""

    file_name = "tensile"
    curves: tuple[Curve, ...]
    fits: tuple[Fit, ...]
    law: Fit | None

    @property
    def covered(self) -> dict[str, tuple[float, float]]:
        """Least and largest stretch of each kind of test."""
        kinds = {curve.test for curve in self.curves}
        data = {kind: np.concatenate([c.stretch for c in self.curves if c.test == kind]) for kind in kinds}
        return {
            kind: (float(min(s.min(), 1.0)), float(max(s.max(), 1.0))) for kind, s in sorted(data.items())
        }

    def material(self, density: float = 1000.0, poisson: float = POISSON) -> Material:
        """Return the law as a scene's material. Raises BadInput where there is none."""
        if self.law is None:
            raise BadInput("tensile: no law fits these curves stably")
        values: dict[str, Any] = {"law": self.law.law, "poisson": poisson, "density": density}
        constants = dict(self.law.constants)
        if "young" in constants:
            constants["young"] *= (1.0 + poisson) / 1.5  # of the same shear modulus
        return Material.model_validate(values | constants)

    def document(self) -> dict[str, Any]:
        """Return the JSON document: SI units."""
        return {
            "law": self.law.law if self.law else None,
            "covered": {kind: list(ends) for kind, ends in self.covered.items()},
            "laws": [asdict(f) for f in self.fits],
            "curves": [vars(curve) for curve in self.curves],
            "warnings": [],
        }

    def heading(self) -> tuple[str, str, str]:
        covered = ", ".join(f"{kind} {low:.3g} to {high:.3g}" for kind, (low, high) in self.covered.items())
        rows = sum(len(curve.stretch) for curve in self.curves)
        return "Tensile test", f"{rows} rows, stretch covered: {covered}", ""

    def tables(self) -> tuple[Table, ...]:
        """Return a row per constant of every law, and a row per law with its misfit and a remark."""
        constants = (
            ConstantRow(f.law, key, unit("" if key == "limit" else "Pa"), value, *f.intervals[key])
            for f in self.fits
            for key, value in f.constants.items()
        )
        misfits = [MisfitRow(f.law, f.young, f.rms, f.largest, _remark_on(f, self.law)) for f in self.fits]
        caption = "Misfit, of the largest stress (root mean square)"
        return (
            Table.of(ConstantRow, constants, "Constants and their 95 % intervals", "constants", grouped=True),
            Table.of(MisfitRow, misfits, caption, "misfits"),
        )

    def figures(self) -> tuple[Picture, ...]:
        return (Picture("tensile", "comparisons.identification.figure:tensile", (self,)),)

    def notes(self) -> list[str]:
        """Return lines for a scene with the chosen law, and the reason for leaving out mooney-rivlin."""
        sentences = []
        mooney = next((f for f in self.fits if f.law == "mooney-rivlin"), None)
        if mooney is not None and len(self.covered) == 1:
            sentences.append(
                "mooney-rivlin is not chosen: one kind of test cannot distinguish c1 from c2 (correlation "
                f"{number(mooney.correlation, '.3f')}); add a test in pure shear or equibiaxial tension."
            )
        if self.law is not None:
            material = self.material()
            keys = {key: getattr(material, key) for key in (*self.law.constants, "poisson")}
            lines = "\n".join(f"{key} = {value:.6g}" for key, value in keys.items())
            sentences.append(f'Write into the scene:\n[material]\nlaw = "{self.law.law}"\n{lines}')
        return sentences

    def complaints(self) -> tuple[str, ...]:
        return () if self.law else ("no law fits these curves stably; try a smaller --up-to",)

    def choices(self) -> dict[str, Any]:
        return {"files": [curve.file for curve in self.curves]}

    @property
    def succeeded(self) -> bool:
        return self.law is not None


def _remark_on(fit: Fit, law: Fit | None) -> str:
    if fit is law:
        return "← fits with the fewest constants"
    if fit.unstable:
        return "its stress falls below 0 at some stretch, or it has no stiffness at rest: scenes refuse it"
    if "limit" in fit.bound:
        return "limit beyond these data"
    return f"{' and '.join(fit.bound)} at the bound 0" if fit.bound else ""


def identify_tensile(
    curves: Sequence[Curve | str] | Curve | str,
    *,
    area: float | None = None,
    gauge: float | None = None,
    up_to: float | None = None,
) -> TensileFit:
    """Return the constants of every law of rubber from curves or files (`curves.read`), and the law to take.

    area [m²]: undeformed cross-section, for columns of force; gauge [m]: undeformed length, for columns of
    displacement; up_to: largest stretch of files to fit. Raises BadInput for a curve other than a loading
    branch of engineering or true stress."""
    inputs = [curves] if isinstance(curves, Curve | str) else list(curves)
    measured = tuple(c if isinstance(c, Curve) else read(c, area, up_to, gauge) for c in inputs)
    for curve in measured:
        require_loading(curve)
    fits = tuple(result for law in LAWS if (result := fit(law, measured)) is not None)
    return TensileFit(measured, fits, chosen(fits, measured))

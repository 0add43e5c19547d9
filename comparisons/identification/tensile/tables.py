"""The tables of `sheetbench identify --tensile`: constants with intervals, and how well each law fits."""

from __future__ import annotations

from typing import TYPE_CHECKING

from sheetbench.answers.report import Picture, Report
from sheetbench.answers.table import Column, Table, number, unit

if TYPE_CHECKING:
    from comparisons.identification.tensile.laws import Fit
    from comparisons.identification.tensile.tensile import TensileFit


def report(found: TensileFit) -> Report:
    """What is shown of a tensile test."""
    covered = ", ".join(f"{kind} {low:.3g} to {high:.3g}" for kind, (low, high) in found.covered.items())
    rows = sum(len(curve.stretch) for curve in found.curves)
    return Report(
        name="tensile",
        title="Tensile test",
        subtitle=f"{rows} rows, stretch covered: {covered}",
        document=found.as_dict(),
        tables=(constants(found), misfits(found)),
        notes=tuple(notes(found)),
        complaints=() if found.law else ("no law fits these curves stably; try a smaller --up-to",),
        pictures=(Picture("tensile", "comparisons.identification.tensile.figure:compose", (found,)),),
        settings={"files": [curve.file for curve in found.curves]},
        met=found.law is not None,
    )


def constants(found: TensileFit) -> Table:
    """A row per constant of every law."""

    def of(fit: Fit, name: str) -> list[tuple[object, ...]]:
        return [
            (name, key, unit("" if key == "limit" else "Pa"), value, *fit.intervals[key])
            for key, value in fit.constants.items()
        ]

    rows = [row for fit in found.fits for row in of(fit, fit.law)]
    rows += [row for fit in found.free for row in of(fit, f"{fit.law}, unbounded")]
    columns = (
        Column("law"),
        Column("constant"),
        Column("unit"),
        *(Column(name, form=".4g") for name in ("value", "from", "to")),
    )
    return Table("Constants and their 95 % intervals", columns, tuple(rows), "constants", grouped=True)


def misfits(found: TensileFit) -> Table:
    """A row per law: E of small strains, the misfit, and what speaks against it."""
    rows = [
        (f.law, f.young, f.rms, f.largest, "← the data ask for it" if f is found.law else _against(f))
        for f in found.fits
    ]
    rows += [(f"{f.law}, unbounded", f.young, f.rms, f.largest, _against(f)) for f in found.free]
    columns = (
        Column("law"),
        Column("E at small strain", "Pa", "MPa", 1e-6, ".4g"),
        Column("misfit", "", "%", 100.0, ".2f"),
        Column("largest", "", "%", 100.0, ".2f"),
        Column("remark", prose=True),
    )
    return Table("Misfit, of the largest stress (root mean square)", columns, tuple(rows), "misfits")


def _against(fit: Fit) -> str:
    if fit.unstable:
        return "pushes when pulled far enough, or has no stiffness at rest: no scene takes it"
    if "limit" in fit.bound:
        return "these data see no limit"
    return f"{' and '.join(fit.bound)} at the bound 0" if fit.bound else ""


def notes(found: TensileFit) -> list[str]:
    """What to put into a scene, and what the curves leave open."""
    said = []
    mooney = next((f for f in found.fits if f.law == "mooney-rivlin"), None)
    if mooney is not None and len(found.covered) == 1:
        said.append(
            "One kind of test cannot tell c1 from c2 of mooney-rivlin: their errors have the correlation "
            f"{number(mooney.correlation, '.3f')}, and it is not chosen; pure shear or equibiaxial tension "
            "beside it would tell."
        )
    if found.open is not None:
        at, (low, high) = found.open
        said.append(
            f"Not measured: equibiaxial tension. At stretch {at:.3g}, as far as these data go in I₁, laws "
            f"that fit about as well foretell {low / 1e6:.3g} to {high / 1e6:.3g} MPa."
        )
    if found.law is not None:
        material = found.material()
        keys = {key: getattr(material, key) for key in (*found.law.constants, "poisson")}
        lines = "\n".join(f"{key} = {value:.6g}" for key, value in keys.items())
        said.append(f'In a scene:\n[material]\nlaw = "{found.law.law}"\n{lines}')
    return said

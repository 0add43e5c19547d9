"""What a comparison shows: displacement at the probes, cost and error of each model, support forces."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from comparisons.models.grading import told
from comparisons.report.vtk import plan_mesh, write_mesh, write_solution
from sheetbench.answers.figure_style import PLAIN, Look
from sheetbench.answers.report import Picture, Report
from sheetbench.answers.table import Column, Table
from sheetbench.scenes import Material, Sheet, Solution, Status
from sheetbench.scenes.summary import few

if TYPE_CHECKING:
    from comparisons.comparison.comparison import Comparison

_MODEL = Column("model")

BUCKLED = (
    "branch buckled: a model whose equilibrium under the whole load is unstable leaves it along its lowest "
    "mode; what is shown is the stable equilibrium that it comes to, one of several."
)
FIGURES, PROBES = ("comparison.png", "comparison.pdf"), ("probes.png", "probes.pdf")


def report(comparison: Comparison) -> Report:
    """What `sheetbench compare` shows."""
    scene = comparison.scene
    moved, cost = displacements(comparison), costs(comparison)
    return Report(
        name="comparison",
        page="table",
        title=scene.name,
        subtitle=scene.title,
        lead=sheet(scene.sheet, scene.material),
        document=comparison.as_dict(),
        tables=(moved, cost, reactions(comparison)),
        printed=(moved, cost),
        notes=(
            " · ".join(solution.label for solution in comparison.solutions),
            *dict.fromkeys(said for s in comparison.solutions for said in told(s.settings)),
            *([f"{comparison.solutions[0].model}: {comparison.expected}"] if comparison.expected else []),
            *uncertainty(comparison),
            explanation(comparison),
            *([BUCKLED] if comparison.reference.settings.get("branch") == "buckled" else []),
        ),
        complaints=tuple(complaints(comparison)),
        pictures=(
            Picture(FIGURES, partial(draw, comparison)),
            Picture(PROBES, partial(draw_probes, comparison)),
        ),
        attachments={
            **{f"{s.model}.vtu": partial(write_solution, solution=s) for s in comparison.solutions},
            "comparison.vtu": partial(write_plan, comparison=comparison),
        },
        scene=scene,
        settings={solution.model: solution.settings for solution in comparison.solutions},
        met=comparison.converged,
    )


def _millimetres(name: str) -> Column:
    return Column(name, "m", "mm", 1e3, "z.3f")


def displacements(comparison: Comparison) -> Table:
    """A row per probe and model, the reference first; ±: its own error bar, by its mesh or grids."""
    relative = {(d.probe, d.of): d.relative for d in comparison.differences}
    probes = {solution.model: comparison.probes(solution) for solution in comparison.solutions}
    ordered = sorted(comparison.solutions, key=lambda solution: solution is not comparison.reference)
    bars = {s.model: _bars(comparison, s) for s in ordered}
    rows = [
        (
            probe,
            x,
            y,
            s.model,
            *(float(u) for u in probes[s.model][probe]),
            relative.get((probe, s.model)),
            bars[s.model].get(probe),
        )
        for probe, (x, y) in comparison.scene.probes.items()
        for s in ordered
    ]
    columns = (
        Column("probe"),
        Column("x", "m", "mm", 1e3, ".4g", detail=True),
        Column("y", "m", "mm", 1e3, ".4g", detail=True),
        _MODEL,
        _millimetres("ux"),
        _millimetres("uy"),
        _millimetres("uz"),
        Column("off by", "", "%", 100.0, "z.2f"),
        Column("±", "", "%", 100.0, ".2g"),
    )
    return Table("Displacement of the mid-surface", columns, tuple(rows), "table", grouped=True)


def _bars(comparison: Comparison, solution: Solution) -> dict[str, float]:
    """The bar of a model that has one over its displacement, at the probes where it moves."""
    lengths = comparison.own_bar(solution)
    if solution is comparison.reference and comparison.bar is not None:
        lengths = dict(zip(comparison.bar.names, comparison.bar.uncertainty.bar, strict=True))
    moved = {probe: float(np.linalg.norm(u)) for probe, u in comparison.probes(solution).items()}
    return {
        probe: float(np.linalg.norm(length)) / moved[probe]
        for probe, length in (lengths or {}).items()
        if moved[probe] > comparison.least
    }


def costs(comparison: Comparison) -> Table:
    """A row per model: what it is, what it cost, how far it is from the reference."""
    rows = [
        (
            s.model,
            s.label,
            s.unknowns,
            s.iterations,
            s.setup_seconds,
            s.solve_seconds,
            comparison.error(s),
            standing(s),
        )
        for s in comparison.solutions
    ]
    columns = (
        _MODEL,
        Column("what it is", prose=True, detail=True),
        Column("unknowns", form="d"),
        Column("factorisations", form="d"),
        Column("set-up", "s", "s", 1.0, "z.2f"),
        Column("solve", "s", "ms", 1e3, ".1f"),
        Column("error", "", "%", 100.0, "z.2f"),
        Column("status", prose=True),
    )
    doubts = "; ".join(comparison.busy)
    return Table("Cost and error of each model", columns, tuple(rows), "models", text=doubts)


def reactions(comparison: Comparison) -> Table:
    """A row per supported edge and model: the force of the support on the sheet."""
    rows = [
        (edge, s.model, *(float(f) for f in force))
        for s in comparison.solutions
        for edge, force in s.reactions.items()
    ]
    forces = tuple(Column(name, "N", "N", 1.0, "z.4f") for name in ("Fx", "Fy", "Fz"))
    columns = (Column("edge"), _MODEL, *forces)
    return Table("Force of each support on the sheet", columns, tuple(sorted(rows)), "reactions")


def standing(solution: Solution) -> str:
    """The status, with the share of the load that was reached if it is not all of it."""
    reached = "" if solution.load_factor == 1.0 else f" at {100 * solution.load_factor:.0f} % of the load"
    return f"{solution.status}{reached}"


def complaints(comparison: Comparison) -> list[str]:
    """A sentence for every model that did not converge: what happened and what can be done; and why lattice
    and reference are far apart though both did."""
    far = [comparison.apart] if comparison.apart else []
    return far + [
        ": ".join(part for part in (s.model, standing(s), s.message, s.status.advice) if part)
        for s in comparison.solutions
        if s.status is not Status.CONVERGED
    ]


def sheet(sheet: Sheet, material: Material) -> str:
    """The sheet and its material in a line."""
    sides = " × ".join(f"{1e3 * length:g}" for length in (*sheet.lengths, sheet.thickness))
    young = f"{material.young / 1e6:g} MPa" + (" (long-time)" if material.branches.times else "")
    return f"{sides} mm, E = {young}, ν = {material.poisson:g}, ρ = {material.density:g} kg/m³"


def uncertainty(comparison: Comparison) -> list[str]:
    """The reference's error bar in words, the models that differ from it by less, and what is due to laws of
    strain."""
    said = [comparison.laws] if comparison.laws else []
    for solution in comparison.solutions:
        if solution.bar is not None:
            share = 100.0 * (comparison.bar_of(solution) or 0.0)
            said.append(f"{solution.model}: ± {few(share)} % by its grids.")
    if comparison.bar is None:
        return said
    model = comparison.reference.model
    said.append(comparison.bar.note(model))
    said += [f"{model}: {left_out}."] if (left_out := str(comparison.model_error or "")) else []
    for solution in comparison.solutions:
        if comparison.distinguishable(solution) is False:
            said.append(f"{solution.model}: not distinguishable from {comparison.reference.model}.")
            continue
        found = (d for d in comparison.differences if d.of == solution.model)
        if close := [difference.probe for difference in found if difference.distinguishable is False]:
            named = f"not distinguishable from {comparison.reference.model} at {', '.join(close)}"
            said.append(f"{solution.model}: {named}.")
    return said


def explanation(comparison: Comparison) -> str:
    """What the percentages mean, in words."""
    ref = f"u_{comparison.reference.model}"
    return (
        f"off by: |u − {ref}| / |{ref}| at the probe. "
        f"error: largest component of u − {ref} over the probes / largest component of {ref}."
    )


def write_plan(path: Path, comparison: Comparison) -> None:
    """Write all solutions on one plan grid, `displacement_MODEL` each, and what they differ by.

    `displacement` is the reference's; `difference` is the chosen lattice's from it, `difference_MODEL` any
    other model's.
    """
    plan = plan_mesh(comparison.scene.sheet)
    fields = {s.model: s.displacement(plan.points[:, :2]) for s in comparison.solutions}
    truth = fields[comparison.reference.model]
    plan.point_data["displacement"] = truth
    plan.point_data["difference"] = fields[comparison.solutions[0].model] - truth
    for solution in comparison.solutions:
        plan.point_data[f"displacement_{solution.model}"] = fields[solution.model]
    for solution in comparison.solutions[2:]:
        plan.point_data[f"difference_{solution.model}"] = fields[solution.model] - truth
    write_mesh(path, plan)


def draw(comparison: Comparison, paths: Sequence[Path], look: Look = PLAIN) -> str | None:
    """Draw the comparison; where it cannot be drawn, the reason in a sentence."""
    from comparisons.report.offscreen import why_not

    drawn = comparison.solutions[:2]
    if not all(np.all(np.isfinite(s.mesh.point_data["displacement"])) for s in drawn):
        return "a displacement is not a finite number"
    impossible = why_not()
    if impossible is None:
        from comparisons.comparison.figure import picture

        picture(paths, comparison, look)
    return impossible


def draw_probes(comparison: Comparison, paths: Sequence[Path], look: Look = PLAIN) -> str | None:
    """Draw what every model is off by at the probes; where no probe moves, that in a sentence."""
    from comparisons.comparison.probes_figure import picture, shown

    if not shown(comparison):
        return "no probe has a displacement to be off from"
    picture(paths, comparison, look)
    return None

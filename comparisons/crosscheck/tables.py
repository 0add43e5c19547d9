"""Tables of a cross-check: every model's limit and bar, how far from the shell, and where they differ."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.crosscheck.convergence import Convergence
from sheetbench.answers.report import Report
from sheetbench.answers.table import Column, Table
from sheetbench.scenes import Scene, Status

if TYPE_CHECKING:
    from comparisons.crosscheck.crosscheck import Crosscheck

_PER_CENT = ("", "%", 100.0)
EXPLANATION = (
    "u: the component of the largest displacement at the probes, extrapolated from three meshes "
    "(Richardson), ± its grid convergence index. off: the largest component of a model's extrapolated "
    "displacement less the shell's over the probes, of the shell's largest; ± both bars there. Two models "
    "are told apart where they differ by more than both their bars at a probe; what is not may still differ."
)


def report(found: Crosscheck) -> Report:
    """Return the report of `sheetbench crosscheck`."""
    single = found.scenes[0] if len(found.scenes) == 1 else None
    limits, moved = answers(found), displacements(found)
    codes = (external_codes(found),) if found.codes else ()
    return Report(
        name="crosscheck",
        title=single.name if single else "crosscheck",
        subtitle=single.title if single else f"{len(found.scenes)} scenes, every model on meshes of its own",
        document=found.as_dict(),
        tables=(limits, moved, pairs(found), *codes),
        printed=(limits, moved, *codes) if single else (limits, *codes),
        notes=(*refusals(found), EXPLANATION),
        complaints=tuple(found.failures),
        settings={
            "scenes": [scene.name for scene in found.scenes],
            "judges": {one.code.name: one.version for one in found.codes},
        },
        met=not found.failures
        and all(
            one.refused or one.uncertainty is not None for of in found.convergences.values() for one in of
        ),
    )


def answers(found: Crosscheck) -> Table:
    """A row per scene and model: its limit where the sheet moves most, how far off it is, and from whom."""
    rows = [_answer(found, scene, one) for scene in found.scenes for one in found.convergences[scene.name]]
    columns = (
        Column("scene", detail=len(found.scenes) == 1),
        Column("model"),
        Column("elements"),
        Column("at"),
        Column("u", "m", "mm", 1e3, "z.4f"),
        Column("± u", "m", "mm", 1e3, ".2g"),
        Column("off", *_PER_CENT, "z.2f"),
        Column("± off", *_PER_CENT, ".2g"),
        Column("told apart from", prose=True),
    )
    return Table("Extrapolated answers", columns, tuple(rows), "crosscheck", grouped=len(found.scenes) > 1)


def _answer(found: Crosscheck, scene: Scene, one: Convergence) -> tuple[Any, ...]:
    truth = found.against(scene.name)
    if truth is None or truth.uncertainty is None or one.uncertainty is None:
        reason = str(Status.REFUSED) if one.refused else "no answer"
        return scene.name, one.name, one.meshes or None, None, None, None, None, None, reason
    bar, limit = one.uncertainty, truth.uncertainty.extrapolated
    probe, axis = np.unravel_index(np.argmax(np.abs(limit)), limit.shape)
    between = next((p for p in found.pairs(scene) if {p.a, p.b} == {truth.name, one.name}), None)
    return (
        scene.name,
        one.name,
        one.meshes,
        f"{list(scene.probes)[int(probe)]} u{'xyz'[int(axis)]}",
        float(bar.extrapolated[probe, axis]),
        float(bar.bar[probe, axis]),
        None if between is None else between.difference,
        None if between is None else between.bars,
        ", ".join(_distinguishable(found, scene, one)) or "none",
    )


def _distinguishable(found: Crosscheck, scene: Scene, one: Convergence) -> list[str]:
    """The models that differ from one by more than the bars."""
    some = [p for p in found.pairs(scene) if p.distinguishable_at and one.name in (p.a, p.b)]
    return [p.b if p.a == one.name else p.a for p in some]


def displacements(found: Crosscheck) -> Table:
    """A row per scene, probe and model: the extrapolated displacement with its bar."""
    rows = [
        (scene.name, probe, one.name, *map(float, bar.extrapolated[i]), *map(float, bar.bar[i]))
        for scene in found.scenes
        for i, probe in enumerate(scene.probes)
        for one in found.convergences[scene.name]
        if (bar := one.uncertainty) is not None
    ]
    lengths = [Column(name, "m", "mm", 1e3, "z.4f") for name in ("ux", "uy", "uz")]
    bars = [Column(f"± {name}", "m", "mm", 1e3, ".1g") for name in ("ux", "uy", "uz")]
    columns = (
        Column("scene", detail=len(found.scenes) == 1),
        Column("probe"),
        Column("model"),
        *lengths,
        *bars,
    )
    return Table("Extrapolated displacements", columns, tuple(rows), "displacements")


def pairs(found: Crosscheck) -> Table:
    """A row per scene and two models: their largest difference, both bars there."""
    rows = [
        (scene.name, p.a, p.b, p.difference, p.bars, ", ".join(p.distinguishable_at) or "nowhere")
        for scene in found.scenes
        for p in found.pairs(scene)
    ]
    columns = (
        Column("scene"),
        Column("model"),
        Column("and"),
        Column("differ by", *_PER_CENT, "z.3f"),
        Column("bars", *_PER_CENT, ".2g"),
        Column("told apart at"),
    )
    return Table("Every two models", columns, tuple(rows), "pairs")


def external_codes(found: Crosscheck) -> Table:
    """A row per external code: its version, or what it needs to be installed."""
    rows = [
        (one.code.name, one.code.called, one.version or f"absent: needs {one.code.needs}")
        for one in found.codes
    ]
    columns = (Column("code"), Column("what it is", prose=True), Column("version", prose=True))
    return Table("External codes", columns, tuple(rows), "judges")


def refusals(found: Crosscheck) -> list[str]:
    """A sentence for every reason for which a model leaves scenes out."""
    reasons: dict[tuple[str, str], list[str]] = {}
    for scene in found.scenes:
        for one in found.convergences[scene.name]:
            if one.refused:
                reasons.setdefault((one.name, one.finest["message"]), []).append(scene.name)
    return [f"{name} leaves out {', '.join(scenes)}: {reason}." for (name, reason), scenes in reasons.items()]

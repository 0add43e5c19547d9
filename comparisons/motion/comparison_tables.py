"""What `sheetbench compare --duration` shows: measures of each motion, what differs, what it cost."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from comparisons.motion import frames
from comparisons.motion.frames import Frame
from comparisons.motion.measures import leading, measured_alike
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Picture, Report
from sheetbench.answers.table import Column, Table, number
from sheetbench.scenes import FieldMesh, Status
from sheetbench.scenes.measured_history import COMPONENTS

if TYPE_CHECKING:
    from comparisons.motion.comparison import MotionComparison


def report(found: MotionComparison) -> Report:
    """The answer, ready to be shown."""
    histories, reference = found.histories, found.reference
    attachments = {f"{name}.csv": partial(_write_samples, found=found, name=name) for name in histories}
    if all(len(history.extra["frames"]) for history in histories.values()):
        attachments |= {f"{name}.pvd": partial(_write_frames, found=found, name=name) for name in histories}
        attachments["difference.pvd"] = partial(_write_difference, found=found)
    return Report(
        name="motion",
        title=found.scene.name,
        subtitle=found.scene.title,
        lead=f"moving for {histories[reference].time[-1]:g} s; differences from the {reference}",
        document=found.as_dict(),
        tables=(_measures(found), _differences(found), _runs(found)),
        notes=(
            *_bars(found),
            *(f"{name}: {note}" for name, history in histories.items() for note in history.notes()),
        ),
        complaints=tuple(
            f"{name}: {history.status}: {history.message}"
            for name, history in histories.items()
            if history.status is not Status.CONVERGED
        ),
        pictures=(Picture("motion", "comparisons.motion.comparison_figure:compose", (found,)),),
        attachments=attachments,
        settings={name: history.settings for name, history in histories.items()},
        met=found.converged,
    )


def _measures(found: MotionComparison) -> Table:
    truth = found.histories[found.reference]
    probe, component = leading(truth)
    rows = []
    for name, history in found.histories.items():
        of = measured_alike(history, truth)[0]
        damping = None if of.decay is None else of.decay / np.hypot(2.0 * np.pi, of.decay)
        rows.append((name, of.peak, of.peak_time, of.period, of.decay, damping))
    columns = (
        Column("model"),
        Column("first peak", "m", "mm", 1e3, "z.3f"),
        Column("at", "s", "ms", 1e3, "z.2f"),
        Column("period", "s", "ms", 1e3, "z.2f"),
        Column("decay a period", form="z.4f"),
        Column("as a damping ratio", "", form="z.4f"),
    )
    caption = f"{COMPONENTS[component]} of {probe}, which moves farthest: first peak, period, log decrement"
    return Table(caption, columns, tuple(rows), "measures")


def _differences(found: MotionComparison) -> Table:
    """A row a probe, then all together with what the measures differ by."""
    truth, rows = found.histories[found.reference], []
    scale = max(float(np.abs(u).max()) for u in truth.probes.values()) or np.nan
    for d in found.differences:
        history = found.histories[d["of"]]
        count = min(len(history.time), len(truth.time))
        for probe, u in history.probes.items():
            apart = u[:count] - truth.probes[probe][:count]
            rms = float(np.sqrt(np.mean(np.sum(apart**2, axis=1)))) / scale
            rows.append((d["of"], probe, float(np.abs(apart).max()) / scale, rms, *[None] * 4))
        rows.append(
            (d["of"], "all", *(d[key] for key in ("largest", "rms", "peak", "period", "phase", "decay")))
        )
    columns = (
        Column("of"),
        Column("probe"),
        *(Column(name, "", "%", 100.0, "z.2f") for name in ("largest", "rms", "peak", "period", "phase")),
        Column("decay", form="z.4f"),
    )
    caption = (
        f"Off the {found.reference}: largest and rms of its largest displacement, phase of a period; decay: "
        "difference of the decrements"
    )
    return Table(caption, columns, tuple(rows), "differences")


def _runs(found: MotionComparison) -> Table:
    columns = (
        Column("model", detail=True),  # labels begin with it
        Column("label"),
        Column("integrator"),
        Column("status"),
        Column("steps", form="d"),
        Column("set-up", "s", "s", 1.0, ".2f"),
        Column("time", "s", "s", 1.0, ".2f"),
    )
    rows = [
        (name, h.label, h.integrator, str(h.status), h.steps, h.setup_seconds, h.solve_seconds)
        for name, h in found.histories.items()
    ]
    return Table("What it took", columns, tuple(rows), "runs")


def _bars(found: MotionComparison) -> list[str]:
    """What the reference's mesh and steps leave uncertain, in a sentence."""
    known = {name: bar for name, bar in found.uncertainty.items() if bar is not None}
    if not known:
        return []
    how = {"mesh": "elements twice as large", "step": "steps twice as long"}
    parts = (f"{how[name]} move it by up to {number(100 * bar, '.2g')} %" for name, bar in known.items())
    said = " and ".join(parts)
    notes = [f"error of the {found.reference} itself: {said} of its largest displacement"]
    largest, mesh = found.differences[0]["largest"], known.get("mesh")
    if largest is not None and mesh is not None and largest < mesh:
        notes.append(
            f"the lattice is {number(100 * largest, '.2g')} % off, less than what larger elements change: "
            "give more --elements before judging it"
        )
    return notes


def _write_samples(path: Path, found: MotionComparison, name: str) -> None:
    write_text(path, found.histories[name].series().to_csv())


def _write_frames(path: Path, found: MotionComparison, name: str) -> None:
    history = found.histories[name]
    frames.write_series(path, frames.frames(history) if "lattice" in history.extra else _meshes(found))


def _meshes(found: MotionComparison) -> list[tuple[float, FieldMesh]]:
    """Time [s] and mesh of every displacement that the reference kept."""
    extra = found.histories[found.reference].extra
    mesh: FieldMesh = extra["mesh"]
    kept = zip(extra["frame_times"].tolist(), extra["frames"], strict=True)
    return [(time, FieldMesh(mesh.points, mesh.cells, {"displacement": u})) for time, u in kept]


def _write_difference(path: Path, found: MotionComparison) -> None:
    """On the reference's mesh its mid-surface's displacement, and the lattice's less it."""
    lattice: list[tuple[float, Frame]] = frames.frames(found.histories["lumped"])
    extra, shown = found.histories[found.reference].extra, []
    mesh: FieldMesh = extra["mesh"]
    plan = mesh.points[:, :2]
    for kept, (time, frame) in zip(extra["frames"], lattice, strict=False):
        u = extra["sample"](kept, plan)
        fields = {"displacement": u, "difference": frame.displacement(plan) - u}
        shown.append((time, FieldMesh(mesh.points, mesh.cells, fields)))
    frames.write_series(path, shown)

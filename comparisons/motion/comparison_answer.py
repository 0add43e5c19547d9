"""What `sheetbench compare --duration` shows: measures of each motion, what differs, what it cost."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.motion import frames
from comparisons.motion.frames import Frame
from comparisons.motion.measures import difference, leading, measured_alike
from sheetbench.answers.answer import Answer
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Film, Picture, Write
from sheetbench.answers.table import Column, Table, number
from sheetbench.scenes import FieldMesh, History, Scene, Status
from sheetbench.scenes.measured_history import COMPONENTS


@dataclass(frozen=True, repr=False)
class MotionComparison(Answer):
    """Histories by model, the lattice's first, the reference's last; codes: of which program's version some
    are; left_out, failed: why models were refused, or did not reach their end, a sentence each; uncertainty:
    how far the reference may be off by its mesh and by its steps, as `largest` and `rms` are measured; None
    where it was not asked; animate: draw the sheets moving, side by side."""

    file_name = "motion"
    scene: Scene
    histories: dict[str, History]
    uncertainty: dict[str, float | None] = field(default_factory=dict)
    animate: bool = False
    codes: dict[str, str] = field(default_factory=dict)
    left_out: tuple[str, ...] = ()
    failed: tuple[str, ...] = ()

    @property
    def reference(self) -> str:
        """The model that the others are measured against."""
        return list(self.histories)[-1]

    @property
    def converged(self) -> bool:
        """Whether all runs reached their end."""
        ends = (history.status is Status.CONVERGED for history in self.histories.values())
        return not self.failed and all(ends)

    @property
    def differences(self) -> list[dict[str, Any]]:
        """Of every other model from the reference."""
        against, truth = self.reference, self.histories[self.reference]
        others = (name for name in self.histories if name != against)
        return [
            {"of": name, "against": against, **difference(self.histories[name], truth)} for name in others
        ]

    def document(self) -> dict[str, Any]:
        """The JSON document of `sheetbench compare --duration`: metres, newtons, seconds, joules."""
        truth = self.histories[self.reference]
        return {
            "scene": self.scene.document(),
            "failed": self.failed,
            "motion": {
                "time": truth.time,
                "probes": {name: history.probes for name, history in self.histories.items()},
                "energies": {name: history.energies for name, history in self.histories.items()},
                "reactions": {name: history.reactions for name, history in self.histories.items()},
                "measures": {
                    name: measured_alike(history, truth)[0].as_dict()
                    for name, history in self.histories.items()
                },
                "differences": self.differences,
                "uncertainty": self.uncertainty,
            },
            "solutions": [
                {
                    "model": name,
                    "label": history.label,
                    "integrator": history.integrator,
                    "settings": history.settings,
                    "status": str(history.status),
                    "message": history.message,
                    "steps": history.steps,
                    "setup_seconds": history.setup_seconds,
                    "solve_seconds": history.solve_seconds,
                }
                for name, history in self.histories.items()
            ],
        }

    def heading(self) -> tuple[str, str, str]:
        end = self.histories[self.reference].time[-1]
        lead = f"moving for {end:g} s; differences from the {self.reference}"
        return self.scene.name, self.scene.title, lead

    def tables(self) -> tuple[Table, ...]:
        return _measures(self), _differences(self), _runs(self)

    def figures(self) -> tuple[Picture, ...]:
        drawn = Picture("motion", "comparisons.motion.comparison_figure:compose", (self,))
        film = "comparisons.motion.animation:animate_both"
        return (drawn, Film("both", film, (self.scene, self.histories))) if self.animate else (drawn,)

    def notes(self) -> list[str]:
        own = (f"{name}: {note}" for name, history in self.histories.items() for note in history.notes())
        versions = (f"{name} {version}" for name, version in self.codes.items())
        return [*_bars(self), *versions, *self.left_out, *own]

    def complaints(self) -> list[str]:
        ends = (f"{name}: {c}" for name, history in self.histories.items() for c in history.complaints())
        return [*self.failed, *ends]

    def files(self) -> dict[str, Write]:
        """Samples of every model, and where frames were kept sheets at some moments."""
        found: dict[str, Write] = {
            f"{name}.csv": partial(_write_samples, found=self, name=name) for name in self.histories
        }
        if all(len(history.extra.get("frames", ())) for history in self.histories.values()):
            found |= {f"{n}.pvd": partial(_write_frames, found=self, name=n) for n in self.histories}
            found["difference.pvd"] = partial(_write_difference, found=self)
        return found

    def choices(self) -> dict[str, Any]:
        return {name: history.settings for name, history in self.histories.items()}

    @property
    def succeeded(self) -> bool:
        return self.converged


def _measures(found: MotionComparison) -> Table:
    truth = found.histories[found.reference]
    probe, component = leading(truth)
    rows = []
    for name, history in found.histories.items():
        of = measured_alike(history, truth)[0]
        rows.append((name, of.peak, of.peak_time, of.period, of.decay, of.damping))
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
        f"Difference from the {found.reference}: largest and rms of its largest displacement, phase of "
        "a period; decay: difference of the logarithmic decrements"
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
    how = {
        "mesh": "with elements twice as large",
        "step": "with steps twice as long",
        "finer": "on the mesh before its finest",
    }
    parts = (f"{number(100 * bar, '.2g')} % {how[name]}" for name, bar in known.items())
    changes = " and ".join(parts)
    notes = [f"error of the {found.reference} itself: it changes by up to {changes}"]
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
    if "lattice" in history.extra:
        frames.write_series(path, frames.frames(history))
    else:
        frames.write_series(path, [(time, sheet.mesh) for time, sheet in frames.surfaces(history)])


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

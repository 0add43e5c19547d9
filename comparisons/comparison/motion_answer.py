"""What `sheetbench compare --duration` shows: measures of each motion, what differs, what it cost."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from comparisons.comparison import frames
from comparisons.comparison.errors import one_of
from comparisons.comparison.measures import Measures, difference, leading, measured_alike
from comparisons.sweep.limits import in_all
from sheetbench.answers.answer import Answer
from sheetbench.answers.files import write_text
from sheetbench.answers.history import COMPONENTS, History
from sheetbench.answers.report import FILM, Picture, Write
from sheetbench.answers.table import NUMBER, PERCENT, SECONDS, Column, Table, number
from sheetbench.scenes import Scene
from sheetbench.scenes.language.summary import few
from sheetbench.scenes.meaning.motion import kinks

DOUBTFUL, SHARE = 0.1, 1.0 / 3.0  # a reference's bar beyond which it is doubtful: of itself, of a difference
DOUBLED = {"mesh": "with elements twice as large", "step": "with steps twice as long"}
WHOLE = ("largest", "rms", "peak", "period", "decay")  # of two motions' difference
OF_A_RUN = ("label", "integrator", "settings", "status", "message", "steps", "setup_seconds", "solve_seconds")
DIFFERENCES = (
    *("model", "probe", *(PERCENT("z.2f", name) for name in WHOLE[:-1]), NUMBER("z.4f", "decay")),
    *(PERCENT(".2g", "±"), Column("within ±")),
)
RUNS = (
    *(Column("model", detail=True), "label", "integrator", "status", NUMBER("d", "steps")),
    *(SECONDS(".2f", "set-up"), SECONDS(".2f", "time")),
)


@dataclass(frozen=True, repr=False)
class MotionComparison(Answer):
    """Histories by model, the lattice's first, the reference's last.

    uncertainty: how far the reference may be off by its mesh and by its steps, as `largest` and `rms` are
    measured, None where a run of it did not end; animate: draw the sheets moving, side by side.
    """

    file_name, notes_shown = "motion", 1
    scene: Scene
    histories: dict[str, History]
    uncertainty: dict[str, float | None] = field(default_factory=dict)
    animate: bool = False

    @property
    def lattice(self) -> History:
        """The chosen lattice's motion."""
        return next(iter(self.histories.values()))

    def __getitem__(self, model: str) -> History:
        """Return the motion of a model by its name. Raises BadInput where there is none."""
        return one_of(self.histories, model)

    @property
    def reference(self) -> str:
        """The model that the others are measured against."""
        return list(self.histories)[-1]

    @property
    def succeeded(self) -> bool:
        return all(history.succeeded for history in self.histories.values())

    @property
    def _with_frames(self) -> dict[str, History]:
        """Histories that kept whole displacements."""
        return {name: one for name, one in self.histories.items() if len(one.extra.get("frames", ()))}

    @property
    def bar(self) -> float | None:
        """How far the reference may be off, by its mesh and its steps together, as `largest` is measured;
        None where one of them is not known."""
        return in_all(self.uncertainty)

    @cached_property
    def measures(self) -> tuple[Measures, ...]:
        """Of every model, of the extrema that all have."""
        return measured_alike(*self.histories.values())

    @cached_property
    def differences(self) -> list[dict[str, Any]]:
        """Of every other model from the reference; distinguishable: whether it is above the reference's own
        bar, None where that is not known."""
        against, truth, bar = self.reference, self.histories[self.reference], self.bar
        found = []
        for name in (name for name in self.histories if name != against):
            off = difference(self.histories[name], truth)
            beyond = None if bar is None else bool(off["largest"] > bar)
            found.append({"of": name, "against": against, **off, "distinguishable": beyond})
        return found

    @property
    def doubt(self) -> str:
        """That the reference is too uncertain to judge by, in a sentence; "" where it is not."""
        bar, off = self.bar, [one["largest"] for one in self.differences]
        if bar is None or not off or not (bar > DOUBTFUL or bar > SHARE * max(off)):
            return ""
        return (
            f"The {self.reference} itself is uncertain by {few(100 * bar)} % of its largest displacement: "
            "use more --elements before judging by it."
        )

    def document(self) -> dict[str, Any]:
        truth = self.histories[self.reference]
        return {
            "scene": self.scene.document(),
            "motion": {
                "time": truth.time,
                "probes": {name: history.probes for name, history in self.histories.items()},
                "energies": {name: history.accounts for name, history in self.histories.items()},
                "reactions": {name: history.reactions for name, history in self.histories.items()},
                "measures": dict(zip(self.histories, (one.as_dict() for one in self.measures), strict=True)),
                "differences": self.differences,
                "uncertainty": self.uncertainty,
                "bar": self.bar,
            },
            "solutions": [
                {"model": name, **{key: getattr(history, key) for key in OF_A_RUN}}
                for name, history in self.histories.items()
            ],
        }

    def heading(self) -> tuple[str, str, str]:
        end = self.histories[self.reference].time[-1]
        lead = f"motion over {end:g} s; differences are from the {self.reference}"
        return self.scene.name, self.scene.title, f"{self.doubt}\n{lead}" if self.doubt else lead

    def tables(self) -> tuple[Table, ...]:
        return self._measured(), self._different(), self._runs()

    def figures(self) -> tuple[Picture, ...]:
        drawn = Picture("motion", "comparisons.comparison.motion_figure:compose", (self,))
        moving = [*self._with_frames.values()]
        compose = "comparisons.comparison.animation:animate"
        film = Picture("both", compose, (self.scene, moving), formats=FILM)
        return (drawn, film) if self.animate else (drawn,)

    def result(self) -> str:
        bar, reference = self.bar, self.reference
        within = "an unknown error" if bar is None else f"{few(100 * bar)} %"
        off = few(100 * self.differences[0]["largest"])
        own = f"the {reference} within {within} of finer meshes and steps; E and damping are not in this."
        return f"The lattice is up to {off} % off the {reference} in motion, and {own}"

    def notes(self) -> list[str]:
        models: dict[str, list[str]] = {}
        for name, history in self.histories.items():
            for note in history.notes():
                models.setdefault(note, []).append(name)
        return [
            self.result(),
            *self._driven(),
            *self._bars(),
            *(f"{', '.join(names)}: {note}" for note, names in models.items()),
        ]

    def complaints(self) -> list[str]:
        found = [f"{name}: {c}" for name, history in self.histories.items() for c in history.complaints()]
        unknown = [DOUBLED[name] for name, bar in self.uncertainty.items() if bar is None]
        if unknown:
            found.append(
                f"{self.reference}: how far it may be off is not known, nor what is told apart from it: "
                f"{' and '.join(unknown)} there is no motion to its end; more --elements may help"
            )
        return found

    def files(self) -> dict[str, Write]:
        """Return samples of every model and, where frames were kept, sheets at some moments."""
        found: dict[str, Write] = {
            f"{name}.csv": partial(write_text, text=history.series().to_csv())
            for name, history in self.histories.items()
        }
        for name, history in self._with_frames.items():
            found[f"{name}.pvd"] = partial(frames.write_frames, history=history)
        return found

    def choices(self) -> dict[str, Any]:
        return {name: history.settings for name, history in self.histories.items()}

    def _measured(self) -> Table:
        probe, component = leading(self.histories[self.reference])
        rows = [replace(one, model=name) for name, one in zip(self.histories, self.measures, strict=True)]
        farthest = f"{COMPONENTS[component]} of {probe}, which moves farthest"
        fields = ("model", "peak", "peak_time", "period", "decay", "damping")
        caption = f"{farthest}: its peak, period and log decrement"
        return Table.of(Measures, rows, caption, "measures", fields=fields)

    def _different(self) -> Table:
        """A row a probe, then all together with what the measures differ by."""
        truth, rows, bar = self.histories[self.reference], list[tuple[Any, ...]](), self.bar
        scale = max(float(np.abs(u).max()) for u in truth.probes.values()) or np.nan
        for d in self.differences:
            history = self.histories[d["of"]]
            count = min(len(history.time), len(truth.time))
            for probe, u in history.probes.items():
                off = (u[:count] - truth.probes[probe][:count]) / scale
                rms = float(np.sqrt(np.mean(np.sum(off**2, axis=1))))
                rows.append((d["of"], probe, float(np.abs(off).max()), rms, *[None] * 5))
            within = None if bar is None else not d["distinguishable"]
            rows.append((d["of"], "all", *(d[name] for name in WHOLE), bar, within))
        caption = (
            f"Difference from the {self.reference}: largest and rms over its largest displacement; "
            "decay: difference of the log decrements"
        )
        text = f"±: how far the {self.reference} itself may be off, by mesh and steps"
        if self.uncertainty:
            return Table.listed(caption, DIFFERENCES, rows, "differences", text=text)
        of_files = [replace(one, detail=True) for one in DIFFERENCES[-2:] if isinstance(one, Column)]
        return Table.listed(caption, [*DIFFERENCES[:-2], *of_files], rows, "differences")

    def _runs(self) -> Table:
        shown = [key for key in OF_A_RUN if key not in ("settings", "message")]
        rows = ((name, *(getattr(one, key) for key in shown)) for name, one in self.histories.items())
        return Table.listed("Steps and time of each model", RUNS, rows, "runs")

    def _driven(self) -> list[str]:
        """What a decrement means while the sheet is driven, in a sentence."""
        start, first = self.histories[self.reference].time[0], self.measures[-1]
        until = max(kinks(self.scene), default=0.0)
        if first.decay is None or first.peak_time is None or until <= start + first.peak_time:
            return []
        return [
            f"The scene drives the sheet until {until:g} s: log decrement and damping ratio are those of the "
            "driven motion, not of the material's dampers (sheetbench modes lists these)."
        ]

    def _bars(self) -> list[str]:
        """What the reference's mesh and steps leave uncertain, in a sentence."""
        known = {name: bar for name, bar in self.uncertainty.items() if bar is not None}
        if not known:
            return []
        changes = " and ".join(f"{number(100 * bar, '.2g')} % {DOUBLED[name]}" for name, bar in known.items())
        within = ", ".join(one["of"] for one in self.differences if one["distinguishable"] is False)
        notes = [f"{self.reference}: its own motion changes by up to {changes}"]
        return [*notes, f"{within}: within the {self.reference}'s own error."] if within else notes

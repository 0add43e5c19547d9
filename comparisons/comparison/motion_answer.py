"""The answer of `sheetbench compare --duration`: measures of motions, their differences and costs."""

from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from comparisons.comparison import frames
from comparisons.comparison.errors import one_of
from comparisons.comparison.measures import Measures, difference, leading, matching_measures
from comparisons.sweep.limits import total_bar
from sheetbench.answers.answer import Answer
from sheetbench.answers.files import write_text
from sheetbench.answers.history import COMPONENTS, History
from sheetbench.answers.report import FILM, Picture, Write
from sheetbench.answers.table import NUMBER, PERCENT, SECONDS, Column, Table, number
from sheetbench.scenes import Scene
from sheetbench.scenes.language.summary import few
from sheetbench.scenes.meaning.motion import kinks

DOUBTFUL, SHARE = 0.1, 1.0 / 3.0  # limits of a reliable reference's error bar: absolute, of a difference
COARSER = {"mesh": "on larger elements", "step": "in longer steps"}
OVERALL_KEYS = ("largest", "rms", "peak", "period", "decay")  # keys of `measures.difference`
OF_A_RUN = ("label", "integrator", "settings", "status", "message", "steps", "setup_seconds", "solve_seconds")
DIFFERENCES = (
    *("model", "probe", *(PERCENT("z.2f", name) for name in OVERALL_KEYS[:-1]), NUMBER("z.4f", "decay")),
    *(PERCENT(".2g", "±"), Column("within ±")),
)
RUNS = (
    *(Column("model", detail=True), "label", "integrator", "status", NUMBER("d", "steps")),
    *(SECONDS(".2f", "set-up"), SECONDS(".2f", "time")),
)


@dataclass(frozen=True, repr=False)
class MotionComparison(Answer):
    """Histories by model, the lattice's first, the reference's last. uncertainty: error bars of the reference
    by its mesh and by its steps, in the norm of `largest`, None if a run of it failed; animate: make an
    animation of the sheets side by side."""

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
        """Return the motion of a model by its name. Raises BadInput for an unknown name."""
        return one_of(self.histories, model)

    @property
    def reference(self) -> str:
        """Name of the reference."""
        return list(self.histories)[-1]

    @property
    def succeeded(self) -> bool:
        return all(history.succeeded for history in self.histories.values())

    @property
    def _with_frames(self) -> dict[str, History]:
        """Histories with stored displacement fields."""
        return {name: run for name, run in self.histories.items() if len(run.extra.get("frames", ()))}

    @property
    def bar(self) -> float | None:
        """Error bar of the reference by mesh and steps, in the norm of `largest`, if known."""
        return total_bar(self.uncertainty)

    @cached_property
    def measures(self) -> tuple[Measures, ...]:
        """Measures of every model, from an equal number of extrema."""
        return matching_measures(*self.histories.values())

    @cached_property
    def differences(self) -> list[dict[str, Any]]:
        """Differences of all other models from the reference; distinguishable: whether a difference exceeds
        the reference's error bar, None if unknown."""
        reference, truth, bar = self.reference, self.histories[self.reference], self.bar
        out = []
        for name in (name for name in self.histories if name != reference):
            values = difference(self.histories[name], truth)
            beyond = None if bar is None else bool(values["largest"] > bar)
            out.append({"of": name, "against": reference, **values, "distinguishable": beyond})
        return out

    @property
    def doubt(self) -> str:
        """A warning about a reference that is too uncertain for a verdict, or ""."""
        bar, errors = self.bar, [row["largest"] for row in self.differences]
        if bar is None or not errors or not (bar > DOUBTFUL or bar > SHARE * max(errors)):
            return ""
        return (
            f"The {self.reference} itself is uncertain by {few(100 * bar)} % of its largest displacement: "
            "use more --elements before comparing with it."
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
                "measures": dict(zip(self.histories, (m.as_dict() for m in self.measures), strict=True)),
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
        curves = Picture("motion", "comparisons.comparison.motion_figure:compose", (self,))
        histories = [*self._with_frames.values()]
        compose = "comparisons.comparison.animation:animate"
        film = Picture("both", compose, (self.scene, histories), formats=FILM)
        return (curves, film) if self.animate else (curves,)

    def result(self) -> str:
        bar, reference = self.bar, self.reference
        bar_text = "an unknown error" if bar is None else f"{few(100 * bar)} %"
        error = few(100 * self.differences[0]["largest"])
        return (
            f"The lattice is up to {error} % off the {reference} in motion, and the {reference} within "
            f"{bar_text} of finer meshes and steps; errors of E and damping are not included."
        )

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
        complaints = [f"{name}: {c}" for name, run in self.histories.items() for c in run.complaints()]
        unknown = [COARSER[name] for name, bar in self.uncertainty.items() if bar is None]
        if unknown:
            complaints.append(
                f"{self.reference}: its error bar is not known, because a run {' and '.join(unknown)} "
                "failed; more --elements may help"
            )
        return complaints

    def files(self) -> dict[str, Write]:
        """Return samples of every model, and the stored displacement fields."""
        files: dict[str, Write] = {
            f"{name}.csv": partial(write_text, text=history.series().to_csv())
            for name, history in self.histories.items()
        }
        for name, history in self._with_frames.items():
            files[f"{name}.pvd"] = partial(frames.write_frames, history=history)
        return files

    def choices(self) -> dict[str, Any]:
        return {name: history.settings for name, history in self.histories.items()}

    def _measured(self) -> Table:
        probe, component = leading(self.histories[self.reference])
        rows = [replace(m, model=name) for name, m in zip(self.histories, self.measures, strict=True)]
        fields = ("model", "peak", "peak_time", "period", "decay", "damping")
        name = f"{COMPONENTS[component]} of {probe}"
        caption = f"{name}, the largest displacement: its peak, period and log decrement"
        return Table.of(Measures, rows, caption, "measures", fields=fields)

    def _different(self) -> Table:
        """Return a table of differences: a row per probe, then one of all probes and the measures."""
        truth, rows, bar = self.histories[self.reference], list[tuple[Any, ...]](), self.bar
        scale = max(float(np.abs(u).max()) for u in truth.probes.values()) or np.nan
        for d in self.differences:
            history = self.histories[d["of"]]
            count = min(len(history.time), len(truth.time))
            for probe, u in history.probes.items():
                errors = (u[:count] - truth.probes[probe][:count]) / scale
                rms = float(np.sqrt(np.mean(np.sum(errors**2, axis=1))))
                rows.append((d["of"], probe, float(np.abs(errors).max()), rms, *[None] * 5))
            within = None if bar is None else not d["distinguishable"]
            rows.append((d["of"], "all", *(d[name] for name in OVERALL_KEYS), bar, within))
        caption = (
            f"Difference from the {self.reference}: largest and rms over its largest displacement; "
            "decay: difference of the log decrements"
        )
        text = f"±: error bar of the {self.reference}, by mesh and steps"
        if self.uncertainty:
            return Table.listed(caption, DIFFERENCES, rows, "differences", text=text)
        hidden = [replace(column, detail=True) for column in DIFFERENCES[-2:] if isinstance(column, Column)]
        return Table.listed(caption, [*DIFFERENCES[:-2], *hidden], rows, "differences")

    def _runs(self) -> Table:
        keys = [key for key in OF_A_RUN if key not in ("settings", "message")]
        rows = ((name, *(getattr(run, key) for key in keys)) for name, run in self.histories.items())
        return Table.listed("Steps and time of each model", RUNS, rows, "runs")

    def _driven(self) -> list[str]:
        """Return a note on the decrement of a driven motion."""
        start, first = self.histories[self.reference].time[0], self.measures[-1]
        until = max(kinks(self.scene), default=0.0)
        if first.decay is None or first.peak_time is None or until <= start + first.peak_time:
            return []
        return [
            f"The scene drives the sheet until {until:g} s: log decrement and damping ratio describe the "
            "driven motion, not the material's dampers (see sheetbench modes)."
        ]

    def _bars(self) -> list[str]:
        """Return notes on the reference's error bars by mesh and steps, and on models within them."""
        bars = {name: bar for name, bar in self.uncertainty.items() if bar is not None}
        if not bars:
            return []
        changes = " and ".join(
            f"{number(100 * bar, '.2g')} % by runs {COARSER[name]}" for name, bar in bars.items()
        )
        models = ", ".join(row["of"] for row in self.differences if row["distinguishable"] is False)
        notes = [f"{self.reference}: its motion is uncertain by {changes}"]
        return [*notes, f"{models}: within the {self.reference}'s own error."] if models else notes

"""What a run shows: where the probes end and how far they go, their plot over time, the series of frames."""

from __future__ import annotations

import shutil
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

from comparisons.models.grading import told
from comparisons.motion import frames
from comparisons.motion.history import Measured, as_dict, left_out, series, summary
from sheetbench.answers.figure_style import Look
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Picture, Report
from sheetbench.answers.table import number
from sheetbench.scenes import History, Scene, Status


def report(
    history: History, scene: Scene, measured: Mapping[str, Measured] | None = None, animate: bool = False
) -> Report:
    """What `sheetbench simulate` shows of a run; measured: histories by probe; animate: draw it moving."""
    truth = dict(measured or {})
    pictures = [Picture(("history.png", "history.pdf"), partial(_plot, history, scene, truth))]
    if animate:
        films = ("animation.gif", "animation.mp4") if shutil.which("ffmpeg") else ("animation.gif",)
        moving = partial(_animate, history, scene)
        pictures.append(Picture(films, moving))
    complete = history.status is Status.CONVERGED
    resumed = history.resumed_from
    earlier = f"went on from {resumed:.4g} s, which an earlier run had reached"
    return Report(
        name="history",
        title=scene.name,
        subtitle=scene.title,
        lead=f"{history.label}, {history.integrator}, {history.steps} steps",
        document=as_dict(history, truth),
        tables=(summary(history, truth),),
        notes=(*([earlier] if resumed else []), *told(history.settings), *steps(history), balance(history)),
        complaints=(
            *(() if complete else (f"{history.status}: {history.message}",)),
            *left_out(history, truth),
        ),
        pictures=tuple(pictures),
        attachments={
            "history.csv": lambda path: write_text(path, series(history).to_csv()),
            "frames.pvd": lambda path: frames.write_series(path, frames.frames(history)),
        },
        scene=scene,
        settings={"integrator": history.integrator, **history.settings},
        met=complete,
    )


def steps(history: History) -> list[str]:
    """Why the integrator is the one that it is, and how long an explicit one's steps may be, a line each."""
    found = []
    if why := history.settings.get("integrator_reason"):
        found.append(f"integrator {history.integrator}: {why}")
    if limit := history.settings.get("largest_step"):
        taken = number(1e3 * history.settings["step"], ".4g")
        found.append(f"steps of {taken} ms; the largest stable one is {number(1e3 * limit, '.4g')} ms")
    return found


def balance(history: History) -> str:
    """How well the run kept its energy, in a sentence."""
    spread = float(abs(history.balance - history.balance[0]).max())
    scale = max(float(abs(energy).max()) for energy in history.energies.values())
    held = number(spread / scale if scale else spread, ".1e")
    return f"energy balance held to {held} of the largest energy"


def _plot(
    history: History, scene: Scene, measured: dict[str, Measured], paths: Sequence[Path], look: Look
) -> None:
    from comparisons.motion.figure import plot

    plot(paths, history, scene.title or scene.name, measured, look)


def _animate(history: History, scene: Scene, paths: Sequence[Path], _: Look) -> str | None:
    from comparisons.report.offscreen import why_not

    impossible = why_not()
    if impossible is None:
        from comparisons.motion.animation import animate

        animate(paths, scene, frames.frames(history))
    return impossible

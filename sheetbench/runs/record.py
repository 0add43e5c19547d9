"""A motion as a `History`: what runs, where its samples go, its notes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypedDict, cast

import numpy as np

from sheetbench.answers.history import ENERGIES, History
from sheetbench.clock import now
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.numerics.time.method import Advance, AnyState, MotionMethod
from sheetbench.runs.run import Observer, Part, Run
from sheetbench.runs.schedule import Schedule
from sheetbench.runs.store import FolderStore, MemoryStore
from sheetbench.scenes import Scene
from sheetbench.scenes.objects.obstacles import CREEPS


@dataclass(frozen=True)
class Recipe(Generic[AnyState]):
    """A motion of a scene to be run. key: JSON-able, on what its numbers depend, beside the scene; rows: of a
    frame; start: the state to begin in, with the work of what moves at once."""

    scene: Scene
    label: str
    integrator: str
    settings: dict[str, Any]
    key: dict[str, Any]
    schedule: Schedule
    method: MotionMethod[AnyState]
    observer: Observer
    start: Callable[[], Advance[AnyState]]
    rows: int


class Keeping(TypedDict, total=False):
    """What is kept of a motion, and where: keywords of both solvers' `simulate`.

    store: a folder to stream to; a run that was stopped goes on from there. frames: whole displacements to
    keep, evenly over the run, in `extra`: "frames" (f, n, 3) [m], "frame_times" (f,) [s], the "mesh" they
    belong to, "sample", which takes one and plan points (p, 2) [m] to displacements (p, 3), and "axes", of
    each edge with chains the rest places (p, 3) and displacements (f, p, 3) [m] of its axis. progress: called
    with the time reached [s].
    """

    store: Path | None
    frames: int
    progress: Callable[[float], None] | None


def parted(options: dict[str, Any]) -> tuple[Keeping, dict[str, Any]]:
    """Return what options say of `Keeping`, and the others."""
    keeping = {name: options[name] for name in Keeping.__annotations__ if name in options}
    return cast(Keeping, keeping), {name: of for name, of in options.items() if name not in keeping}


def columns_of(scene: Scene, reactions: Iterable[str], wrenches: Mapping[str, np.ndarray]) -> list[Part]:
    """Return what a row holds: time, energies, displacements of probes, reactions, forces of actuators."""
    return [
        ("time", "", ()),
        *(("energy", name, ()) for name in ENERGIES),
        *(("probe", name, (3,)) for name in scene.probes),
        *(("reaction", name, (3,)) for name in reactions),
        *(("actuator", name, wrench.shape) for name, wrench in wrenches.items()),
    ]


def width(columns: Sequence[Part]) -> int:
    """How many numbers a row has."""
    return sum(math.prod(shape) for _, _, shape in columns)


def split(columns: Sequence[Part], rows: np.ndarray) -> dict[str, dict[str, np.ndarray]]:
    """Rows (n, width) as kind → name → (n, …)."""
    parts: dict[str, dict[str, np.ndarray]] = {kind: {} for kind, _, _ in columns}
    ends = np.cumsum([math.prod(shape) for _, _, shape in columns])
    for (kind, name, shape), part in zip(columns, np.split(rows, ends[:-1], axis=1), strict=True):
        parts[kind][name] = part.reshape(len(rows), *shape)
    return parts


def record(recipe: Recipe[AnyState], keeping: Keeping, began: float) -> History:
    """Run a motion, in memory or in a folder, from where that has come. began: when its set-up did [s].

    Raises BadInput for a folder that holds another run, or one of other code, that another process writes to
    or that cannot be written, and for damaged files.
    """
    frames, store, method = keeping.get("frames", 0), keeping.get("store"), recipe.method
    columns, schedule = recipe.observer.columns, recipe.schedule
    described = [[kind, name, list(shape)] for kind, name, shape in columns]
    with ExitStack() as open_store:
        shapes = {"samples": (width(columns),), "frames": (recipe.rows, 3)}
        kept: FolderStore | MemoryStore = MemoryStore(shapes)
        if store is not None:
            key = {
                "scene": recipe.scene.document(),
                **recipe.key,
                "integrator": recipe.integrator,
                "frames": frames,
                "columns": described,
            }
            kept = open_store.enter_context(FolderStore(store, shapes, key))
        shown = schedule.shown(frames)
        run = Run(method, recipe.observer, schedule, kept, shown, keeping.get("progress"))
        ready = now()
        with one_blas_thread():
            status, message = run.finish(recipe.start)
        done = now()
        parts, whole = split(columns, kept.rows("samples")), kept.rows("frames")
    creeping = (f"{name}: {CREEPS}" for name, one in recipe.scene.named_obstacles().items() if one.friction)
    return History(
        label=recipe.label,
        integrator=recipe.integrator,
        settings={**recipe.settings, **method.settings(), "every": schedule.every},
        status=status,
        message="; ".join(filter(None, [message, *creeping])),
        time=parts["time"][""],
        probes=parts.get("probe", {}),
        energies=parts["energy"],
        reactions=parts.get("reaction", {}),
        actuators=parts.get("actuator", {}),
        steps=run.steps,
        setup_seconds=ready - began,
        solve_seconds=done - ready,
        resumed_from=run.resumed_from,
        extra={"frames": whole, "frame_times": schedule.every * np.array(shown)[: len(whole)]},
    )

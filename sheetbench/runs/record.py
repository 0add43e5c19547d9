"""Record of a motion as a `History`: its recipe, the storage of its samples, its notes."""

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
    """A motion of a scene, ready to be run. key: data for JSON on which the numbers depend besides the
    scene. rows: number of rows of a frame. start: makes the initial state, with the work of parts that
    move at once."""

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


class StorageOptions(TypedDict, total=False):
    """Storage of a motion: keywords of both solvers' `simulate`.

    store: a folder for samples; a stopped run resumes from it. frames: number of whole displacements kept,
    evenly over the run, in `extra`: "frames" (f, n, 3) [m], "frame_times" (f,) [s], their "mesh", "sample",
    a function of a frame and plan points (p, 2) [m] with displacements (p, 3), and "axes", for each edge with
    chains the rest places (p, 3) and displacements (f, p, 3) [m] of its axis. progress: called with the time
    reached [s].
    """

    store: Path | None
    frames: int
    progress: Callable[[float], None] | None


def split_options(options: dict[str, Any]) -> tuple[StorageOptions, dict[str, Any]]:
    """Split options into the keywords of `StorageOptions` and the others."""
    keeping = {name: options[name] for name in StorageOptions.__annotations__ if name in options}
    return cast(StorageOptions, keeping), {name: of for name, of in options.items() if name not in keeping}


def columns_of(scene: Scene, reactions: Iterable[str], wrenches: Mapping[str, np.ndarray]) -> list[Part]:
    """Return the parts of a row: time, energies, displacements of probes, reactions, forces of actuators."""
    return [
        ("time", "", ()),
        *(("energy", name, ()) for name in ENERGIES),
        *(("probe", name, (3,)) for name in scene.probes),
        *(("reaction", name, (3,)) for name in reactions),
        *(("actuator", name, wrench.shape) for name, wrench in wrenches.items()),
    ]


def width(columns: Sequence[Part]) -> int:
    """Return the number of numbers in a row."""
    return sum(math.prod(shape) for _, _, shape in columns)


def split(columns: Sequence[Part], rows: np.ndarray) -> dict[str, dict[str, np.ndarray]]:
    """Split rows (n, width) into arrays (n, …) by kind and name."""
    parts: dict[str, dict[str, np.ndarray]] = {kind: {} for kind, _, _ in columns}
    ends = np.cumsum([math.prod(shape) for _, _, shape in columns])
    for (kind, name, shape), part in zip(columns, np.split(rows, ends[:-1], axis=1), strict=True):
        parts[kind][name] = part.reshape(len(rows), *shape)
    return parts


def record(recipe: Recipe[AnyState], keeping: StorageOptions, began: float) -> History:
    """Run a motion, in memory or in a folder, from the folder's last checkpoint.

    began: the clock's time at the start of the set-up [s]. Raises BadInput for a folder with another run or a
    run of other code, a folder in use or without permission to write, and for damaged files.
    """
    frames, store, method = keeping.get("frames", 0), keeping.get("store"), recipe.method
    columns, schedule = recipe.observer.columns, recipe.schedule
    described = [[kind, name, list(shape)] for kind, name, shape in columns]
    with ExitStack() as open_store:
        shapes = {"samples": (width(columns),), "frames": (recipe.rows, 3)}
        storage: FolderStore | MemoryStore = MemoryStore(shapes)
        if store is not None:
            key = {
                "scene": recipe.scene.document(),
                **recipe.key,
                "integrator": recipe.integrator,
                "frames": frames,
                "columns": described,
            }
            storage = open_store.enter_context(FolderStore(store, shapes, key))
        shown = schedule.shown(frames)
        run = Run(method, recipe.observer, schedule, storage, shown, keeping.get("progress"))
        ready = now()
        with one_blas_thread():
            status, message = run.finish(recipe.start)
        done = now()
        parts, whole = split(columns, storage.rows("samples")), storage.rows("frames")
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
